//! The instrument on a recording, in the emulator: see [`firmware::replay`].
#![no_std]
#![no_main]

use defmt_semihosting as _;

#[path = "../handlers.rs"]
mod handlers;

#[rtic::app(device = stm32f4xx_hal::pac)]
mod app {
    use antinode_telemetry::Cause;
    use firmware::gather::Gatherer;
    use firmware::hardware::{
        clock,
        line::{Line, Transfer},
        log, reset,
    };
    use firmware::instrument::Instrument;
    use firmware::marks;
    use firmware::pipeline::{Places, Queues};
    use firmware::replay::{self, Replay, Script};
    use firmware::settings::Arithmetic;
    use stm32f4xx_hal::pac::Interrupt;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        source: Replay,
        gatherer: &'static mut Gatherer<'static, Arithmetic>,
        instrument: &'static mut Instrument<'static, Arithmetic>,
        line: Line,
        script: Script,
        idle_script: Script,
    }

    #[init(local = [
        queues: Queues<Arithmetic> = Queues::new(),
        places: Places<'static, Arithmetic> = Places::new(),
    ])]
    fn init(c: init::Context) -> (Shared, Local) {
        let note = reset::started(&c.device.RCC);
        log::started(&note);
        clock::start_tick(c.core.SYST);
        let mut text = replay::line();
        let Some(mut script) = Script::read(&mut text) else {
            defmt::error!("the command line must be: RECORDING [OPTION=NUMBER[:NUMBER]]...");
            marks::fail()
        };
        if note.cause == Cause::Panic {
            script.panic = None;
        }
        let Some(source) = Replay::open(&text, script) else {
            defmt::error!("no recording, nor one of two channels of 16 bits");
            marks::fail()
        };
        let Ok(parts) = c
            .local
            .queues
            .split(c.local.places, source.configuration(), note.cause)
        else {
            defmt::error!("the sample rate is beyond the settings' range");
            marks::fail()
        };
        let line = Line::new(
            c.device.USART1,
            &c.device.RCC,
            parts.out,
            parts.inbox,
            Transfer::Software,
        );
        let local = Local {
            source,
            gatherer: parts.gatherer,
            instrument: parts.instrument,
            line,
            script,
            idle_script: script,
        };
        (Shared {}, local)
    }

    #[idle(local = [instrument, idle_script])]
    fn idle(c: idle::Context) -> ! {
        let (instrument, script) = (c.local.instrument, c.local.idle_script);
        loop {
            if instrument.answered() >= script.hold {
                for _ in 0..script.slow {
                    rtic::pend(Interrupt::DMA2_STREAM0);
                    cortex_m::asm::isb();
                }
            }
            instrument.poll(clock::now(), log::event);
            rtic::pend(Interrupt::USART1);
            if instrument.wants_restart() {
                reset::restart(Cause::Command, 0);
            }
            if replay::has_ended() {
                instrument.report_counters();
                while !instrument.is_flushed() {
                    rtic::pend(Interrupt::USART1);
                }
                marks::leave();
            }
        }
    }

    /// Stands in for the DMA's interrupt, which the emulator lacks; the main loop pends it.
    #[task(binds = DMA2_STREAM0, priority = 3, local = [source, gatherer])]
    fn samples(c: samples::Context) {
        c.local.gatherer.serve(c.local.source);
    }

    #[task(binds = USART1, priority = 2, local = [line, script])]
    fn line(c: line::Context) {
        let open = c.local.script.is_open() || replay::has_ended();
        c.local.line.serve(open);
    }

    #[task(binds = SysTick, priority = 1)]
    fn tick(_: tick::Context) {
        clock::tick();
    }
}
