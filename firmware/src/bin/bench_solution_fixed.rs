//! The solution of one window of 10 periods, in thread context, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::solution::<i16>);
