//! The four methods beside the exact solution, for `identify --methods all`.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use antinode::Estimate;
use antinode::methods::comparison::{Comparison, Reference, Sums, compare};
use antinode::methods::{
    Delayed, Moments, Products, Shape, Wave, algorithm1, algorithm2, algorithm3, algorithm4,
    frequency, functional, phase,
};
use antinode::{Calibration, Pair};

/// A window's methods, and the frequency of each by J → min(ω), Hz.
#[derive(Debug, Clone, Copy)]
pub struct Methods {
    pub comparison: Comparison,
    pub frequencies: [f64; 4],
}

/// Keeps the samples that the next window may need.
#[derive(Debug)]
pub struct History {
    pairs: VecDeque<Pair>,
    /// Index in the stream of the first pair kept.
    start: u64,
    calibration: Calibration,
    sample_rate: f64,
}

/// Most samples before a window: a quarter of the longest period, and one for the skew.
const LEAD: usize = 66;

impl History {
    /// Nothing kept yet.
    pub fn new(calibration: Calibration, sample_rate: f64) -> Self {
        Self {
            pairs: VecDeque::new(),
            start: 0,
            calibration,
            sample_rate,
        }
    }

    /// Takes the samples that the identification took.
    pub fn extend(&mut self, pairs: &[Pair]) {
        self.pairs.extend(pairs);
        // A window and its lead: 1022 periods of 256 samples at the most.
        let excess = self.pairs.len().saturating_sub(1024 * 256);
        self.pairs.drain(..excess);
        self.start += excess as u64;
    }

    /// All methods over the window of an estimate; `None` where its samples are not here.
    pub fn compare(&self, estimate: &Estimate) -> Option<Methods> {
        let omega = TAU * estimate.frequency / self.sample_rate;
        let first = usize::try_from(estimate.start.checked_sub(self.start)?).ok()?;
        let from = first.saturating_sub(LEAD);
        let end = first + estimate.samples as usize;
        let raw: Vec<Pair> = self
            .pairs
            .range(from..end.min(self.pairs.len()))
            .copied()
            .collect();
        let pairs = self.corrected(&raw, estimate, omega);
        let lead = first - from;
        let window = pairs.get(lead..)?;
        if window.len() < 4 || !omega.is_finite() {
            return None;
        }
        let lag = algorithm2::quarter_lag((TAU / omega) as f32);
        let sums = Sums {
            moments: Moments::of(window),
            delayed: Delayed::of(&pairs, lead, lag),
            products: Products::of(window, omega),
        };
        let reference = Reference::of(estimate, self.sample_rate);
        let frequencies = self.frequencies(window, &sums, omega);
        Some(Methods {
            comparison: compare(&sums, &reference),
            frequencies,
        })
    }

    /// J → min(ω) of each method, in Hz, from the exact frequency.
    fn frequencies(&self, window: &[Pair], sums: &Sums, omega: f64) -> [f64; 4] {
        let Sums {
            moments,
            delayed,
            products,
        } = sums;
        let search = |at: &dyn Fn(&Products) -> Wave| {
            let j = |omega: f64| {
                let products = Products::of(window, omega);
                functional::squares(&at(&products), moments, &products)
            };
            frequency::exact(omega, window.len() as u32, j) / TAU * self.sample_rate
        };
        let fixed =
            |shape: Shape| search(&move |products: &Products| phase::align(&shape, products));
        [
            fixed(algorithm1::shape(moments)),
            fixed(algorithm2::shape(moments, delayed.quarter(moments, omega))),
            fixed(algorithm3::shape(moments, products.q())),
            search(&algorithm4::wave),
        ]
    }

    /// Centred samples of ideal pick-offs. The estimate's offsets are those of the raw signals.
    fn corrected(&self, raw: &[Pair], estimate: &Estimate, omega: f64) -> Vec<Pair> {
        let Calibration {
            gain_ratio,
            skew,
            pick_off_angle,
        } = self.calibration;
        let (s, c) = (2.0 * pick_off_angle).sin_cos();
        let centred: Vec<Pair> = raw
            .iter()
            .map(|p| [p[0] - estimate.offsets[0], p[1] - estimate.offsets[1]])
            .collect();
        // D was sampled `delay` later: what it showed earlier is exact between two samples of a sinusoid.
        let delay = f64::from(skew) * self.sample_rate;
        let neighbour = |k: usize| {
            if delay >= 0.0 {
                k.checked_sub(1)
            } else {
                Some(k + 1)
            }
        };
        let own = ((omega * (1.0 - delay.abs())).sin() / omega.sin()) as f32;
        let other = ((omega * delay.abs()).sin() / omega.sin()) as f32;
        let earlier = |k: usize, d: f32| {
            let beside = neighbour(k).and_then(|k| centred.get(k));
            if delay == 0.0 {
                d
            } else {
                beside.map_or(d, |p| own * d + other * p[1])
            }
        };
        let ideal = |(k, p): (usize, &Pair)| [p[0], (earlier(k, p[1]) / gain_ratio + p[0] * s) / c];
        centred.iter().enumerate().map(ideal).collect()
    }
}
