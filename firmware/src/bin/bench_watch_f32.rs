//! Block sums from half-buffers of codes, with the watch, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::block::<f32>, true);
