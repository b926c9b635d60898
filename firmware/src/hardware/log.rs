//! The log, by defmt, in addition to the telemetry.

use antinode_telemetry::{Cause, State};
use stm32f4xx_hal::pac::FLASH;

use super::reset::Note;
use crate::instrument::Event;

/// Logs why the device started.
pub fn started(note: &Note) {
    match note.cause {
        Cause::Panic => defmt::info!("antinode started: panic, at line {=u32}", note.place),
        Cause::HardFault => defmt::info!(
            "antinode started: hard fault, at address {=u32:#x}, called from {=u32:#x}, CFSR {=u32:#x}",
            note.place,
            note.caller,
            note.status
        ),
        cause => defmt::info!("antinode started: {=str}", cause.name()),
    }
}

/// Warns if the supply was low at the start, or if nothing resets the chip between 1.7 V and the 2.7 V that its clock needs.
pub fn supply(flash: &FLASH, is_high: bool) {
    if !is_high {
        defmt::warn!("the supply was below 3 V at the start: see firmware/docs/wiring.md");
    }
    // OPTCR.BOR_LEV: 0 means level 3.
    if flash.optcr().read().bor_lev().bits() != 0 {
        defmt::warn!("the brown-out level is not set: see firmware/docs/wiring.md");
    }
}

/// Logs an event.
pub fn event(event: Event) {
    match event {
        Event::State(State::Searching) => defmt::info!("searching for a wave"),
        Event::State(State::Tracking) => defmt::info!("tracking a wave"),
        Event::State(State::Started(cause)) => defmt::info!("started: {=str}", cause.name()),
        Event::State(State::SamplingRestarted(cause)) => {
            defmt::warn!("sampling restarted: {=str}", cause.name());
        }
        Event::State(State::Fault(cause)) => defmt::error!("fault: {=str}", cause.name()),
        // There is no other state.
        Event::State(_) => {}
        Event::Lapse(lapse) => {
            defmt::warn!("{=u32} pairs lost: {=str}", lapse.lost, lapse.cause.name());
        }
        Event::Answered { id, done } => defmt::info!("command {=u16} done: {=bool}", id, done),
    }
}
