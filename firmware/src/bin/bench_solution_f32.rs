//! The solution of one window of 10 periods, in thread context, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::solution::<f32>);
