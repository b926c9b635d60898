//! The main loop of the images for boards.

use antinode::Sample;
use antinode_telemetry::Cause;
use cortex_m::peripheral::NVIC;
use stm32f4xx_hal::pac::Interrupt;

use super::watchdog::Watchdog;
use super::{clock, log, reset};
use crate::clocks::CORE;
use crate::instrument::Instrument;
use crate::settings::BAUD;

/// Polls the instrument, feeds the watchdog while the pipeline is alive, and sleeps from interrupt to interrupt.
pub fn run<S: Sample>(instrument: &mut Instrument<'_, S>, watchdog: &mut Watchdog) -> ! {
    loop {
        if instrument.poll(clock::now(), log::event) {
            watchdog.feed();
        }
        NVIC::pend(Interrupt::USART1);
        if instrument.asks_for_source() {
            NVIC::pend(Interrupt::DMA2_STREAM0);
        }
        if instrument.wants_restart() {
            // The last two bytes, of ten bits each, are still in the USART.
            cortex_m::asm::delay(20 * (CORE / BAUD + 1));
            reset::restart(Cause::Command, 0);
        }
        sleep();
    }
}

/// Sleeps until an interrupt.
///
/// While a probe has the clock go on in sleep (DBGMCU_CR.DBG_SLEEP, which only power-off resets), the chip may run wrong instructions
/// after a `wfi` at certain addresses: ES0182, "Debugging Sleep/Stop mode with WFE/WFI entry". Three instructions after it that do nothing
/// were seen not to help at addresses that end in 4 (apache/mynewt-core#2058), so that it has 16 bytes of its own.
#[allow(unsafe_code, reason = "the instruction needs an address of its own")]
fn sleep() {
    // SAFETY: it changes no register; `.balign` pads code with instructions that do nothing.
    unsafe {
        core::arch::asm!(
            ".balign 16",
            "wfi",
            ".balign 16",
            options(nostack, preserves_flags)
        );
    }
}
