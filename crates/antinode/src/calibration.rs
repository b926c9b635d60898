//! What the electronics do to the wave, and its inverse, applied to a window's phasors: it costs nothing at sample rate.

use num_complex::Complex32;

use crate::arch::square_root;
use crate::phase::Phase;

/// How the D pick-off differs from an ideal one that stands 45° from C, has C's gain and is sampled with C.
///
/// The raw signal is S_D(t) = g·[D cos 2ε − C sin 2ε](t + Δ), with D and C of formula (3).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Calibration {
    /// g, gain of channel D over that of channel C. 0.1 to 10; 1 is ideal.
    pub gain_ratio: f32,
    /// Δ in seconds: how much later than C channel D is sampled. Within ±1 ms; 0 is ideal. Beyond a tenth of a window what the
    /// uncertain frequency makes of it is not in the stated deviations.
    pub skew: f32,
    /// ε in radians: pick-off D stands at 45° + ε from pick-off C. Within ±0.3; 0 is ideal.
    pub pick_off_angle: f32,
}

impl Calibration {
    /// Ideal pick-offs.
    pub const IDEAL: Self = Self {
        gain_ratio: 1.0,
        skew: 0.0,
        pick_off_angle: 0.0,
    };

    /// The correction for a wave of `cycles_per_sample`, at a sample rate in Hz.
    pub(crate) fn at(&self, cycles_per_sample: f32, sample_rate: f32) -> Correction {
        let turns = cycles_per_sample * sample_rate * self.skew;
        let lag = Phase::from_turns(turns).unit() * self.gain_ratio;
        let turned = Phase::from_radians(2.0 * self.pick_off_angle).unit();
        let ideal = *self == Self::IDEAL;
        Correction {
            delay: self.skew * sample_rate,
            lag,
            cosine: turned.re,
            sine: turned.im,
            ideal,
        }
    }
}

impl Default for Calibration {
    fn default() -> Self {
        Self::IDEAL
    }
}

/// A [`Calibration`] made ready for one frequency: D_raw = lag·(cosine·D − sine·C).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Correction {
    /// Skew in samples: the slow course of the wave goes on during it.
    pub delay: f32,
    lag: Complex32,
    cosine: f32,
    sine: f32,
    ideal: bool,
}

impl Correction {
    /// Phasors of ideal pick-offs from raw ones.
    pub(crate) fn correct(&self, raw: [Complex32; 2]) -> [Complex32; 2] {
        if self.ideal {
            return raw;
        }
        let [c, d] = raw;
        let d = d * self.lag.conj() / self.lag.norm_sqr();
        [c, (d + c * self.sine) / self.cosine]
    }

    /// Raw phasors from those of ideal pick-offs.
    #[inline]
    pub(crate) fn distort(&self, ideal: [Complex32; 2]) -> [Complex32; 2] {
        if self.ideal {
            return ideal;
        }
        let [c, d] = ideal;
        [c, self.lag * (d * self.cosine - c * self.sine)]
    }

    /// What correcting makes of noise: by how much it amplifies that of channel D, and the share of C's that it adds there.
    pub(crate) fn noise_gains(&self) -> [f32; 2] {
        if self.ideal {
            return [1.0, 0.0];
        }
        let per_cosine = 1.0 / self.cosine;
        [
            per_cosine / square_root(self.lag.norm_sqr()),
            self.sine * per_cosine,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correcting_undoes_distorting() {
        let calibration = Calibration {
            gain_ratio: 1.1,
            skew: -1e-6,
            pick_off_angle: 0.02,
        };
        let correction = calibration.at(0.05332, 1e5);
        let wave = [Complex32::new(0.3, -1.2), Complex32::new(-0.7, 0.4)];
        let raw = correction.distort(wave);
        assert!((raw[1] - wave[1]).norm_sqr() > 1e-3);
        for (back, wave) in correction.correct(raw).iter().zip(wave) {
            assert!((back - wave).norm_sqr() < 1e-12);
        }
    }
}
