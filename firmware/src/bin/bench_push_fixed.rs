//! Block sums from one call a pair, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::push::<i16>);
