//! Many rows as fewer ones, each the mean of some, as if windows had been longer: a fit to them costs less, and ends where that to all rows
//! is nearly settled.

use crate::runs::{BOWS, Row, Run, turn};

/// Number of means, about.
const MEANS: usize = 10_000;
/// Number of means in a run, at least.
const IN_RUN: usize = 100;
/// Fewer rows than these are not worth a mean.
const WORTH: usize = 4;
/// Turn of a pattern, rad, and change of an amplitude as a share of a_A from mean to mean, at most: half of the turn that rows may have.
const MAX_TURN: f64 = 0.2;
const MAX_CHANGE: f64 = 0.02;
/// Deviations of noise that are added to these.
const BY_NOISE: f64 = 5.0;
/// Distance of rows, in mean distances, beyond which there is a gap between them.
const GAP: f64 = 1.5;

/// Runs of the means of many rows; `None` if there are not so many, or the patterns move too fast.
pub fn joined(runs: &[Run]) -> Option<Vec<Run>> {
    let count = rows(runs);
    let each = count / MEANS;
    let joined = (each >= WORTH).then(|| runs.iter().map(|run| means(run, each)).collect());
    joined.filter(|joined: &Vec<Run>| WORTH * rows(joined) <= count)
}

/// Number of rows of all runs.
fn rows(runs: &[Run]) -> usize {
    runs.iter().map(|run| run.rows.len()).sum()
}

/// The means of up to so many rows of a run each, as many as its motion allows.
fn means(run: &Run, most: usize) -> Run {
    // What is known of an unsteady turn between two rows, no mean tells.
    let is_bowed = run.rows.iter().any(|row| row.bow != [0.0; BOWS]);
    let most = most.min(run.rows.len() / IN_RUN);
    let halved = std::iter::successors(Some(most), |each| Some(each / 2));
    let joined = halved
        .take_while(|&each| each >= WORTH && !is_bowed)
        .find_map(|each| means_of(run, each));
    joined.map_or_else(|| run.clone(), |rows| run.with(rows))
}

/// The means of this many rows each, or fewer before a gap; `None` if the wave moves too much between them.
fn means_of(run: &Run, each: usize) -> Option<Vec<Row>> {
    let mut joined = Vec::new();
    for piece in run.pieces(GAP) {
        let first = joined.len();
        joined.extend(piece.chunks(each).map(mean));
        if !joined[first..].windows(2).all(is_slow) {
            return None;
        }
    }
    Some(joined)
}

/// The mean of rows, of which the middle one gives what has no mean.
fn mean(rows: &[Row]) -> Row {
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let count = rows.len() as f64;
    let mean = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).sum::<f64>() / count;
    Row {
        time: mean(&|row| row.time),
        main: mean(&|row| row.main),
        quadrature: mean(&|row| row.quadrature),
        angle: first.angle + mean(&|row| turn(row.angle - first.angle)),
        deviations: [0, 1, 2].map(|i| mean(&|row| row.deviations[i]) / count.sqrt()),
        seconds: last.time - first.time + first.seconds,
        ..rows[rows.len() / 2]
    }
}

/// True if a wave moves little from one mean to the next.
fn is_slow(pair: &[Row]) -> bool {
    let [row, next] = pair else {
        return true;
    };
    let turned = turn(next.angle - row.angle).abs();
    let noise = [0, 1, 2].map(|i| BY_NOISE * row.deviations[i].hypot(next.deviations[i]));
    let changes = [next.main - row.main, next.quadrature - row.quadrature];
    turned < MAX_TURN + noise[2]
        && changes
            .iter()
            .zip(noise)
            .all(|(change, noise)| change.abs() < MAX_CHANGE * row.main + noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use antinode_sim::Deviates;

    /// A run of this many rows 0.01 s apart whose pattern turns by `turn` from row to row, with noise of 10⁻³.
    fn run(count: usize, turn: f64, seed: u64) -> Run {
        let mut random = Deviates::new(seed);
        let row = |k: usize| {
            let at = k as f64;
            let wave = [1.0, 0.1, turn * at].map(|value| value + 1e-3 * random.draw());
            Row {
                seconds: 0.01,
                ..Row::of(0.01 * at, wave, [1e-3; 3])
            }
        };
        Run {
            rows: (0..count).map(row).collect(),
            file: "a".to_owned(),
        }
    }

    #[test]
    fn means_are_those_of_longer_windows() {
        let run = run(100_000, 1e-3, 1);
        let [joined] = &joined(std::slice::from_ref(&run)).unwrap()[..] else {
            panic!("a run stays one");
        };
        assert_eq!(joined.rows.len(), 10_000);
        let mut squares = [0.0; 3];
        for (index, row) in joined.rows.iter().enumerate() {
            let middle = 10.0 * index as f64 + 4.5;
            assert!((row.time - 0.01 * middle).abs() < 1e-9 && (row.seconds - 0.1).abs() < 1e-9);
            let errors = [
                row.main - 1.0,
                row.quadrature - 0.1,
                turn(row.angle - 1e-3 * middle),
            ];
            for (square, (error, deviation)) in
                squares.iter_mut().zip(errors.iter().zip(row.deviations))
            {
                *square += (error / deviation).powi(2) / joined.rows.len() as f64;
            }
        }
        for square in squares {
            assert!((square - 1.0).abs() < 0.06, "{squares:?}");
        }
    }

    #[test]
    fn few_rows_fast_patterns_and_known_bows_stay_as_they_are() {
        assert!(joined(&[run(39_999, 1e-3, 1)]).is_none());
        assert!(joined(&[run(40_000, 1e-3, 1)]).is_some());
        // Five rows must not turn by more than 0.2 rad.
        assert!(joined(&[run(100_000, 0.038, 1)]).is_some());
        assert!(joined(&[run(100_000, 0.042, 1)]).is_none());
        let mut swinging = run(100_000, 1e-3, 1);
        swinging.rows[50_000].bow[0] = 0.1;
        assert!(joined(&[swinging]).is_none());
        let mut dying = run(100_000, 1e-3, 1);
        for (k, row) in dying.rows.iter_mut().enumerate() {
            row.main *= (-0.01 * k as f64).exp();
        }
        assert!(joined(&[dying]).is_none());
    }

    #[test]
    fn no_mean_spans_a_gap_and_short_runs_keep_enough_rows() {
        let mut long = run(100_000, 1e-3, 1);
        long.rows.drain(50_007..50_100);
        let short = run(350, 1e-3, 2);
        let joined = joined(&[long, short]).unwrap();
        assert_eq!(joined[0].rows.len(), 5_001 + 4_990);
        assert_eq!(joined[1].rows.len(), 350);
        let lengths = joined[0].rows.iter().map(|row| row.seconds);
        assert!(lengths.fold(0.0, f64::max) < 0.101);
    }
}
