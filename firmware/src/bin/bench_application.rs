//! The whole pipeline on half-buffers of codes: interrupt, main loop, reports to the line.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use firmware::pipeline::{Places, Queues};
use firmware::settings::Arithmetic;
use firmware::{application, marks};

#[entry]
fn main() -> ! {
    static mut QUEUES: Queues<Arithmetic> = Queues::new();
    static mut PLACES: Places<'static, Arithmetic> = Places::new();
    application::run(env!("CARGO_BIN_NAME"), QUEUES, PLACES)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::leave()
}
