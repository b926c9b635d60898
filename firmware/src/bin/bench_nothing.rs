//! Codes, marks and the report alone: what every other image has beside its kernel.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{beside, marks};

#[entry]
fn main() -> ! {
    beside::nothing(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
