//! Phase as a wrapping integer, and the core's only sine, cosine and arc tangent.

use core::f32::consts::{FRAC_PI_4, TAU};

use num_complex::Complex32;

use crate::double::units;
use crate::scalar::{greater, nearest};

/// One turn, in units of [`Phase`].
const TURN: f32 = 4_294_967_296.0;

/// A phase in units of 2⁻³² turn. It wraps at one turn, as a phase does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Phase(pub u32);

/// A frequency as an advance of phase a sample, in units of 2⁻³² turn a sample.
///
/// Valid below half a turn a sample; at 100 kS/s the unit is 23 µHz.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PhaseStep(pub u32);

impl Phase {
    /// The phase of an angle in radians. Valid within ±10⁴; f32 rounding grows with the angle.
    pub fn from_radians(radians: f32) -> Self {
        Self::from_turns(radians * (1.0 / TAU))
    }

    /// The phase of some turns.
    pub(crate) fn from_turns(turns: f32) -> Self {
        // Whole turns are taken off first: the rest fits an i32 in units of 2⁻³¹ turn, which are then doubled.
        let rest = turns - turns as i32 as f32;
        Self(((rest * (0.5 * TURN)) as i32 as u32) << 1)
    }

    /// `exp(jφ)`: cosine and sine of this phase, each within 1.2·10⁻⁷ of the truth.
    #[inline(never)]
    pub fn unit(self) -> Complex32 {
        // The nearest quarter turn is taken off, so that the polynomials see |x| ≤ π/4.
        let quarter = self.0.wrapping_add(1 << 29) >> 30;
        let rest = self.0.wrapping_sub(quarter << 30) as i32;
        let x = rest as f32 * (TAU / TURN);
        let x2 = x * x;
        // Taylor to x⁹ and x⁸: the first terms left out are below 1.8·10⁻⁹ and 2.5·10⁻⁸ at π/4.
        let sine = x + x
            * x2
            * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0))));
        let cosine =
            1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40_320.0))));
        match quarter & 3 {
            0 => Complex32::new(cosine, sine),
            1 => Complex32::new(-sine, cosine),
            2 => Complex32::new(-cosine, -sine),
            _ => Complex32::new(sine, -cosine),
        }
    }

    /// Cosine and sine times `scale` (at most 32 767), rounded to whole numbers, in integers alone: within 0.52 of the truth.
    pub(crate) fn scaled_unit(self, scale: u16) -> [i16; 2] {
        const ONE: i32 = 1 << 30;
        let times = |a: i32, b: i32| ((i64::from(a) * i64::from(b)) >> 30) as i32;
        let quarter = self.0.wrapping_add(1 << 29) >> 30;
        let rest = self.0.wrapping_sub(quarter << 30) as i32;
        // π/2 in units of 2⁻³⁰; 2⁻³² turn is π/2 of 2⁻³⁰.
        let x = times(rest, 1_686_629_713);
        let x2 = times(x, x);
        // Horner with the factor 1/n as a product: 1/42, 1/20, 1/6 and 1/56, 1/30, 1/12, 1/2.
        let series = |factors: &[i32]| {
            factors
                .iter()
                .fold(ONE, |sum, &factor| ONE - times(times(x2, factor), sum))
        };
        let sine = times(x, series(&[ONE / 42, ONE / 20, ONE / 6]));
        let cosine = series(&[ONE / 56, ONE / 30, ONE / 12, ONE / 2]);
        let [cosine, sine] = [cosine, sine]
            .map(|value| ((i64::from(value) * i64::from(scale) + i64::from(ONE / 2)) >> 30) as i16);
        match quarter & 3 {
            0 => [cosine, sine],
            1 => [sine.wrapping_neg(), cosine],
            2 => [cosine.wrapping_neg(), sine.wrapping_neg()],
            _ => [sine, cosine.wrapping_neg()],
        }
    }
}

impl PhaseStep {
    /// The step of a tone of `period` samples. Valid for `period` > 2.
    pub fn from_period(period: f32) -> Self {
        // f32 holds 24 bits of the step; the tracker finds the rest.
        Self((TURN / period) as u32)
    }

    /// Samples in one period.
    pub fn period(self) -> f32 {
        TURN / self.0 as f32
    }

    /// Radians a sample.
    pub fn radians(self) -> f32 {
        self.0 as f32 * (TAU / TURN)
    }

    /// The frequency in Hz plus `offset` radians a sample, at full resolution; `unit` is sample rate · 2⁻⁶⁴, in Hz.
    ///
    /// An offset beyond ±3, as found where there is no wave, gives a number that means nothing.
    pub(crate) fn hertz(self, offset: f32, unit: f64) -> f64 {
        // The offset as whole units of 2⁻²⁹ rad, each of which is 2³⁵/2π times 2⁻⁶⁴ turn, and a rest: no digit of it is lost.
        let scaled = offset * 536_870_912.0;
        let whole = scaled as i32;
        let rest = ((scaled - whole as f32) * (2.0 * TURN / TAU)) as i32;
        let offset = i64::from(whole)
            .wrapping_mul(5_468_522_205)
            .wrapping_add(i64::from(rest) << 2);
        units((i64::from(self.0) << 32).wrapping_add(offset), unit)
    }

    /// This step moved by `offset` radians a sample, to within half a unit and f32 rounding of the offset.
    #[must_use = "it gives another, and changes none"]
    pub fn shifted(self, offset: f32) -> Self {
        let steps = nearest(offset * (TURN / TAU));
        Self(self.0.wrapping_add(steps as u32))
    }

    /// The phase after `half_samples` halves of a sample (negative: before), counted from phase zero.
    pub fn after_half_samples(self, half_samples: i64) -> Phase {
        // Exact to half a unit: the product is kept whole before it is halved and wrapped.
        Phase((i64::from(self.0).wrapping_mul(half_samples) >> 1) as u32)
    }
}

/// The argument of a number, −π to π, within 1.8·10⁻⁷ of the truth; 0 of zero.
#[inline(never)]
pub(crate) fn argument(z: Complex32) -> f32 {
    /// tan π/8.
    const NARROW: f32 = 0.414_213_57;
    /// π/4 cut short, so that three times it is exact in f32, and what was cut off.
    const EIGHTH: f32 = FRAC_PI_4 - 3.0 / 16_777_216.0;
    const EIGHTH_REST: f32 = 1.569_582_4e-7;
    let (x, y) = (z.re.abs(), z.im.abs());
    // Measured from the nearest multiple of π/4, so that the polynomial sees |t| ≤ tan π/8.
    let (eighths, t) = if y <= NARROW * x {
        (0.0, y / greater(x, f32::MIN_POSITIVE))
    } else if x <= NARROW * y {
        (2.0, -x / y)
    } else {
        (1.0, (y - x) / (y + x))
    };
    let t2 = t * t;
    // Minimax, with a relative error below 2·10⁻⁸.
    let series = -0.333_329_56 + t2 * (0.199_779_14 + t2 * (-0.138_797_1 + t2 * 0.080_598_23));
    let rest = t + t * t2 * series;
    let (eighths, rest) = if z.re < 0.0 {
        (4.0 - eighths, -rest)
    } else {
        (eighths, rest)
    };
    let angle = eighths * EIGHTH + (eighths * EIGHTH_REST + rest);
    if z.im < 0.0 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_is_within_its_stated_error() {
        let mut worst = 0f64;
        for i in 0..200_000u32 {
            let phase = Phase(i.wrapping_mul(2_654_435_761));
            let x = f64::from(phase.0) / 4_294_967_296.0 * core::f64::consts::TAU;
            let unit = phase.unit();
            worst = worst
                .max((f64::from(unit.re) - libm::cos(x)).abs())
                .max((f64::from(unit.im) - libm::sin(x)).abs());
        }
        assert!(worst < 1.2e-7, "{worst:e}");
    }

    #[test]
    fn arguments_are_within_their_stated_error() {
        let mut worst = 0f64;
        for i in 0..400_000u32 {
            let phase = Phase(i.wrapping_mul(2_654_435_761));
            for size in [1e-15, 0.7, 1e17] {
                let z = phase.unit() * size;
                let truth = libm::atan2(f64::from(z.im), f64::from(z.re));
                worst = worst.max((f64::from(argument(z)) - truth).abs());
            }
        }
        assert!(worst < 1.8e-7, "{worst:e}");
        assert_eq!(argument(Complex32::ZERO), 0.0);
    }

    #[test]
    fn scaled_units_are_within_their_stated_error() {
        for scale in [1u16, 327, 3449, 32_767] {
            let mut worst = 0f64;
            for i in 0..200_000u32 {
                let phase = Phase(i.wrapping_mul(2_654_435_761));
                let x = f64::from(phase.0) / 4_294_967_296.0 * core::f64::consts::TAU;
                let [cosine, sine] = phase.scaled_unit(scale).map(f64::from);
                let scale = f64::from(scale);
                worst = worst
                    .max((cosine - scale * libm::cos(x)).abs())
                    .max((sine - scale * libm::sin(x)).abs());
            }
            assert!(worst < 0.52, "{worst} at a scale of {scale}");
        }
    }

    #[test]
    fn a_shift_moves_the_frequency_and_hertz_keeps_its_digits() {
        let step = PhaseStep::from_period(18.75);
        let unit = 1e5 / 18_446_744_073_709_551_616.0;
        for offset in [1e-3f32, -2.5e-4, 3e-9, -0.01] {
            let moved = step.shifted(offset).hertz(0.0, unit) - step.hertz(0.0, unit);
            let wanted = f64::from(offset) / core::f64::consts::TAU * 1e5;
            assert!(
                (moved - wanted).abs() < 1.3e-5 + 1e-7 * wanted.abs(),
                "{moved} {wanted}"
            );
            let added = step.hertz(offset, unit) - step.hertz(0.0, unit);
            assert!(
                (added - wanted).abs() < 1e-11 + 1e-9 * wanted.abs(),
                "{added} {wanted}"
            );
        }
    }

    #[test]
    fn no_offset_is_too_large_to_be_added() {
        for offset in [3.1f32, -3.9, 1e9, f32::MAX, f32::INFINITY, f32::NAN] {
            for offset in [offset, -offset] {
                assert!(PhaseStep(u32::MAX).hertz(offset, 1e-15).is_finite());
            }
        }
    }

    #[test]
    fn half_samples_wrap_exactly() {
        let step = PhaseStep(0x4000_0001);
        assert_eq!(step.after_half_samples(2), Phase(0x4000_0001));
        assert_eq!(
            step.after_half_samples(-2),
            Phase(0x4000_0001u32.wrapping_neg())
        );
        assert_eq!(step.after_half_samples(8), Phase(4));
    }
}
