//! Where the pattern went while no window was clean.

use core::f32::consts::FRAC_PI_8;

use super::angle::Angle;
use super::record::Record;

/// The angle followed from window to window through those that are no clean ones, but show the wave: over many of them a pattern may turn
/// otherwise than the last clean one promised.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    angle: Angle,
    /// Where it was, half samples: what is left of it in 32 bits, for nothing is followed for hours.
    middle: u32,
}

impl Followed {
    /// From the angle that a first window is nearest to: until a pattern has one, it is promised no rate, and any time will do.
    pub(super) const fn begin(angle: Angle) -> Self {
        Self { angle, middle: 0 }
    }

    /// From a window whose angle is certain.
    pub(super) fn from(record: &Record) -> Self {
        Self {
            angle: record.angle,
            middle: record.middle as u32,
        }
    }

    /// The angle at `middle` half samples, turning at `rate` a sample.
    pub(super) fn at(&self, middle: u64, rate: f32) -> Angle {
        let passed = 0.5 * (middle as u32).wrapping_sub(self.middle) as f32;
        self.angle.plus(rate * passed)
    }

    /// Goes on to the window of `record`, unless its angle is far from where this goes: a fault may have made that.
    pub(super) fn follow(&mut self, record: &Record, rate: f32) {
        let expected = self.at(record.middle, rate);
        let (angle, _) = expected.nearest(record.angle.rest);
        if angle.less(expected).abs() < FRAC_PI_8 {
            self.angle = angle;
            self.middle = record.middle as u32;
        }
    }
}
