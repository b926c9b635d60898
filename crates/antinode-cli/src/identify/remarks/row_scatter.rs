//! Check whether rows scatter as their stated deviations say: in noise that is not white they do not.

use std::collections::VecDeque;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};

use antinode::{Estimate, Flags};

/// Rows in a fourth difference, which cancels smooth changes.
const DIFFERENCE_ROWS: usize = 5;
/// Span of a difference, at most, in units of the shortest distance between its rows, as misfits between them are skipped.
const MAX_SPAN: u64 = 8;
/// Limit of a difference, in deviations: a single jump of the wave is no noise.
const MAX_DIFFERENCE: f64 = 10.0;
/// Differences needed to know the scatter well enough.
const MIN_DIFFERENCES: u32 = 200;
/// Ratios of scatter to stated deviation beyond which there is a warning, and what chance may add to the ratio of a single difference.
const MAX_RATIO: f64 = 1.25;
const MIN_RATIO: f64 = 0.75;
const CHANCE: f64 = 3.5;
/// Residual, as a share of a_A, below which it is mostly rounding.
const MIN_RESIDUAL: f32 = 1e-5;
/// The same for harmonics and the converter's steps, which need not scatter from row to row.
const MIN_NOISE: f32 = 1e-4;
/// Residual, in steps of the converter, below which rounding exceeds noise; rounding alone has 0.29.
const COARSE: f32 = 0.5;
/// Mean of |z| of a normal z, √(2/π).
const MEAN: f64 = FRAC_2_SQRT_PI * FRAC_1_SQRT_2;

const NAMES: [&str; 4] = [
    "main amplitude",
    "quadrature amplitude",
    "angle",
    "frequency",
];

/// The quantities of a row that are compared, each with its deviation: the amplitudes as ln a_A and a_B/a_A, which a decay does not bend.
fn compared(e: &Estimate) -> [[f64; 2]; NAMES.len()] {
    let main = f64::from(e.main_amplitude);
    let [quadrature, of_main, of_quadrature] = [
        e.quadrature_amplitude,
        e.main_amplitude_std,
        e.quadrature_amplitude_std,
    ]
    .map(|value| f64::from(value) / main);
    [
        [main.ln(), of_main],
        [quadrature, of_quadrature.hypot(quadrature * of_main)],
        [e.angle, e.angle_std.into()],
        [e.frequency, e.frequency_std.into()],
    ]
}

/// Differences of clean rows that share no samples, over their deviations.
#[derive(Debug, Default)]
pub(super) struct RowScatter {
    /// The converter's step, 0 if unknown: a residual below it is not noise.
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
    /// No rows yet, of samples with this resolution, if known.
    pub fn new(resolution: Option<f32>) -> Self {
        Self {
            resolution: resolution.unwrap_or(0.0),
            ..Self::default()
        }
    }

    /// Takes a row.
    pub fn see(&mut self, estimate: &Estimate) {
        if estimate.flags == Flags::MISFIT {
            // Only this row is left out: the wave goes on.
            return;
        }
        if !estimate.flags.is_empty()
            || estimate.residual_rms < MIN_RESIDUAL * estimate.main_amplitude
        {
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
        if self.rows.len() < DIFFERENCE_ROWS {
            return;
        }
        let pairs = self.rows.iter().zip(self.rows.iter().skip(1));
        let apart = pairs.map(|(row, next)| next.start - row.start).min();
        if estimate.start - self.rows[0].start <= MAX_SPAN * apart.unwrap_or(0) {
            self.differ();
        }
        self.rows.pop_front();
    }

    /// Adds the difference of the current rows.
    fn differ(&mut self) {
        let times: [f64; DIFFERENCE_ROWS] = std::array::from_fn(|i| self.rows[i].time);
        let min = |row: &Estimate| (MIN_NOISE * row.main_amplitude).max(self.resolution);
        let is_noisy = self.rows.iter().all(|row| row.residual_rms >= min(row));
        let coarse = COARSE * self.resolution;
        let is_coarse = self.rows.iter().all(|row| row.residual_rms < coarse);
        let mut differences = [[0.0; 2]; NAMES.len()];
        for (i, row) in self.rows.iter().enumerate() {
            // The weights cancel any cubic through the rows.
            let others = (0..DIFFERENCE_ROWS).filter(|&k| k != i);
            let weight: f64 = others
                .map(|k| (times[DIFFERENCE_ROWS - 1] - times[0]) / (times[i] - times[k]))
                .product();
            for (total, [value, deviation]) in differences.iter_mut().zip(compared(row)) {
                total[0] += weight * value;
                total[1] += (weight * deviation).powi(2);
            }
        }
        for (sum, [difference, variance]) in self.sums.iter_mut().zip(differences) {
            *sum += (difference.abs() / variance.sqrt()).min(MAX_DIFFERENCE);
        }
        self.count += 1;
        self.noisy += u32::from(is_noisy);
        self.coarse += u32::from(is_coarse);
    }

    /// A warning if rows scatter more or less than stated; `has_option` with `--hum` or `--coloured`.
    pub fn warning(&self, has_option: bool) -> Option<String> {
        if self.count < MIN_DIFFERENCES {
            return None;
        }
        let count = f64::from(self.count);
        let (ratios, chance) = (
            self.sums.map(|sum| sum / (MEAN * count)),
            CHANCE / count.sqrt(),
        );
        let is_noise = 2 * self.noisy > self.count;
        if is_noise && ratios.iter().all(|&ratio| ratio < MIN_RATIO - 0.5 * chance) {
            let max = ratios.into_iter().fold(0.0, f64::max);
            let hum = if has_option {
                ""
            } else {
                "hum (try --hum) or "
            };
            return Some(format!(
                "rows scatter by only {max:.2} times their stated deviations: most of the assumed noise is {hum}a tone, which affects all \
                 rows equally and so does not scatter"
            ));
        }
        let more: Vec<String> = NAMES
            .iter()
            .zip(ratios)
            .filter(|&(_, ratio)| ratio > MAX_RATIO + chance)
            .map(|(name, ratio)| format!("{name} {ratio:.2}"))
            .collect();
        let step = if 2 * self.coarse > self.count {
            format!(
                "the converter's step of {:.1e} is coarser than the noise, and its rounding repeats with the wave (raise the gain, or use a \
                 finer converter), ",
                self.resolution
            )
        } else {
            String::new()
        };
        let remedy = if has_option { "" } else { " (try --coloured)" };
        (!more.is_empty()).then(|| {
            format!(
                "rows scatter by more than their stated deviations ({} times): {step}the wave is unsteady, the sampling jitters, the \
                 pick-offs share noise, there is a second tone or a harmonic (try a larger --periods), or the noise is not white{remedy}",
                more.join(", ")
            )
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use antinode_sim::Deviates;

    /// A row of a steady wave that scatters by `times` its deviations.
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

    /// The warning for 1000 rows that scatter by `times` their deviations, each first changed according to its index.
    fn warning(times: f64, change: impl Fn(u64, &mut Estimate)) -> Option<String> {
        warning_with(None, times, change)
    }

    /// The same for samples with this resolution.
    fn warning_with(
        resolution: Option<f32>,
        times: f64,
        change: impl Fn(u64, &mut Estimate),
    ) -> Option<String> {
        let (mut scatter, mut deviates) = (RowScatter::new(resolution), Deviates::new(3));
        for index in 0..1000 {
            let mut row = row(index, times, &mut deviates);
            change(index, &mut row);
            scatter.see(&row);
        }
        scatter.warning(false)
    }

    #[test]
    fn rows_between_misfits_are_compared() {
        // Never five in a row, as hum may cause.
        let misfits = |index: u64, row: &mut Estimate| {
            if index % 4 == 3 {
                row.flags = Flags::MISFIT;
                row.main_amplitude = 0.3;
            }
            // A ring-down is smooth at unequal distances too.
            row.main_amplitude += 0.4 * (-1e-3 * index as f32).exp_m1();
        };
        assert_eq!(warning(1.0, misfits), None);
        let more = warning(1.6, misfits).unwrap();
        assert!(
            more.contains("by more") && more.contains("main amplitude 1."),
            "{more}"
        );
        let less = warning(0.35, misfits).unwrap();
        assert!(less.contains("by only 0.3"), "{less}");
    }

    #[test]
    fn rows_far_apart_are_not_compared() {
        let few_together = |index: u64, row: &mut Estimate| {
            if index % 12 >= 4 {
                row.flags = Flags::MISFIT;
            }
        };
        assert_eq!(warning(1.6, few_together), None);
    }

    #[test]
    fn options_that_were_given_are_not_suggested() {
        for times in [0.4, 1.6] {
            let (mut scatter, mut deviates) = (RowScatter::new(None), Deviates::new(3));
            (0..1000).for_each(|index| scatter.see(&row(index, times, &mut deviates)));
            for has_option in [false, true] {
                let warning = scatter.warning(has_option).unwrap();
                assert_eq!(warning.contains("try --hum"), times < 1.0 && !has_option);
                assert_eq!(
                    warning.contains("try --coloured"),
                    times > 1.0 && !has_option
                );
            }
        }
    }

    #[test]
    fn one_jump_is_no_scatter() {
        // As if an excitation were switched off just between two windows.
        let jump = |index: u64, row: &mut Estimate| {
            row.frequency += if index < 500 { 20.0 } else { 0.0 };
        };
        assert_eq!(warning(1.0, jump), None);
    }

    #[test]
    fn steps_of_the_wave_are_no_scatter() {
        // As if a gain were switched to and fro, just between two windows.
        let steps = |index: u64, row: &mut Estimate| {
            row.main_amplitude += if (index / 25).is_multiple_of(2) {
                0.1
            } else {
                0.0
            };
            if index.is_multiple_of(25) {
                row.flags = Flags::STEP;
            }
        };
        assert_eq!(warning(1.0, steps), None);
    }

    #[test]
    fn fast_decays_are_no_scatter() {
        // Ring-downs of 10 windows, in each of which the amplitude falls by a quarter.
        for quadrature in [0.03, 0.9] {
            let decays = |index: u64, row: &mut Estimate| {
                let left = (-0.3 * (index % 10) as f32).exp();
                row.main_amplitude += 0.6 * (left - 1.0);
                row.quadrature_amplitude += 0.6 * quadrature * left - 0.02;
                if index.is_multiple_of(10) {
                    row.flags = Flags::REACQUIRED;
                }
            };
            assert_eq!(warning(1.0, decays), None);
            let more = warning(1.6, decays).unwrap();
            assert!(
                more.contains("main amplitude 1.") && more.contains("quadrature amplitude 1."),
                "{more}"
            );
        }
    }

    #[test]
    fn a_small_residual_explains_too_little_scatter_but_not_too_much() {
        // Harmonics and the converter leave a residual, which need not scatter from row to row.
        let quiet = |_, row: &mut Estimate| row.residual_rms = 3e-5;
        assert_eq!(warning(0.4, quiet), None);
        // In codes of a converter.
        let of_codes = |residual: f32| {
            move |_, row: &mut Estimate| {
                row.main_amplitude *= 2e4;
                row.main_amplitude_std *= 2e4;
                row.residual_rms = 2e4 * residual;
            }
        };
        assert_eq!(warning(0.4, of_codes(3e-5)), None);
        assert!(warning(1.6, of_codes(3e-5)).is_some());
        assert_eq!(warning(1.6, of_codes(3e-6)), None);
        // Little less scatter may be chance.
        assert_eq!(warning(0.73, |_, _| ()), None);
        assert!(warning(1.6, quiet).is_some());
        // Rounding may scatter in any way.
        assert_eq!(warning(1.6, |_, row| row.residual_rms = 3e-6), None);
    }

    #[test]
    fn a_step_coarser_than_the_noise_is_named() {
        // Residuals of 1e-3: 0.29 steps are those of rounding alone, one step is noise.
        for (resolution, is_named) in [
            (Some(1e-3 / 0.29), true),
            (Some(1e-3), false),
            (None, false),
        ] {
            let warning = warning_with(resolution, 1.6, |_, _| ()).unwrap();
            let step = "times): the converter's step of 3.4e-3 is coarser than the noise";
            assert_eq!(
                warning.contains(step),
                is_named,
                "{resolution:?}: {warning}"
            );
            assert_eq!(
                warning.contains("the converter's step"),
                is_named,
                "{warning}"
            );
        }
    }
}
