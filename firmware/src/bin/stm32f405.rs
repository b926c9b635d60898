//! The product: an STM32F405 with both pick-offs at its own converters. Pins and ranges are in `firmware/docs/wiring.md`.
#![no_std]
#![no_main]

// Not in the library: an image can have only one of each, and benches have other handlers, `replay` another logger.
#[path = "../handlers.rs"]
mod handlers;
#[path = "../rtt.rs"]
mod rtt;

#[rtic::app(device = stm32f4xx_hal::pac)]
mod app {
    use antinode::Packed;
    use antinode_telemetry::{Cause, FrontEnd};
    use firmware::gather::Gatherer;
    use firmware::hardware::dual_adc::DualAdc;
    use firmware::hardware::line::{Line, Transfer};
    use firmware::hardware::pair_clock::Tim2;
    use firmware::hardware::ring::{Memory, Stream};
    use firmware::hardware::watchdog::Watchdog;
    use firmware::hardware::{clock, log, main_loop, reset, supply};
    use firmware::instrument::Instrument;
    use firmware::pipeline::{Places, Queues};
    use firmware::sampler::Sampler;
    use firmware::sampling::DUAL_ADC_RAILS;
    use firmware::settings::{Arithmetic, HALF, configuration};
    use stm32f4xx_hal::prelude::*;

    #[shared]
    struct Shared {
        /// `None` if there is no clock to sample by.
        #[lock_free]
        source: Option<Sampler<DualAdc, Stream, Tim2>>,
        #[lock_free]
        gatherer: &'static mut Gatherer<'static, Arithmetic>,
        #[lock_free]
        line: Line,
    }

    #[local]
    struct Local {
        instrument: &'static mut Instrument<'static, Arithmetic>,
        watchdog: Watchdog,
    }

    #[init(local = [
        queues: Queues<Arithmetic> = Queues::new(),
        places: Places<'static, Arithmetic> = Places::new(),
        memory: Memory = [[Packed(0); HALF]; 2],
    ])]
    fn init(c: init::Context) -> (Shared, Local) {
        let device = c.device;
        let mut watchdog = Watchdog::start(device.IWDG, &device.DBGMCU);
        let note = reset::started(&device.RCC);
        log::started(&note);
        let is_high = supply::start(&device.RCC, &device.PWR, &device.EXTI, &mut watchdog);
        log::supply(&device.FLASH, is_high);
        let crystal = clock::start(&device.RCC, &device.FLASH);
        clock::start_tick(c.core.SYST);

        let mut rcc = device.RCC.constrain();
        let pins = device.GPIOA.split(&mut rcc);
        // Pulled up: without a serial bridge it would float, and noise be taken for bytes.
        let _ = pins.pa10.into_alternate::<7>().internal_pull_up(true);
        let inputs = (pins.pa1.into_analog(), pins.pa2.into_analog());

        let settings = configuration(FrontEnd::DualAdc, DUAL_ADC_RAILS);
        let Ok(parts) = c.local.queues.split(c.local.places, settings, note.cause) else {
            // Never: invalid settings do not compile.
            reset::restart(Cause::Panic, line!())
        };
        let line = Line::new(device.USART1, &rcc, parts.out, parts.inbox, Transfer::Dma);
        // Only now: the pin of a USART that is off may be low, which looks like a byte.
        let _ = pins.pa9.into_alternate::<7>();
        let source = crystal.then(|| {
            DualAdc::start(
                (device.ADC1, device.ADC2, device.ADC_COMMON),
                (device.TIM3, device.TIM2),
                (device.DMA2, c.local.memory),
                inputs,
                &rcc,
            )
        });
        if source.is_none() {
            // Nothing feeds the watchdog then, and its reset starts another attempt.
            parts.instrument.fault(Cause::Clock, log::event);
        }
        let shared = Shared {
            source,
            gatherer: parts.gatherer,
            line,
        };
        let local = Local {
            instrument: parts.instrument,
            watchdog,
        };
        (shared, local)
    }

    #[idle(local = [instrument, watchdog])]
    fn idle(c: idle::Context) -> ! {
        main_loop::run(c.local.instrument, c.local.watchdog)
    }

    /// Half of the ring is full.
    #[task(binds = DMA2_STREAM0, priority = 3, shared = [source, gatherer])]
    fn samples(c: samples::Context) {
        if let Some(source) = c.shared.source {
            c.shared.gatherer.serve(source);
        }
    }

    /// A converter has overrun.
    #[task(binds = ADC, priority = 3, shared = [source, gatherer])]
    fn overrun(c: overrun::Context) {
        if let Some(source) = c.shared.source {
            c.shared.gatherer.serve(source);
        }
    }

    /// Pended by the main loop, for bytes that have arrived or wait to be sent.
    #[task(binds = USART1, priority = 2, shared = [line])]
    fn line(c: line::Context) {
        c.shared.line.serve(true);
    }

    /// A run of bytes has been sent.
    #[task(binds = DMA2_STREAM7, priority = 2, shared = [line])]
    fn sent(c: sent::Context) {
        c.shared.line.serve(true);
    }

    /// The supply falls.
    #[task(binds = PVD, priority = 4)]
    fn brown_out(_: brown_out::Context) {
        reset::restart(Cause::BrownOut, 0)
    }

    #[task(binds = SysTick, priority = 1)]
    fn tick(_: tick::Context) {
        clock::tick();
    }
}
