//! antinode on a gyro controller with an STM32F405: the modules from which the firmware images are built.
//!
//! ```text
//! interrupt:  Source ── pairs ──► Gatherer ── blocks ──► queue
//! main loop:  queue ──► Instrument (solve, track) ── reports ──► Link ──► serial line
//! ```
//!
//! | image | samples come from |
//! |---|---|
//! | `stm32f405` | both converters of the chip: the product |
//! | `stm32f405_ad7380` | an AD7380 on SPI |
//! | `replay` | a recording, in the emulator |
//! | `bench_block_*`, `bench_watch_*` | codes in memory: block sums from half-buffers, without and with the watch |
//! | `bench_push_*` | block sums from one call a pair |
//! | `bench_acquire_*` | the search for a period |
//! | `bench_longest_*` | the longest call that takes one pair, while searching or tracking |
//! | `bench_solution_*` | the solution of one window |
//! | `bench_pipeline_*`, `bench_unwatched_*` | the whole core, with and without the watch |
//! | `bench_waveless_*` | the whole core on noise alone, at a known frequency |
//! | `bench_methods_*` | block sums together with the sums of the paper's four methods |
//! | `bench_interrupt`, `bench_application` | the instrument's interrupt alone, and the whole instrument |
//! | `bench_idsp_sums` | for comparison: the same sums with the crate idsp |
//! | `bench_nothing` | the part that every bench has besides its kernel |
//! | `check_arch` | compares the core's assembly kernels with their portable twins |
//! | `check_memory` | verifies that memory is copied, moved and cleared as the ABI demands |
//!
//! A bench works between `mark_begin` and `mark_end`, which other counting tools may use too, and at its end prints one line over
//! semihosting: `NAME instructions=… units=… state=… stack=…`. On hardware, which has a cycle counter, it prints `cycles` instead of
//! `instructions`. `cargo bench-table` runs all of them in QEMU.
//!
//! | module | content |
//! |---|---|
//! | [`settings`] | everything that the owner of another gyro may want to change |
//! | [`sampling`] | the interface between converters and pipeline: a source of simultaneous pairs, and its failures |
//! | [`sampler`] | such a source of a converter, a DMA's ring and the count of triggers, with its recovery from overruns |
//! | [`gather`] | the interrupt's half: pairs become blocks |
//! | [`instrument`] | the main loop's half: blocks become reports; commands are executed |
//! | [`link`], [`inbox`] | reports out and commands in, without blocking |
//! | [`pipeline`] | both halves and the queues between them, for images and tests |
//! | [`supervision`] | whether the pipeline is alive, and why the device started |
//! | [`methods`] | the paper's four methods beside every estimate, with the feature `methods` |
//! | `counts`, `wav`, `clocks` | the interrupt's counters; the position of samples in a WAV file; frequencies and dividers |
//! | `hardware` | clocks, converters, DMA, line, watchdog, log, main loop: registers by their names in RM0090 |
//! | `replay` | the emulator's source |
//! | `bench`, `beside`, `load`, `codes` | kernels to measure, others to compare with, the interrupt, and samples for all of them |
//! | `application` | the whole pipeline to measure, with the line |
//! | `marks`, `gauge`, `text` | begin and end of a measurement; counters and stack paint; the printed line |
//!
//! The modules above `hardware` do not depend on hardware, and are tested on the host too: `cargo test -p firmware --lib` and
//! `cargo test --test firmware`. Pins and ranges are in `firmware/docs/wiring.md`.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod clocks;
pub mod counts;
pub mod gather;
pub mod inbox;
pub mod instrument;
pub mod link;
#[cfg_attr(not(feature = "methods"), path = "no_methods.rs")]
pub mod methods;
pub mod pipeline;
pub mod sampler;
pub mod sampling;
pub mod settings;
pub mod supervision;
pub mod wav;

#[cfg(all(target_os = "none", feature = "board"))]
pub mod application;
#[cfg(target_os = "none")]
pub mod bench;
#[cfg(target_os = "none")]
pub mod beside;
#[cfg(target_os = "none")]
pub mod codes;
#[cfg(target_os = "none")]
pub mod gauge;
#[cfg(all(target_os = "none", feature = "board"))]
pub mod hardware;
#[cfg(target_os = "none")]
pub mod load;
#[cfg(target_os = "none")]
pub mod marks;
// The memory functions of the C library replace the compiler's in every image.
#[cfg(target_os = "none")]
#[path = "../../crates/antinode-capi/src/memory.rs"]
mod memory;
#[cfg(target_os = "none")]
pub mod replay;
#[cfg(target_os = "none")]
pub mod text;
