//! Benches of the pipeline: its interrupt, fed with half-buffers of codes, alone and with the main loop.

#![allow(unsafe_code, reason = "the bench takes the USART for itself")]

use core::hint::black_box;
use core::mem::MaybeUninit;

use antinode::{Front, Packed};
use antinode_telemetry::{Cause, Configuration, FrontEnd};
use heapless::spsc::Queue;
use stm32f4xx_hal::pac::Peripherals;

use crate::bench::PAIRS;
use crate::codes::{Codes, RING};
use crate::counts::Counts;
use crate::gather::Gatherer;
use crate::gauge::Gauge;
use crate::hardware::line::{Line, Transfer};
use crate::marks::leave;
use crate::methods::AVAILABLE;
use crate::pipeline::{Places, Queues};
use crate::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source, both, is_at_rail_12};
use crate::settings::{Arithmetic, HALF, QUEUE, REQUESTS, configuration};

/// A source of endless codes, half of a DMA ring at a time.
struct Endless {
    ring: [Packed; RING],
    from: usize,
    to: usize,
    /// Pairs handed out so far.
    total: usize,
}

impl Endless {
    fn new() -> Self {
        let codes = Codes::new();
        let mut ring = [Packed(0); RING];
        for (to, from) in ring.iter_mut().zip(codes.slice(0, RING)) {
            // The 12-bit converters give codes about mid-scale.
            let unipolar = |code: u32| u32::from((code as u16).wrapping_add(2048));
            *to = Packed(unipolar(from.0) | unipolar(from.0 >> 16) << 16);
        }
        Self {
            ring,
            from: 0,
            to: 0,
            total: 0,
        }
    }
}

impl Source for Endless {
    type Pair = Packed;

    fn next(&mut self) -> Ready {
        self.from = self.to % RING;
        self.to = (self.from + HALF).min(RING);
        self.total += self.to - self.from;
        Ready::Pairs
    }

    fn pairs(&self) -> &[Packed] {
        self.ring.get(self.from..self.to).unwrap_or(&[])
    }

    fn is_intact(&self) -> bool {
        black_box(true)
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        Lapse { cause, lost: 0 }
    }

    fn rails(&self) -> [Packed; 2] {
        both(DUAL_ADC_RAILS)
    }

    fn is_at_rail(&self, pair: Packed) -> bool {
        is_at_rail_12(pair)
    }
}

/// The interrupt's work; not inlined, like a handler.
#[inline(never)]
fn interrupt(gatherer: &mut Gatherer<'_, Arithmetic>, source: &mut Endless) {
    gatherer.serve(source);
}

/// Measures [`PAIRS`] pairs, after 10 000 pairs (0.1 s) from cold.
fn measure(name: &'static str, state: usize, mut half: impl FnMut() -> usize) -> ! {
    let mut gauge = Gauge::new(name, PAIRS, state);
    while half() < 10_000 {}
    gauge.start();
    while half() < 10_000 + PAIRS {}
    gauge.finish()
}

/// The interrupt alone, with a main loop that only empties the queue.
pub fn interrupt_alone(name: &'static str) -> ! {
    let mut source = Endless::new();
    let (mut items, mut requests) = (Queue::<_, QUEUE>::new(), Queue::<_, REQUESTS>::new());
    let counts = Counts::new();
    let (sender, mut blocks) = items.split();
    let (_, asked) = requests.split();
    let settings = configuration(FrontEnd::DualAdc, DUAL_ADC_RAILS).settings;
    let (mut front, mut place) = (Front::UNSET, MaybeUninit::<Gatherer<Arithmetic>>::uninit());
    let state = size_of_val(&front) + size_of_val(&place);
    if front.configure(settings).is_err() {
        leave()
    }
    let gatherer = Gatherer::make(&mut place, &mut front, sender, asked, &counts);
    measure(name, state, || {
        interrupt(gatherer, &mut source);
        while blocks.dequeue().is_some() {}
        source.total
    })
}

/// The whole pipeline; with the feature `methods`, the methods are on.
pub fn application(
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
