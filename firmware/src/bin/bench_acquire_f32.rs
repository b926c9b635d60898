//! The search for a period from cold until it is found, repeatedly, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::acquire::<f32>);
