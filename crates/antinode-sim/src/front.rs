//! From the resonator to the converter's input: jitter, pick-offs, distortion, gain, offset, hum and noise.

use crate::carrier::Carrier;
use crate::flaws::Flaws;
use crate::gyro::Pair;
use crate::noise::{Normals, Stream};
use crate::split::SplitWave;
use crate::time::Instant;
use crate::wave::Wave;
use libm::sincos;

/// The converter's input at one sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Input {
    /// The whole of it.
    pub signal: Pair,
    /// What is left of it without the wave: offset, hum and noise.
    pub floor: Pair,
}

/// Where the clean signals come from.
#[derive(Debug, Clone)]
enum Source {
    /// Even instants and a steady frequency: by complex rotation.
    Steady(Box<Carrier<Wave>>),
    /// The same of a resonator with splits.
    Split(Box<Carrier<SplitWave>>),
    /// Anything else: by the formulas.
    Formulas { jitter: Option<(f64, Normals)> },
}

/// The analogue part of the gyro; sample `index` is a function of `index` alone.
#[derive(Debug, Clone)]
pub(crate) struct Front {
    wave: Wave,
    sample_rate: f64,
    source: Source,
    skew: f64,
    /// (sin, cos) of the pick-off error in the pattern, 2 eps.
    turn: Option<(f64, f64)>,
    /// Cubic distortion over a^2, 1 / (input unit)^2.
    bend: f64,
    gain: f64,
    offset: Pair,
    /// Amplitude of the hum and its turns a sample.
    hum: Option<(f64, f64)>,
    noise: Option<(f64, Normals)>,
}

impl Front {
    pub fn new(wave: Wave, flaws: &Flaws, sample_rate: f64, seed: u64) -> Front {
        let normals = |rms: f64, stream| (rms > 0.0).then(|| (rms, Normals::new(seed, stream)));
        let source = if flaws.jitter > 0.0 || wave.frequency_rate != 0.0 {
            Source::Formulas {
                jitter: normals(flaws.jitter, Stream::Jitter),
            }
        } else if let Some(split) = SplitWave::of(&wave) {
            Source::Split(Box::new(Carrier::new(split, sample_rate, flaws.skew)))
        } else {
            Source::Steady(Box::new(Carrier::new(wave, sample_rate, flaws.skew)))
        };
        Front {
            wave,
            sample_rate,
            source,
            skew: flaws.skew,
            turn: (flaws.pick_off_angle != 0.0).then(|| sincos(2.0 * flaws.pick_off_angle)),
            bend: flaws.cubic / (wave.main_amplitude * wave.main_amplitude),
            gain: flaws.gain_ratio,
            offset: Pair {
                c: flaws.offset_c,
                d: flaws.offset_d,
            },
            hum: (flaws.hum != 0.0).then(|| (flaws.hum, flaws.hum_frequency / sample_rate)),
            noise: normals(flaws.noise, Stream::Noise),
        }
    }

    pub fn at(&mut self, index: u64) -> Input {
        let seen = self.pick_offs(index);
        let mut floor = self.offset;
        if let Some((amplitude, turns)) = self.hum {
            let turns = turns * index as f64;
            let hum = amplitude * sincos(core::f64::consts::TAU * (turns - libm::floor(turns))).0;
            floor.c += hum;
            floor.d += hum;
        }
        if let Some((rms, normals)) = &mut self.noise {
            let (c, d) = normals.pair(index);
            floor.c += *rms * c;
            floor.d += *rms * d;
        }
        let bent = |s: f64| s + self.bend * s * s * s;
        let signal = Pair {
            c: bent(seen.c) + floor.c,
            d: self.gain * bent(seen.d) + floor.d,
        };
        Input { signal, floor }
    }

    fn pick_offs(&mut self, index: u64) -> Pair {
        let ((c, _), (c_late, d_late)) = match &mut self.source {
            Source::Steady(carrier) => carrier.at(index),
            Source::Split(carrier) => carrier.at(index),
            Source::Formulas { jitter } => {
                let mut instant = Instant::of_sample(index, self.sample_rate);
                if let Some((rms, normals)) = jitter {
                    instant = instant.later(*rms * normals.pair(index).0);
                }
                let on_time = self.wave.pick_offs_at(instant);
                let skewed = if self.skew == 0.0 {
                    on_time
                } else {
                    self.wave.pick_offs_at(instant.later(self.skew))
                };
                (on_time, skewed)
            }
        };
        let d = self
            .turn
            .map_or(d_late, |(sin, cos)| d_late * cos - c_late * sin);
        Pair { c, d }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(wave: Wave, flaws: Flaws, n: u64) -> Vec<Pair> {
        let mut front = Front::new(wave, &flaws, 100_000.0, 1);
        (0..n).map(|k| front.at(k).signal).collect()
    }

    #[test]
    fn hum_is_added_to_both() {
        let wave = Wave::default();
        let flaws = Flaws {
            hum: 0.1,
            hum_frequency: 60.0,
            ..Flaws::default()
        };
        let clean = first(wave, Flaws::default(), 3000);
        for (k, (a, b)) in clean.iter().zip(first(wave, flaws, 3000)).enumerate() {
            let hum = 0.1 * libm::sin(core::f64::consts::TAU * 60.0 * k as f64 / 100_000.0);
            assert!((b.c - a.c - hum).abs() < 1e-12 && (b.d - a.d - hum).abs() < 1e-12);
        }
    }

    #[test]
    fn noise_is_added_and_nothing_else() {
        let wave = Wave::default();
        let clean = first(wave, Flaws::default(), 200_000);
        let noisy = first(
            wave,
            Flaws {
                noise: 0.25,
                ..Flaws::default()
            },
            200_000,
        );
        let (mut cc, mut dd, mut cd) = (0.0, 0.0, 0.0);
        for (a, b) in clean.iter().zip(&noisy) {
            let (c, d) = (b.c - a.c, b.d - a.d);
            cc += c * c;
            dd += d * d;
            cd += c * d;
        }
        let n = clean.len() as f64;
        // Standard errors: of an rms sigma / sqrt(2n) = 0.16 %, of a correlation 1 / sqrt n = 0.22 %.
        assert!(
            ((cc / n).sqrt() / 0.25 - 1.0).abs() < 0.007,
            "{}",
            (cc / n).sqrt()
        );
        assert!(
            ((dd / n).sqrt() / 0.25 - 1.0).abs() < 0.007,
            "{}",
            (dd / n).sqrt()
        );
        assert!((cd / n / 0.0625).abs() < 0.01, "{}", cd / n);
    }

    #[test]
    fn jitter_moves_both_channels_together() {
        let wave = Wave::default();
        let jitter = 1e-8;
        let n = 100_000;
        let moved = first(
            wave,
            Flaws {
                jitter,
                ..Flaws::default()
            },
            n,
        );
        let mut squares = 0.0;
        for (k, pair) in moved.iter().enumerate() {
            let t = k as f64 / 100_000.0;
            let ((c, d), (c1, d1)) = (wave.pick_offs(t), wave.pick_offs(t + 1e-7));
            let (slope_c, slope_d) = ((c1 - c) / 1e-7, (d1 - d) / 1e-7);
            // Least squares for the one shift that explains both channels, and what it leaves.
            let shift = ((pair.c - c) * slope_c + (pair.d - d) * slope_d)
                / (slope_c.powi(2) + slope_d.powi(2));
            let left = (pair.c - c - shift * slope_c)
                .abs()
                .max((pair.d - d - shift * slope_d).abs());
            // A shift of 5e-8 s at most, against a slope taken over 1e-7 s: omega^2 a (1e-7 + 5e-8) 5e-8 / 2
            assert!(left < 1e-5, "sample {k}: {left}");
            squares += shift * shift;
        }
        let rms = (squares / n as f64).sqrt();
        assert!((rms / jitter - 1.0).abs() < 0.02, "{rms}");
    }

    #[test]
    fn jitter_leaves_the_noise_as_it_was() {
        let wave = Wave {
            frequency_rate: 1.0,
            ..Wave::default()
        };
        let mut with = Front::new(
            wave,
            &Flaws {
                noise: 0.1,
                jitter: 1e-7,
                ..Flaws::default()
            },
            1e5,
            3,
        );
        let mut without = Front::new(
            wave,
            &Flaws {
                noise: 0.1,
                ..Flaws::default()
            },
            1e5,
            3,
        );
        for k in 0..100 {
            assert_eq!(with.at(k).floor, without.at(k).floor);
        }
    }

    #[test]
    fn drift_and_no_drift_agree_where_they_meet() {
        let flaws = Flaws {
            skew: 1e-6,
            pick_off_angle: 0.01,
            ..Flaws::default()
        };
        let steady = first(Wave::default(), flaws.clone(), 500);
        let drifting = first(
            Wave {
                frequency_rate: 1e-12,
                ..Wave::default()
            },
            flaws,
            500,
        );
        for (a, b) in steady.iter().zip(&drifting) {
            assert!((a.c - b.c).abs() < 1e-14 && (a.d - b.d).abs() < 1e-14);
        }
    }

    #[test]
    fn the_cubic_bends_by_the_third_harmonic() {
        // At theta = 0 with a_B = 0, S_C = a cos tau: c S^3 / a^2 = c a (3/4 cos tau + 1/4 cos 3 tau).
        let wave = Wave {
            quadrature_amplitude: 0.0,
            angle: 0.0,
            phase: 0.0,
            frequency: 1000.0,
            ..Wave::default()
        };
        let bent = first(
            wave,
            Flaws {
                cubic: 0.01,
                gain_ratio: 2.0,
                offset_c: 5.0,
                offset_d: -1.0,
                ..Flaws::default()
            },
            100,
        );
        for (k, pair) in bent.iter().enumerate() {
            let tau = std::f64::consts::TAU * k as f64 / 100.0;
            let expected = 5.0 + 2.0 * (1.0075 * tau.cos() + 0.0025 * (3.0 * tau).cos());
            assert!((pair.c - expected).abs() < 1e-13, "{k}");
            assert!((pair.d + 1.0).abs() < 1e-13, "{k}");
        }
    }
}
