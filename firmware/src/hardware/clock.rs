//! The clocks: 168 MHz from the crystal, and milliseconds since the start.
//!
//! The hardware layer's `freeze` is not used: it searches the PLL's factors at run time, can panic, and waits for a dead crystal for ever.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use stm32f4xx_hal::pac::{FLASH, RCC};

use crate::clocks::{CORE, HSI_MHZ, Pll, pll};
use crate::settings::{CRYSTAL_MHZ, OSCILLATOR, WATCHDOG_MS};

/// Longest wait for the crystal, ms: it takes a few milliseconds to start.
const CRYSTAL_MS: u32 = 30;
/// Longest wait for the PLL, ms: it takes 0.3 ms at most to lock.
const LOCK_MS: u32 = 3;
/// Polls of a flag in a millisecond, at five cycles each; they may take more.
const POLLS_PER_MS: u32 = HSI_MHZ * 1000 / 5;

const _: () = assert!(
    CRYSTAL_MHZ >= 4 && CRYSTAL_MHZ <= 26,
    "CRYSTAL_MHZ must be 4 to 26: the frequency of the board's crystal"
);
// A poll may take ten cycles, and the watchdog's clock may run half as fast again.
const _: () = assert!(
    2 * 2 * (CRYSTAL_MS + 2 * LOCK_MS) <= WATCHDOG_MS,
    "WATCHDOG_MS must be 150 or more: a dead crystal takes so long to be told"
);

/// Waits until clocks that were just enabled have reached their peripherals: a write before that would be lost.
///
/// See errata ES0182, "Delay after an RCC peripheral clock enabling". Of its remedies, reading back was seen to fail on the chip.
pub fn settle() {
    cortex_m::asm::dsb();
}

/// Starts the PLL on the crystal or on the internal oscillator; false if it does not lock.
fn lock(rcc: &RCC, crystal: bool, Pll { m, n }: Pll) -> bool {
    // CR.PLLON: off, as its factors cannot be set otherwise.
    rcc.cr().modify(|_, w| w.pllon().clear_bit());
    let _ = (0..POLLS_PER_MS).any(|_| rcc.cr().read().pllrdy().bit_is_clear());
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
    (0..LOCK_MS * POLLS_PER_MS).any(|_| rcc.cr().read().pllrdy().bit_is_set())
}

/// Starts the clocks; false if the crystal is dead or the PLL does not lock to it. They then come from the internal oscillator, which is
/// good enough for the line only.
pub fn start(rcc: &RCC, flash: &FLASH) -> bool {
    // Constants, so that nothing is divided at run time.
    const CRYSTAL: Pll = pll(CRYSTAL_MHZ);
    const OWN: Pll = pll(HSI_MHZ);
    // PWR_CR.VOS stays as after a reset: scale 1, required above 144 MHz (RM0090, 5.4.1).
    // ACR: five wait states at 168 MHz and 3.3 V (RM0090, 3.5.1), which both caches hide in part. No prefetch: it adds noise to the
    // converters (errata "Internal noise impacting the ADC accuracy", AN4073), and does not work in revision A (ES0182).
    flash.acr().modify(|_, w| {
        w.latency().ws5();
        w.icen().set_bit();
        w.dcen().set_bit()
    });
    // CFGR: APB1 at 42 MHz, APB2 at 84 MHz, their maxima (RM0090, 7.2).
    rcc.cfgr().modify(|_, w| w.ppre1().div4().ppre2().div2());
    // CR.HSEBYP: an oscillator instead of the crystal (RM0090, 7.2.1). CR.HSEON: on.
    rcc.cr().modify(|_, w| w.hsebyp().bit(OSCILLATOR));
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    let swings = (0..CRYSTAL_MS * POLLS_PER_MS).any(|_| rcc.cr().read().hserdy().bit_is_set());
    let crystal = swings && lock(rcc, true, CRYSTAL);
    // CFGR.SW: run from the PLL.
    if crystal || lock(rcc, false, OWN) {
        rcc.cfgr().modify(|_, w| w.sw().pll());
    }
    // CR.CSSON: an NMI if the crystal stops.
    rcc.cr().modify(|_, w| w.csson().bit(crystal));
    crystal
}

static MILLISECONDS: AtomicU32 = AtomicU32::new(0);

/// Starts the millisecond tick.
pub fn start_tick(mut systick: SYST) {
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(CORE / 1000 - 1);
    systick.clear_current();
    systick.enable_counter();
    systick.enable_interrupt();
}

/// To be called from the tick's interrupt.
pub fn tick() {
    let now = MILLISECONDS.load(Ordering::Relaxed);
    MILLISECONDS.store(now.wrapping_add(1), Ordering::Relaxed);
}

/// Milliseconds since the start; they wrap.
pub fn now() -> u32 {
    MILLISECONDS.load(Ordering::Relaxed)
}
