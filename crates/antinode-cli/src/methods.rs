//! The four methods beside the exact solution, for `identify --methods all`.

mod ideal;
pub mod rows;
pub mod table;

use std::collections::VecDeque;
use std::f64::consts::TAU;

use antinode::methods::comparison::{Comparison, Reference, Sums, compare};
use antinode::methods::{
    Delayed, Moments, Products, Shape, Wave, algorithm1, algorithm2, algorithm3, algorithm4,
    frequency, functional, phase,
};
use antinode::{Calibration, Estimate, Flags, Pair, Settings};

use ideal::Ideal;

/// The results of the methods in one window.
#[derive(Debug, Clone, Copy)]
pub struct Methods {
    pub comparison: Comparison,
    /// Frequency of each by J → min(ω), Hz.
    pub frequencies: [f64; 4],
    /// The frequencies less that of the exact solution, in its standard deviations.
    pub frequency_differences: [f64; 4],
}

/// The largest number of samples in a window that are whole periods at `omega` rad a sample, to the nearest sample; `None` if the window
/// is shorter than a period.
fn whole_periods(samples: u32, omega: f64) -> Option<usize> {
    let period = TAU / omega;
    let periods = ((f64::from(samples) + 0.5) / period).floor();
    (periods >= 1.0 && periods.is_finite()).then(|| (periods * period).round() as usize)
}

/// Keeps the samples that the next window may need.
#[derive(Debug)]
pub struct History {
    pairs: VecDeque<Pair>,
    /// Samples before a window that its methods may need, and the number of all samples that are kept.
    lead: usize,
    capacity: usize,
    /// Index in the stream of the first pair kept.
    start: u64,
    calibration: Calibration,
    sample_rate: f64,
}

impl History {
    /// No samples yet, for an identification with these settings and periods of at most `longest` samples.
    pub fn new(settings: &Settings, longest: usize) -> Self {
        // A quarter of a period, rounded up, and two for the skew; 6/5 for windows longer than asked or a known frequency that is off.
        let (lead, window) = (longest / 4 + 3, usize::from(settings.periods) * longest);
        Self {
            pairs: VecDeque::new(),
            lead,
            capacity: lead + window * 6 / 5,
            start: 0,
            calibration: settings.calibration,
            sample_rate: settings.sample_rate,
        }
    }

    /// Takes the samples that the identification took.
    pub fn extend(&mut self, pairs: &[Pair]) {
        self.pairs.extend(pairs);
        let excess = self.pairs.len().saturating_sub(self.capacity);
        self.pairs.drain(..excess);
        self.start += excess as u64;
    }

    /// Skips this many lost samples: no window reaches across them.
    pub fn skip(&mut self, count: u64) {
        self.start += self.pairs.len() as u64 + count;
        self.pairs.clear();
    }

    /// All methods over the whole periods of an estimate's window, to the nearest sample, (8); `None` if it holds no wave, or if its
    /// samples or those of a quarter of a period before it are not kept.
    pub fn compare(&self, estimate: &Estimate) -> Option<Methods> {
        if estimate.flags.contains(Flags::LOST) {
            return None;
        }
        let omega = TAU * estimate.frequency / self.sample_rate;
        let first = usize::try_from(estimate.start.checked_sub(self.start)?).ok()?;
        let from = first.saturating_sub(self.lead);
        let end = first + whole_periods(estimate.samples, omega)?;
        let raw: Vec<Pair> = self
            .pairs
            .range(from..end.min(self.pairs.len()))
            .copied()
            .collect();
        let ideal = Ideal::new(&self.calibration, omega, self.sample_rate);
        // The estimate's offsets are those of the raw signals.
        let pairs = ideal.pairs(&raw, estimate.offsets);
        let lead = first - from;
        let window = pairs.get(lead..)?;
        let lag = algorithm2::quarter_lag((TAU / omega) as f32);
        if lead < usize::from(lag) {
            // A wave of known frequency may begin with the first sample.
            return None;
        }
        let sums = Sums {
            moments: Moments::of(window),
            delayed: Delayed::of(&pairs, lead, lag),
            products: Products::of(window, omega),
        };
        let reference = Reference {
            noise: ideal.noise(f64::from(estimate.residual_rms).powi(2), lag),
            ..Reference::of(estimate, self.sample_rate)
        };
        let frequencies = self.frequencies(window, &sums, omega);
        Some(Methods {
            comparison: compare(&sums, &reference),
            frequencies,
            frequency_differences: frequencies
                .map(|f| (f - estimate.frequency) / f64::from(estimate.frequency_std)),
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
}
