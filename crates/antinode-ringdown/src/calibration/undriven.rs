//! Calibration without driven rows: a recording of several ring-downs also holds their excitation.

use super::moments::Run;
use super::pick_offs::PickOffs;
use super::solve::{Found, solve};
use crate::runs::driven::{undriven, unevenness};
use crate::runs::{self, BEYOND_NOISE};

/// Parts of a run of which one may be free of drives, and how many of all parts are tried, about.
const PARTS: usize = 6;
const TRIED: usize = 48;
/// Times that driven runs are sought again, with the calibration from the others.
const REPETITIONS: usize = 3;
/// Driven runs are left out if the residual of the others is that of noise, or below this share of that of all runs.
const MAX_RESIDUAL_SHARE: f64 = 0.05;

/// The moments of runs that were identified with a calibration.
pub fn moments(runs: &[runs::Run], corrected: &PickOffs) -> Vec<Run> {
    let each = runs.iter().map(|run| Run::new(run, corrected));
    each.collect()
}

/// The calibration without the runs in which something drives the wave, with the other runs and the driven ones; `every` has the
/// moments of every run, which a calibration explains with a residual. `None` if it does not explain the rows better.
pub fn without_driven(
    runs: &[runs::Run],
    every: &[Run],
    corrected: &PickOffs,
    (all, residual): (PickOffs, f64),
) -> Option<(Found, [Vec<runs::Run>; 2])> {
    let parts_by = |pick_offs: &PickOffs| {
        let energies: Vec<_> = every.iter().map(|run| run.energies(pick_offs)).collect();
        undriven(runs, &energies, 0.0)
    };
    let solved = |[decaying, _]: &[Vec<runs::Run>; 2], start| {
        let moments = moments(decaying, corrected);
        solve(&moments, start).ok()
    };
    // Driven rows spoil the calibration that is to reveal them; that from a part without any makes most parts decay evenly.
    let parts: Vec<_> = every.iter().flat_map(|run| run.parts(PARTS)).collect();
    let some = parts.iter().step_by(parts.len().div_ceil(TRIED).max(1));
    let of_some = some.filter_map(|part| solve(std::slice::from_ref(part), all).ok());
    let rough = of_some
        .map(|found| found.pick_offs)
        .chain([all])
        .map(|pick_offs| (pick_offs, median_unevenness(&parts, &pick_offs)))
        .min_by(|(_, one), (_, other)| one.total_cmp(other));
    let (rough, _) = rough?;
    let mut divided = parts_by(&rough);
    let mut found = solved(&divided, rough)?;
    for _ in 0..REPETITIONS {
        let again = parts_by(&found.pick_offs);
        if again == divided {
            break;
        }
        divided = again;
        found = solved(&divided, found.pick_offs)?;
    }
    let is_better = found.residual < BEYOND_NOISE.max(MAX_RESIDUAL_SHARE * residual);
    let [_, driven] = &divided;
    (is_better && !driven.is_empty()).then_some((found, divided))
}

/// How unevenly energy decays in runs if the pick-offs are these: the median of the mean squared residuals, over the moments' own
/// deviations.
fn median_unevenness(runs: &[Run], pick_offs: &PickOffs) -> f64 {
    let each = runs.iter();
    let mut each: Vec<_> = each
        .map(|run| unevenness(&run.energies(pick_offs)))
        .collect();
    each.sort_unstable_by(f64::total_cmp);
    each.get(each.len() / 2).copied().unwrap_or(f64::INFINITY)
}
