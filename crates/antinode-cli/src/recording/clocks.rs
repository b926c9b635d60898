//! Columns that go up as times do: files of one channel each, pasted side by side, have a time each.

use super::columns::Places;
use super::error::TIME;
use super::number::number;
use super::preamble::{MAX_STEP_RATIO, are_even};

/// Lines looked at, the last of those that are seen before the samples are read.
const LINES: usize = 15;

/// Largest difference of two times and of their steps, in steps.
const MAX_DIFFERENCE: f64 = 0.05;

/// Largest skew of the two signals that `identify` corrects, ns.
const MAX_SKEW: f64 = 1e6;

/// A column that goes up as a time does.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub place: usize,
    /// The mean of its values.
    mean: f64,
    step: f64,
}

/// The columns that go up as times do in these lines.
pub(super) fn clocks(rows: &[&[&[u8]]], separator: u8) -> Vec<Clock> {
    let Some(rows) = rows
        .len()
        .checked_sub(LINES)
        .and_then(|from| rows.get(from..))
    else {
        return Vec::new();
    };
    let clock = |place: usize| {
        let values = rows.iter().map(|row| number(row.get(place)?, separator));
        let values: Vec<f64> = values.collect::<Option<_>>()?;
        let count = values.len() as f64;
        are_even(&values, MAX_STEP_RATIO).then(|| Clock {
            place,
            mean: values.iter().sum::<f64>() / count,
            step: (values[values.len() - 1] - values[0]) / (count - 1.0),
        })
    };
    (0..rows[0].len()).filter_map(clock).collect()
}

/// The warning if the nearest times before S_C and S_D, in the unit of this power of ten of a second, differ.
pub(super) fn warning(clocks: &[Clock], places: Places, exponent: i32) -> Option<String> {
    let time = clocks
        .iter()
        .find(|clock| Some(clock.place) == places[TIME])?;
    let own = |signal: Option<usize>| {
        let is_own = |clock: &&Clock| {
            let is_before = Some(clock.place) < signal && !places[1..].contains(&Some(clock.place));
            is_before && (clock.step - time.step).abs() <= MAX_DIFFERENCE * time.step
        };
        clocks.iter().rev().find(is_own).unwrap_or(time)
    };
    let [_, c, d] = places.map(own);
    let late = d.mean - c.mean;
    let samples = late / time.step;
    if samples.abs() <= MAX_DIFFERENCE {
        return None;
    }
    let skew = late * 10f64.powi(exponent + 9);
    let remedy = if skew.abs() <= MAX_SKEW {
        format!("give --skew-ns={skew:.0}")
    } else {
        "leave out the first samples of the one that begins earlier".to_owned()
    };
    Some(format!(
        "the times of S_C in column {} and those of S_D in column {} differ by {:.2} samples, but both signals are read with those in \
         column {}; {remedy}, or record both with one trigger",
        c.place + 1,
        d.place + 1,
        samples.abs(),
        time.place + 1
    ))
}
