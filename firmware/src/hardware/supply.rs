//! Watches the supply: below 2.7 V the flash is too slow for the clock (RM0090, 3.5.1), and the chip, as delivered, is reset only below 1.7 V.
//!
//! Registers by their names in RM0090, 5.2.3 and 12.3.

use stm32f4xx_hal::pac::{EXTI, PWR, RCC};

use super::clock;
use super::watchdog::Watchdog;
use crate::clocks::HSI_MHZ;

/// Longest wait for the supply, ms; the device then starts in any case.
const RISE_MS: u32 = 200;
/// Turns of `delay`'s loop in a millisecond: it takes three cycles a turn.
const TURNS_PER_MS: u32 = 1000 * HSI_MHZ / 3;

/// Starts the detector and waits for the supply, before the clock is raised; false if it stays low.
///
/// From then on the interrupt `PVD` comes when the supply falls: the device must be restarted by it, while the flash can still be read.
pub fn start(rcc: &RCC, power: &PWR, lines: &EXTI, watchdog: &mut Watchdog) -> bool {
    // APB1ENR.PWREN: clock on.
    rcc.apb1enr().modify(|_, w| w.pwren().set_bit());
    clock::settle();
    // CR.PLS 6: about 2.93 V falling and 3.03 V rising. Level 7 may be above a supply of 3.3 V less 5 % (data sheet, "Embedded reset and
    // power control block characteristics").
    power
        .cr()
        .modify(|_, w| w.pls().set(0b110).pvde().set_bit());
    let is_high = (0..RISE_MS).any(|_| {
        cortex_m::asm::delay(TURNS_PER_MS);
        watchdog.feed();
        // CSR.PVDO: low.
        power.csr().read().pvdo().bit_is_clear()
    });
    // Line 16, where PVDO rises as the supply falls. PR: what was before is forgotten. IMR: an interrupt.
    lines.rtsr().modify(|_, w| w.tr16().set_bit());
    lines.pr().write(|w| w.pr16().clear_bit_by_one());
    lines.imr().modify(|_, w| w.mr16().set_bit());
    is_high
}
