//! What the resonator's motion leaves of the rows.

use serde::Serialize;

use super::Results;
use super::curve::{CURVES, curves, undamped};
use super::model::Model;
use super::motion::PARAMETERS;
use crate::digits::significant;

/// What is left of a row, in its own standard deviations.
#[derive(Serialize)]
pub struct Rest<'a> {
    time_s: f64,
    /// Number of the run, from 1, if it is listed.
    run: Option<usize>,
    main_amplitude_off_sigma: f64,
    quadrature_amplitude_off_sigma: f64,
    /// None if pattern angles are taken from the rows.
    angle_off_sigma: Option<f64>,
    file: &'a str,
}

/// The rests of all rows, run by run.
pub fn rests(results: &Results) -> Vec<Rest<'_>> {
    let Results {
        rows,
        listed,
        found,
        ..
    } = results;
    let model = found.model;
    let mut list = Vec::with_capacity(rows.used());
    for (index, run) in rows.runs.iter().enumerate() {
        let terms = model.terms(index, run);
        let parameters = Model::parameters(&terms, &found.values);
        let of_curves: [f64; CURVES] = std::array::from_fn(|i| parameters[PARAMETERS + i]);
        let mut motion = model.motion(run, &parameters);
        let mut last = &run.rows[0];
        let number = listed.iter().position(|&listed| listed == index);
        for (row, curve) in run.rows.iter().zip(curves(run)) {
            model.advance(&mut motion, last, row);
            last = row;
            let row = undamped(row, &curve, &of_curves);
            let (rests, _) = motion.residuals(&row);
            let [main, quadrature, angle] =
                std::array::from_fn(|i| significant(rests[i] / row.deviations[i], 6));
            list.push(Rest {
                time_s: row.time,
                run: number.map(|number| number + 1),
                main_amplitude_off_sigma: main,
                quadrature_amplitude_off_sigma: quadrature,
                angle_off_sigma: (!model.is_unsteady()).then_some(angle),
                file: &run.file,
            });
        }
    }
    list
}
