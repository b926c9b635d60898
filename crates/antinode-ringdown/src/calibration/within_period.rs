//! What rotation and decay together do to a wave within its periods.

use num_complex::Complex;

use super::moments::Moment;
use super::shares::shares;
use super::solve::SPLITS;
use crate::runs::{per_radian, turn};

/// Mean decay rate of the amplitude in so many `seconds`, 1/s, by the energy of the first and the last of these phasors.
pub fn mean_decay(ideal: &[[Complex<f64>; 2]], seconds: f64) -> f64 {
    let energy = |phasors| shares(phasors)[0];
    0.5 * (energy(ideal[0]) / energy(ideal[ideal.len() - 1])).ln() / seconds
}

/// What rotation and decay together do within a period to ln E and to Q/E since the first moment: as in `resonator::motion`,
/// their rates are (κ/ω)(2/τ) Q/E and (κ/ω)(2/τ)(1 − (Q/E)²).
pub struct WithinPeriod {
    /// 1/τ, 1/s.
    decay: f64,
    /// δ c_τ, δ s_τ, Δω s_ω and Δω c_ω, per second.
    splits: [f64; SPLITS],
    sums: [f64; 2],
    /// Time, s, the pattern angle, rad, and R/E, S/E and Q/E of the last moment.
    last: Option<(f64, f64, [f64; 3])>,
}

impl WithinPeriod {
    pub fn new(decay: f64, splits: [f64; SPLITS], unit: f64) -> Self {
        Self {
            decay,
            splits: splits.map(|split| split / unit),
            sums: [0.0; 2],
            last: None,
        }
    }

    /// Takes the next moment, with its pattern angle and its R/E, S/E and Q/E; gives what is added to ln E and to Q/E up to it.
    pub fn advance(&mut self, moment: &Moment, angle: f64, state: [f64; 3]) -> [f64; 2] {
        let now = (moment.time, angle, state);
        if let Some((time, before, last)) = self.last.replace(now) {
            let [dc, ds, ws, wc] = self.splits;
            let [r, s, q] = [0, 1, 2].map(|i| 0.5 * (last[i] + state[i]));
            let line = (r * r + s * s).max(f64::MIN_POSITIVE);
            // The splits turn the pattern too: the rest of its turn is by −κ/2 a second.
            let by_splits = (s * (dc - ws * q) - r * (ds + wc * q)) / line;
            let kappa = -2.0 * turn(angle - before) + 0.5 * by_splits * (moment.time - time);
            let by = 2.0 * self.decay * kappa * per_radian(moment.omega);
            self.sums[0] += by * q;
            self.sums[1] += by * line;
        }
        self.sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::pick_offs::PickOffs;
    use crate::resonator::motion::Motion;

    #[test]
    fn sums_are_what_the_motion_has_beyond_that_of_short_periods() {
        const OMEGA: f64 = 2000.0;
        // With splits and without: 1/τ, δ c_τ, δ s_τ, Δω c_ω, Δω s_ω, γ, κ, a_A, a_B and θ.
        for (parameters, splits) in [
            ([0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.6, 1.0, 0.3, 0.4], [0.0; 4]),
            (
                [0.2, 0.02, -0.03, 0.0, 0.0, 0.0, -0.6, 1.0, -0.4, 0.1],
                [0.02, -0.03, 0.0, 0.0],
            ),
        ] {
            let mut short = Motion::new(&parameters);
            let mut true_motion = Motion::new(&parameters).of_frequency(OMEGA);
            let of = |motion: &Motion| {
                let [main, quadrature, angle] = motion.wave().into();
                let energy = main * main + quadrature * quadrature;
                let (sine, cosine) = (4.0 * angle).sin_cos();
                let line = (main * main - quadrature * quadrature) / energy;
                let state = [line * cosine, line * sine, 2.0 * main * quadrature / energy];
                (energy.ln(), angle, state)
            };
            let mut within = WithinPeriod::new(0.2, splits, 1.0);
            let mut sums = [0.0; 2];
            for step in 0..=200 {
                let (_, angle, state) = of(&true_motion);
                let moment = Moment {
                    time: 0.01 * f64::from(step),
                    raw: [Complex::new(1.0, 0.0); 2],
                    omega: OMEGA,
                    variance: 1.0,
                    corrected: PickOffs::IDEAL,
                    seconds: 0.0,
                };
                sums = within.advance(&moment, angle, state);
                if step < 200 {
                    short.advance(0.01);
                    true_motion.advance(0.01);
                }
            }
            let ((energy, _, now), (other_energy, _, other)) = (of(&true_motion), of(&short));
            let expected = [energy - other_energy, now[2] - other[2]];
            for (sum, expected) in sums.into_iter().zip(expected) {
                assert!((sum / expected - 1.0).abs() < 0.05, "{sums:?} {expected}");
            }
        }
    }
}
