//! defmt over RTT. The usual logger crate links a panic in, for reentrance; this one drops the inner message.

#![allow(unsafe_code, reason = "`defmt::Logger` is an unsafe trait")]

use core::cell::UnsafeCell;

use critical_section::RestoreState;
use rtt_target::{ChannelMode, UpChannel, rtt_init};

/// Bytes that wait for the debugger; what finds no room is dropped.
const BUFFER: usize = 512;

#[defmt::global_logger]
struct Logger;

/// What the open critical section owns.
struct State {
    channel: Option<UpChannel>,
    encoder: defmt::Encoder,
    restore: RestoreState,
    /// Messages within each other.
    depth: u32,
}

struct Shared(UnsafeCell<State>);

// SAFETY: the cell is touched within critical sections only, on the one core.
unsafe impl Sync for Shared {}

static SHARED: Shared = Shared(UnsafeCell::new(State {
    channel: None,
    encoder: defmt::Encoder::new(),
    restore: RestoreState::invalid(),
    depth: 0,
}));

/// Starts the log; once.
pub fn start() {
    let channels = rtt_init! {
        up: { 0: { size: BUFFER, mode: ChannelMode::NoBlockSkip, name: "defmt" } }
    };
    critical_section::with(|_| {
        // SAFETY: within a critical section, and no reference outlives it.
        let state = unsafe { &mut *SHARED.0.get() };
        state.channel = Some(channels.up.0);
    });
}

/// Sends through the channel.
fn send(channel: &mut Option<UpChannel>, bytes: &[u8]) {
    if let Some(channel) = channel {
        channel.write(bytes);
    }
}

// SAFETY: `acquire` opens a critical section that `release` closes, and what lies between writes to the one encoder.
unsafe impl defmt::Logger for Logger {
    fn acquire() {
        // SAFETY: closed by `release`.
        let restore = unsafe { critical_section::acquire() };
        // SAFETY: within the critical section.
        let state = unsafe { &mut *SHARED.0.get() };
        state.depth += 1;
        if state.depth == 1 {
            state.restore = restore;
            let State { channel, encoder, .. } = state;
            encoder.start_frame(|bytes| send(channel, bytes));
        }
    }

    unsafe fn flush() {}

    unsafe fn release() {
        // SAFETY: within the critical section that `acquire` opened.
        let state = unsafe { &mut *SHARED.0.get() };
        state.depth = state.depth.saturating_sub(1);
        if state.depth == 0 {
            let State { channel, encoder, .. } = state;
            encoder.end_frame(|bytes| send(channel, bytes));
            // SAFETY: that of the outermost `acquire`.
            unsafe { critical_section::release(state.restore) };
        }
    }

    unsafe fn write(bytes: &[u8]) {
        // SAFETY: within the critical section that `acquire` opened.
        let State { channel, encoder, depth, .. } = unsafe { &mut *SHARED.0.get() };
        if *depth == 1 {
            encoder.write(bytes, |bytes| send(channel, bytes));
        }
    }
}
