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
//! | `bench_*` | codes in memory, between two marks |
//!
//! | module | what it is |
//! |---|---|
//! | [`settings`] | everything that the owner of another gyro may want to change |
//! | [`sampling`] | the seam: a source of simultaneous pairs, and what can go wrong with one |
//! | [`gather`] | the interrupt's half: pairs become blocks |
//! | [`instrument`] | the main loop's half: blocks become reports; commands are obeyed |
//! | [`link`] | reports out, commands in, neither ever waited for |
//! | [`pipeline`] | both halves and the queues between them, for images and tests |
//! | [`supervision`] | whether the pipeline lives, and why the device started |
//! | [`methods`] | the paper's four methods beside every estimate, with the feature `methods` |
//! | `counts`, `wav` | the interrupt's counters; where a WAV file's samples lie |
//! | `hardware` | clocks, converters, DMA, line, watchdog, log: registers by their names in RM0090 |
//! | `replay`, `bench`, `load`, `codes`, `marks` | the emulator's source; what is measured, and between which marks |
//!
//! All but the last two lines knows no hardware, and is tested on the host too. Pins and ranges are in `firmware/docs/wiring.md`.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod counts;
pub mod gather;
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
pub mod codes;
#[cfg(target_os = "none")]
pub mod hardware;
#[cfg(target_os = "none")]
pub mod load;
#[cfg(target_os = "none")]
pub mod marks;
#[cfg(target_os = "none")]
pub mod replay;
