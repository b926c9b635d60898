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

pub use capacity::{
    ANTINODE_FIXED_WORDS, ANTINODE_FLOAT_WORDS, ANTINODE_LONGEST_PERIOD, ANTINODE_MOST_PERIODS,
    ANTINODE_QUEUE_BLOCKS, ANTINODE_SHORTEST_PERIOD, Fixed, Float, antinode_fixed_size,
    antinode_float_size,
};
pub use estimate::{
    ANTINODE_FLAG_CIRCULAR, ANTINODE_FLAG_CLIPPED, ANTINODE_FLAG_DEAD_CHANNEL, ANTINODE_FLAG_LOST,
    ANTINODE_FLAG_MISFIT, ANTINODE_FLAG_NOT_FINITE, ANTINODE_FLAG_PHASE_JUMP,
    ANTINODE_FLAG_REACQUIRED, ANTINODE_FLAG_STEP, Estimate,
};
pub use fixed::{
    antinode_fixed_health, antinode_fixed_identify, antinode_fixed_init, antinode_fixed_push,
    antinode_fixed_push_block, antinode_fixed_push_block_interleaved,
    antinode_fixed_push_block_packed, antinode_fixed_reset, antinode_fixed_search,
    antinode_fixed_set_calibration, antinode_fixed_skip, antinode_fixed_solve,
};
pub use float::{
    antinode_float_health, antinode_float_identify, antinode_float_init, antinode_float_push,
    antinode_float_push_block, antinode_float_push_block_interleaved,
    antinode_float_push_block_packed, antinode_float_reset, antinode_float_search,
    antinode_float_set_calibration, antinode_float_skip, antinode_float_solve,
};
pub use settings::{
    ANTINODE_DETECTION_DIFFERENCE, ANTINODE_DETECTION_MEAN_RETURN, Calibration, Settings,
    antinode_settings_default,
};
pub use state::Health;
pub use status::{ANTINODE_HEADER_VERSION, Status, antinode_status_string, antinode_version};

/// Every `no_std` library must have one; nothing reaches it, so the linker drops it.
#[cfg(any(target_os = "none", panic = "abort"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
