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
        cortex_m::asm::wfi();
    }
}
