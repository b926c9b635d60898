//! Kernels that the bench images measure, most of them over [`PAIRS`] sample pairs between the marks. `name` is that of the image.
//!
//! Samples arrive as packed codes, in half-buffers of 128 pairs. `S` selects the arithmetic: `i16` or `f32`.

use core::hint::black_box;
use core::ops::RangeInclusive;

use antinode::block::Demodulator;
use antinode::phase::PhaseStep;
use antinode::{Front, Identifier, Packed, Sample, SamplePair, Settings, Tracker};

use crate::codes::{Codes, Flaw, HALF_BUFFER, PERIOD, PERIODS};
use crate::gauge::{Gauge, apart};
use crate::marks::leave;

/// Sample pairs that a bench processes.
pub const PAIRS: usize = 16_384;
/// Calls timed for each wave by [`longest`].
const CALLS_PER_WAVE: usize = 2_000;
/// Periods in the ring of 1406 pairs, of the waves of [`longest`]: 4.3 to 176 samples a period.
const PERIODS_IN_RING: RangeInclusive<u64> = 8..=327;

pub(crate) fn demodulator<S: Sample>(watch: bool) -> Demodulator<S, 200> {
    // Blocks of two periods, as in a window of 10 periods.
    Demodulator::new(PhaseStep::from_period(PERIOD), 38, 0, watch)
}

/// Block sums from half-buffers, with or without the watch.
pub fn block<S: Sample>(name: &'static str, watch: bool) -> !
where
    Packed: SamplePair<S>,
{
    let codes = Codes::new();
    let mut demodulator = demodulator::<S>(watch);
    let mut run = |from: usize, to: usize| {
        let mut at = from;
        while at < to {
            let mut pairs = codes.slice(at, HALF_BUFFER.min(to - at));
            at += pairs.len();
            while !pairs.is_empty() {
                let (taken, block) = demodulator.push_slice(pairs);
                black_box(block.is_some());
                pairs = pairs.get(taken..).unwrap_or(&[]);
            }
        }
    };
    let mut gauge = Gauge::new(name, PAIRS, size_of::<Demodulator<S, 200>>());
    // The first block makes the table.
    run(0, 100);
    gauge.start();
    apart(|| run(100, 100 + PAIRS));
    gauge.finish()
}

/// Block sums from one call a pair, without the watch.
pub fn push<S: Sample>(name: &'static str) -> !
where
    Packed: SamplePair<S>,
{
    let codes = Codes::new();
    let mut demodulator = demodulator::<S>(false);
    let mut run = |from: usize, to: usize| {
        let mut at = from;
        while at < to {
            let pairs = codes.slice(at, HALF_BUFFER.min(to - at));
            at += pairs.len();
            for &pair in pairs {
                if let Some(block) = push_one(&mut demodulator, pair) {
                    black_box(block);
                }
            }
        }
    };
    let mut gauge = Gauge::new(name, PAIRS, size_of::<Demodulator<S, 200>>());
    run(0, 100);
    gauge.start();
    apart(|| run(100, 100 + PAIRS));
    gauge.finish()
}

/// One call a pair, as from an interrupt: not inlined into the loop.
#[inline(never)]
fn push_one<S: Sample>(
    demodulator: &mut Demodulator<S, 200>,
    pair: Packed,
) -> Option<&antinode::Block<S>>
where
    Packed: SamplePair<S>,
{
    demodulator.push(pair)
}

/// The whole core, with or without the watch: samples, blocks, and a solved, tracked window every 10 periods.
pub fn pipeline<S: Sample>(name: &'static str, watch: bool) -> !
where
    Packed: SamplePair<S>,
{
    let settings = Settings {
        watch,
        ..Settings::new(100_000.0)
    };
    whole::<S>(name, &Codes::new(), settings)
}

/// The whole core where there is no wave, but noise: with a known frequency every window is solved as a wave's first one.
pub fn waveless<S: Sample>(name: &'static str) -> !
where
    Packed: SamplePair<S>,
{
    let mut codes = Codes::new();
    codes.make(PERIODS, Flaw::Noise);
    let settings = Settings {
        frequency: Some(5_332.0),
        ..Settings::new(100_000.0)
    };
    whole::<S>(name, &codes, settings)
}

#[inline(always)]
fn whole<S: Sample>(name: &'static str, codes: &Codes, settings: Settings) -> !
where
    Packed: SamplePair<S>,
{
    // Configured in place, as in an image: a returned identifier would be copied, at a cost in stack and code.
    let mut identifier = Identifier::<S, 200, 16>::UNSET;
    if identifier.configure(settings).is_err() {
        leave()
    }
    let mut run = |from: usize, to: usize| {
        let mut at = from;
        while at < to {
            let pairs = codes.slice(at, HALF_BUFFER.min(to - at));
            at += pairs.len();
            identifier.extend(pairs, |estimate| {
                black_box(&estimate);
            });
        }
    };
    let mut gauge = Gauge::new(name, PAIRS, size_of::<Identifier<S, 200, 16>>());
    // The search and the first windows come before the marks.
    run(0, 2_000);
    gauge.start();
    apart(|| run(2_000, 2_000 + PAIRS));
    gauge.finish()
}

/// The solution of one window of 10 periods alone, in thread context.
pub fn solution<S: Sample>(name: &'static str) -> !
where
    Packed: SamplePair<S>,
{
    let codes = Codes::new();
    let mut demodulator = demodulator::<S>(true);
    let mut tracker = Tracker::<16>::UNSET;
    if tracker.configure(Settings::new(100_000.0)).is_err() {
        leave()
    }
    let mut at = 0;
    let mut next = || loop {
        let (taken, block) = demodulator.push_slice(codes.slice(at, HALF_BUFFER));
        at += taken;
        if let Some(block) = block {
            return *block;
        }
    };
    // The stack is that of the tracker alone, from its first window on.
    let mut gauge = Gauge::new(name, 1, size_of::<Tracker<16>>());
    for _ in 0..100 {
        let block = next();
        black_box(tracker.push(&block));
    }
    // One by one into this frame: code that fills an array would need more stack than the tracker.
    let blocks = [next(), next(), next(), next(), next()];
    gauge.start();
    apart(|| {
        for block in &blocks {
            black_box(&tracker.push(block));
        }
    });
    gauge.finish()
}

/// The search for a period from cold until it is found, repeatedly, from half-buffers.
pub fn acquire<S: Sample>(name: &'static str) -> !
where
    Packed: SamplePair<S>,
{
    let codes = Codes::new();
    let Ok(mut front) = Front::<S, 200>::new(Settings::new(100_000.0)) else {
        leave()
    };
    let mut gauge = Gauge::new(name, PAIRS, size_of::<Front<S, 200>>());
    let mut at = 0;
    gauge.start();
    apart(|| {
        while at < PAIRS {
            let pairs = codes.slice(at, HALF_BUFFER.min(PAIRS - at));
            at += pairs.len();
            let mut taken = 0;
            while let Some(rest) = pairs.get(taken..).filter(|rest| !rest.is_empty()) {
                taken += search(&mut front, rest);
                if !front.is_searching() {
                    front.search();
                }
            }
        }
    });
    gauge.finish()
}

/// Searches, and gives the count of pairs taken.
#[inline(never)]
fn search<S: Sample>(front: &mut Front<S, 200>, pairs: &[Packed]) -> usize
where
    Packed: SamplePair<S>,
{
    let (taken, block) = front.push_slice(pairs);
    black_box(block.is_some());
    taken
}

/// The longest call of an interrupt that hands over one pair at a time, from cold through the search into tracking, over many waves, with
/// and without flaws.
pub fn longest<S: Sample>(name: &'static str) -> !
where
    Packed: SamplePair<S>,
{
    let mut codes = Codes::new();
    let settings = Settings::new(100_000.0);
    let Ok(mut front) = Front::<S, 200>::new(settings) else {
        leave()
    };
    let mut gauge = Gauge::new(name, 1, size_of::<Front<S, 200>>());
    // The longest call is found first, then repeated between the marks: every run takes the same calls.
    let (mut longest, mut call) = (0, None);
    for periods in PERIODS_IN_RING.step_by(7) {
        for flaw in [
            Flaw::None,
            Flaw::Clipped,
            Flaw::Held,
            Flaw::Tone,
            Flaw::Noise,
        ] {
            codes.make(periods, flaw);
            if front.configure(settings).is_err() {
                leave()
            }
            for index in 0..CALLS_PER_WAVE {
                if let [pair] = *codes.slice(index, 1) {
                    let lap = gauge.lap(|| push_front(&mut front, pair));
                    if lap > longest {
                        (longest, call) = (lap, Some((periods, flaw, index)));
                    }
                }
            }
            if matches!(flaw, Flaw::None) && front.is_searching() {
                leave()
            }
        }
    }
    let Some((periods, flaw, at)) = call else {
        leave()
    };
    codes.make(periods, flaw);
    if front.configure(settings).is_err() {
        leave()
    }
    for index in 0..at {
        if let [pair] = *codes.slice(index, 1) {
            push_front(&mut front, pair);
        }
    }
    let [pair] = *codes.slice(at, 1) else { leave() };
    gauge.start();
    push_front(&mut front, pair);
    gauge.finish()
}

#[inline(never)]
fn push_front<S: Sample>(front: &mut Front<S, 200>, pair: Packed)
where
    Packed: SamplePair<S>,
{
    black_box(front.push(pair).is_some());
}
