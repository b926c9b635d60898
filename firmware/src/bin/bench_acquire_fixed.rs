//! The period detector until its first period, again and again, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::acquire::<i16>);
