//! antinode on a gyro controller with an STM32F405: the parts that its images are made of.
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
//! | `bench_longest_*` | the longest call that takes one pair, of searching and of tracking |
//! | `bench_solution_*` | the solution of one window |
//! | `bench_pipeline_*`, `bench_unwatched_*` | the whole core, with and without the watch |
//! | `bench_methods_*` | block sums with the sums of the paper's four methods beside them |
//! | `bench_interrupt`, `bench_application` | the instrument's interrupt alone, and all of the instrument |
//! | `bench_idsp_sums` | the peer: the same sums with the crate idsp |
//! | `bench_nothing` | what every other bench has beside its kernel |
//! | `check_arch` | compares the core's kernels in instructions with their portable twins |
//! | `check_memory` | proves that memory is copied, moved and cleared as the ABI wants it |
//!
//! A bench works between `mark_begin` and `mark_end`, where a counting tool may look too, and at its end prints one line over
//! semihosting: `NAME instructions=… units=… state=… stack=…`, with `cycles` for `instructions` on hardware, whose cycle counter
//! counts. `cargo bench-table` runs all of them in QEMU.
//!
//! | module | what it is |
//! |---|---|
//! | [`settings`] | everything that the owner of another gyro may want to change |
//! | [`sampling`] | the seam: a source of simultaneous pairs, and what can go wrong with one |
//! | [`gather`] | the interrupt's half: pairs become blocks |
//! | [`instrument`] | the main loop's half: blocks become reports; commands are obeyed |
//! | [`link`], [`inbox`] | reports out, commands in, neither ever waited for |
//! | [`pipeline`] | both halves and the queues between them, for images and tests |
//! | [`supervision`] | whether the pipeline lives, and why the device started |
//! | [`methods`] | the paper's four methods beside every estimate, with the feature `methods` |
//! | `counts`, `wav`, `clocks` | the interrupt's counters; where a WAV file's samples lie; frequencies and dividers |
//! | `hardware` | clocks, converters, DMA, line, watchdog, log, main loop: registers by their names in RM0090 |
//! | `replay` | the emulator's source |
//! | `bench`, `beside`, `load`, `codes` | what is measured, and of what |
//! | `marks`, `gauge`, `text` | where a bench begins and ends; its counters and painted stack; the line that it prints |
//!
//! All but the last four lines know no hardware, and are tested on the host too: `cargo test --release -p firmware --lib` and
//! `cargo test --release -p host-tests --test firmware`. Pins and ranges are in `firmware/docs/wiring.md`.
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
pub mod sampling;
pub mod settings;
pub mod supervision;
pub mod wav;

#[cfg(target_os = "none")]
pub mod bench;
#[cfg(target_os = "none")]
pub mod beside;
#[cfg(target_os = "none")]
pub mod codes;
#[cfg(target_os = "none")]
pub mod gauge;
#[cfg(target_os = "none")]
pub mod hardware;
#[cfg(target_os = "none")]
pub mod load;
#[cfg(target_os = "none")]
pub mod marks;
#[cfg(target_os = "none")]
pub mod replay;
#[cfg(target_os = "none")]
pub mod text;
