//! Whether a column of a text is its time.

use super::Line;
use crate::median::ends;
use crate::recording::number::number;

/// Largest ratio of the longest step of a time to the shortest, which rounding makes uneven.
pub(in crate::recording) const MAX_STEP_RATIO: f64 = 1.5;

/// The same if nothing else suggests a time: a wave bends more within these lines, even at 1024 samples a period.
pub(super) const MAX_STEP_RATIO_ALONE: f64 = 1.0001;

/// Whether a column goes up by the same step, within `max_ratio`, from each of these lines to the next.
pub(super) fn is_clock(rows: &[Line], column: usize, separator: u8, max_ratio: f64) -> bool {
    let time = |line: &Line| {
        let time = number::<f64>(line.fields.get(column)?, separator)?;
        time.is_finite().then_some(time)
    };
    let times: Option<Vec<f64>> = rows.iter().map(time).collect();
    times.is_some_and(|times| are_even(&times, max_ratio))
}

/// Whether these values go up by the same step, within `max_ratio`.
pub(in crate::recording) fn are_even(values: &[f64], max_ratio: f64) -> bool {
    let [least, most] = ends(values.windows(2).map(|pair| pair[1] - pair[0]));
    least > 0.0 && most <= max_ratio * least
}

/// Whether a column has a number in these lines that is not whole.
pub(super) fn has_fractions(rows: &[Line], column: usize, separator: u8) -> bool {
    let fields = rows.iter().filter_map(|line| line.fields.get(column));
    let mut numbers = fields.filter_map(|field| number::<f64>(field, separator));
    numbers.any(|number| number.fract() != 0.0)
}
