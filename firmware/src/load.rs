//! The bench of the pipeline's interrupt alone, fed with half-buffers of codes.

use core::hint::black_box;
use core::mem::MaybeUninit;

use antinode::{Front, Packed};
use antinode_telemetry::{Cause, FrontEnd};
use heapless::spsc::Queue;

use crate::bench::PAIRS;
use crate::codes::{Codes, RING};
use crate::counts::Counts;
use crate::gather::Gatherer;
use crate::gauge::Gauge;
use crate::marks::leave;
use crate::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source, both, is_at_rail_12};
use crate::settings::{Arithmetic, HALF, QUEUE, REQUESTS, configuration};

/// A source of endless codes, half of a DMA ring at a time.
pub(crate) struct Endless {
    ring: [Packed; RING],
    from: usize,
    to: usize,
    /// Pairs handed out so far.
    pub(crate) total: usize,
}

impl Endless {
    pub(crate) fn new() -> Self {
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
pub(crate) fn interrupt(gatherer: &mut Gatherer<'_, Arithmetic>, source: &mut Endless) {
    gatherer.serve(source);
}

/// Measures [`PAIRS`] pairs, after 10 000 pairs (0.1 s) from cold.
pub(crate) fn measure(name: &'static str, state: usize, mut half: impl FnMut() -> usize) -> ! {
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
