//! Decides whether the residuals of a trial's fit are noise or a second tone.

use super::trial::{Fitted, Row, Trial};
use crate::block::Pair;

/// Correlations of the residuals of a fit at lags of 0, 1 and 2 samples.
#[derive(Debug, Clone)]
pub(super) struct Residuals {
    row: Row,
    sums: [f32; 3],
    /// The last two residuals of each pick-off, newest first: two of the first half, then two of the last half, which runs backwards.
    before: [[f32; 4]; 2],
}

impl Residuals {
    /// Residuals of no samples.
    pub(super) const NONE: Self = Self {
        row: Row::NONE,
        sums: [0.0; 3],
        before: [[0.0; 4]; 2],
    };

    /// Begins the residuals of a completed trial, in place.
    pub(super) fn begin(&mut self, trial: &Trial) {
        trial.restart(&mut self.row);
        self.sums = [0.0; 3];
        self.before = [[0.0; 4]; 2];
    }

    /// Adds samples less the fit: in each item the next one from the start, and the next one from the end backwards.
    #[inline(always)]
    pub(super) fn push_ends(&mut self, ends: impl Iterator<Item = [Pair; 2]>, fitted: &Fitted) {
        let Self {
            mut row,
            sums: [mut all, mut one, mut two],
            mut before,
        } = *self;
        for samples in ends {
            let [cosine, sine, u_cosine, u_sine] = row.next();
            for (channel, before) in before.iter_mut().enumerate() {
                let [c, s, uc, us, offset] = fitted.parameters[channel];
                // Of both rows the even columns are equal, the odd ones opposite.
                let even = c * cosine + us * u_sine + offset;
                let odd = s * sine + uc * u_cosine;
                let a = samples[0][channel] - (even + odd);
                let b = samples[1][channel] - (even - odd);
                let [a_1, a_2, b_1, b_2] = *before;
                all += a * a + b * b;
                one += a * a_1 + b * b_1;
                two += a * a_2 + b * b_2;
                *before = [a, a_1, b, b_1];
            }
        }
        *self = Self {
            row,
            sums: [all, one, two],
            before,
        };
    }

    /// Correlations over all samples, with those across the middle, where the last samples of both halves are neighbours.
    fn correlations(&self) -> [f32; 3] {
        let [all, mut one, mut two] = self.sums;
        for [a_1, a_2, b_1, b_2] in self.before {
            one += a_1 * b_1;
            two += a_1 * b_2 + a_2 * b_1;
        }
        [all, one, two]
    }

    /// True if the residuals are noise: a second tone of less than twice the wave's frequency shows in one correlation or the other.
    pub(super) fn are_noise(&self) -> bool {
        let [all, one, two] = self.correlations();
        one <= 0.5 * all && two >= -0.6 * all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::PhaseStep;

    #[test]
    fn correlations_from_both_ends_equal_those_in_order_of_time() {
        let mut seed = 1u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for length in (14..=32).step_by(2) {
            let step = PhaseStep::from_period(6.3);
            let samples: std::vec::Vec<Pair> = (0..length)
                .map(|k| {
                    let unit = step.after_half_samples(2 * k as i64).unit();
                    [unit.re + 0.1 * random(), unit.im + 0.1 * random()]
                })
                .collect();
            let mut trial = Trial::NONE;
            trial.begin(6.3, length);
            let (first, last) = samples.split_at(length / 2);
            trial.push_ends(first.iter().zip(last.iter().rev()).map(|(&a, &b)| [a, b]));
            let fitted = trial.fitted(0.0).expect("a wave");
            let mut residuals = Residuals::NONE;
            residuals.begin(&trial);
            // In two parts, as in a search.
            let ends: std::vec::Vec<[Pair; 2]> = (first.iter().zip(last.iter().rev()))
                .map(|(&a, &b)| [a, b])
                .collect();
            let (inner, outer) = ends.split_at(length / 4);
            residuals.push_ends(inner.iter().copied(), &fitted);
            residuals.push_ends(outer.iter().copied(), &fitted);
            // The same by definition, sample after sample.
            let mut row = Row::NONE;
            trial.restart(&mut row);
            let left: std::vec::Vec<Pair> = samples
                .iter()
                .map(|sample| {
                    let [c, s, uc, us] = row.next();
                    core::array::from_fn(|channel| {
                        let x = fitted.parameters[channel];
                        let wave = x[0] * c + x[1] * s + x[2] * uc + x[3] * us + x[4];
                        sample[channel] - wave
                    })
                })
                .collect();
            for (lag, sum) in residuals.correlations().iter().enumerate() {
                let pairs = left[lag..].iter().zip(&left);
                let expected: f32 = pairs.map(|(x, y)| x[0] * y[0] + x[1] * y[1]).sum();
                assert!(
                    (sum - expected).abs() < 1e-4 * residuals.sums[0],
                    "{length} samples, lag {lag}: {sum}, not {expected}"
                );
            }
        }
    }
}
