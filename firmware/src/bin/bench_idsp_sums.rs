//! The peer: the sums of both pick-offs with the crate idsp, from half-buffers of codes.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{beside, marks};

#[entry]
fn main() -> ! {
    beside::idsp_sums(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
