//! What the pipeline costs: its interrupt fed with half-buffers of codes, alone and with the main loop, between the marks.

#![allow(unsafe_code, reason = "the bench takes the USART for itself")]

use core::hint::black_box;

use antinode::Packed;
use antinode_telemetry::{Cause, FrontEnd};
use stm32f4xx_hal::pac::Peripherals;

use crate::bench::PAIRS;
use crate::codes::Codes;
use crate::gather::Gatherer;
use crate::hardware::line::{By, Line};
use crate::marks::{leave, mark_begin, mark_end};
use crate::pipeline::Queues;
use crate::sampling::{Lapse, Ready, Source, is_at_rail_12};
use crate::settings::{Arithmetic, DUAL_ADC_RAILS, HALF, configuration};

/// Codes without end, half a ring at a time.
struct Endless {
    codes: Codes,
    from: usize,
    to: usize,
}

impl Source for Endless {
    type Pair = Packed;

    fn next(&mut self) -> Ready {
        self.from = self.to;
        self.to += self.codes.slice(self.from, HALF).len();
        Ready::Pairs
    }

    fn pairs(&self) -> &[Packed] {
        self.codes.slice(self.from, self.to - self.from)
    }

    fn is_intact(&self) -> bool {
        black_box(true)
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        Lapse { cause, lost: 0 }
    }

    fn is_at_rail(pair: Packed) -> bool {
        is_at_rail_12(pair)
    }
}

/// The interrupt's work, not inlined, as a handler is not.
#[inline(never)]
fn interrupt(gatherer: &mut Gatherer<'_, Arithmetic>, source: &mut Endless) {
    gatherer.serve(source);
}

/// The pipeline from cold over a tenth of a second, then [`PAIRS`] pairs between the marks: the interrupt `alone`, or all there is.
pub fn run(queues: &'static mut Queues<Arithmetic>, alone: bool) -> ! {
    let mut source = Endless {
        codes: Codes::new(),
        from: 0,
        to: 0,
    };
    let configuration = configuration(FrontEnd::DualAdc, DUAL_ADC_RAILS);
    let Ok(mut parts) = queues.split(configuration, Cause::PowerOn) else {
        leave()
    };
    // SAFETY: nobody else uses the peripherals.
    let device = unsafe { Peripherals::steal() };
    let mut line = Line::new(device.USART1, &device.RCC, parts.out, parts.bytes, By::Hand);
    let mut now = 0;
    let mut half = |alone: bool| {
        interrupt(&mut parts.gatherer, &mut source);
        if !alone {
            now += 1;
            black_box(parts.instrument.poll(now, |_| {}));
            line.serve(true);
        }
        source.to
    };
    while half(false) < 10_000 {}
    mark_begin();
    while half(alone) < 10_000 + PAIRS {}
    mark_end();
    leave()
}
