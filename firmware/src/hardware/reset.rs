//! The cause of a reset, kept in memory that start-up code does not initialise.

#![allow(unsafe_code, reason = "`link_section` is an unsafe attribute")]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicU32, Ordering};

use antinode_telemetry::Cause;
use cortex_m::peripheral::SCB;
use cortex_m_rt::ExceptionFrame;
use stm32f4xx_hal::pac::RCC;

use crate::supervision::{cause, number, numbered};

/// Distinguishes a note that was written from random memory after power-on.
const MARK: u32 = 0x616e_7469;

// SAFETY: `.uninit` is RAM that the linker script of cortex-m-rt reserves and that start-up code does not write; any bits are valid
// atomics.
#[unsafe(link_section = ".uninit.NOTE")]
static NOTE: [AtomicU32; 3] = [const { AtomicU32::new(0) }; 3];

/// Leaves a note of the cause and the place, and resets the chip.
pub fn restart(cause: Cause, place: u32) -> ! {
    let number = number(cause);
    for (word, value) in NOTE.iter().zip([number, place, MARK ^ number]) {
        word.store(value, Ordering::Relaxed);
    }
    SCB::sys_reset()
}

/// Cause of the reset, and its place: the source line of a panic, the address of a fault, or else 0. To be called once, as it clears the
/// note and the chip's flags.
pub fn started(rcc: &RCC) -> (Cause, u32) {
    let [first, place, mark] = [0, 1, 2].map(|i: usize| {
        NOTE.get(i)
            .map_or(0, |word| word.swap(0, Ordering::Relaxed))
    });
    let noted = if mark == MARK ^ first {
        numbered(first)
    } else {
        None
    };
    let csr = rcc.csr().read().bits();
    // RMVF: flags accumulate over resets until they are removed.
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
    let place = if noted.is_some() { place } else { 0 };
    (cause(csr, noted), place)
}

/// The panic handler: restarts the instrument, which then reports [`Cause::Panic`] and logs the line.
pub fn panicked(info: &PanicInfo) -> ! {
    restart(
        Cause::Panic,
        info.location().map_or(0, |place| place.line()),
    )
}

/// The fault handler: restarts the instrument, which then reports [`Cause::HardFault`] and logs the address.
pub fn faulted(frame: &ExceptionFrame) -> ! {
    restart(Cause::HardFault, frame.pc())
}
