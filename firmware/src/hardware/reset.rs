//! The cause of a reset, kept in memory that start-up code does not initialise.

#![allow(unsafe_code, reason = "`link_section` is an unsafe attribute")]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use antinode_telemetry::Cause;
use cortex_m::peripheral::SCB;
use cortex_m_rt::ExceptionFrame;
use stm32f4xx_hal::pac::RCC;

use crate::supervision::{ResetFlags, cause, number, numbered};

/// Distinguishes a note that was written from random memory after power-on.
const MARK: u32 = 0x616e_7469;

// SAFETY: `.uninit` is RAM that the linker script of cortex-m-rt reserves and that start-up code does not write; any bits are valid
// atomics.
#[unsafe(link_section = ".uninit.NOTE")]
static NOTE: [AtomicU32; 5] = [const { AtomicU32::new(0) }; 5];

/// Why the device was reset.
pub struct Note {
    /// The cause.
    pub cause: Cause,
    /// Source line of a panic, address of a hard fault, or else 0.
    pub place: u32,
    /// Of a hard fault: the address to which the function that it was in would have returned, LR.
    pub caller: u32,
    /// Of a hard fault: CFSR, what the core objected to. If it was a write, the fault comes some instructions after it.
    pub status: u32,
}

/// Leaves a note of the cause and the place, and resets the chip.
pub fn restart(cause: Cause, place: u32) -> ! {
    leave(&Note {
        cause,
        place,
        caller: 0,
        status: 0,
    })
}

/// Leaves a note, and resets the chip.
fn leave(note: &Note) -> ! {
    let number = number(note.cause);
    let words = [number, note.place, note.caller, note.status, MARK ^ number];
    for (word, value) in NOTE.iter().zip(words) {
        word.store(value, Ordering::Relaxed);
    }
    SCB::sys_reset()
}

/// Why the device was reset. To be called once, as it clears the note and the chip's flags.
pub fn started(rcc: &RCC) -> Note {
    let [first, place, caller, status, mark] = NOTE.each_ref().map(|word| {
        let was = word.load(Ordering::Relaxed);
        word.store(0, Ordering::Relaxed);
        was
    });
    let noted = if mark == MARK ^ first {
        numbered(first)
    } else {
        None
    };
    // CSR, RM0090, 7.3.21. By default the brown-out reset is off, and every loss of power sets PORRSTF. BORRSTF comes alone if a level is
    // set in the option bytes, see `firmware/docs/wiring.md`; where the supply falls less, the firmware leaves a note of it.
    let csr = rcc.csr().read();
    let flags = ResetFlags {
        power_on: csr.porrstf().bit_is_set(),
        watchdog: csr.wdgrstf().bit_is_set() || csr.wwdgrstf().bit_is_set(),
        brown_out: csr.borrstf().bit_is_set(),
        software: csr.sftrstf().bit_is_set(),
        low_power: csr.lpwrrstf().bit_is_set(),
        pin: csr.padrstf().bit_is_set(),
    };
    // RMVF: flags accumulate over resets until they are removed.
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
    let known = |word| if noted.is_some() { word } else { 0 };
    Note {
        cause: cause(flags, noted),
        place: known(place),
        caller: known(caller),
        status: known(status),
    }
}

/// The panic handler: restarts the instrument, which then reports [`Cause::Panic`] and logs the line.
pub fn panicked(info: &PanicInfo) -> ! {
    restart(
        Cause::Panic,
        info.location().map_or(0, |place| place.line()),
    )
}

/// The fault handler: restarts the instrument, which then reports [`Cause::HardFault`] and logs where and why.
pub fn faulted(frame: &ExceptionFrame) -> ! {
    #[allow(unsafe_code, reason = "the fault handler does not own the core")]
    // SAFETY: a read without effects.
    let status = unsafe { (*SCB::PTR).cfsr.read() };
    leave(&Note {
        cause: Cause::HardFault,
        place: frame.pc(),
        caller: frame.lr(),
        status,
    })
}
