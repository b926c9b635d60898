//! Rows become what the pick-offs showed.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::solve::PickOffs;
use crate::runs::{self, Row};

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
        let moments = run.rows.iter().map(|row| Moment::new(row, corrected));
        Self {
            moments: moments.collect(),
            turned: run.turned,
        }
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
        Self {
            time: row.time,
            raw: corrected.distort(ideal, omega),
            omega,
            deviation: row.deviations[0],
        }
    }
}
