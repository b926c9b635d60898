//! The solution of one window of 10 periods, in thread context, in f32.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{bench, marks};

#[entry]
fn main() -> ! {
    bench::solution::<f32>(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
