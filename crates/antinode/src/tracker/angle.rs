//! The pattern angle, continued over its ambiguity of π/2, and phases within one turn.

use core::f32::consts::{FRAC_2_PI, FRAC_PI_2, PI, TAU};

use crate::double::units;
use crate::scalar::{lesser, nearest};

/// Takes whole turns off an angle in radians: (−π, π].
pub(crate) fn wrap(angle: f32) -> f32 {
    let rest = angle - nearest(angle * (1.0 / TAU)) as f32 * TAU;
    if rest <= -PI {
        return rest + TAU;
    }
    // Rounding may take half a turn for a little less.
    lesser(PI, rest)
}

/// A pattern angle continued over the ambiguity of π/2: its whole quarter turns are kept apart from the rest, so that it never loses
/// digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Angle {
    pub quarters: i32,
    /// In rad, about −π/4…π/4; ±π/2 before it is continued.
    pub rest: f32,
}

impl Angle {
    pub(crate) const ZERO: Self = Self {
        quarters: 0,
        rest: 0.0,
    };

    #[inline]
    pub(crate) fn new(radians: f32) -> Self {
        let quarters = nearest(radians * FRAC_2_PI);
        Self {
            quarters,
            rest: radians - quarters as f32 * FRAC_PI_2,
        }
    }

    /// The value nearest to this one that equals `angle` modulo π/2, and the quarter turns by which it differs from `angle`.
    pub(crate) fn nearest(self, angle: f32) -> (Self, i32) {
        let quarters = nearest((self.rest - angle) * FRAC_2_PI);
        let rest = angle + quarters as f32 * FRAC_PI_2;
        let moved = Angle::new(rest);
        (
            Self {
                quarters: self.quarters.wrapping_add(moved.quarters),
                rest: moved.rest,
            },
            self.quarters.wrapping_add(quarters),
        )
    }

    /// This angle less `other`, rad.
    pub(crate) fn less(self, other: Self) -> f32 {
        self.quarters.wrapping_sub(other.quarters) as f32 * FRAC_PI_2 + (self.rest - other.rest)
    }

    /// This angle moved by a small one, rad.
    pub(crate) fn plus(self, radians: f32) -> Self {
        let moved = Angle::new(self.rest + radians);
        Self {
            quarters: self.quarters.wrapping_add(moved.quarters),
            rest: moved.rest,
        }
    }

    /// The angle in radians; beyond 2³¹ quarter turns their count goes on at −2³¹.
    pub(crate) fn radians(self) -> f64 {
        // In units of 2⁻³² quarter turn.
        let rest = (self.rest * 2_147_483_648.0) as i32;
        let rest = (i64::from(rest) * 2_734_261_102) >> 31;
        let unit = core::f64::consts::FRAC_PI_2 / 4_294_967_296.0;
        units((i64::from(self.quarters) << 32).wrapping_add(rest), unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_turn_is_positive() {
        assert_eq!([wrap(PI), wrap(-PI)], [PI; 2]);
    }

    #[test]
    fn near_half_a_turn_no_rounding_leaves_the_range() {
        for half_turns in [1.0f32, 3.0, 5.0, 7.0] {
            let bits = (half_turns * PI).to_bits();
            for bits in bits - 100..bits + 100 {
                for angle in [f32::from_bits(bits), -f32::from_bits(bits)] {
                    let wrapped = wrap(angle);
                    assert!(wrapped > -PI && wrapped <= PI, "{angle}: {wrapped}");
                }
            }
        }
    }

    #[test]
    fn beyond_the_greatest_count_of_quarter_turns_an_angle_goes_on() {
        let all = 2_147_483_648.0 * core::f64::consts::FRAC_PI_2;
        let last = Angle {
            quarters: i32::MAX,
            rest: 0.7,
        };
        let next = last.plus(0.5);
        assert_eq!(next.quarters, i32::MIN);
        assert!(next.rest < 0.0 && (next.less(last) - 0.5).abs() < 1e-6);
        // With the least count and a rest below zero the value is below the range, and wraps to its upper end.
        let quarter = core::f64::consts::FRAC_PI_2;
        for (angle, radians) in [(last, all - quarter + 0.7), (next, all - quarter + 1.2)] {
            assert!((angle.radians() - radians).abs() < 1e-5, "{angle:?}");
        }
        let after = next.plus(0.5);
        assert!(
            (after.radians() + all + quarter - 1.7).abs() < 1e-5,
            "{after:?}"
        );
    }
}
