//! The main loop of the images for a board.

use antinode::Sample;
use antinode_telemetry::Cause;
use cortex_m::peripheral::NVIC;
use stm32f4xx_hal::pac::Interrupt;

use super::watchdog::Watchdog;
use super::{clock, log, reset};
use crate::instrument::Instrument;

/// Lets the instrument work, feeds the watchdog while the pipeline lives, and sleeps from interrupt to interrupt.
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
            // The last bytes are still in the USART.
            cortex_m::asm::delay(clock::CORE / 1000);
            reset::restart(Cause::Command, 0);
        }
        cortex_m::asm::wfi();
    }
}
