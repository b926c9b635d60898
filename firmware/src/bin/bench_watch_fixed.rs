//! Block sums from half-buffers of codes, with the watch, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::block::<i16>, true);
