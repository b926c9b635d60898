//! Everything: samples, blocks, and a solved, tracked window every 10 periods, in fixed point.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{bench, marks};

#[entry]
fn main() -> ! {
    bench::pipeline::<i16>(env!("CARGO_BIN_NAME"), true)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
