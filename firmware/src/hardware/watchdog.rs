//! The independent watchdog, which has its own oscillator and cannot be stopped.

#![allow(unsafe_code, reason = "the registers take any bits")]

use stm32f4xx_hal::pac::{DBGMCU, IWDG};

use crate::settings::WATCHDOG_MS;

/// Reload value in ticks of a millisecond, within 47 %: the 32 kHz oscillator over 32.
const RELOAD: u16 = WATCHDOG_MS as u16;
const _: () = assert!(
    WATCHDOG_MS > 0 && WATCHDOG_MS < 1 << 12,
    "WATCHDOG_MS must be 1 to 4095"
);

/// Polls of the status before the watchdog is fed in any case, some 12 ms at the initial 16 MHz. Its registers need five or six cycles of
/// its clock, by ST's own driver (stm32f4xx_hal_iwdg.c) perhaps after the divider: 11 ms at 17 kHz.
const MAX_POLLS: u32 = 40_000;

/// The running watchdog.
pub struct Watchdog(IWDG);

impl Watchdog {
    /// Starts the watchdog; it pauses while a debugger halts the core.
    pub fn start(iwdg: IWDG, debug: &DBGMCU) -> Self {
        // APB1_FZ.DBG_IWDG_STOP.
        debug.apb1_fz().modify(|_, w| w.dbg_iwdg_stop().set_bit());
        // SAFETY: keys and values are those of RM0090, 21.4.
        unsafe {
            // KR 0xCCCC starts it, 0x5555 opens PR and RLR, 0xAAAA loads the counter.
            iwdg.kr().write(|w| w.bits(0xCCCC));
            iwdg.kr().write(|w| w.bits(0x5555));
            // PR 3: division by 32.
            iwdg.pr().write(|w| w.bits(3));
            iwdg.rlr().write(|w| w.bits(RELOAD));
        }
        // SR.PVU, RVU: until both values are updated, feeding would load the reset values, which last for seconds.
        let _ = (0..MAX_POLLS).any(|_| iwdg.sr().read().bits() == 0);
        let mut watchdog = Self(iwdg);
        watchdog.feed();
        watchdog
    }

    /// Restarts the count of [`WATCHDOG_MS`]; to be called only while the pipeline is alive.
    pub fn feed(&mut self) {
        // SAFETY: the key that loads the counter.
        self.0.kr().write(|w| unsafe { w.bits(0xAAAA) });
    }
}
