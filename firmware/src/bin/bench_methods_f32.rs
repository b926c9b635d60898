//! Block sums with the sums of the paper's four methods beside them, in f32.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{beside, marks};

#[entry]
fn main() -> ! {
    beside::methods::<f32>(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
