//! The description of the electronics' flaws.

use crate::error::{Error, finite, positive, require};
use crate::timed::{ClipSpan, Dropout, Loss};
use serde::{Deserialize, Serialize};

/// Flaws of everything between the resonator and the record; none by default.
///
/// They act in this order, each on the result of the one before:
///
/// 1. the sampling instants move (`jitter`, both channels alike);
/// 2. the pick-offs see the wave there (`skew`, `pick_off_angle`);
/// 3. they bend it (`cubic`);
/// 4. gain, offset and hum (`gain_ratio`, `offset_c`, `offset_d`, `hum`);
/// 5. noise is added (`noise`, `coloured_noise`);
/// 6. a channel drops out (`dropouts`);
/// 7. the signal is clipped (`clip`, `clip_spans`);
/// 8. the ADC quantises, and saturates (`bits`, `full_scale`);
/// 9. samples are lost (`lost`).
///
/// The formulas below give, to first order in the flaw, the values that an exact identification of (1)-(3) then finds; theta is the true
/// angle, E = a_A^2 + a_B^2, D = a_A^2 - a_B^2 and Q = 2 a_A a_B.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Flaws {
    /// Rms of the noise of (2): white, Gaussian, independent in the two channels. Input units, 0 or more.
    pub noise: f64,
    /// Rms of additional noise behind a first-order low-pass: white below `coloured_corner`, 1/f^2 in power above it. Gaussian, independent
    /// in the two channels, of the same rms from the first sample on. Input units, 0 or more.
    pub coloured_noise: f64,
    /// Corner of that low-pass, Hz, above 0: some Hz for a wandering offset, some kHz for a front end.
    pub coloured_corner: f64,
    /// Offset of channel C, input units.
    pub offset_c: f64,
    /// Offset of channel D, input units.
    pub offset_d: f64,
    /// Amplitude of the mains hum on both channels, a sine from t = 0 on, input units, signed.
    pub hum: f64,
    /// Frequency of the hum, Hz.
    pub hum_frequency: f64,
    /// Gain of channel D over that of channel C, above 0; 1 = equal. C's gain is 1.
    ///
    /// For 1 + g: a_A + g a_A (1 - cos 4 theta) / 2, theta + g (E/D) sin 4 theta / 4.
    pub gain_ratio: f64,
    /// Delay of channel D's sampling after channel C's, s, signed.
    ///
    /// For psi = omega `skew`: a_B - psi a_A sin 4 theta / 2, theta + psi (Q/D) cos 4 theta / 4.
    pub skew: f64,
    /// Pick-off D stands at 45 degrees + this angle on the resonator's rim, rad, in the sense of theta.
    ///
    /// An angle on the rim counts twice in the pattern, so with eps for this angle channel D gets
    /// D cos 2 eps - C sin 2 eps in place of D of (3), which is A sin(2 theta - 2 eps) + B cos(2 theta - 2 eps).
    /// To first order: a_A - eps a_A sin 4 theta, theta - (eps / 2) (1 + (E/D) cos 4 theta).
    pub pick_off_angle: f64,
    /// Cubic distortion c of both pick-offs: S becomes S + c S^3 / a^2, a being the wave's main amplitude at t = 0. No unit.
    pub cubic: f64,
    /// Both channels are limited to plus or minus this, input units, above 0; `None` = unlimited.
    ///
    /// For one channel alone with amplitude a above the limit c, r = c/a: the amplitude of its fundamental changes by the factor
    /// (2/pi) (asin r + r sqrt(1 - r^2)).
    pub clip: Option<f64>,
    /// Clipping during spans of time, which must not overlap; the lower of their level and `clip` applies.
    pub clip_spans: Vec<ClipSpan>,
    /// Resolution of the ADC, 2 to 32 bits: codes from -2^(bits-1) to 2^(bits-1) - 1. `None` = no ADC.
    pub bits: Option<u32>,
    /// Full scale of the ADC, input units, above 0 if `bits` is set (unused otherwise): one code is
    /// `full_scale` / 2^(bits-1), see [`Flaws::lsb`].
    pub full_scale: f64,
    /// Rms of the white Gaussian jitter of the sampling instants, common to both channels, s, 0 or more.
    pub jitter: f64,
    /// Samples that never reach the record, in both channels. Losses may overlap.
    pub lost: Vec<Loss>,
    /// Spans of time without a signal. Those of one channel must not overlap.
    pub dropouts: Vec<Dropout>,
}

impl Default for Flaws {
    /// No flaws; 50 Hz for a hum, and 1 kHz for coloured noise.
    fn default() -> Self {
        Flaws {
            noise: 0.0,
            coloured_noise: 0.0,
            coloured_corner: 1000.0,
            offset_c: 0.0,
            offset_d: 0.0,
            hum: 0.0,
            hum_frequency: 50.0,
            gain_ratio: 1.0,
            skew: 0.0,
            pick_off_angle: 0.0,
            cubic: 0.0,
            clip: None,
            clip_spans: Vec::new(),
            bits: None,
            full_scale: 0.0,
            jitter: 0.0,
            lost: Vec::new(),
            dropouts: Vec::new(),
        }
    }
}

impl Flaws {
    /// White noise of this rms on both channels, input units, 0 or more, and nothing else.
    pub fn white(noise: f64) -> Self {
        Self {
            noise,
            ..Self::default()
        }
    }

    /// The value of one ADC code, input units: `full_scale` / 2^(`bits` - 1). `None` without an ADC.
    pub fn lsb(&self) -> Option<f64> {
        self.bits
            .map(|bits| self.full_scale / libm::exp2(f64::from(bits) - 1.0))
    }

    /// Checks the ranges of single numbers; lists are checked when they are sorted.
    pub(crate) fn check(&self) -> Result<(), Error> {
        for (what, value) in [
            ("offset_c", self.offset_c),
            ("offset_d", self.offset_d),
            ("hum", self.hum),
            ("hum_frequency", self.hum_frequency),
            ("skew", self.skew),
            ("pick_off_angle", self.pick_off_angle),
            ("cubic", self.cubic),
        ] {
            finite(what, value)?;
        }
        for (what, value) in [
            ("noise", self.noise),
            ("coloured_noise", self.coloured_noise),
            ("jitter", self.jitter),
        ] {
            require(
                what,
                value,
                value >= 0.0 && value.is_finite(),
                "finite and 0 or more",
            )?;
        }
        positive("coloured_corner", self.coloured_corner)?;
        positive("gain_ratio", self.gain_ratio)?;
        if let Some(clip) = self.clip {
            positive("clip", clip)?;
        }
        for span in &self.clip_spans {
            positive("level of clip_spans", span.level)?;
        }
        if let Some(bits) = self.bits {
            require("bits", f64::from(bits), (2..=32).contains(&bits), "2 to 32")?;
            positive("full_scale", self.full_scale)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_has_its_range() {
        assert_eq!(Flaws::default().check(), Ok(()));
        let wrong: [(fn(&mut Flaws), _); 17] = [
            (|f| f.noise = -1e-9, "noise"),
            (|f| f.coloured_noise = -1e-9, "coloured_noise"),
            (|f| f.coloured_corner = 0.0, "coloured_corner"),
            (|f| f.jitter = f64::NAN, "jitter"),
            (|f| f.offset_c = f64::INFINITY, "offset_c"),
            (|f| f.offset_d = f64::NAN, "offset_d"),
            (|f| f.hum = f64::NAN, "hum"),
            (|f| f.hum_frequency = f64::INFINITY, "hum_frequency"),
            (|f| f.skew = f64::NAN, "skew"),
            (|f| f.pick_off_angle = f64::NAN, "pick_off_angle"),
            (|f| f.cubic = f64::NAN, "cubic"),
            (|f| f.gain_ratio = 0.0, "gain_ratio"),
            (|f| f.clip = Some(0.0), "clip"),
            (
                |f| {
                    f.clip_spans = vec![ClipSpan {
                        from: 0.0,
                        to: 1.0,
                        level: -1.0,
                    }];
                },
                "level of clip_spans",
            ),
            (|f| f.bits = Some(16), "full_scale"),
            (|f| (f.bits, f.full_scale) = (Some(33), 1.0), "bits"),
            (|f| (f.bits, f.full_scale) = (Some(1), 1.0), "bits"),
        ];
        for (set, field) in wrong {
            let mut flaws = Flaws::default();
            set(&mut flaws);
            match flaws.check() {
                Err(Error::OutOfRange { what, .. }) => assert_eq!(what, field),
                other => panic!("{field}: {other:?}"),
            }
        }
    }

    #[test]
    fn one_code_is_full_scale_over_half_the_codes() {
        assert_eq!(
            Flaws {
                bits: Some(16),
                full_scale: 2.0,
                ..Flaws::default()
            }
            .lsb(),
            Some(2.0 / 32768.0)
        );
        assert_eq!(Flaws::default().lsb(), None);
    }
}
