//! Runs in which something drives the wave: a recording of several ring-downs also holds what excites them.

use super::fit::found;
use super::found::Measured;
use super::model::Model;
use crate::runs::{Run, Runs};

/// Deviations by which a decay is one, or is none.
const SURE: f64 = 10.0;
/// Of this share of the least decay that is one, it is none: two modes of one resonator are never that far apart.
const LITTLE: f64 = 0.1;
/// A gain ratio that is 15 % off changes an amplitude by this share per radian that the pattern turns, while nothing drives it.
const BY_FLAWS: f64 = 0.3;
/// So many are named.
const NAMED: usize = 5;

/// Takes the runs out whose wave does not decay, if that of others does; gives them.
pub fn take_driven(rows: &mut Runs) -> Vec<Run> {
    if rows.runs.len() < 2 {
        return Vec::new();
    }
    let decays: Vec<_> = rows.runs.iter().map(own_decay).collect();
    let sure = decays
        .iter()
        .flatten()
        .filter(|(rate, std)| *rate > SURE * std);
    let least = sure.map(|(rate, _)| *rate).fold(f64::INFINITY, f64::min);
    if least.is_infinite() {
        return Vec::new();
    }
    let is_driven = |(run, decay): (&Run, &Option<Measured>)| {
        let [back, forth] = run.turns();
        let by_flaws = BY_FLAWS * forth.max(-back) / run.seconds();
        decay.is_some_and(|(rate, std)| rate + SURE * std + by_flaws < LITTLE * least)
    };
    let driven: Vec<_> = rows.runs.iter().zip(&decays).map(is_driven).collect();
    let mut driven = driven.into_iter();
    let all = std::mem::take(&mut rows.runs).into_iter();
    let (left_out, kept) = all.partition(|_| driven.next() == Some(true));
    rows.runs = kept;
    left_out
}

/// The decay of a run by itself, 1/s.
fn own_decay(run: &Run) -> Option<Measured> {
    let found = found(std::slice::from_ref(run), Model::Each).ok()?;
    Some(found.decay_of_run(0))
}

/// Which they are, to be told.
pub fn names(driven: &[Run]) -> String {
    let name = |run: &Run| {
        let file = if run.file.is_empty() {
            String::new()
        } else {
            format!("{}, ", run.file)
        };
        let (seconds, from) = (run.seconds(), run.rows[0].time);
        format!("{file}{seconds:.1} s from {from:.1} s on")
    };
    let mut names: Vec<_> = driven.iter().take(NAMED).map(name).collect();
    if driven.len() > NAMED {
        names.push(format!("and {} more", driven.len() - NAMED));
    }
    names.join("; ")
}
