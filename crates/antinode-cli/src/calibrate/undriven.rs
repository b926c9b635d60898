//! A calibration that nothing driven spoils: a recording of several ring-downs also holds what excites them.

use super::moments::Run;
use super::solve::{Found, PickOffs, solve};
use crate::runs::driven::{undriven, unevenness};
use crate::runs::{self, BEYOND_NOISE};

/// Into so many parts a run is cut for a calibration that nothing driven spoils, and so many of all parts are tried.
const PARTS: usize = 6;
const TRIED: usize = 48;
/// So many times driven runs are sought anew, with the calibration of the others.
const REPEATED: usize = 3;
/// They are left out if the residual of the others is that of noise, or less than this share of all runs'.
const LESS: f64 = 0.05;

/// The moments of runs that were identified with a calibration.
pub fn moments(runs: &[runs::Run], corrected: &PickOffs) -> Vec<Run> {
    let each = runs.iter().map(|run| Run::new(run, corrected));
    each.collect()
}

/// What is found where of runs, with the moments of every one, those are left out in which something drives the wave; the others, and those.
/// None if it explains no more.
pub fn without_driven(
    runs: &[runs::Run],
    every: &[Run],
    corrected: &PickOffs,
    all: &Found,
) -> Option<(Found, [Vec<runs::Run>; 2])> {
    let without = |pick_offs: &PickOffs| {
        let energies: Vec<_> = every.iter().map(|run| run.energies(pick_offs)).collect();
        let parts = undriven(runs, &energies, 0.0);
        let found = solve(&moments(&parts[0], corrected), *pick_offs).ok()?;
        Some((found, parts))
    };
    // What is driven spoils the calibration by which it is told: that of a part without it lets most parts decay evenly.
    let parts: Vec<_> = every.iter().flat_map(|run| run.parts(PARTS)).collect();
    let some = parts.iter().step_by(parts.len().div_ceil(TRIED).max(1));
    let of_some = some.filter_map(|part| solve(std::slice::from_ref(part), all.pick_offs).ok());
    let rough = of_some
        .map(|found| found.pick_offs)
        .chain([all.pick_offs])
        .map(|pick_offs| (pick_offs, median_unevenness(&parts, &pick_offs)))
        .min_by(|(_, one), (_, other)| one.total_cmp(other));
    let mut found = without(&rough?.0)?;
    for _ in 0..REPEATED {
        found = without(&found.0.pick_offs)?;
    }
    (found.0.residual < BEYOND_NOISE.max(LESS * all.residual)).then_some(found)
}

/// How unevenly energy decays in runs through these pick-offs: the median of their residuals' squares, over the moments' own deviations.
fn median_unevenness(runs: &[Run], pick_offs: &PickOffs) -> f64 {
    let each = runs.iter();
    let mut each: Vec<_> = each
        .map(|run| unevenness(&run.energies(pick_offs)))
        .collect();
    each.sort_by(f64::total_cmp);
    each.get(each.len() / 2).copied().unwrap_or(f64::INFINITY)
}
