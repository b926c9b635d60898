//! Conversion of samples to those of ideal pick-offs, and of their noise.

use antinode::methods::comparison::Noise;
use antinode::{Calibration, Pair};

/// Undoes a calibration's flaws at a frequency, sample by sample.
#[derive(Debug, Clone, Copy)]
pub struct Ideal {
    /// Delay of D, in samples.
    delay: f64,
    /// Frequency, rad a sample.
    omega: f64,
    gain_ratio: f64,
    /// Share of S_C in the S_D of an ideal pick-off, and the factor of their sum.
    across: f64,
    factor: f64,
}

impl Ideal {
    /// For a wave at `omega` rad a sample, at a sample rate in Hz.
    pub fn new(calibration: &Calibration, omega: f64, sample_rate: f64) -> Self {
        let (sine, cosine) = (2.0 * f64::from(calibration.pick_off_angle)).sin_cos();
        Self {
            delay: f64::from(calibration.skew) * sample_rate,
            omega,
            gain_ratio: calibration.gain_ratio.into(),
            across: sine,
            factor: 1.0 / cosine,
        }
    }

    /// Weights of a sample of D and its neighbour that give D this many samples towards the neighbour: exact for a sinusoid, also away
    /// from it.
    fn shares(&self, towards: f64) -> [f64; 2] {
        [1.0 - towards, towards].map(|samples| (self.omega * samples).sin() / self.omega.sin())
    }

    /// The pairs of ideal pick-offs, after subtraction of the `offsets` of the raw signals, (4).
    pub fn pairs(&self, raw: &[Pair], offsets: [f32; 2]) -> Vec<Pair> {
        let d = |k: usize| raw.get(k).map(|pair| f64::from(pair[1] - offsets[1]));
        let shares = [self.delay.abs(), -self.delay.abs()].map(|towards| self.shares(towards));
        let earlier = |k: usize, own: f64| {
            // The neighbour that D lies towards, and the one that serves instead at an end.
            let mut others = [k.checked_sub(1).and_then(d), d(k + 1)];
            if self.delay < 0.0 {
                others.swap(0, 1);
            }
            let mut others = shares.iter().zip(others);
            let found = others.find_map(|(shares, other)| Some((shares, other?)));
            match found {
                Some(([share, of_other], other)) if self.delay != 0.0 => {
                    share * own + of_other * other
                }
                _ => own,
            }
        };
        let ideal = |(k, pair): (usize, &Pair)| {
            let c = pair[0] - offsets[0];
            let d = earlier(k, f64::from(pair[1] - offsets[1]));
            let ideal = (d / self.gain_ratio + f64::from(c) * self.across) * self.factor;
            [c, ideal as f32]
        };
        raw.iter().enumerate().map(ideal).collect()
    }

    /// Noise of the ideal pairs, if that of the raw ones is white with `variance` a sample; `lag` is that of the delayed sums.
    pub fn noise(&self, variance: f64, lag: u16) -> Noise {
        let [own, other] = self
            .shares(self.delay.abs())
            .map(|share| share / self.gain_ratio);
        let square = self.factor * self.factor;
        Noise {
            moments: [
                variance,
                variance * (own * own + other * other + self.across * self.across) * square,
                variance * self.across * self.factor,
            ],
            delayed: if lag == 1 {
                variance * own * other * square
            } else {
                0.0
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use antinode_sim::{Flaws, Gyro, Wave};

    use super::*;

    const RATE: f64 = 1e5;

    fn calibration(skew: f32) -> Calibration {
        Calibration {
            gain_ratio: 1.3,
            skew,
            pick_off_angle: 0.1,
        }
    }

    #[test]
    fn flaws_are_undone() {
        let wave = Wave::default();
        let omega = std::f64::consts::TAU * wave.frequency / RATE;
        for skew in [0.0, 3e-6, -7e-6, 1.4e-5] {
            let flaws = Flaws {
                gain_ratio: f64::from(1.3f32),
                skew: skew.into(),
                pick_off_angle: f64::from(0.1f32),
                offset_d: 0.25,
                ..Flaws::default()
            };
            let raw: Vec<Pair> = Gyro::new(wave, flaws, RATE, 1)
                .expect("a valid gyro")
                .take(60)
                .map(|pair| pair.map(|x| x as f32))
                .collect();
            let ideal = Ideal::new(&calibration(skew), omega, RATE).pairs(&raw, [0.0, 0.25]);
            assert_eq!(ideal.len(), raw.len());
            for (k, pair) in ideal.iter().enumerate() {
                let [c, d] = wave.pick_offs(k as f64 / RATE);
                assert!((f64::from(pair[0]) - c).abs() < 1e-6, "{skew} {k}");
                assert!((f64::from(pair[1]) - d).abs() < 3e-6, "{skew} {k}");
            }
        }
    }

    #[test]
    fn noise_of_ideal_pairs_is_as_computed() {
        let wave = Wave {
            main_amplitude: 1e-9,
            quadrature_amplitude: 0.0,
            ..Wave::default()
        };
        let raw: Vec<Pair> = Gyro::new(wave, Flaws::white(0.1), RATE, 1)
            .expect("a valid gyro")
            .take(400_000)
            .map(|pair| pair.map(|x| x as f32))
            .collect();
        let ideal = Ideal::new(&calibration(4e-6), 1.3, RATE);
        let pairs = ideal.pairs(&raw, [0.0; 2]);
        let mean = |product: &dyn Fn(&[Pair]) -> f32| {
            pairs
                .windows(2)
                .map(|two| f64::from(product(two)))
                .sum::<f64>()
                / pairs.len() as f64
        };
        let found = [
            mean(&|two| two[1][0] * two[1][0]),
            mean(&|two| two[1][1] * two[1][1]),
            mean(&|two| two[1][0] * two[1][1]),
            mean(&|two| two[1][1] * two[0][1]),
        ];
        let noise = ideal.noise(0.01, 1);
        let computed = [
            noise.moments[0],
            noise.moments[1],
            noise.moments[2],
            noise.delayed,
        ];
        for (found, computed) in found.into_iter().zip(computed) {
            assert!((found - computed).abs() < 6e-5, "{found} {computed}");
        }
    }
}
