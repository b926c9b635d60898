//! Fits across long gaps: as no row shows how far the splits moved the pattern meanwhile, a search may begin far off.

use nalgebra::DVector;

use super::fit::{searched, settle};
use super::found::Found;
use super::model::Model;
use crate::runs::{MIN_ROWS, Run};

/// Length of a gap, at least, in mean distances of a run's rows.
const LONG: f64 = 8.0;

/// The fit of a shared model, starting from a fit to the pieces of runs between long gaps; `None` if there are no such gaps.
pub fn across(runs: &[Run], model: Model) -> Option<Found> {
    let (pieces, firsts) = cut(runs)?;
    let of_pieces = searched(&pieces, model)?;
    let mut values = DVector::zeros(model.unknowns(runs.len()));
    let mut copy = |to, from, count| {
        let from = of_pieces.values.rows(from, count);
        values.rows_mut(to, count).copy_from(&from);
    };
    copy(0, 0, model.shared());
    for (run, first) in firsts.into_iter().enumerate() {
        copy(model.own_at(run), model.own_at(first), model.own());
    }
    settle(runs, model, values)
}

/// The pieces of the runs, and which of them each run begins with; `None` if there is no gap, or a run begins with too few rows.
fn cut(runs: &[Run]) -> Option<(Vec<Run>, Vec<usize>)> {
    let (mut pieces, mut firsts) = (Vec::new(), Vec::new());
    for run in runs {
        firsts.push(pieces.len());
        for (index, rows) in run.pieces(LONG).enumerate() {
            if rows.len() >= MIN_ROWS {
                pieces.push(run.with(rows.to_vec()));
            } else if index == 0 {
                return None;
            }
        }
    }
    (pieces.len() > runs.len()).then_some((pieces, firsts))
}
