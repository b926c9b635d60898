//! Codes, marks and the report alone: the part that every other bench image has besides its kernel.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::beside::nothing);
