//! What the resonator's motion leaves of the rows.

use serde::Serialize;

use super::Results;
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
        resonance, listed, ..
    } = results;
    let is_unsteady = resonance.found.is_unsteady();
    let mut list = Vec::new();
    for (index, run) in resonance.runs.iter().enumerate() {
        let number = listed.iter().position(|&listed| listed == index);
        for (row, rests) in run.rows.iter().zip(resonance.rests(index)) {
            let [main, quadrature, angle] = rests.map(|rest| significant(rest, 6));
            list.push(Rest {
                time_s: row.time,
                run: number.map(|number| number + 1),
                main_amplitude_off_sigma: main,
                quadrature_amplitude_off_sigma: quadrature,
                angle_off_sigma: (!is_unsteady).then_some(angle),
                file: &run.file,
            });
        }
    }
    list
}
