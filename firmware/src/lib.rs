//! What the images share.
//!
//! | image | what it does |
//! |---|---|
//! | `bench_block_*`, `bench_watch_*` | block sums from half-buffers, without and with the watch |
//! | `bench_push_*` | block sums from one call a pair |
//! | `bench_acquire_*` | the search for a period |
//! | `bench_solution_*` | the solution of one window |
//! | `bench_pipeline_*` | everything |
//! | `bench_methods_fixed`, `_f32` | block sums with the sums of the paper's four methods beside them |
//! | `bench_idsp_sums` | the peer: the same sums with the crate idsp |
//! | `bench_nothing` | what every other image has beside its kernel |
//! | `check_arch` | compares the core's kernels in instructions with their portable twins |
//!
//! A bench works between `mark_begin` and `mark_end`, where a counting tool may look too, and at its end prints one line over
//! semihosting: `NAME instructions=… units=… state=… stack=…`, with `cycles` for `instructions` on hardware, whose cycle counter
//! counts. `cargo bench-table` runs all of them in QEMU.
#![no_std]

pub mod bench;
pub mod beside;
pub mod codes;
pub mod gauge;
pub mod line;
pub mod marks;
