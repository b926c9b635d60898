//! defmt over RTT (SEGGER's real-time transfer: a ring in RAM that the debugger reads).
//!
//! The usual crates for it link in panics, which this firmware must not have. A message that does not fit is dropped as a whole, and so is
//! one nested within another.

#![allow(
    unsafe_code,
    reason = "a symbol for the debugger, and `defmt::Logger` is an unsafe trait"
)]

use core::cell::UnsafeCell;
use core::ffi::CStr;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use critical_section::RestoreState;
use defmt::Encoder;

/// Size of the ring, bytes.
const SIZE: usize = 512;

/// RTT's control block, which a debugger finds by its id, with one channel to the debugger and none from it.
#[repr(C)]
struct Control {
    id: [u8; 16],
    up_channels: u32,
    down_channels: u32,
    name: &'static CStrPointer,
    buffer: &'static [AtomicU8; SIZE],
    size: u32,
    /// Index of the next byte to write; only the firmware changes it.
    write: AtomicU32,
    /// Index of the next byte to read; only the debugger changes it.
    read: AtomicU32,
    flags: AtomicU32,
}

/// First byte of a zero-terminated name.
#[repr(transparent)]
struct CStrPointer(u8);

const NAME: &CStr = c"defmt";
static BUFFER: [AtomicU8; SIZE] = [const { AtomicU8::new(0) }; SIZE];

// SAFETY: debuggers look for this name, and no other symbol has it.
#[unsafe(export_name = "_SEGGER_RTT")]
// SAFETY: data that is written at run time belongs in `.data`.
#[unsafe(link_section = ".data._SEGGER_RTT")]
static CONTROL: Control = Control {
    id: *b"SEGGER RTT\0\0\0\0\0\0",
    up_channels: 1,
    down_channels: 0,
    // SAFETY: a byte of a static string.
    name: unsafe { &*NAME.as_ptr().cast::<CStrPointer>() },
    buffer: &BUFFER,
    size: SIZE as u32,
    write: AtomicU32::new(0),
    read: AtomicU32::new(0),
    // Never block.
    flags: AtomicU32::new(0),
};

/// State of the unfinished message.
struct State {
    encoder: Encoder,
    restore: RestoreState,
    /// Nesting of messages.
    depth: u32,
    /// Index of the next byte.
    at: u32,
    /// True if all bytes so far found room.
    fits: bool,
}

struct Shared(UnsafeCell<State>);

// SAFETY: the cell is used only within critical sections, on a single core.
unsafe impl Sync for Shared {}

static SHARED: Shared = Shared(UnsafeCell::new(State {
    encoder: Encoder::new(),
    restore: RestoreState::invalid(),
    depth: 0,
    at: 0,
    fits: false,
}));

/// Writes bytes after those that the debugger may already read; they become visible to it only with the whole message.
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

// SAFETY: `acquire` opens a critical section, which `release` closes; all writes between them go to the one encoder.
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
            // SAFETY: this is the state saved by the outermost `acquire`.
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
