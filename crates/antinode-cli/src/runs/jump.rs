//! Whether the wave that stands behind rows left out is still the one before them: a fault in a window may have moved it.

use super::{Row, turn};

/// Rows that tell how fast the wave changes.
const KNOWN: usize = 5;
/// So many times as fast as the fastest of these changes it may go on.
const FASTER: f64 = 3.0;
/// Deviations that a change may be beyond that.
const SIGMAS: f64 = 8.0;

/// True where the main amplitude, the quadrature amplitude or the angle jumps from the last of the `rows` of a run to `next`; not where
/// the run is too short to tell.
pub fn jumps(rows: &[Row], next: &Row) -> bool {
    let Some(known) = rows.last_chunk::<KNOWN>() else {
        return false;
    };
    let last = &known[KNOWN - 1];
    (0..3).any(|i| {
        let rates = known
            .windows(2)
            .map(|pair| change(&pair[0], &pair[1], i).abs() / (pair[1].time - pair[0].time));
        let likely = FASTER * rates.fold(0.0, f64::max) * (next.time - last.time);
        let noise = last.deviations[i].hypot(next.deviations[i]);
        change(last, next, i).abs() > likely + SIGMAS * noise
    })
}

/// By how much the value whose deviation is number `index` changes.
fn change(from: &Row, to: &Row, index: usize) -> f64 {
    match index {
        0 => to.main - from.main,
        1 => to.quadrature - from.quadrature,
        _ => turn(to.angle - from.angle),
    }
}
