//! Block sums from one call a pair, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::push::<f32>);
