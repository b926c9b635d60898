//! Whether rows scatter as their stated deviations say: in noise that is not white they do not.

use std::collections::VecDeque;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};

use antinode::{Estimate, Flags};

/// Rows of a difference, the fourth: what changes smoothly is not in it.
const ROWS: usize = 5;
/// How many times the least distance of its rows a difference may span, where some between them are misfits.
const SPAN: u64 = 8;
/// Deviations that count of a difference: one jump of the wave is no noise.
const MOST: f64 = 10.0;
/// Differences from which on the scatter is known well enough.
const MANY: u32 = 200;
/// Scatter over stated deviation that is worth a word, and what chance may add to that of a single difference.
const MORE: f64 = 1.25;
const LESS: f64 = 0.75;
const CHANCE: f64 = 3.5;
/// Residual, as a share of a_A, below which rounding is most of it.
const LEAST: f32 = 1e-5;
/// The same of harmonics and the converter's steps: such a residual need not scatter in rows.
const LEAST_NOISE: f32 = 1e-4;
/// Residual, in steps of the converter, below which there is less noise than rounding: that alone has 0.29.
const COARSE: f32 = 0.5;
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
#[derive(Debug, Default)]
pub(super) struct RowScatter {
    /// The converter's step, 0 where it is not known: below it the residual is no noise.
    resolution: f32,
    rows: VecDeque<Estimate>,
    sums: [f64; NAMES.len()],
    count: u32,
    /// Differences of rows whose residual is noise.
    noisy: u32,
    /// Differences of rows whose residual is mostly rounding.
    coarse: u32,
}

impl RowScatter {
    /// Of samples of this resolution, where it is known.
    pub fn new(resolution: Option<f32>) -> Self {
        Self {
            resolution: resolution.unwrap_or(0.0),
            ..Self::default()
        }
    }

    /// Takes a row.
    pub fn see(&mut self, estimate: &Estimate) {
        if estimate.flags == Flags::MISFIT {
            // The wave goes on.
            return;
        }
        if !estimate.flags.is_empty() || estimate.residual_rms < LEAST * estimate.main_amplitude {
            self.rows.clear();
            return;
        }
        if self
            .rows
            .back()
            .is_some_and(|last| estimate.start < last.end())
        {
            return;
        }
        self.rows.push_back(*estimate);
        if self.rows.len() < ROWS {
            return;
        }
        let pairs = self.rows.iter().zip(self.rows.iter().skip(1));
        let apart = pairs.map(|(row, next)| next.start - row.start).min();
        if estimate.start - self.rows[0].start <= SPAN * apart.unwrap_or(0) {
            self.differ();
        }
        self.rows.pop_front();
    }

    /// Takes the difference of the rows.
    fn differ(&mut self) {
        let times: [f64; ROWS] = std::array::from_fn(|i| self.rows[i].time);
        let least = |row: &Estimate| (LEAST_NOISE * row.main_amplitude).max(self.resolution);
        let is_noisy = self.rows.iter().all(|row| row.residual_rms >= least(row));
        let coarse = COARSE * self.resolution;
        let is_coarse = self.rows.iter().all(|row| row.residual_rms < coarse);
        let mut differences = [[0.0; 2]; NAMES.len()];
        for (i, row) in self.rows.iter().enumerate() {
            // Of any curve of the third degree through the rows nothing is left.
            let others = (0..ROWS).filter(|&k| k != i);
            let weight: f64 = others
                .map(|k| (times[ROWS - 1] - times[0]) / (times[i] - times[k]))
                .product();
            for (total, [value, deviation]) in differences.iter_mut().zip(compared(row)) {
                total[0] += weight * value;
                total[1] += (weight * deviation).powi(2);
            }
        }
        for (sum, [difference, variance]) in self.sums.iter_mut().zip(differences) {
            *sum += (difference.abs() / variance.sqrt()).min(MOST);
        }
        self.count += 1;
        self.noisy += u32::from(is_noisy);
        self.coarse += u32::from(is_coarse);
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
        let is_noise = 2 * self.noisy > self.count;
        if is_noise && ratios.iter().all(|&ratio| ratio < LESS - 0.5 * chance) {
            let most = ratios.into_iter().fold(0.0, f64::max);
            let hum = if has_option {
                ""
            } else {
                "hum, which --hum leaves out, or "
            };
            return Some(format!(
                "rows scatter by only {most:.2} of their stated deviations: most of what was taken for noise is {hum}a tone; what it adds to every row alike does not scatter"
            ));
        }
        let more: Vec<String> = NAMES
            .iter()
            .zip(ratios)
            .filter(|&(_, ratio)| ratio > MORE + chance)
            .map(|(name, ratio)| format!("{name} {ratio:.2}"))
            .collect();
        let step = if 2 * self.coarse > self.count {
            format!(
                "the converter's step of {:.1e} is coarser than the noise, and its rounding repeats with the wave: give the wave more gain, or \
                 the converter more bits; or ",
                self.resolution
            )
        } else {
            String::new()
        };
        let remedy = if has_option { "" } else { " (try --coloured)" };
        (!more.is_empty()).then(|| {
            format!(
                "rows scatter by more than their stated deviations ({} times): {step}the wave moves, the sampling jitters, the pick-offs share noise, \
                 there is a second tone or a harmonic (try a larger --periods), or the noise is not white{remedy}",
                more.join(", ")
            )
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::deviates::Deviates;

    /// A row of a steady wave that scatters by so many of its deviations.
    pub fn row(index: u64, times: f64, deviates: &mut Deviates) -> Estimate {
        let mut near = |value: f64, deviation: f64| value + times * deviation * deviates.draw();
        Estimate {
            start: 200 * index,
            samples: 200,
            time: 2e-3 * index as f64 + 1e-3,
            main_amplitude: near(0.6, 1e-4) as f32,
            quadrature_amplitude: near(0.02, 1e-4) as f32,
            angle: near(0.4, 1e-4),
            phase: 0.0,
            frequency: near(5332.0, 0.02),
            angle_rate: 0.0,
            decay_rate: 0.0,
            offsets: [0.0; 2],
            main_amplitude_std: 1e-4,
            quadrature_amplitude_std: 1e-4,
            angle_std: 1e-4,
            phase_std: 1e-4,
            frequency_std: 0.02,
            angle_rate_std: 0.1,
            decay_rate_std: 0.1,
            residual_rms: 1e-3,
            flags: Flags::empty(),
        }
    }

    /// What is told of 1000 rows that scatter by so many of their deviations, each first changed by its index.
    fn told(times: f64, change: impl Fn(u64, &mut Estimate)) -> Option<String> {
        told_of(None, times, change)
    }

    /// The same of samples of this resolution.
    fn told_of(
        resolution: Option<f32>,
        times: f64,
        change: impl Fn(u64, &mut Estimate),
    ) -> Option<String> {
        let (mut scatter, mut deviates) = (RowScatter::new(resolution), Deviates(3));
        for index in 0..1000 {
            let mut row = row(index, times, &mut deviates);
            change(index, &mut row);
            scatter.see(&row);
        }
        scatter.told(false)
    }

    #[test]
    fn rows_between_misfits_are_compared() {
        // Never five in a row, as hum may have it.
        let misfits = |index: u64, row: &mut Estimate| {
            if index % 4 == 3 {
                row.flags = Flags::MISFIT;
                row.main_amplitude = 0.3;
            }
            // A ring-down is a smooth course at unequal distances too.
            row.main_amplitude += 0.4 * (-1e-3 * index as f32).exp_m1();
        };
        assert_eq!(told(1.0, misfits), None);
        let more = told(1.6, misfits).unwrap();
        assert!(
            more.contains("by more") && more.contains("main amplitude 1."),
            "{more}"
        );
        let less = told(0.4, misfits).unwrap();
        assert!(less.contains("by only 0.3"), "{less}");
    }

    #[test]
    fn one_jump_is_no_scatter() {
        // As where an excitation is switched off just between two windows.
        let jump = |index: u64, row: &mut Estimate| {
            row.frequency += if index < 500 { 20.0 } else { 0.0 };
        };
        assert_eq!(told(1.0, jump), None);
    }

    #[test]
    fn little_noise_may_be_too_little_and_not_too_much() {
        // Harmonics and the converter leave a residual that rows may not have, but no scatter.
        let quiet = |_, row: &mut Estimate| row.residual_rms = 3e-5;
        assert_eq!(told(0.4, quiet), None);
        assert!(told(1.6, quiet).is_some());
        // Rounding may be any.
        assert_eq!(told(1.6, |_, row| row.residual_rms = 3e-6), None);
    }

    #[test]
    fn a_step_coarser_than_the_noise_is_named() {
        // Residuals of 1e-3: 0.29 steps are those of rounding alone, one step is noise.
        for (resolution, is_named) in [
            (Some(1e-3 / 0.29), true),
            (Some(1e-3), false),
            (None, false),
        ] {
            let told = told_of(resolution, 1.6, |_, _| ()).unwrap();
            let step = "times): the converter's step of 3.4e-3 is coarser than the noise";
            assert_eq!(told.contains(step), is_named, "{resolution:?}: {told}");
            assert_eq!(told.contains("the converter's step"), is_named, "{told}");
        }
    }
}
