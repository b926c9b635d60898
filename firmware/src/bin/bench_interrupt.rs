//! The interrupt half of the pipeline: half-buffers of codes become blocks, which are taken from its queue and thrown away.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{load, marks};

#[entry]
fn main() -> ! {
    load::interrupt_alone(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
