//! The course of the pattern angle over the last windows: what rate it promises for the present one.
//!
//! With a quadrature wave a turning pattern shifts the apparent frequency, so a window that must find θ̇ and f together knows f up
//! to (a_A² + a_B²)/(a_A² − a_B²) times worse than the bound. The angles of the windows before know θ̇ far better than one window.

use super::angle::Angle;
use super::record::Record;
use super::standing::Standing;
use crate::scalar::{greater, lesser};
use crate::window::Model;

/// Windows kept.
const KEPT: usize = 5;
/// Quarter windows ago beyond which an angle says nothing of the present rate: what its powers leave of nearer ones is lost in rounding.
const OLDEST: f32 = 4e3;

/// Angles from which on a window's own is compared with the curve through the others.
const ENOUGH: u32 = 5;
/// The share that these others have in the curve at the window, below which it is lost in rounding: all were in far more noise.
const LEAST: f32 = 1e-4;
/// Windows over which is averaged by how much it lies beside that.
const AVERAGED: f32 = 16.0;
/// The share of its variance by which that average exceeds its noise by chance.
const BY_CHANCE: f32 = 0.4;
/// A single window counts no more than so many times what is expected of it: one step is no vibration, and by itself no more than chance.
const MOST: f32 = 7.0;
/// What a rate is off, times the distance of two windows, where the last angle of six, which turn as a cubic, is off the parabola through
/// the others by one.
const OF_CUBIC: f32 = 0.82;
/// The square of the same of a few angles: a line or a parabola through them is off by more.
const OF_LINE: f32 = 20.0;

/// A rate in rad/sample and its variance.
#[derive(Debug, Clone, Copy)]
struct Rate {
    value: f32,
    variance: f32,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    /// Middle of the window, half samples, in halves of 32 bits: one of 64 would leave a gap in every point.
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
    points: [Point; KEPT],
    length: u16,
    /// Where the last one is.
    last: u16,
    /// Mean square of what angles are beside the curves through those before, over what noise makes of it, less one: a pattern that vibrates
    /// turns as no parabola.
    beside: f32,
    /// What that becomes if the present window is kept.
    learned: f32,
}

impl Trend {
    pub(crate) const fn new() -> Self {
        Self {
            points: [Point {
                middle: [0; 2],
                angle: Angle::ZERO,
                weight: 0.0,
            }; KEPT],
            length: 0,
            last: 0,
            beside: 0.0,
            learned: 0.0,
        }
    }

    /// Drops the angles: the next ones do not continue them.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
        self.learned = self.beside;
    }

    /// Drops what is known of the pattern's vibration too.
    pub(crate) fn forget(&mut self) {
        self.clear();
        (self.beside, self.learned) = (0.0, 0.0);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Keeps a clean window of `samples`, unless it overlaps the last one kept.
    #[inline]
    pub(crate) fn keep(&mut self, middle: u64, samples: u32, angle: Angle, variance: f32) {
        let overlaps = |last: &Point| middle < last.middle().wrapping_add(2 * u64::from(samples));
        if self
            .known()
            .get(usize::from(self.last))
            .is_some_and(overlaps)
        {
            return;
        }
        self.beside = self.learned;
        // In the place of the oldest where all are taken.
        let next = self.last + 1;
        self.last = if self.length == 0 || next == KEPT as u16 {
            0
        } else {
            next
        };
        self.length = (self.length + 1).min(KEPT as u16);
        if let Some(place) = self.points.get_mut(usize::from(self.last)) {
            *place = Point {
                middle: [middle as u32, (middle >> 32) as u32],
                angle,
                weight: 1.0 / variance,
            };
        }
    }

    fn known(&self) -> &[Point] {
        let length = usize::from(self.length);
        self.points.get(..length).unwrap_or(&self.points)
    }

    /// Takes the share of a turning pattern out of a window's frequency, with what the angles of the windows before promise.
    #[inline]
    pub(crate) fn take_turning_out(&mut self, wave: &mut Standing, model: &Model) {
        let record = &mut wave.record;
        let rate = self.rate(record, model.per_half);
        let (apart, spread) = if rate.variance > 0.0 {
            record.promise(rate.value, rate.variance)
        } else if self.is_empty() {
            (record.turning, record.turning_variance)
        } else {
            // All of them overlap this window: nothing is known of its rate, and least of all that it stands still.
            return;
        };
        if apart * apart < 16.0 * spread {
            let (squared, per_half) = (model.half * model.half, model.per_half);
            let per_spread = 1.0 / (squared * spread);
            record.drift -= wave.drift_turning * per_spread * apart;
            // The variance less shared²/spread, without a difference: near a circle nothing would be left of it.
            record.drift_variance = (wave.turn_determinant * per_half * per_half
                + record.drift_variance * rate.variance * squared)
                * per_spread;
        }
    }

    /// The rate at the middle of a window, from its own angle and the angles before: constant through three points, linear in time
    /// through more. With none before, the pattern is taken to stand still until a window shows that it does not.
    ///
    /// `per_half` is one over half the window's samples.
    #[inline(always)]
    fn rate(&mut self, record: &Record, per_half: f32) -> Rate {
        // Sums of weight·timeⁿ and of weight·timeⁿ·angle; the window itself is at time and angle 0, and its weight is one.
        let own = record.angle_variance;
        let mut powers = [1.0, 0.0, 0.0, 0.0, 0.0];
        let mut values = [0.0; 3];
        let (mut used, mut nearest) = (1, -OLDEST);
        for point in self.known() {
            // Not overlapping, and so near that 32 bits hold it.
            let passed = record.middle.wrapping_sub(point.middle());
            let Ok(passed) = u32::try_from(passed) else {
                continue;
            };
            if passed / 2 < record.samples.get() {
                continue;
            }
            let time = -(passed as f32) * per_half;
            if time < -OLDEST {
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
        // The curve is taken out of level and rate where there are points for it, then the level out of the rate.
        let bent = if used > 3 { 1.0 / s4 } else { 0.0 };
        // First over s4: a product of two sums may be beyond f32, where noise was far less long ago.
        let (of_level, of_rate) = (s2 * bent, s3 * bent);
        let (level, mixed, rate) = (s0 - s2 * of_level, s1 - s2 * of_rate, s2 - s3 * of_rate);
        let (level_value, rate_value) = (v0 - of_level * v2, v1 - of_rate * v2);
        // Of a rate a quarter window: a rate a sample is so much less.
        let per_sample = 2.0 * per_half;
        let per_determinant = 1.0 / (level * rate - mixed * mixed);
        let mut variance = level * own * per_determinant;
        // Of a pattern that vibrates a curve through the angles is off by this, where those of the windows before were beside theirs by one.
        let of_others = 1.0 - rate * per_determinant;
        let (off, share) = if used >= ENOUGH && of_others > LEAST {
            // The angle of the curve at the window, in which the others have this share: what is left is its distance from the others' curve.
            let at_window = (rate * level_value - mixed * rate_value) * per_determinant;
            // The square of that over what is expected of it.
            let most = MOST * (1.0 + greater(self.beside, 0.0));
            let square = lesser(at_window * at_window / (own * of_others), most);
            self.learned = self.beside + (square - 1.0 - self.beside) * (1.0 / AVERAGED);
            (OF_CUBIC * OF_CUBIC, of_others)
        } else {
            self.learned = self.beside;
            (OF_LINE, 1.0)
        };
        let bias = self.learned - BY_CHANCE;
        if bias > 0.0 {
            variance += off * own * bias / (share * nearest * nearest);
        }
        Rate {
            value: (level * rate_value - mixed * level_value) * per_determinant * per_sample,
            variance: variance * per_sample * per_sample,
        }
    }
}
