//! The wave of a row in the samples of its window.

use std::f64::consts::TAU;

use antinode::{Calibration, Estimate, Flags};

/// The wave of a row, as the raw pick-offs see it.
pub(super) struct Fitted<'a> {
    row: &'a Estimate,
    rate: f64,
    calibration: Calibration,
    /// 2πf, rad/s.
    omega: f64,
    /// θ̇, rad/s.
    angle_rate: f64,
}

impl<'a> Fitted<'a> {
    /// The wave of this row, of samples taken at this rate, Hz, by pick-offs of this calibration.
    pub fn new(row: &'a Estimate, rate: f64, calibration: Calibration) -> Self {
        // The rate at which a circle turns is noise, and its frequency is that of a pattern at rest.
        let is_circle = row.flags.contains(Flags::CIRCULAR);
        Self {
            row,
            rate,
            calibration,
            omega: TAU * row.frequency,
            angle_rate: if is_circle {
                0.0
            } else {
                row.angle_rate.into()
            },
        }
    }

    /// What its wave leaves of these pairs of the window, of which the first has the number `from` in the stream.
    pub fn leaves(mut self, from: u64, pairs: &[[f32; 2]]) -> Vec<[f64; 2]> {
        self.fit_slope(from, pairs);
        self.without_wave(from, pairs)
            .map(|(left, _)| left)
            .collect()
    }

    /// Fits the slope of the phase to the pairs: the row's frequency is corrected by how other windows say that the pattern turns.
    fn fit_slope(&mut self, from: u64, pairs: &[[f32; 2]]) {
        let offsets = self.row.offsets.map(f64::from);
        let (mut sum, mut squares) = (0.0, 0.0);
        for (left, by_omega) in self.without_wave(from, pairs) {
            for ((left, offset), by_omega) in left.into_iter().zip(offsets).zip(by_omega) {
                sum += (left - offset) * by_omega;
                squares += by_omega * by_omega;
            }
        }
        if squares > 0.0 {
            self.omega += sum / squares;
        }
    }

    /// S_C and S_D of these pairs without the wave, and the derivatives of the wave's by 2πf.
    fn without_wave(
        &self,
        from: u64,
        pairs: &[[f32; 2]],
    ) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let Calibration {
            gain_ratio,
            skew,
            pick_off_angle,
        } = self.calibration;
        let [gain, skew, turned] = [gain_ratio, skew, 2.0 * pick_off_angle].map(f64::from);
        pairs.iter().zip(from..).map(move |(&pair, number)| {
            let time = number as f64 / self.rate - self.row.time;
            let [c, _] = self.waves(time, 0.0);
            let [_, d] = self.waves(time + skew, turned);
            let waves = [c, d.map(|value| gain * value)];
            let [c, d] = pair.map(f64::from);
            let left = [c - waves[0][0], d - waves[1][0]];
            (left, waves.map(|[_, by_omega]| by_omega))
        })
    }

    /// S_C and S_D, formulas (2) and (3), at this time from the window's middle, s, each with its derivative by 2πf, for a pattern turned
    /// back by half of `turned`, rad.
    fn waves(&self, time: f64, turned: f64) -> [[f64; 2]; 2] {
        let row = self.row;
        let decayed = (-f64::from(row.decay_rate) * time).exp();
        let [main, quadrature] = [row.main_amplitude, row.quadrature_amplitude]
            .map(|amplitude| f64::from(amplitude) * decayed);
        let (sine, cosine) = (self.omega * time - f64::from(row.phase)).sin_cos();
        let (sine_of_twice, cosine_of_twice) =
            (2.0 * (row.angle + self.angle_rate * time) - turned).sin_cos();
        let seen = |a: f64, b: f64| {
            [
                a * cosine_of_twice - b * sine_of_twice,
                a * sine_of_twice + b * cosine_of_twice,
            ]
        };
        let now = seen(main * cosine, quadrature * sine);
        let by_omega = seen(-main * sine * time, quadrature * cosine * time);
        [[now[0], by_omega[0]], [now[1], by_omega[1]]]
    }
}
