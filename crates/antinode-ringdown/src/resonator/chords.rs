//! Corrected angles of rows, between which a pattern that is turned unsteadily may be taken to turn steadily.

use crate::runs::{Row, Run, turn};

/// Relative difference of one distance of rows from the next, at most.
const MAX_UNEVENNESS: f64 = 0.1;

/// The runs with angles whose chords have the pattern's mean angle between rows.
///
/// A row's own angle is the mean over its window, and the pattern does not follow the chord of two: if it accelerates by θ̈, and windows
/// of length h are Δ apart, chords through the rows' angles are θ̈(Δ²/12 + h²/24) off on average, but the splits act where the pattern is.
pub fn through(runs: &[Run]) -> Vec<Run> {
    runs.iter().map(straightened).collect()
}

fn straightened(run: &Run) -> Run {
    let bends: Vec<Option<f64>> = (0..run.rows.len()).map(|k| bend(&run.rows, k)).collect();
    let bend_at = |index: Option<usize>| *bends.get(index?)?;
    let straightened = |(index, row): (usize, &Row)| {
        let mut row = *row;
        if let Some(own) = bends[index] {
            let beside = [index.checked_sub(1), Some(index + 1)].map(bend_at);
            let [before, after] = beside.map(|bend| bend.unwrap_or(own));
            // The median of the three: if a table stops abruptly, only one row sees a bend, and there is none between rows.
            row.angle -= own.max(before.min(after)).min(before.max(after));
        }
        row
    };
    run.with(run.rows.iter().enumerate().map(straightened).collect())
}

/// Mean distance of chords from the pattern at a row, rad, if both its neighbours are equally far from it.
fn bend(rows: &[Row], index: usize) -> Option<f64> {
    let (row, before, after) = (
        rows[index],
        rows.get(index.checked_sub(1)?)?,
        rows.get(index + 1)?,
    );
    let apart = [row.time - before.time, after.time - row.time];
    let is_even = (apart[1] - apart[0]).abs() < MAX_UNEVENNESS * apart[0];
    let bend = turn(after.angle - row.angle) - turn(row.angle - before.angle);
    let window = row.seconds / apart[0];
    is_even.then_some(bend * (1.0 / 12.0 + window * window / 24.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_have_the_mean_angle_of_the_pattern() {
        // θ = 0.3 sin ωt, and its mean over an interval.
        let omega = 4.0;
        let mean = |from: f64, to: f64| {
            0.3 * ((omega * from).cos() - (omega * to).cos()) / (omega * (to - from))
        };
        for (apart, seconds) in [(0.1, 0.1), (0.1, 0.04), (0.05, 0.0)] {
            let row = |k: usize| {
                let time = apart * k as f64;
                let angle = mean(time - 0.5 * seconds - 1e-6, time + 0.5 * seconds + 1e-6);
                Row {
                    seconds,
                    ..Row::of(time, [1.0, 0.0, angle], [1e-4; 3])
                }
            };
            let mut run = Run {
                rows: (0..60).map(row).collect(),
                file: String::new(),
            };
            // A gap: its neighbours are not corrected.
            run.rows.remove(30);
            let off = |run: &Run, index: usize| {
                let [from, to] = [run.rows[index], run.rows[index + 1]];
                (0.5 * (from.angle + to.angle) - mean(from.time, to.time)).abs()
            };
            let max = |run: &Run| {
                let whole = (1..57).filter(|index| !(28..31).contains(index));
                whole.map(|index| off(run, index)).fold(0.0, f64::max)
            };
            let straight = &through(std::slice::from_ref(&run))[0];
            let (before, after) = (max(&run), max(straight));
            let bend = 0.3 * (omega * apart).powi(2);
            let ratio = seconds / apart;
            let expected = bend * (1.0 / 12.0 + ratio * ratio / 24.0);
            assert!(
                (before / expected - 1.0).abs() < 0.05,
                "{before} {expected}"
            );
            assert!(after < 0.1 * before, "{apart}, {seconds}: {after} {before}");
            for index in [0, 29, 30, 58] {
                assert_eq!(straight.rows[index].angle, run.rows[index].angle);
            }
        }
    }
}
