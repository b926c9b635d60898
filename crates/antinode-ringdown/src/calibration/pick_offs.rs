//! Pick-offs that differ, and what they make of a wave.

use num_complex::Complex;

/// How pick-off D differs from an ideal one, as in the core's `Calibration`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PickOffs {
    /// Its gain over that of pick-off C, above 0.
    pub gain_ratio: f64,
    /// Time by which it is sampled later than C, s.
    pub skew: f64,
    /// Its angle from C less 45°, rad.
    pub angle: f64,
}

impl PickOffs {
    /// Ideal pick-offs, which need no calibration.
    pub const IDEAL: Self = Self {
        gain_ratio: 1.0,
        skew: 0.0,
        angle: 0.0,
    };

    /// Whether gain ratio, skew and angle differ from ideal ones by no more than these tolerances.
    pub fn are_ideal_to(&self, tolerances: [f64; 3]) -> bool {
        let flaws = [self.gain_ratio - 1.0, self.skew, self.angle];
        flaws
            .iter()
            .zip(tolerances)
            .all(|(flaw, tolerance)| flaw.abs() <= tolerance)
    }

    /// These pick-offs at 2πf, rad/s.
    pub(crate) fn at(&self, omega: f64) -> PickOffsAt {
        let (sine, cosine) = (2.0 * self.angle).sin_cos();
        PickOffsAt {
            lag: Complex::from_polar(self.gain_ratio, omega * self.skew),
            sine,
            cosine,
        }
    }

    /// Factors of the noise of pick-off D, and of C, in an ideal D.
    pub(crate) fn noise_gains(&self) -> [f64; 2] {
        let (sine, cosine) = (2.0 * self.angle).sin_cos();
        [1.0 / (self.gain_ratio * cosine), sine / cosine]
    }
}

/// Pick-offs at one frequency.
#[derive(Clone, Copy)]
pub struct PickOffsAt {
    lag: Complex<f64>,
    sine: f64,
    cosine: f64,
}

impl PickOffsAt {
    /// Converts phasors of ideal pick-offs to those that these show.
    pub fn distort(&self, [c, d]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
        [c, self.lag * (d * self.cosine - c * self.sine)]
    }

    /// Converts phasors that these pick-offs show to those of ideal ones.
    pub fn correct(&self, [c, d]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
        [c, (d / self.lag + c * self.sine) / self.cosine]
    }
}
