//! The interrupt half of the pipeline: half-buffers of codes become blocks, which are taken from its queue and thrown away.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::load::interrupt_alone);
