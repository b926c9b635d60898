//! What needs the chip: registers, interrupts, memory that a reset leaves alone.

pub mod clock;
pub mod dual_adc;
pub mod line;
pub mod log;
mod memory;
pub mod pair_clock;
pub mod reset;
pub mod ring;
pub mod sampler;
pub mod spi_adc;
pub mod watchdog;
