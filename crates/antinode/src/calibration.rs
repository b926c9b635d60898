//! The effect of the electronics on the wave, and its inverse, applied to a window's phasors: nothing is done at sample rate.

use num_complex::Complex32;

use crate::phase::Phase;

/// How the D pick-off differs from an ideal one that stands 45° from C, has C's gain and is sampled with C.
///
/// The raw signal is S_D(t) = g·[D cos 2ε − C sin 2ε](t + Δ), C and D being what ideal pick-offs would see, formulas (2) and (3).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Calibration {
    /// g, gain of channel D over that of channel C. 0.1 to 10; 1 is ideal.
    pub gain_ratio: f32,
    /// Δ in seconds: how much later than C channel D is sampled. Within ±1 ms; 0 is ideal. If it is more than a tenth of a window, the
    /// uncertainty of the frequency adds to those of a_B and the angle, and the stated deviations do not include it.
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
        let lag = Phase::from_turns(turns).unit();
        let turned = Phase::from_radians(2.0 * self.pick_off_angle).unit();
        let per_cosine = 1.0 / turned.re;
        let noise_gains = [per_cosine / self.gain_ratio, turned.im * per_cosine];
        Correction {
            delay: self.skew * sample_rate,
            // An ideal D sees −j z₊ + j z₋ where C sees z₊ + z₋: z₊ = z_C + j z_D and z₋ = z_C − j z_D.
            of_waves: [-1.0, 1.0]
                .map(|d| lag * Complex32::new(-turned.im, d * turned.re) * self.gain_ratio),
            lead: lag.conj() * (noise_gains[0] / lag.norm_sqr()),
            noise_gains,
        }
    }
}

impl Default for Calibration {
    fn default() -> Self {
        Self::IDEAL
    }
}

/// A [`Calibration`] made ready for one frequency: D_raw = g·lag·(cosine·D − sine·C).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Correction {
    /// Skew in samples, during which the wave's slow course goes on.
    pub delay: f32,
    /// What raw pick-off D sees of each travelling wave of which C sees one.
    pub of_waves: [Complex32; 2],
    /// 1/(g·lag·cosine).
    lead: Complex32,
    /// Effect of the correction on noise: the gain of channel D's, and the share of C's that it adds to that.
    pub noise_gains: [f32; 2],
}

impl Correction {
    /// The phasor of an ideal pick-off D from the raw ones; that of C stays as it is.
    #[inline]
    pub(crate) fn correct(&self, c: Complex32, d: Complex32) -> Complex32 {
        d * self.lead + c * self.noise_gains[1]
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
        let (c, d) = (Complex32::new(0.3, -1.2), Complex32::new(-0.7, 0.4));
        let turned = Complex32::I * d;
        let [plus, minus] = correction.of_waves;
        let raw = (plus * (c + turned) + minus * (c - turned)) * 0.5;
        assert!((raw - d).norm_sqr() > 1e-3);
        assert!((correction.correct(c, raw) - d).norm_sqr() < 1e-12);
    }

    #[test]
    fn an_ideal_pick_off_is_left_as_it_is() {
        let correction = Calibration::IDEAL.at(0.05332, 1e5);
        let (c, d) = (Complex32::new(0.3, -1.2), Complex32::new(-0.7, 0.4));
        assert_eq!(correction.correct(c, d), d);
        assert_eq!(correction.of_waves, [-Complex32::I, Complex32::I]);
        assert_eq!(correction.noise_gains, [1.0, 0.0]);
    }
}
