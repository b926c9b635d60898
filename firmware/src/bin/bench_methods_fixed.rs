//! Block sums together with the sums of the paper's four methods, of 16-bit codes.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::beside::methods::<i16>);
