//! The longest call of an interrupt that hands over one pair at a time, in f32.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::{bench, marks};

#[entry]
fn main() -> ! {
    bench::longest::<f32>(env!("CARGO_BIN_NAME"))
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
