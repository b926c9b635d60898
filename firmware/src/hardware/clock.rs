//! The clocks: 168 MHz from the crystal, and milliseconds since the start.
//!
//! Not by the hardware layer's `freeze`: that searches the PLL's factors at run time, can panic, and waits for a dead crystal for ever.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use stm32f4xx_hal::pac::{FLASH, RCC};

use crate::clocks::{CORE, HSI_MHZ, Pll, pll};
use crate::settings::{CRYSTAL_MHZ, OSCILLATOR, WATCHDOG_MS};

/// How long the crystal is waited for, ms: it takes some milliseconds.
const CRYSTAL_MS: u32 = 30;
/// How long the PLL is waited for, ms: it takes 0.3 at most.
const LOCK_MS: u32 = 3;
/// Looks at a flag in a millisecond, of five cycles or more each.
const LOOKS: u32 = HSI_MHZ * 1000 / 5;

const _: () = assert!(
    CRYSTAL_MHZ >= 4 && CRYSTAL_MHZ <= 26,
    "CRYSTAL_MHZ must be 4 to 26: the frequency of the board's crystal"
);
// In looks of up to ten cycles, and the watchdog's clock may run at one and a half of its rate.
const _: () = assert!(
    2 * 2 * (CRYSTAL_MS + 2 * LOCK_MS) <= WATCHDOG_MS,
    "WATCHDOG_MS must be 150 or more: a dead crystal takes so long to be told"
);

/// Waits until the clocks just switched on have reached their peripherals: a write before that is lost.
///
/// Errata ES0182, "Delay after an RCC peripheral clock enabling"; of the remedies there, reading back was seen to fail on the chip.
pub fn settle() {
    cortex_m::asm::dsb();
}

/// Starts the PLL on the crystal, or on the chip's own oscillator; false where it does not lock.
fn lock(rcc: &RCC, crystal: bool, Pll { m, n }: Pll) -> bool {
    // CR.PLLON: off, or its factors could not be set.
    rcc.cr().modify(|_, w| w.pllon().clear_bit());
    let _ = (0..LOOKS).any(|_| rcc.cr().read().pllrdy().bit_is_clear());
    // PLLCFGR: 336 MHz in the PLL, 168 MHz out of P, 48 MHz out of Q. The rest as after a reset: P divides by 2, and bit 29 must stay 1.
    #[allow(unsafe_code, reason = "the fields take any bits")]
    // SAFETY: the factors are within the limits of RM0090, 7.3.2.
    rcc.pllcfgr().write(|w| unsafe {
        w.pllsrc().bit(crystal);
        w.pllm().bits(m);
        w.plln().bits(n);
        w.pllq().bits(7)
    });
    rcc.cr().modify(|_, w| w.pllon().set_bit());
    (0..LOCK_MS * LOOKS).any(|_| rcc.cr().read().pllrdy().bit_is_set())
}

/// Starts the clocks; false where the crystal is dead, or nothing that the PLL locks to: then they come from the chip's own oscillator,
/// which serves the line only.
pub fn start(rcc: &RCC, flash: &FLASH) -> bool {
    // Known here: nothing is divided at run time.
    const CRYSTAL: Pll = pll(CRYSTAL_MHZ);
    const OWN: Pll = pll(HSI_MHZ);
    // PWR_CR.VOS stays as after a reset: scale 1, which more than 144 MHz want (RM0090, 5.4.1).
    // ACR: five wait states at 168 MHz and 3.3 V (RM0090, 3.5.1), hidden by both caches. No prefetch: it is heard in the converters
    // (errata "Internal noise impacting the ADC accuracy", AN4073), and revision A has none that works (ES0182).
    flash.acr().modify(|_, w| {
        w.latency().ws5();
        w.icen().set_bit();
        w.dcen().set_bit()
    });
    // CFGR: APB1 at 42 MHz, APB2 at 84 MHz, their most (RM0090, 7.2).
    rcc.cfgr().modify(|_, w| w.ppre1().div4().ppre2().div2());
    // CR.HSEBYP: an oscillator instead of the crystal (RM0090, 7.2.1). CR.HSEON: on.
    rcc.cr().modify(|_, w| w.hsebyp().bit(OSCILLATOR));
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    let swings = (0..CRYSTAL_MS * LOOKS).any(|_| rcc.cr().read().hserdy().bit_is_set());
    let crystal = swings && lock(rcc, true, CRYSTAL);
    // CFGR.SW: on to the PLL.
    if crystal || lock(rcc, false, OWN) {
        rcc.cfgr().modify(|_, w| w.sw().pll());
    }
    // CR.CSSON: should the crystal stop, an NMI says so.
    rcc.cr().modify(|_, w| w.csson().bit(crystal));
    crystal
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
