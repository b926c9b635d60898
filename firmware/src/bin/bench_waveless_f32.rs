//! The whole core on noise alone, at a known frequency, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::waveless::<f32>);
