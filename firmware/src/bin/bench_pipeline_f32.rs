//! Everything, in f32: samples, blocks, and a solved, tracked window every 10 periods.
#![no_std]
#![no_main]

use core::hint::black_box;

use antinode::{Identifier, Settings};
use cortex_m_rt::entry;
use firmware::{Codes, PAIRS, leave, mark_begin, mark_end};

#[entry]
fn main() -> ! {
    let codes = Codes::new();
    let Ok(mut identifier) = Identifier::<200, 32>::new(Settings::new(100_000.0)) else {
        leave()
    };
    let mut at = 0;
    let mut run = |pairs: usize| {
        let end = at + pairs;
        let mut windows = 0;
        while at < end {
            let slice = codes.slice(at, 128.min(end - at));
            at += slice.len();
            let mut buffer = [[0.0; 2]; 128];
            for (pair, code) in buffer.iter_mut().zip(slice) {
                *pair = [f32::from(code[0]), f32::from(code[1])];
            }
            identifier.extend(buffer.get(..slice.len()).unwrap_or(&[]), |estimate| {
                black_box(estimate);
                windows += 1;
            });
        }
        windows
    };
    run(2_000);
    mark_begin();
    black_box(run(PAIRS));
    mark_end();
    leave()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    leave()
}
