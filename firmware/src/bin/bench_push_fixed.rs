//! Block sums from one call a pair, in fixed point.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{bench, marks};

#[entry]
fn main() -> ! {
    bench::push::<i16>(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
