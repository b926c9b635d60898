//! Whether rows scatter as their stated deviations say: in noise that is not white they do not.

use std::collections::VecDeque;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};

use antinode::Estimate;

/// Fourth differences: what changes smoothly is not in them.
const WEIGHTS: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
/// Differences from which on the scatter is known well enough.
const MANY: u32 = 200;
/// Scatter over stated deviation that is worth a word, and what chance may add to that of a single difference.
const MORE: f64 = 1.25;
const LESS: f64 = 0.75;
const CHANCE: f64 = 3.5;
/// Residual, as a share of a_A, below which harmonics, rounding and the converter are most of it.
const LEAST: f32 = 1e-4;
/// Mean of |z| of a normal z, √(2/π).
const MEAN: f64 = FRAC_2_SQRT_PI * FRAC_1_SQRT_2;

const NAMES: [&str; 4] = [
    "main amplitude",
    "quadrature amplitude",
    "angle",
    "frequency",
];

/// What is compared of a row, each with its deviation.
fn compared(e: &Estimate) -> [[f64; 2]; NAMES.len()] {
    [
        [e.main_amplitude.into(), e.main_amplitude_std.into()],
        [
            e.quadrature_amplitude.into(),
            e.quadrature_amplitude_std.into(),
        ],
        [e.angle, e.angle_std.into()],
        [e.frequency, e.frequency_std.into()],
    ]
}

/// Differences of clean rows that share no samples, over their deviations.
#[derive(Debug)]
pub(super) struct Scatter {
    /// The converter's step, 0 where it is not known: below it the residual is no noise.
    resolution: f32,
    rows: VecDeque<Estimate>,
    sums: [f64; NAMES.len()],
    count: u32,
}

impl Scatter {
    /// Of samples of this resolution, where it is known.
    pub fn new(resolution: Option<f32>) -> Self {
        Self {
            resolution: resolution.unwrap_or(0.0),
            rows: VecDeque::with_capacity(WEIGHTS.len()),
            sums: [0.0; NAMES.len()],
            count: 0,
        }
    }

    /// Takes a row.
    pub fn see(&mut self, estimate: &Estimate) {
        let least = (LEAST * estimate.main_amplitude).max(self.resolution);
        if !estimate.flags.is_empty() || estimate.residual_rms < least {
            self.rows.clear();
            return;
        }
        if let Some(last) = self.rows.back() {
            if estimate.start < last.end() {
                return;
            }
            // Rows as far apart as those before, or others begin.
            let apart = estimate.start - last.start;
            if self.rows.len() > 1 && apart != last.start - self.rows[self.rows.len() - 2].start {
                self.rows.drain(..self.rows.len() - 1);
            }
        }
        self.rows.push_back(*estimate);
        if self.rows.len() < WEIGHTS.len() {
            return;
        }
        let mut differences = [[0.0; 2]; NAMES.len()];
        for (row, weight) in self.rows.iter().zip(WEIGHTS) {
            for (total, [value, deviation]) in differences.iter_mut().zip(compared(row)) {
                total[0] += weight * value;
                total[1] += (weight * deviation).powi(2);
            }
        }
        for (sum, [difference, variance]) in self.sums.iter_mut().zip(differences) {
            *sum += difference.abs() / variance.sqrt();
        }
        self.count += 1;
        self.rows.pop_front();
    }

    /// What to tell where noise was taken to be white, or, with its option, not to be.
    pub fn told(&self, has_option: bool) -> Option<String> {
        if self.count < MANY {
            return None;
        }
        let count = f64::from(self.count);
        let (ratios, chance) = (
            self.sums.map(|sum| sum / (MEAN * count)),
            CHANCE / count.sqrt(),
        );
        if ratios.iter().all(|&ratio| ratio < LESS - 0.5 * chance) {
            let most = ratios.into_iter().fold(0.0, f64::max);
            let hum = if has_option {
                ""
            } else {
                "hum, which --hum leaves out, or "
            };
            return Some(format!(
                "rows scatter by only {most:.2} of their stated deviations: most of what was taken for noise is {hum}a tone that is not near the wave"
            ));
        }
        let more: Vec<String> = NAMES
            .iter()
            .zip(ratios)
            .filter(|&(_, ratio)| ratio > MORE + chance)
            .map(|(name, ratio)| format!("{name} {ratio:.2}"))
            .collect();
        let remedy = if has_option {
            ""
        } else {
            ", for which there is --coloured"
        };
        (!more.is_empty()).then(|| {
            format!(
                "rows scatter by more than their stated deviations ({} times): the wave moves or the sampling jitters, or the noise is not white{remedy}",
                more.join(", ")
            )
        })
    }
}
