//! Codes, marks and the report alone: what every other image has beside its kernel.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::beside::nothing);
