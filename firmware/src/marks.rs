//! The marks that measurements run between, and the way out of the emulator.

// Marks must have the names that a counting tool looks for.
#![allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]

use cortex_m_semihosting::debug;

/// The measurement begins with the return from here.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn mark_begin() {
    core::hint::black_box(1);
}

/// The measurement ends with the call of this.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn mark_end() {
    core::hint::black_box(2);
}

/// Leaves the emulator with success.
pub fn leave() -> ! {
    loop {
        debug::exit(debug::EXIT_SUCCESS);
    }
}

/// Leaves the emulator with failure.
pub fn fail() -> ! {
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}
