//! Verifies on the target that memory is copied, moved and cleared as the ABI demands: for every count, at every distance of source and
//! target. It leaves the emulator with success or failure and names the functions that fail.
#![no_std]
#![no_main]
#![allow(unsafe_code, reason = "functions of the ABI take addresses")]

use core::ptr::{read_volatile, write_volatile};

use cortex_m_rt::entry;
use firmware::marks;
use firmware::text::TextLine;

unsafe extern "C" {
    fn __aeabi_memcpy(to: *mut u8, from: *const u8, count: usize);
    fn __aeabi_memcpy4(to: *mut u8, from: *const u8, count: usize);
    fn __aeabi_memcpy8(to: *mut u8, from: *const u8, count: usize);
    fn __aeabi_memmove(to: *mut u8, from: *const u8, count: usize);
    fn __aeabi_memmove4(to: *mut u8, from: *const u8, count: usize);
    fn __aeabi_memmove8(to: *mut u8, from: *const u8, count: usize);
    fn __aeabi_memclr(to: *mut u8, count: usize);
    fn __aeabi_memclr4(to: *mut u8, count: usize);
    fn __aeabi_memclr8(to: *mut u8, count: usize);
}

/// Bytes of the memory.
const SIZE: usize = 96;
/// Counts that are tried are below this.
const MAX_COUNT: usize = 50;

#[repr(align(8))]
struct Memory([u8; SIZE]);

/// The initial value of a byte.
fn before(index: usize) -> u8 {
    (index * 7 + 1) as u8
}

/// Runs `act` on the memory; true if each byte then has the value by `after`. It compares byte by byte, without the functions under test.
fn leaves(act: impl FnOnce(*mut u8), after: impl Fn(usize) -> u8) -> bool {
    let mut memory = Memory([0; SIZE]);
    let first = memory.0.as_mut_ptr();
    // SAFETY: these are bytes of the memory, here and below.
    (0..SIZE).for_each(|i| unsafe { write_volatile(first.add(i), before(i)) });
    act(first);
    (0..SIZE).all(|i| unsafe { read_volatile(first.add(i)) } == after(i))
}

type Copy = unsafe extern "C" fn(*mut u8, *const u8, usize);
type Clear = unsafe extern "C" fn(*mut u8, usize);

/// True if `copy` is right at all addresses that are multiples of `step`; with `overlapping` also for runs that overlap.
fn copies(copy: Copy, step: usize, overlapping: bool) -> bool {
    let places = || (0..SIZE - MAX_COUNT).step_by(step);
    places().all(|to| {
        places().all(|from| {
            (0..MAX_COUNT).all(|count| {
                let apart = to.abs_diff(from) >= count;
                (!apart && !overlapping)
                    || leaves(
                        // SAFETY: both runs lie in the memory, and overlap only if the function allows it.
                        |first| unsafe { copy(first.add(to), first.add(from), count) },
                        |i| {
                            before(if (to..to + count).contains(&i) {
                                i - to + from
                            } else {
                                i
                            })
                        },
                    )
            })
        })
    })
}

/// True if `clear` is right at all addresses that are multiples of `step`.
fn clears(clear: Clear, step: usize) -> bool {
    (0..SIZE - MAX_COUNT).step_by(step).all(|to| {
        (0..MAX_COUNT).all(|count| {
            leaves(
                // SAFETY: the run lies in the memory.
                |first| unsafe { clear(first.add(to), count) },
                |i| {
                    if (to..to + count).contains(&i) {
                        0
                    } else {
                        before(i)
                    }
                },
            )
        })
    })
}

#[entry]
fn main() -> ! {
    let checks = [
        ("memcpy", copies(__aeabi_memcpy, 3, false)),
        ("memcpy4", copies(__aeabi_memcpy4, 4, false)),
        ("memcpy8", copies(__aeabi_memcpy8, 8, false)),
        ("memmove", copies(__aeabi_memmove, 3, true)),
        ("memmove4", copies(__aeabi_memmove4, 4, true)),
        ("memmove8", copies(__aeabi_memmove8, 8, true)),
        ("memclr", clears(__aeabi_memclr, 3)),
        ("memclr4", clears(__aeabi_memclr4, 4)),
        ("memclr8", clears(__aeabi_memclr8, 8)),
    ];
    let mut good = true;
    for (function, right) in checks {
        let mut line = TextLine::new();
        line.text("check_memory ");
        line.text(function);
        line.text(if right { ": right" } else { ": WRONG" });
        line.print();
        good &= right;
    }
    if good { marks::leave() } else { marks::fail() }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    marks::fail()
}
