//! The whole core on noise alone, at a known frequency, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::waveless::<i16>);
