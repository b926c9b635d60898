//! The standing wave's parameters from the travelling waves of a window: the short form of formulas (24)–(25).
//!
//! z₊ = (a_A + a_B)·e^{j(2θ−α)} and z₋ = (a_A − a_B)·e^{−j(2θ+α)}. Hence a_A = (|z₊|+|z₋|)/2, a_B = (|z₊|−|z₋|)/2,
//! 4θ = arg z₊ − arg z₋, 2α = −arg z₊ − arg z₋, with no cancellation and the right quadrant.

use core::num::NonZeroU32;

use num_complex::Complex32;

use super::angle::Angle;
use super::record::{Amplitude, Record};
use crate::arch::square_root;
use crate::phase::argument;
use crate::scalar::greater;
use crate::window::{Covariance, Fit, Model};

/// The standing wave at the middle of a window, with variances for the fit's own noise, and what only the tests of this window need.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Standing {
    /// Its angle, within ±π/2, and its phase, within ±π, are values that go together.
    pub record: Record,
    /// The noise variance a sample from which all variances are computed.
    pub noise: f32,
    /// Covariance of drift and turning, per half window: with quadrature, a turning pattern looks like another frequency.
    pub drift_turning: f32,
    /// The product of both variances less the square of their covariance.
    pub turn_determinant: f32,
}

/// Variances of the components of z₊ and z₋ along a direction each, and their covariance.
struct Variances {
    plus: f32,
    minus: f32,
    covariance: f32,
}

impl Variances {
    /// Variances of the sum of both components and of their difference.
    fn sum_and_difference(&self) -> [f32; 2] {
        let separate = self.plus + self.minus;
        [
            separate + 2.0 * self.covariance,
            separate - 2.0 * self.covariance,
        ]
    }

    /// The variances of the components times these factors.
    fn times(&self, [plus, minus]: [f32; 2]) -> Self {
        Self {
            plus: self.plus * plus * plus,
            minus: self.minus * minus * minus,
            covariance: self.covariance * plus * minus,
        }
    }
}

/// Variances of the components of z₊ and z₋ along a direction each that are due to unit variance of the raw phasors' real parts, and of
/// their imaginary parts.
struct Shares([Variances; 2]);

impl Shares {
    /// Along the directions `plus` and `minus`; the gains are the noise gains of a [`Correction`](crate::calibration::Correction).
    fn along(plus: Complex32, minus: Complex32, [d, c_on_d]: [f32; 2]) -> Self {
        // From z₊ = z_C + j z_D and z₋ = z_C − j z_D: how a component depends on z_D, and through it on raw D and C.
        let (plus_d, minus_d) = (
            Complex32::new(plus.im, -plus.re),
            Complex32::new(-minus.im, minus.re),
        );
        let (plus_c, minus_c) = (plus + plus_d * c_on_d, minus + minus_d * c_on_d);
        let (plus_d, minus_d) = (plus_d * d, minus_d * d);
        let of = |part: fn(Complex32) -> f32| {
            let [plus_c, minus_c] = [plus_c, minus_c].map(part);
            let [plus_d, minus_d] = [plus_d, minus_d].map(part);
            Variances {
                plus: plus_c * plus_c + plus_d * plus_d,
                minus: minus_c * minus_c + minus_d * minus_d,
                covariance: plus_c * minus_c + plus_d * minus_d,
            }
        };
        Self([of(|z| z.re), of(|z| z.im)])
    }

    /// The variances that result from these of the real and the imaginary parts.
    fn of(&self, [real, imaginary]: [f32; 2]) -> Variances {
        let [re, im] = &self.0;
        Variances {
            plus: real * re.plus + imaginary * im.plus,
            minus: real * re.minus + imaginary * im.minus,
            covariance: real * re.covariance + imaginary * im.covariance,
        }
    }

    /// As [`Shares::of`], for the components across the directions: real and imaginary parts change places.
    fn across(&self, [real, imaginary]: [f32; 2]) -> Variances {
        self.of([imaginary, real])
    }
}

impl Standing {
    /// The standing wave of a fit whose noise variance a sample is `noise`, and `share` times that for the stated standard deviations;
    /// `residual` is the variance of what the fit leaves, and `end` the index of the sample after its window.
    #[inline(never)]
    pub(crate) fn new(
        model: &Model,
        fit: &Fit,
        [noise, share]: [f32; 2],
        residual: f32,
        end: u64,
    ) -> Self {
        let samples = u32::from(model.blocks) * u32::from(model.layout.length);
        let middle = end.wrapping_mul(2).wrapping_sub(u64::from(samples) + 1);
        let [plus, minus] = fit.waves.value;
        let [plus_change, minus_change] = fit.waves.change;
        let absolute = |z: Complex32| square_root(z.norm_sqr());
        let (plus_angle, minus_angle) = (argument(plus), argument(minus));
        let (p, m) = (absolute(plus), absolute(minus));
        // A wave smaller than this share of both is rounding, and has no direction.
        let min_size = greater(1e-7 * (p + m), f32::MIN_POSITIVE);
        let per_size = [p, m].map(|size| 1.0 / greater(size, min_size));
        let along = |z: Complex32, size: f32, per_size: f32| {
            if size > min_size {
                z * per_size
            } else {
                Complex32::ONE
            }
        };
        let e_plus = along(plus, p, per_size[0]);
        let e_minus = along(minus, m, per_size[1]);
        // The components of a change along a wave and across it: the change of its amplitude and, over the amplitude, of its phase.
        let grown = |change: Complex32, e: Complex32| change.re * e.re + change.im * e.im;
        let turned = |change: Complex32, e: Complex32| change.im * e.re - change.re * e.im;
        let (plus_growth, minus_growth) =
            (grown(plus_change, e_plus), grown(minus_change, e_minus));
        let plus_turn = turned(plus_change, e_plus) * per_size[0];
        let minus_turn = turned(minus_change, e_minus) * per_size[1];

        let Covariance { even, odd } = &model.covariance;
        let levels = [noise * even[0][0], noise * odd[0][0]];
        let slopes = [noise * odd[1][1], noise * even[1][1]];
        let shares = Shares::along(e_plus, e_minus, model.correction.noise_gains);
        let (size, growth) = (shares.of(levels), shares.of(slopes));
        let phase = shares.across(levels).times(per_size);
        let turn = shares.across(slopes).times(per_size);
        let [main, quadrature] = size.sum_and_difference();
        let [main_change, quadrature_change] = growth.sum_and_difference();
        let [common, difference] = phase.sum_and_difference();
        let [drift, turning] = turn.sum_and_difference();
        let per_half = model.per_half;
        let squared = per_half * per_half;
        let (turning_rate, turning_variance) = (
            0.25 * (plus_turn - minus_turn) * per_half,
            0.0625 * turning * squared,
        );
        Self {
            record: Record {
                middle,
                angle_middle: middle,
                samples: NonZeroU32::new(samples).unwrap_or(NonZeroU32::MIN),
                residual,
                share,
                carrier: model.carrier,
                drift: 0.5 * (plus_turn + minus_turn) * per_half,
                drift_variance: 0.25 * drift * squared,
                angle: Angle {
                    quarters: 0,
                    rest: 0.25 * (plus_angle - minus_angle),
                },
                angle_variance: 0.0625 * difference,
                turning: turning_rate,
                turning_variance,
                predicted_rate: turning_rate,
                predicted_rate_variance: turning_variance,
                phase: -0.5 * (plus_angle + minus_angle),
                phase_variance: 0.25 * common,
                main: Amplitude {
                    value: 0.5 * (p + m),
                    rate: 0.5 * (plus_growth + minus_growth) * per_half,
                    variance: 0.25 * main,
                    rate_variance: 0.25 * main_change * squared,
                },
                quadrature: Amplitude {
                    value: 0.5 * (p - m),
                    rate: 0.5 * (plus_growth - minus_growth) * per_half,
                    variance: 0.25 * quadrature,
                    rate_variance: 0.25 * quadrature_change * squared,
                },
                channel_power: fit.power,
                channel_variance: noise * greater(even[0][0], odd[0][0]),
                offsets: fit.offsets,
                // Four times the variance of a mean: a short window knows its offset worse than that. Offsets of single blocks may be
                // anywhere.
                offset_variance: if model.shared > 0.0 {
                    2.0 * noise * per_half
                } else {
                    f32::INFINITY
                },
            },
            noise,
            drift_turning: 0.125 * (turn.plus - turn.minus),
            turn_determinant: 0.0625 * (turn.plus * turn.minus - turn.covariance * turn.covariance),
        }
    }
}
