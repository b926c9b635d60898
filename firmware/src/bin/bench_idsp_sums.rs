//! For comparison: the sums of both pick-offs with the crate idsp, from half-buffers of codes.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::beside::idsp_sums);
