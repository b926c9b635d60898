//! The same instrument with an AD7380 as its converters. Pins and ranges are in `firmware/docs/wiring.md`.
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
    use firmware::hardware::line::{Line, Transfer};
    use firmware::hardware::pair_clock::Tim2;
    use firmware::hardware::ring::{Memory, Stream};
    use firmware::hardware::spi_adc::SpiAdc;
    use firmware::hardware::watchdog::Watchdog;
    use firmware::hardware::{clock, log, main_loop, reset, supply};
    use firmware::instrument::Instrument;
    use firmware::pipeline::{Places, Queues};
    use firmware::sampler::Sampler;
    use firmware::sampling::AD7380_RAILS;
    use firmware::settings::{Arithmetic, HALF, configuration};
    use stm32f4xx_hal::gpio::{PinState, Speed};
    use stm32f4xx_hal::prelude::*;

    #[shared]
    struct Shared {
        #[lock_free]
        line: Line,
    }

    #[local]
    struct Local {
        /// `None` if there is no clock to sample by, or no converter.
        source: Option<Sampler<SpiAdc, Stream, Tim2>>,
        gatherer: &'static mut Gatherer<'static, Arithmetic>,
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
        // After a reset pins have their slowest edges, too slow for 10.5 MHz. Slow edges of SCK corrupt the last bit of each word at any
        // frequency (ES0182, "Corrupted last bit of data"), and the edge of CS is when both inputs are sampled.
        let data = (
            pins.pa5.into_alternate::<5>().speed(Speed::VeryHigh),
            pins.pa6.into_alternate::<5>(),
            pins.pa7.into_alternate::<5>().speed(Speed::High),
        );
        // High from the beginning: an output would otherwise be low until the SPI is set up, and start a conversion.
        let cs = pins
            .pa8
            .into_push_pull_output_in_state(PinState::High)
            .speed(Speed::VeryHigh);

        let settings = configuration(FrontEnd::Spi, AD7380_RAILS);
        let Ok(parts) = c.local.queues.split(c.local.places, settings, note.cause) else {
            // Never: invalid settings do not compile.
            reset::restart(Cause::Panic, line!())
        };
        let line = Line::new(device.USART1, &rcc, parts.out, parts.inbox, Transfer::Dma);
        // Only now: the pin of a USART that is off may be low, which looks like a byte.
        let _ = pins.pa9.into_alternate::<7>();
        let started = if crystal {
            SpiAdc::start(
                device.SPI1,
                (device.TIM1, device.TIM2),
                (device.DMA2, c.local.memory),
                data,
                cs,
                (&rcc, &device.SYSCFG),
            )
            .map_err(|_| Cause::Converter)
        } else {
            Err(Cause::Clock)
        };
        if let Err(cause) = started {
            // Nothing feeds the watchdog then, and its reset starts another attempt.
            parts.instrument.fault(cause, log::event);
        }
        let local = Local {
            source: started.ok(),
            gatherer: parts.gatherer,
            instrument: parts.instrument,
            watchdog,
        };
        (Shared { line }, local)
    }

    #[idle(local = [instrument, watchdog])]
    fn idle(c: idle::Context) -> ! {
        main_loop::run(c.local.instrument, c.local.watchdog)
    }

    /// Half of the ring is full.
    #[task(binds = DMA2_STREAM0, priority = 3, local = [source, gatherer])]
    fn samples(c: samples::Context) {
        if let Some(source) = c.local.source {
            c.local.gatherer.serve(source);
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
