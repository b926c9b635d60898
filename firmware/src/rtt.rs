//! defmt over RTT (SEGGER's real-time transfer: a ring in RAM that the debugger reads).
//!
//! The usual crates for it link panics in, which this firmware must not have. A message that finds no room is dropped as a whole, and so
//! is one within another.

#![allow(
    unsafe_code,
    reason = "a symbol for the debugger, and `defmt::Logger` is an unsafe trait"
)]

use core::cell::UnsafeCell;
use core::ffi::CStr;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use critical_section::RestoreState;
use defmt::Encoder;

/// Bytes that wait for the debugger.
const SIZE: usize = 512;

/// RTT's control block, which a debugger finds by its id, with one channel up and none down.
#[repr(C)]
struct Control {
    id: [u8; 16],
    up_channels: u32,
    down_channels: u32,
    name: &'static CStrPointer,
    buffer: &'static [AtomicU8; SIZE],
    size: u32,
    /// Where the next byte goes; ours.
    write: AtomicU32,
    /// Where the debugger goes on to read; its own.
    read: AtomicU32,
    flags: AtomicU32,
}

/// The first byte of a name that ends with a zero.
#[repr(transparent)]
struct CStrPointer(u8);

const NAME: &CStr = c"defmt";
static BUFFER: [AtomicU8; SIZE] = [const { AtomicU8::new(0) }; SIZE];

// SAFETY: the name is the one that debuggers look for, and no other symbol's.
#[unsafe(export_name = "_SEGGER_RTT")]
// SAFETY: a block that is written at run time belongs into `.data`.
#[unsafe(link_section = ".data._SEGGER_RTT")]
static CONTROL: Control = Control {
    id: *b"SEGGER RTT\0\0\0\0\0\0",
    up_channels: 1,
    down_channels: 0,
    // SAFETY: a byte of a string that lives for ever.
    name: unsafe { &*NAME.as_ptr().cast::<CStrPointer>() },
    buffer: &BUFFER,
    size: SIZE as u32,
    write: AtomicU32::new(0),
    read: AtomicU32::new(0),
    // Never block.
    flags: AtomicU32::new(0),
};

/// The message under way.
struct State {
    encoder: Encoder,
    restore: RestoreState,
    /// Messages within each other.
    depth: u32,
    /// Where its next byte goes, and whether all so far found room.
    at: u32,
    fits: bool,
}

struct Shared(UnsafeCell<State>);

// SAFETY: the cell is touched within critical sections only, on the one core.
unsafe impl Sync for Shared {}

static SHARED: Shared = Shared(UnsafeCell::new(State {
    encoder: Encoder::new(),
    restore: RestoreState::invalid(),
    depth: 0,
    at: 0,
    fits: false,
}));

/// Stages bytes behind those that the debugger may read already.
fn stage(at: &mut u32, fits: &mut bool, bytes: &[u8]) {
    for &byte in bytes {
        let next = (*at + 1) % SIZE as u32;
        *fits &= next != CONTROL.read.load(Ordering::Relaxed);
        if let Some(place) = BUFFER.get(*at as usize).filter(|_| *fits) {
            place.store(byte, Ordering::Relaxed);
            *at = next;
        }
    }
}

#[defmt::global_logger]
struct Logger;

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
            state.at = CONTROL.write.load(Ordering::Relaxed);
            state.fits = true;
            let State {
                encoder, at, fits, ..
            } = state;
            encoder.start_frame(|bytes| stage(at, fits, bytes));
        }
    }

    unsafe fn flush() {}

    unsafe fn release() {
        // SAFETY: within the critical section that `acquire` opened.
        let state = unsafe { &mut *SHARED.0.get() };
        state.depth = state.depth.saturating_sub(1);
        if state.depth == 0 {
            let State {
                encoder, at, fits, ..
            } = state;
            encoder.end_frame(|bytes| stage(at, fits, bytes));
            if *fits {
                CONTROL.write.store(*at, Ordering::Release);
            }
            // SAFETY: that of the outermost `acquire`.
            unsafe { critical_section::release(state.restore) };
        }
    }

    unsafe fn write(bytes: &[u8]) {
        // SAFETY: within the critical section that `acquire` opened.
        let State {
            encoder,
            depth,
            at,
            fits,
            ..
        } = unsafe { &mut *SHARED.0.get() };
        if *depth == 1 {
            encoder.write(bytes, |bytes| stage(at, fits, bytes));
        }
    }
}
