//! Block sums together with the sums of the paper's four methods, in f32.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::beside::methods::<f32>);
