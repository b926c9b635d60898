//! What the images share.
#![no_std]

pub mod bench;
pub mod codes;
pub mod marks;
