//! Tests of the images: `replay` in QEMU against the same pipeline on the host, and properties of the others.
//!
//! Those of the emulator and of what is in the images need the ARM target and QEMU, and so are run explicitly:
//! `cargo test --test firmware -- --ignored`.
#![cfg(unix)] // the emulator's serial line is a Unix socket

mod board;
mod commands;
mod emulator;
mod faults;
mod image;
mod line;
mod methods;
mod mirror;
mod priorities;
mod recordings;
mod recovery;
mod registers;
mod run;
mod same;
mod sampler;
mod stack;
mod steered;
mod told;
