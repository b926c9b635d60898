//! The C ABI of [`antinode`]: `include/antinode.h` is generated from this crate.
//!
//! | C type | samples | arithmetic at sample rate |
//! |---|---|---|
//! | `antinode_fixed_t` | `int16_t` codes | fixed point; uses floating point only for the search |
//! | `antinode_float_t` | `float` in any unit, or codes | f32 |
//!
//! A state holds a [`Front`](antinode::Front) for the interrupt, a [`Tracker`](antinode::Tracker) for the thread, and between
//! them a queue of finished blocks that needs no lock. Memory is the caller's; nothing here allocates, calls back, or keeps a global.
//!
//! Built with `panic = "abort"` (always on bare metal, and in the profile `capi` on a PC), it is `no_std` and holds no panic: nothing in it
//! can reach the handler below, and `check` makes sure that the linker drops it.
#![cfg_attr(any(target_os = "none", panic = "abort"), no_std)]

mod boundary;
mod capacity;
mod estimate;
mod fixed;
mod float;
mod interrupt;
#[cfg(all(target_arch = "arm", target_os = "none"))]
mod memory;
mod queue;
mod settings;
mod state;
mod status;

pub use capacity::*;
pub use estimate::*;
pub use fixed::*;
pub use float::*;
pub use settings::*;
pub use state::Health;
pub use status::*;

/// Every `no_std` library must have one; nothing reaches it, so the linker drops it.
#[cfg(any(target_os = "none", panic = "abort"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
