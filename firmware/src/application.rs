//! The bench of the whole pipeline: interrupt, main loop and line, fed with half-buffers of codes.

#![allow(unsafe_code, reason = "the bench takes the USART for itself")]

use core::hint::black_box;

use antinode_telemetry::{Cause, Configuration, FrontEnd};
use stm32f4xx_hal::pac::Peripherals;

use crate::hardware::line::{Line, Transfer};
use crate::load::{Endless, interrupt, measure};
use crate::marks::leave;
use crate::methods::AVAILABLE;
use crate::pipeline::{Places, Queues};
use crate::sampling::DUAL_ADC_RAILS;
use crate::settings::{Arithmetic, configuration};

/// The whole pipeline; with the feature `methods`, the methods are on.
pub fn run(
    name: &'static str,
    queues: &'static mut Queues<Arithmetic>,
    places: &'static mut Places<'static, Arithmetic>,
) -> ! {
    let mut source = Endless::new();
    let configuration = Configuration {
        methods: AVAILABLE,
        ..configuration(FrontEnd::DualAdc, DUAL_ADC_RAILS)
    };
    let Ok(parts) = queues.split(places, configuration, Cause::PowerOn) else {
        leave()
    };
    // SAFETY: nobody else uses the peripherals.
    let device = unsafe { Peripherals::steal() };
    let parts_size = size_of_val(&parts) + size_of::<Places<'static, Arithmetic>>();
    // The emulator has no DMA: the registers look like those of a stream that has ended, and no bytes are sent.
    let mut line = Line::new(
        device.USART1,
        &device.RCC,
        parts.out,
        parts.inbox,
        Transfer::Dma,
    );
    let mut now = 0;
    let state = size_of::<Queues<Arithmetic>>() + parts_size + size_of_val(&line);
    measure(name, state, || {
        interrupt(parts.gatherer, &mut source);
        now += 1;
        black_box(parts.instrument.poll(now, |_| {}));
        line.serve(true);
        source.total
    })
}
