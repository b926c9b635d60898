//! The demodulator with the sums of all four methods beside it, in f32: half-buffers of codes become blocks and moments.
#![no_std]
#![no_main]

use core::hint::black_box;

use antinode::Settings;
use antinode::block::Demodulator;
use antinode::methods::{DelayedSums, MomentSums};
use cortex_m_rt::entry;
use firmware::{Codes, Floats, PAIRS, leave, mark_begin, mark_end};

#[entry]
fn main() -> ! {
    let codes = Codes::new();
    let mut floats = Floats::new();
    let mut demodulator = Demodulator::<200>::new(Settings::new(100_000.0).layout(18.747), 0);
    let offsets = [20.0, -15.0];
    let mut moments = MomentSums::new(offsets);
    let mut delayed = DelayedSums::<50>::new(5, offsets);
    let mut at = 0;
    mark_begin();
    while at < PAIRS {
        let mut pairs = floats.of(codes.slice(at, PAIRS - at));
        at += pairs.len();
        while !pairs.is_empty() {
            let (taken, block) = demodulator.push_slice(pairs);
            let (new, rest) = pairs.split_at_checked(taken).unwrap_or((pairs, &[]));
            moments.extend(new);
            delayed.extend(new);
            if block.is_some() {
                black_box((moments.take(), delayed.take()));
            }
            black_box(block);
            pairs = rest;
        }
    }
    mark_end();
    leave()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    leave()
}
