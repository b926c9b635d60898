//! What the resonator's motion leaves of the rows.

use super::Resonance;
use super::curve::{CURVES, curves, undamped};
use super::model::Model;
use super::motion::PARAMETERS;

impl Resonance {
    /// How far a_A, a_B and θ of each row of a run lie from the motion, in the row's own deviations; the angle means nothing if
    /// [`is_unsteady`](super::Found::is_unsteady).
    pub fn rests(&self, run: usize) -> Vec<[f64; 3]> {
        let model = self.found.model;
        let rows = &self.runs[run];
        let terms = model.terms(run, rows);
        let parameters = Model::parameters(&terms, &self.found.values);
        let of_curves: [f64; CURVES] = std::array::from_fn(|i| parameters[PARAMETERS + i]);
        let mut motion = model.motion(rows, &parameters);
        let mut last = &rows.rows[0];
        let rests = rows.rows.iter().zip(curves(rows)).map(|(row, curve)| {
            model.advance(&mut motion, last, row);
            last = row;
            let row = undamped(row, &curve, &of_curves);
            let (rests, _) = motion.residuals(&row);
            std::array::from_fn(|i| rests[i] / row.deviations[i])
        });
        rests.collect()
    }
}
