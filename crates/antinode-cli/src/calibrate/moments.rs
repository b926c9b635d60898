//! Rows become what the pick-offs showed.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::solve::PickOffs;
use crate::runs::{self, Row, turn};

/// A window's wave as the pick-offs show it.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Time, s.
    pub time: f64,
    /// Phasors of both pick-offs, in the samples' unit; their common phase is anything.
    pub raw: [Complex<f64>; 2],
    /// 2πf, rad/s.
    pub omega: f64,
    /// Standard deviation of an amplitude, in the samples' unit.
    pub deviation: f64,
    /// What the window was identified with.
    pub corrected: PickOffs,
    /// By how much the pattern turns in the window, rad.
    pub turn: f64,
}

/// A span of moments without a break.
#[derive(Debug, Clone)]
pub struct Run {
    pub moments: Vec<Moment>,
    /// By how much the pattern turns, rad.
    pub turned: f64,
}

impl Run {
    /// Of rows that were identified with a calibration.
    pub fn new(run: &runs::Run, corrected: &PickOffs) -> Self {
        let rate = |index: usize| {
            let (before, after) = (index.saturating_sub(1), (index + 1).min(run.rows.len() - 1));
            let (before, after) = (&run.rows[before], &run.rows[after]);
            turn(after.angle - before.angle) / (after.time - before.time)
        };
        let moments = run
            .rows
            .iter()
            .enumerate()
            .map(|(index, row)| Moment::new(row, corrected, rate(index)));
        Self {
            moments: moments.collect(),
            turned: run.turned,
        }
    }
}

impl Moment {
    /// The phasors of (1) to (3), as pick-offs of this calibration show them, of a pattern that turns at `rate` rad/s.
    fn new(row: &Row, corrected: &PickOffs, rate: f64) -> Self {
        let (sine, cosine) = (2.0 * row.angle).sin_cos();
        let ideal = [
            Complex::new(row.main * cosine, row.quadrature * sine),
            Complex::new(row.main * sine, -row.quadrature * cosine),
        ];
        let omega = TAU * row.frequency;
        Self {
            time: row.time,
            raw: corrected.distort(ideal, omega),
            omega,
            deviation: row.deviations[0],
            corrected: *corrected,
            turn: rate * row.seconds,
        }
    }

    /// Phasors of ideal pick-offs in the middle of the window, where the true ones are these.
    ///
    /// Within a window each of both travelling waves is taken to turn evenly. Through a calibration that is not right both are seen in
    /// each, which then does not: its logarithm comes out as the mean over the window, by Simpson's rule.
    pub fn ideal(&self, pick_offs: &PickOffs) -> [Complex<f64>; 2] {
        let true_waves = waves(pick_offs.correct(self.raw, self.omega));
        // As the window saw them when the pattern stood so much further.
        let seen = |by: f64| {
            let [plus, minus] = true_waves;
            let turned = Complex::from_polar(1.0, 2.0 * by);
            let ideal = phasors([plus * turned, minus * turned.conj()]);
            let raw = pick_offs.distort(ideal, self.omega);
            waves(self.corrected.correct(raw, self.omega))
        };
        let [before, middle, after] = [-0.5, 0.0, 0.5].map(|part| seen(part * self.turn));
        let momentary = [0, 1].map(|i| {
            let bent = (before[i] * after[i] / (middle[i] * middle[i])).ln() / 6.0;
            // A wave of nothing is seen as nothing.
            middle[i]
                * if bent.is_finite() {
                    (-bent).exp()
                } else {
                    1.0.into()
                }
        });
        let raw = self.corrected.distort(phasors(momentary), self.omega);
        pick_offs.correct(raw, self.omega)
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
