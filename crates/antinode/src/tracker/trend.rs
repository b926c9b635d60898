//! The pattern angles of the last windows, and the angle rate that they predict for the present one.
//!
//! With a quadrature wave a turning pattern shifts the apparent frequency, so a window that must find θ̇ and f together knows f up
//! to (a_A² + a_B²)/(a_A² − a_B²) times worse than the bound. The angles of the windows before know θ̇ far better than one window.

use super::angle::Angle;
use super::record::Record;
use super::standing::Standing;
use crate::scalar::{greater, lesser};
use crate::window::Model;

/// Windows kept at most.
const MAX_POINTS: usize = 5;
/// Age, in quarter windows, beyond which an angle is left out: its powers would drown those of newer angles in rounding.
const MAX_AGE: f32 = 4e3;

/// Fewest angles, the window's own included, with which that is compared with the curve through the others.
const MIN_COMPARED: u32 = 5;
/// Share of the others in the curve's value at the window, below which it is lost in rounding: all of them had far more noise.
const MIN_SHARE_OF_OTHERS: f32 = 1e-4;
/// Windows over which the squared distance from that curve is averaged.
const AVERAGED_WINDOWS: f32 = 16.0;
/// Excess of that average that chance explains, as a share of its value in noise.
const CHANCE_EXCESS: f32 = 0.4;
/// Highest square that a single window counts for, over the expected one: one step is no vibration, and by itself no more than chance.
const MAX_SQUARE: f32 = 7.0;
/// Error of a rate, times the distance of two windows, if of six angles along a cubic the last lies one off the parabola through the
/// others.
const CUBIC_ERROR: f32 = 0.82;
/// The square of the same for fewer angles, through which a line or a parabola is off by more.
const LINE_ERROR_SQUARED: f32 = 20.0;

/// A rate in rad/sample and its variance.
#[derive(Debug, Clone, Copy)]
struct Rate {
    value: f32,
    variance: f32,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    /// Middle of the window, half samples, in halves of 32 bits: a `u64` would leave a gap in every point.
    middle: [u32; 2],
    angle: Angle,
    /// One over the variance.
    weight: f32,
}

impl Point {
    fn middle(&self) -> u64 {
        let [low, high] = self.middle;
        u64::from(high) << 32 | u64::from(low)
    }
}

/// Angles of the last clean windows that do not overlap.
#[derive(Debug, Clone)]
pub(crate) struct Trend {
    points: [Point; MAX_POINTS],
    length: u16,
    /// Index of the last one kept.
    last: u16,
    /// Mean squared distance of angles from the curves through those before, over its value in noise, less one: a pattern that vibrates
    /// follows no parabola.
    excess: f32,
    /// The value of `excess` if the present window is kept.
    next_excess: f32,
}

impl Trend {
    pub(crate) const fn new() -> Self {
        Self {
            points: [Point {
                middle: [0; 2],
                angle: Angle::ZERO,
                weight: 0.0,
            }; MAX_POINTS],
            length: 0,
            last: 0,
            excess: 0.0,
            next_excess: 0.0,
        }
    }

    /// Drops the angles: the next ones do not continue them.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
        self.next_excess = self.excess;
    }

    /// Drops what is known of the pattern's vibration too.
    pub(crate) fn forget(&mut self) {
        self.clear();
        (self.excess, self.next_excess) = (0.0, 0.0);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Keeps a clean window of `samples`, unless it overlaps the last one kept.
    #[inline]
    pub(crate) fn keep(&mut self, middle: u64, samples: u32, angle: Angle, variance: f32) {
        let overlaps = |last: &Point| middle < last.middle().wrapping_add(2 * u64::from(samples));
        if self
            .kept()
            .get(usize::from(self.last))
            .is_some_and(overlaps)
        {
            return;
        }
        self.excess = self.next_excess;
        // Takes the place of the oldest if all are in use.
        let next = self.last + 1;
        self.last = if self.length == 0 || next == MAX_POINTS as u16 {
            0
        } else {
            next
        };
        self.length = (self.length + 1).min(MAX_POINTS as u16);
        if let Some(place) = self.points.get_mut(usize::from(self.last)) {
            *place = Point {
                middle: [middle as u32, (middle >> 32) as u32],
                angle,
                weight: 1.0 / variance,
            };
        }
    }

    fn kept(&self) -> &[Point] {
        let length = usize::from(self.length);
        self.points.get(..length).unwrap_or(&self.points)
    }

    /// Takes the share of a turning pattern out of a window's frequency, by the rate that the angles of the windows before predict. If the
    /// window's own rate contradicts that, it is not done, except for a circular pattern, whose lesser wave is too small to know a rate.
    #[inline(always)]
    pub(crate) fn take_turning_out(
        &mut self,
        wave: &mut Standing,
        model: &Model,
        is_first: bool,
        is_circular: bool,
    ) {
        let record = &mut wave.record;
        let rate = self.rate(record, model.per_half);
        let (difference, spread) = if rate.variance > 0.0 {
            record.predict_rate(rate.value, rate.variance)
        } else if self.is_empty() {
            (record.turning, record.turning_variance)
        } else {
            // All of them overlap this window: nothing is known of its rate, not even that the pattern is at rest.
            return;
        };
        if is_circular || difference * difference < 16.0 * spread {
            let (squared, per_half) = (model.half * model.half, model.per_half);
            let per_spread = 1.0 / (squared * spread);
            let moved = wave.drift_turning * per_spread * difference;
            record.drift -= moved;
            // The variance less covariance²/spread, without a difference, which would lose all digits near a circle.
            record.drift_variance = (wave.turn_determinant * per_half * per_half
                + record.drift_variance * rate.variance * squared)
                * per_spread;
            if is_first {
                // The pattern may in fact turn by as much as it seems to.
                record.drift_variance += moved * moved;
            }
        }
    }

    /// The rate at the middle of a window, from its own angle and the angles before: constant with up to three points, linear in time with
    /// more. With none before, the pattern is taken to be at rest until a window shows that it is not.
    ///
    /// `per_half` is one over half the window's samples.
    #[inline(always)]
    fn rate(&mut self, record: &Record, per_half: f32) -> Rate {
        // Sums of weight·timeⁿ and of weight·timeⁿ·angle; the window itself is at time and angle 0, and its weight is one.
        let own = record.angle_variance;
        let mut powers = [1.0, 0.0, 0.0, 0.0, 0.0];
        let mut values = [0.0; 3];
        let (mut used, mut nearest) = (1, -MAX_AGE);
        for point in self.kept() {
            // Those that overlap the window, or are too old for 32 bits, are left out.
            let passed = record.middle.wrapping_sub(point.middle());
            let Ok(passed) = u32::try_from(passed) else {
                continue;
            };
            if passed / 2 < record.samples.get() {
                continue;
            }
            let time = -(passed as f32) * per_half;
            if time < -MAX_AGE {
                continue;
            }
            nearest = greater(time, nearest);
            let angle = point.angle.less(record.angle);
            let mut weight = point.weight * own;
            for (n, power) in powers.iter_mut().enumerate() {
                *power += weight;
                if let Some(value) = values.get_mut(n) {
                    *value += weight * angle;
                }
                weight *= time;
            }
            used += 1;
        }
        if used < 2 {
            return Rate {
                value: 0.0,
                variance: 0.0,
            };
        }
        let [s0, s1, s2, s3, s4] = powers;
        let [v0, v1, v2] = values;
        // The curvature is eliminated from level and rate if there are enough points for it, then the level from the rate.
        let per_s4 = if used > 3 { 1.0 / s4 } else { 0.0 };
        // Divided by s4 first: a product of two sums may exceed f32 if noise was far less long ago.
        let (of_level, of_rate) = (s2 * per_s4, s3 * per_s4);
        let (level, mixed, rate) = (s0 - s2 * of_level, s1 - s2 * of_rate, s2 - s3 * of_rate);
        let (level_value, rate_value) = (v0 - of_level * v2, v1 - of_rate * v2);
        // From a rate per quarter window to one per sample.
        let per_sample = 2.0 * per_half;
        let per_determinant = 1.0 / (level * rate - mixed * mixed);
        let mut variance = level * own * per_determinant;
        // The rate's error if the pattern vibrates is inferred from how far angles have lain off the curves through those before them.
        let of_others = 1.0 - rate * per_determinant;
        let (error_square, share) = if used >= MIN_COMPARED && of_others > MIN_SHARE_OF_OTHERS {
            // The curve's value at the window, whose own angle is 0: `of_others` times the distance of the others' curve.
            let at_window = (rate * level_value - mixed * rate_value) * per_determinant;
            // Its square over the expected one.
            let max_square = MAX_SQUARE * (1.0 + greater(self.excess, 0.0));
            let square = lesser(at_window * at_window / (own * of_others), max_square);
            self.next_excess =
                self.excess + (square - 1.0 - self.excess) * (1.0 / AVERAGED_WINDOWS);
            (CUBIC_ERROR * CUBIC_ERROR, of_others)
        } else {
            self.next_excess = self.excess;
            (LINE_ERROR_SQUARED, 1.0)
        };
        let bias = self.next_excess - CHANCE_EXCESS;
        if bias > 0.0 {
            variance += error_square * own * bias / (share * nearest * nearest);
        }
        Rate {
            value: (level * rate_value - mixed * level_value) * per_determinant * per_sample,
            variance: variance * per_sample * per_sample,
        }
    }
}
