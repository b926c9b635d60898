//! The whole core without the watch: samples, blocks, and a solved, tracked window every 10 periods, in fixed point.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::bench::pipeline::<i16>, false);
