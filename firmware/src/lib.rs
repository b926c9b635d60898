//! What the images share.
#![no_std]

pub mod bench;
pub mod beside;
pub mod codes;
pub mod gauge;
pub mod line;
pub mod marks;
