//! Converts rows to what the pick-offs showed.

use std::f64::consts::TAU;

use num_complex::Complex;

use super::pick_offs::PickOffs;
use super::shares::{shares, variances};
use crate::runs::driven::Energy;
use crate::runs::{self, MIN_ROWS, Row, turn};

/// A window's wave as the pick-offs show it.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Time, s.
    pub time: f64,
    /// Phasors of both pick-offs, in the samples' unit; their common phase is arbitrary.
    pub raw: [Complex<f64>; 2],
    /// 2πf, rad/s.
    pub omega: f64,
    /// Variance of the real and of the imaginary part of a phasor, for noise that is equal on both pick-offs.
    pub variance: f64,
    /// The calibration that the window was identified with.
    pub corrected: PickOffs,
    /// Length of the window, s.
    pub seconds: f64,
}

/// A span of moments without a break.
#[derive(Debug, Clone)]
pub struct Run {
    pub moments: Vec<Moment>,
    /// Largest turns of the pattern, rad: backwards, at most 0, and forwards, at least 0.
    pub turns: [f64; 2],
}

impl Run {
    /// The moments of a run of rows that were identified with a calibration.
    pub fn new(run: &runs::Run, corrected: &PickOffs) -> Self {
        let moments = run.rows.iter().map(|row| Moment::new(row, corrected));
        Self {
            moments: moments.collect(),
            turns: run.turns(),
        }
    }

    /// About `count` parts of the run, of equally many moments; each states the turns of the whole.
    pub fn parts(&self, count: usize) -> impl Iterator<Item = Self> {
        let parts = self
            .moments
            .chunks_exact((self.moments.len() / count).max(MIN_ROWS));
        parts.map(|moments| Self {
            moments: moments.to_vec(),
            turns: self.turns,
        })
    }

    /// The wave's energy in each window, if the pick-offs are these.
    pub fn energies(&self, pick_offs: &PickOffs) -> Vec<Energy> {
        let noise_gains = pick_offs.noise_gains();
        let moments = self.moments.iter().zip(self.ideal(pick_offs));
        let energies = moments.map(|(moment, ideal)| {
            let [energy, ..] = shares(ideal);
            let [variance, _] = variances(ideal, noise_gains);
            Energy {
                time: moment.time,
                log: 0.5 * energy.ln(),
                deviation: 0.5 * (variance * moment.variance).sqrt(),
                angle: moment.angle(pick_offs),
            }
        });
        energies.collect()
    }

    /// Phasors of ideal pick-offs in the middle of each window, if the true ones are these.
    pub fn ideal(&self, pick_offs: &PickOffs) -> Vec<[Complex<f64>; 2]> {
        // Not the rows' own angles, which a wrong calibration makes turn unevenly.
        let angles: Vec<_> = self
            .moments
            .iter()
            .map(|moment| moment.angle(pick_offs))
            .collect();
        let rate = |index: usize| {
            let (before, after) = (index.saturating_sub(1), (index + 1).min(angles.len() - 1));
            let seconds = self.moments[after].time - self.moments[before].time;
            turn(angles[after] - angles[before]) / seconds
        };
        let moments = self.moments.iter().enumerate();
        moments
            .map(|(index, moment)| moment.ideal(pick_offs, rate(index) * moment.seconds))
            .collect()
    }
}

impl Moment {
    /// The phasors of (1) to (3), as pick-offs of this calibration show them.
    fn new(row: &Row, corrected: &PickOffs) -> Self {
        let (sine, cosine) = (2.0 * row.angle).sin_cos();
        let ideal = [
            Complex::new(row.main * cosine, row.quadrature * sine),
            Complex::new(row.main * sine, -row.quadrature * cosine),
        ];
        let omega = TAU * row.frequency;
        let [of_main, of_quadrature, _] = row.deviations;
        let [d, c] = corrected.noise_gains();
        Self {
            time: row.time,
            raw: corrected.at(omega).distort(ideal),
            omega,
            // At any pattern angle, both amplitudes together have the noise of both ideal pick-offs.
            variance: (of_main.powi(2) + of_quadrature.powi(2)) / (1.0 + c * c + d * d),
            corrected: *corrected,
            seconds: row.seconds,
        }
    }

    /// The pattern angle if the pick-offs are these, rad, modulo π/2.
    pub fn angle(&self, pick_offs: &PickOffs) -> f64 {
        let [plus, minus] = waves(pick_offs.at(self.omega).correct(self.raw));
        0.25 * (minus * plus.conj()).arg()
    }

    /// Phasors of ideal pick-offs in the middle of the window, if the true ones are these and the pattern turns by `turn` rad in it.
    ///
    /// The identification takes each travelling wave to turn evenly within a window. With a wrong calibration each shows some of the other,
    /// and does not: what is identified is the mean of its logarithm over the window, here by Simpson's rule.
    fn ideal(&self, pick_offs: &PickOffs, turn: f64) -> [Complex<f64>; 2] {
        let [pick_offs, corrected] = [pick_offs, &self.corrected].map(|these| these.at(self.omega));
        let true_waves = waves(pick_offs.correct(self.raw));
        // As the window shows them when the pattern stands further by this angle.
        let shown = |by: f64| {
            let [plus, minus] = true_waves;
            let turned = Complex::from_polar(1.0, 2.0 * by);
            let ideal = phasors([plus * turned, minus * turned.conj()]);
            waves(corrected.correct(pick_offs.distort(ideal)))
        };
        let [before, middle, after] = [-0.5, 0.0, 0.5].map(|part| shown(part * turn));
        let momentary = [0, 1].map(|i| {
            let bent = (before[i] * after[i] / (middle[i] * middle[i])).ln() / 6.0;
            // A wave of amplitude 0 stays one.
            middle[i]
                * if bent.is_finite() {
                    (-bent).exp()
                } else {
                    1.0.into()
                }
        });
        pick_offs.correct(corrected.distort(phasors(momentary)))
    }
}

/// The travelling waves of ideal phasors.
fn waves([c, d]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
    let turned = Complex::new(-d.im, d.re);
    [c + turned, c - turned]
}

/// The ideal phasors of travelling waves.
fn phasors([plus, minus]: [Complex<f64>; 2]) -> [Complex<f64>; 2] {
    [
        (plus + minus) * 0.5,
        (minus - plus) * Complex::new(0.0, 0.5),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variance_of_a_phasor_is_that_of_the_noise_before_the_calibration() {
        let corrected = PickOffs {
            gain_ratio: 3.0,
            skew: 0.0,
            angle: 0.15,
        };
        // What noise of variance 1 on each raw phasor adds up to in both ideal ones.
        let one = Complex::new(1.0, 0.0);
        let zero = Complex::new(0.0, 0.0);
        let gains = [[one, zero], [zero, one]].map(|raw| {
            let [c, d] = corrected.at(1.0).correct(raw);
            c.norm_sqr() + d.norm_sqr()
        });
        let of_both = (0.5 * (gains[0] + gains[1])).sqrt();
        let row = Row::of(0.0, [1.0, 0.1, 0.3], [1e-3 * of_both, 1e-3 * of_both, 1e-3]);
        let variance = Moment::new(&row, &corrected).variance;
        assert!((variance / 1e-6 - 1.0).abs() < 1e-9, "{variance}");
    }
}
