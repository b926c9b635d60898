//! The interrupt half of the pipeline: it turns half-buffers of codes into blocks, which are taken from its queue and discarded.
#![no_std]
#![no_main]

firmware::bench_image!(firmware::load::interrupt_alone);
