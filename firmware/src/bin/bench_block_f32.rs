//! The demodulator alone, in f32: half-buffers of codes become blocks.
#![no_std]
#![no_main]

use core::hint::black_box;

use antinode::Settings;
use antinode::block::Demodulator;
use cortex_m_rt::entry;
use firmware::{Codes, Floats, PAIRS, leave, mark_begin, mark_end};

#[entry]
fn main() -> ! {
    let codes = Codes::new();
    let mut floats = Floats::new();
    let mut demodulator = Demodulator::<200>::new(Settings::new(100_000.0).layout(18.747), 0);
    let mut at = 0;
    mark_begin();
    while at < PAIRS {
        let mut pairs = floats.of(codes.slice(at, PAIRS - at));
        at += pairs.len();
        while !pairs.is_empty() {
            let (taken, block) = demodulator.push_slice(pairs);
            black_box(block);
            pairs = pairs.get(taken..).unwrap_or(&[]);
        }
    }
    mark_end();
    leave()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    leave()
}
