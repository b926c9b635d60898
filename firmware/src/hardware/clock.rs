//! The clocks: 168 MHz from the crystal, and milliseconds since the start.
//!
//! Not by the hardware layer's `freeze`: that searches the PLL's factors at run time, can panic, and waits for a dead crystal for ever.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use stm32f4xx_hal::pac::{FLASH, RCC};

use crate::clocks::{CORE, HSI_MHZ, Pll, pll};
use crate::settings::{CRYSTAL_MHZ, WATCHDOG_MS};

/// How long an oscillator is waited for, ms: a crystal takes some milliseconds.
const PATIENCE_MS: u32 = 30;
/// Looks at its flag in that time, of five cycles or more each.
const PATIENCE: u32 = PATIENCE_MS * HSI_MHZ * 1000 / 5;

const _: () = assert!(
    CRYSTAL_MHZ >= 4 && CRYSTAL_MHZ <= 26,
    "CRYSTAL_MHZ must be 4 to 26: the frequency of the board's crystal"
);
// Crystal and PLL are waited for, in looks of up to ten cycles, and the watchdog's clock may run at one and a half of its rate.
const _: () = assert!(
    2 * 2 * PATIENCE_MS * 2 <= WATCHDOG_MS,
    "WATCHDOG_MS must be 240 or more: a dead crystal takes so long to be told"
);

/// Waits until the clocks just switched on have reached their peripherals: a write before that is lost.
///
/// Errata ES0182, "Delay after an RCC peripheral clock enabling"; of the remedies there, reading back was seen to fail on the chip.
pub fn settle() {
    cortex_m::asm::dsb();
}

/// Starts the clocks; false where the crystal is dead: then they come from the chip's own oscillator, which serves the line only.
pub fn start(rcc: &RCC, flash: &FLASH) -> bool {
    // CR.HSEON: the crystal's oscillator.
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    let crystal = (0..PATIENCE).any(|_| rcc.cr().read().hserdy().bit_is_set());
    // Both known here: nothing is divided at run time.
    const PLLS: [Pll; 2] = [pll(HSI_MHZ), pll(CRYSTAL_MHZ)];
    let [own, external] = PLLS;
    let Pll { m, n } = if crystal { external } else { own };
    // PLLCFGR: 336 MHz in the PLL, 168 MHz out of P, 48 MHz out of Q. The rest as after a reset: P divides by 2, and bit 29 must stay 1.
    // So is PWR_CR.VOS: scale 1, which more than 144 MHz want (RM0090, 5.4.1).
    #[allow(unsafe_code, reason = "the fields take any bits")]
    // SAFETY: the PLL is off after a reset, and the factors are within the limits of RM0090, 7.3.2.
    rcc.pllcfgr().write(|w| unsafe {
        w.pllsrc().bit(crystal);
        w.pllm().bits(m);
        w.plln().bits(n);
        w.pllq().bits(7)
    });
    // ACR: five wait states at 168 MHz and 3.3 V (RM0090, 3.5.1), hidden by both caches. No prefetch: it is heard in the converters
    // (errata "Internal noise impacting the ADC accuracy", AN4073), and revision A has none that works (ES0182).
    flash.acr().modify(|_, w| {
        w.latency().ws5();
        w.icen().set_bit();
        w.dcen().set_bit()
    });
    // CFGR: APB1 at 42 MHz, APB2 at 84 MHz, their most (RM0090, 7.2).
    rcc.cfgr().modify(|_, w| w.ppre1().div4().ppre2().div2());
    // CR.PLLON, then CFGR.SW: on to the PLL once it has locked.
    rcc.cr().modify(|_, w| w.pllon().set_bit());
    let locked = (0..PATIENCE).any(|_| rcc.cr().read().pllrdy().bit_is_set());
    if locked {
        rcc.cfgr().modify(|_, w| w.sw().pll());
    }
    // CR.CSSON: should the crystal stop, an NMI says so.
    rcc.cr().modify(|_, w| w.csson().bit(crystal));
    crystal && locked
}

static MILLISECONDS: AtomicU32 = AtomicU32::new(0);

/// Starts the tick of a millisecond.
pub fn start_tick(mut systick: SYST) {
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(CORE / 1000 - 1);
    systick.clear_current();
    systick.enable_counter();
    systick.enable_interrupt();
}

/// The tick's interrupt.
pub fn tick() {
    let now = MILLISECONDS.load(Ordering::Relaxed);
    MILLISECONDS.store(now.wrapping_add(1), Ordering::Relaxed);
}

/// Milliseconds since the start; they wrap.
pub fn now() -> u32 {
    MILLISECONDS.load(Ordering::Relaxed)
}
