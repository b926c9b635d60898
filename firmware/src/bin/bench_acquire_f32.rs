//! The period detector until its first period, again and again, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::acquire::<f32>);
