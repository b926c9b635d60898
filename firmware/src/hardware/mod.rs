//! Code that depends on the chip: registers, interrupts, memory that survives a reset.

pub mod clock;
pub mod dual_adc;
pub mod line;
pub mod log;
pub mod main_loop;
pub mod pair_clock;
pub mod reset;
pub mod ring;
pub mod spi_adc;
pub mod supply;
pub mod watchdog;
