//! Everything, in f32: samples, blocks, and a solved, tracked window every 10 periods.
#![no_std]
#![no_main]

use core::hint::black_box;

use antinode::{Identifier, Settings};
use cortex_m_rt::entry;
use firmware::{Codes, Floats, PAIRS, leave, mark_begin, mark_end};

#[entry]
fn main() -> ! {
    let codes = Codes::new();
    let mut floats = Floats::new();
    let Ok(mut identifier) = Identifier::<200, 32>::new(Settings::new(100_000.0)) else {
        leave()
    };
    // From cold to a tracked wave before the marks.
    let mut at = 0;
    let mut run = |end: usize| {
        while at < end {
            let pairs = floats.of(codes.slice(at, end - at));
            at += pairs.len();
            identifier.extend(pairs, |estimate| {
                black_box(estimate);
            });
        }
    };
    run(2_000);
    mark_begin();
    run(2_000 + PAIRS);
    mark_end();
    leave()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    leave()
}
