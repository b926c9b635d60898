//! Block sums from half-buffers of codes, in fixed point.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{bench, marks};

#[entry]
fn main() -> ! {
    bench::block::<i16>(env!("CARGO_BIN_NAME"), false)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
