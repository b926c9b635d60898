//! antinode on a gyro controller with an STM32F405: the parts that its images are made of.
//!
//! ```text
//! interrupt:  Source ── pairs ──► Gatherer ── blocks ──► queue
//! main loop:  queue ──► Instrument (solve, track) ── reports ──► Link ──► serial line
//! ```
//!
//! What stands before the line below knows no hardware and is tested on the host.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod counts;
pub mod gather;
pub mod instrument;
pub mod link;
pub mod pipeline;
pub mod sampling;
pub mod settings;
pub mod supervision;

#[cfg(target_os = "none")]
pub mod bench;
#[cfg(target_os = "none")]
pub mod codes;
#[cfg(target_os = "none")]
pub mod load;
#[cfg(target_os = "none")]
pub mod marks;
#[cfg(target_os = "none")]
pub mod hardware;
#[cfg(target_os = "none")]
pub mod replay;
