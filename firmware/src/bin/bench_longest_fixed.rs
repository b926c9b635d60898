//! The longest call of an interrupt that hands over one pair at a time, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::longest::<i16>);
