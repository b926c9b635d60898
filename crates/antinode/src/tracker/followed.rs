//! Follows the pattern angle while no window is clean.

use core::f32::consts::FRAC_PI_8;

use super::angle::Angle;
use super::record::Record;

/// The angle followed through windows that are not clean but show the wave: over many of them a pattern may turn at another rate than the
/// last clean one predicts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    angle: Angle,
    /// Time of `angle`, half samples, in its lowest 32 bits: nothing is followed for hours.
    middle: u32,
}

impl Followed {
    /// From the angle before a first window: until a pattern has an angle, no rate is predicted, and any time will do.
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

    /// Goes on to the window of `record`, unless its angle is far from the expected one, as it may be by a fault.
    pub(super) fn follow(&mut self, record: &Record, rate: f32) {
        let expected = self.at(record.middle, rate);
        let (angle, _) = expected.nearest(record.angle.rest);
        if angle.less(expected).abs() < FRAC_PI_8 {
            self.angle = angle;
            self.middle = record.middle as u32;
        }
    }
}
