//! The way of a pattern across rows left out: their waves are not steady, but their angles still show where it went.

use nalgebra::{DMatrix, DVector};

use super::row::{BOWS, Row};
use super::turn;

/// Rows left out that show a way, at least: a single one may be due to a fault.
const MIN_ROWS: usize = 2;
/// Rms that the curve may leave, as a share of the angles' departure from a steady turn: with more, something else moved them.
const MAX_LEFT: f64 = 0.3;

/// Departure of a pattern from a steady turn between two rows, as [`Row::bow`], if the times and angles of rows `between` show one,
/// for example because a table speeds up; 0 if they do not.
pub fn bow(from: &Row, to: &Row, between: &[[f64; 2]]) -> [f64; BOWS] {
    let mut bow = [0.0; BOWS];
    if between.len() < MIN_ROWS {
        return bow;
    }
    let unknowns = BOWS.min(between.len() - 1);
    let seconds = to.time - from.time;
    let share = |index: usize| (between[index][0] - from.time) / seconds;
    let whole = turn(to.angle - from.angle);
    let beside = DVector::from_fn(between.len(), |index, _| {
        turn(between[index][1] - from.angle) - share(index) * whole
    });
    // A row has the mean over its window, taken here by Simpson's rule.
    let half = 0.5 * to.seconds / seconds;
    let lines = DMatrix::from_fn(between.len(), unknowns, |index, i| {
        let at = |by: f64| Row::curves(share(index) + by * half)[i];
        (at(-1.0) + 4.0 * at(0.0) + at(1.0)) / 6.0
    });
    let Some(inverse) = lines.tr_mul(&lines).try_inverse() else {
        return bow;
    };
    let found = inverse * lines.tr_mul(&beside);
    let left = (&beside - lines * &found).norm();
    if left < MAX_LEFT * beside.norm() {
        bow[..unknowns].copy_from_slice(found.as_slice());
    }
    bow
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The turn of a pattern whose table speeds up to 0.3 rad/s within half a second.
    fn angle(time: f64) -> f64 {
        let begun = (time - 0.13).clamp(0.0, 0.5);
        0.3 * (begun * begun + (time - 0.63).max(0.0))
    }

    fn row(time: f64) -> Row {
        Row::of(time, [1.0, 0.0, 0.7 + angle(time)], [1e-4; 3])
    }

    #[test]
    fn a_table_that_speeds_up_among_rows_left_out_is_followed() {
        let (from, mut to) = (row(0.0), row(0.8));
        let between: Vec<_> = (1..8).map(|k| 0.1 * f64::from(k)).collect();
        let between: Vec<_> = between
            .into_iter()
            .map(|time| [time, row(time).angle])
            .collect();
        let off = |to: &Row| {
            let each = (0..=100).map(|k| 0.01 * f64::from(k));
            each.map(|share| to.turned(&from, share) - angle(0.8 * share))
                .sum::<f64>()
                / 101.0
        };
        let steadily = off(&to);
        to.bow = bow(&from, &to, &between);
        assert!(steadily > 0.02, "{steadily}");
        assert!(off(&to).abs() < 0.02 * steadily, "{} {steadily}", off(&to));
    }

    #[test]
    fn scattered_angles_are_not_followed() {
        let (from, to) = (row(0.0), row(0.8));
        let scattered = [[0.2, 0.8], [0.3, 0.6], [0.4, 0.9], [0.5, 0.65], [0.6, 0.8]];
        assert_eq!(bow(&from, &to, &scattered), [0.0; BOWS]);
        assert_eq!(bow(&from, &to, &[[0.3, 0.9]]), [0.0; BOWS]);
    }
}
