//! The true wave and its motion.

use crate::error::{Error, finite, positive, require};
use crate::split::SplitWave;
use crate::time::Instant;
use libm::{exp, sincos};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_6, PI, TAU};

/// The true wave; all values are those at t = 0, the time of the first sample.
///
/// With splits it moves as both modes do, to the second order in rates over omega: rotation then also acts within a period, together with
/// damping and splits. Without splits it turns and decays exactly as its rates say.
///
/// (theta, alpha) and (theta + pi/2, alpha + pi) are the same motion: an angle found from the signals is known modulo pi/2.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wave {
    /// a_A of (1): amplitude of the main wave at t = 0, input units, above 0.
    pub main_amplitude: f64,
    /// a_B of (1): amplitude of the quadrature wave at t = 0, input units, signed, |a_B| <= a_A.
    pub quadrature_amplitude: f64,
    /// theta of (3): pattern angle at t = 0, rad, any.
    pub angle: f64,
    /// alpha of (1), rad, any: tau(t) = 2 pi (f t + `frequency_rate` t^2 / 2) - alpha.
    pub phase: f64,
    /// f = omega / 2 pi of (1) at t = 0, Hz, above 0. Above half the sample rate the samples show its alias.
    pub frequency: f64,
    /// Drift of the frequency, Hz/s, any.
    pub frequency_rate: f64,
    /// Rate at which rotation turns the pattern, rad/s, any: without splits theta(t) = theta + `angle_rate` t.
    pub angle_rate: f64,
    /// Decay, 1/s, any: without splits both amplitudes go as exp(-`decay_rate` t). Quality factor Q means pi f / Q.
    pub decay_rate: f64,
    /// Difference of the two modes' decay rates, 1/s, any: the wave decays with `decay_rate` + `damping_split` / 2 at
    /// `damping_angle`, with `decay_rate` - `damping_split` / 2 at 45 degrees from there.
    pub damping_split: f64,
    /// Pattern angle at which a wave is damped most (least, if the split is negative), rad, any; known modulo pi/2.
    pub damping_angle: f64,
    /// Difference of the two modes' frequencies, Hz, within a tenth of `frequency`: a wave has the frequency
    /// `frequency` + `frequency_split` / 2 at `frequency_angle`, `frequency` - `frequency_split` / 2 at 45 degrees from there.
    pub frequency_split: f64,
    /// Pattern angle at which the frequency is highest (lowest, if the split is negative), rad, any; known modulo pi/2.
    pub frequency_angle: f64,
}

impl Default for Wave {
    /// The paper's example: a_A = 2, a_B = 0.1, theta = 30 degrees, alpha = pi/6, f = 5332 Hz, constant.
    fn default() -> Self {
        Wave {
            main_amplitude: 2.0,
            quadrature_amplitude: 0.1,
            angle: FRAC_PI_6,
            phase: FRAC_PI_6,
            frequency: 5332.0,
            frequency_rate: 0.0,
            angle_rate: 0.0,
            decay_rate: 0.0,
            damping_split: 0.0,
            damping_angle: 0.0,
            frequency_split: 0.0,
            frequency_angle: 0.0,
        }
    }
}

/// The true wave at one moment: the values that an identification over a short window about that moment should find.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// The moment, s from the first sample.
    pub time: f64,
    /// a_A of (1) at that moment, input units.
    pub main_amplitude: f64,
    /// a_B of (1) at that moment, input units, signed.
    pub quadrature_amplitude: f64,
    /// theta of (3) at that moment, rad, continuous from [`Wave::angle`] (not reduced).
    ///
    /// Splits may make the pattern a circle, a_A = |a_B|, for a moment; there the angle has no meaning, and may jump.
    pub angle: f64,
    /// alpha about that moment, rad, in (-pi, pi]: tau(`time` + dt) = 2 pi `frequency` dt - `phase`.
    pub phase: f64,
    /// f at that moment, Hz, tau' / 2 pi: with splits it changes with the pattern. Without meaning in a circle.
    pub frequency: f64,
    /// Precession theta', rad/s, by rotation and by the splits. Without meaning in a circle.
    pub angle_rate: f64,
    /// Decay of the main wave, -a_A' / a_A, 1/s.
    pub decay_rate: f64,
}

impl Wave {
    /// The wave at `t` s.
    ///
    /// The phase is accurate to about 1e-15 rad for the `t` given, however late; with splits, to 1e-15 of the turn by rotation and splits.
    /// But the time of sample `k` is seldom an exact `f64`: for a sample, use [`Gyro::truth_at`](crate::Gyro::truth_at).
    pub fn at(&self, t: f64) -> Truth {
        self.at_instant(Instant::of(t))
    }

    pub(crate) fn at_instant(&self, instant: Instant) -> Truth {
        if let Some(split) = SplitWave::of(self) {
            return split.at_instant(instant);
        }
        self.steady_at(instant)
    }

    /// The true wave at an instant, if there are no splits.
    pub(crate) fn steady_at(&self, instant: Instant) -> Truth {
        let time = instant.seconds();
        let decay = exp(-self.decay_rate * time);
        let turns = instant.turns(self.frequency, self.frequency_rate);
        Truth {
            time,
            main_amplitude: self.main_amplitude * decay,
            quadrature_amplitude: self.quadrature_amplitude * decay,
            angle: self.angle + self.angle_rate * time,
            phase: reduced(self.phase - TAU * turns),
            frequency: self.frequency + self.frequency_rate * time,
            angle_rate: self.angle_rate,
            decay_rate: self.decay_rate,
        }
    }

    /// The pick-off signals [S_C, S_D] of (1)-(3) at `t` s, without noise, input units.
    pub fn pick_offs(&self, t: f64) -> [f64; 2] {
        self.pick_offs_at(Instant::of(t))
    }

    pub(crate) fn pick_offs_at(&self, instant: Instant) -> [f64; 2] {
        if let Some(split) = SplitWave::of(self) {
            return split.pick_offs_at(instant);
        }
        let truth = self.steady_at(instant);
        let (sin_tau, cos_tau) = sincos(-truth.phase);
        let (sin, cos) = sincos(2.0 * truth.angle);
        let a = truth.main_amplitude * cos_tau;
        let b = truth.quadrature_amplitude * sin_tau;
        [a * cos - b * sin, a * sin + b * cos]
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        positive("main_amplitude", self.main_amplitude)?;
        positive("frequency", self.frequency)?;
        for (what, value) in [
            ("quadrature_amplitude", self.quadrature_amplitude),
            ("angle", self.angle),
            ("phase", self.phase),
            ("frequency_rate", self.frequency_rate),
            ("angle_rate", self.angle_rate),
            ("decay_rate", self.decay_rate),
            ("damping_split", self.damping_split),
            ("damping_angle", self.damping_angle),
            ("frequency_split", self.frequency_split),
            ("frequency_angle", self.frequency_angle),
        ] {
            finite(what, value)?;
        }
        require(
            "frequency_split",
            self.frequency_split,
            self.frequency_split.abs() <= 0.1 * self.frequency,
            "within a tenth of the frequency",
        )?;
        if self.quadrature_amplitude.abs() > self.main_amplitude {
            return Err(Error::QuadratureAboveMain {
                main: self.main_amplitude,
                quadrature: self.quadrature_amplitude,
            });
        }
        Ok(())
    }
}

/// `phase` less whole turns, in (-pi, pi].
pub(crate) fn reduced(phase: f64) -> f64 {
    let rest = libm::remainder(phase, TAU);
    if rest <= -PI { PI } else { rest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_papers_wave_at_zero() {
        // tau = -30 deg, 2 theta = 60 deg: A = 2 cos 30 = sqrt 3, B = -0.1 sin 30 = -0.05
        let [c, d] = Wave::default().pick_offs(0.0);
        let root = 3f64.sqrt();
        assert!((c - (root / 2.0 + 0.05 * root / 2.0)).abs() < 1e-15, "{c}");
        assert!((d - (root * root / 2.0 - 0.05 / 2.0)).abs() < 1e-15, "{d}");
    }

    #[test]
    fn the_error_names_the_wave_that_one_with_too_much_quadrature_is() {
        for quadrature_amplitude in [2.5f64, -2.5] {
            let wrong = Wave {
                quadrature_amplitude,
                ..Wave::default()
            };
            let sign = quadrature_amplitude.signum();
            let right = Wave {
                main_amplitude: quadrature_amplitude.abs(),
                quadrature_amplitude: sign * wrong.main_amplitude,
                angle: wrong.angle - sign * 0.5 * FRAC_PI_2,
                phase: wrong.phase - FRAC_PI_2,
                ..wrong
            };
            for t in [0.0, 1e-5, 7.3e-5] {
                let pairs = wrong.pick_offs(t).into_iter().zip(right.pick_offs(t));
                pairs.for_each(|(one, other)| assert!((one - other).abs() < 1e-12, "{t}"));
            }
        }
    }

    #[test]
    fn truth_describes_the_wave_about_its_moment() {
        let wave = Wave {
            frequency_rate: 0.3,
            angle_rate: 0.7,
            decay_rate: 0.05,
            ..Wave::default()
        };
        for t0 in [0.0, 0.01, 3.3, 1000.1] {
            let truth = wave.at(t0);
            assert!(truth.phase > -PI && truth.phase <= PI);
            let moved = Wave {
                main_amplitude: truth.main_amplitude,
                quadrature_amplitude: truth.quadrature_amplitude,
                angle: truth.angle,
                phase: truth.phase,
                frequency: truth.frequency,
                ..wave
            };
            for dt in [0.0, 1e-5, 0.01] {
                let [c, d] = wave.pick_offs_at(Instant::of(t0).later(dt));
                let [c0, d0] = moved.pick_offs(dt);
                // 1e-16 of 1.5e5 turns of drift at 1000 s
                assert!(
                    (c - c0).abs() < 1e-9 && (d - d0).abs() < 1e-9,
                    "{t0} {dt}: {c} {c0} {d} {d0}"
                );
            }
        }
    }

    #[test]
    fn rates_act_as_documented() {
        let wave = Wave {
            frequency_rate: 0.5,
            angle_rate: 0.25,
            decay_rate: 0.125,
            ..Wave::default()
        };
        let truth = wave.at(2.0);
        assert!((truth.frequency - 5333.0).abs() < 1e-12);
        assert!((truth.angle - (FRAC_PI_6 + 0.5)).abs() < 1e-15);
        assert!((truth.main_amplitude - 2.0 * exp(-0.25)).abs() < 1e-15);
        assert!((truth.quadrature_amplitude - 0.1 * exp(-0.25)).abs() < 1e-15);
        // 5332 * 2 + 0.5 * 4 / 2 = 10665 whole turns: the phase is back
        assert!((truth.phase - FRAC_PI_6).abs() < 1e-14);
        // a quarter turn later alpha has fallen by pi/2
        let quarter = Wave::default().at(0.25 / 5332.0);
        assert!((quarter.phase - (FRAC_PI_6 - FRAC_PI_2)).abs() < 1e-14);
    }

    #[test]
    fn the_phase_is_half_open() {
        assert_eq!(reduced(-PI), PI);
        assert_eq!(reduced(PI), PI);
        assert!((reduced(7.0) - (7.0 - TAU)).abs() < 1e-15);
    }

    #[test]
    fn an_angle_a_quarter_turn_on_with_the_opposite_phase_is_the_same_motion() {
        let wave = Wave::default();
        let same = Wave {
            angle: wave.angle + FRAC_PI_2,
            phase: wave.phase + PI,
            ..wave
        };
        let ([c, d], [c2, d2]) = (wave.pick_offs(1e-4), same.pick_offs(1e-4));
        assert!((c - c2).abs() < 1e-14 && (d - d2).abs() < 1e-14);
    }

    #[test]
    fn values_out_of_range_are_refused() {
        let check = |set: fn(&mut Wave, f64), value| {
            let mut wave = Wave::default();
            set(&mut wave, value);
            wave.check()
        };
        assert!(check(|wave, value| wave.main_amplitude = value, 0.0).is_err());
        let any: [fn(&mut Wave, f64); 6] = [
            |wave, value| wave.frequency = value,
            |wave, value| wave.angle_rate = value,
            |wave, value| wave.damping_split = value,
            |wave, value| wave.damping_angle = value,
            |wave, value| wave.frequency_split = value,
            |wave, value| wave.frequency_angle = value,
        ];
        for (i, set) in any.into_iter().enumerate() {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(check(set, value).is_err(), "{i}: {value}");
            }
        }
        // Within a tenth of the frequency, and no larger than the main wave.
        for (split, is_right) in [(533.0, true), (534.0, false)] {
            for split in [split, -split] {
                let checked = check(|wave, value| wave.frequency_split = value, split);
                assert_eq!(checked.is_ok(), is_right, "{split}");
            }
        }
        for (quadrature, is_right) in [(-2.0, true), (-2.1, false)] {
            let checked = check(|wave, value| wave.quadrature_amplitude = value, quadrature);
            assert_eq!(checked.is_ok(), is_right, "{quadrature}");
        }
    }
}
