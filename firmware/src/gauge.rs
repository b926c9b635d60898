//! An image's measurement of itself, printed at its end: instructions or cycles, state, stack.
//!
//! Hardware has a cycle counter. The emulator has none, but its system timer runs in step with the emulated instructions.

#![allow(
    unsafe_code,
    reason = "paints the free stack, and examines it afterwards"
)]

use core::ptr::{read_volatile, write_volatile};

use cortex_m::Peripherals;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{DWT, SYST};
use cortex_m::register::msp;

use crate::marks::{leave, mark_begin, mark_end};
use crate::text::TextLine;

/// Paint of the free stack: a word that no frame is likely to leave.
const PAINT: u32 = 0x5aa5_c33c;
/// Bytes left unpainted for the frame of the painting function: the smallest depth that can be measured.
const FRAME: u32 = 48;
/// Period of the system timer, in counts.
const TIMER: u32 = 1 << 24;
/// With `-M netduinoplus2 -icount shift=0` an instruction takes 1 ns, and the timer counts at 168 MHz: 21 counts are 125 instructions.
const INSTRUCTIONS: u32 = 125;
const COUNTS: u32 = 21;

unsafe extern "C" {
    /// The lowest address that the stack may reach, from the linker.
    static mut _stack_end: u32;
}

/// A measurement of one kernel.
pub struct Gauge {
    name: &'static str,
    units: u32,
    state: usize,
    /// Stack pointer of the bench.
    base: u32,
    peripherals: Option<Peripherals>,
    began: u32,
    counts_cycles: bool,
}

impl Gauge {
    /// Paints the free stack: the deepest word that loses its paint from here on gives the kernel's worst stack.
    ///
    /// `name` is the image's; `units` are the sample pairs or windows that are counted for; `state` is the size in bytes of what the
    /// kernel keeps from call to call.
    #[inline(always)]
    pub fn new(name: &'static str, units: usize, state: usize) -> Self {
        // Inlined, so that this is the stack pointer of the bench, below which the kernel's frames begin.
        let base = msp::read();
        paint();
        let mut peripherals = Peripherals::take();
        Self {
            name,
            units: units as u32,
            state,
            base,
            counts_cycles: peripherals.as_mut().is_some_and(start_counters),
            peripherals,
            began: 0,
        }
    }

    /// Starts counting, and marks the begin.
    #[inline(always)]
    pub fn start(&mut self) {
        if let Some(peripherals) = &mut self.peripherals {
            // Reading clears the flag, which may be set from before.
            peripherals.SYST.has_wrapped();
        }
        self.began = self.count();
        mark_begin();
    }

    /// Duration of `work` in counts of the counter at hand, for comparison with others.
    #[inline(always)]
    pub fn lap(&self, work: impl FnOnce()) -> u32 {
        let before = self.count();
        work();
        let after = self.count();
        if self.counts_cycles {
            after.wrapping_sub(before)
        } else {
            before.wrapping_sub(after) % TIMER
        }
    }

    /// Marks the end, prints the measurement, and leaves the emulator.
    #[inline(always)]
    pub fn finish(self) -> ! {
        mark_end();
        let ended = self.count();
        // First, before a larger frame, such as that of the report, spoils the paint.
        let depth = self.base.saturating_sub(deepest(self.base));
        self.report(ended, depth)
    }

    #[inline(never)]
    fn report(mut self, ended: u32, depth: u32) -> ! {
        let wrapped = self
            .peripherals
            .as_mut()
            .is_none_or(|p| p.SYST.has_wrapped());
        let mut line = TextLine::new();
        line.text(self.name);
        if self.counts_cycles {
            line.field("cycles", ended.wrapping_sub(self.began));
        } else if wrapped {
            // Beyond 10⁸ instructions no number is printed rather than a wrong one.
            line.text(" too long for the timer");
        } else {
            // The timer counts down. The product fits: 2²⁴ × 125 < 2³¹.
            let counts = self.began.wrapping_sub(ended) % TIMER;
            line.field("instructions", counts * INSTRUCTIONS / COUNTS);
        }
        line.field("units", self.units);
        line.field("state", self.state as u32);
        line.field("stack", depth);
        line.print();
        leave()
    }

    #[inline(always)]
    fn count(&self) -> u32 {
        if self.counts_cycles {
            DWT::cycle_count()
        } else {
            SYST::get_current()
        }
    }
}

/// Runs `work` in a stack frame of its own, so that its stack is measured.
#[inline(never)]
pub fn apart<R>(work: impl FnOnce() -> R) -> R {
    work()
}

/// Starts both counters; true if the cycle counter counts.
fn start_counters(peripherals: &mut Peripherals) -> bool {
    peripherals.DCB.enable_trace();
    peripherals.DWT.enable_cycle_counter();
    let timer = &mut peripherals.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(TIMER - 1);
    timer.clear_current();
    timer.enable_counter();
    let before = DWT::cycle_count();
    cortex_m::asm::delay(100);
    // Reading clears the flag, which the first reload sets.
    timer.has_wrapped();
    DWT::cycle_count() != before
}

#[inline(never)]
fn paint() {
    let mut word = &raw mut _stack_end;
    // The margin spares this function's frame, as the pointer may be read before the frame is made.
    let end = msp::read().saturating_sub(FRAME);
    while (word as u32) < end {
        // SAFETY: words of RAM between the linked data and the stack pointer are unused, and no interrupt is enabled.
        unsafe { write_volatile(word, PAINT) };
        word = word.wrapping_add(1);
    }
}

/// The lowest word below `base` that lost its paint, or never had any.
#[inline(never)]
fn deepest(base: u32) -> u32 {
    let mut word = &raw const _stack_end;
    // SAFETY: these words of RAM lie below the stack pointer of the bench.
    while (word as u32) < base && unsafe { read_volatile(word) } == PAINT {
        word = word.wrapping_add(1);
    }
    word as u32
}
