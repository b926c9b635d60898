//! What needs the chip: registers, interrupts, memory that a reset leaves alone.

pub mod clock;
pub mod dual_adc;
pub mod line;
pub mod log;
pub mod main_loop;
// The same as for C: of every image all memory functions are these.
#[path = "../../../crates/antinode-capi/src/memory.rs"]
mod memory;
pub mod pair_clock;
pub mod reset;
pub mod ring;
pub mod sampler;
pub mod spi_adc;
pub mod watchdog;
