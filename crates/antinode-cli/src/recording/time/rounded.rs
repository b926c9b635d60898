//! Equal steps of times that are rounded to about a sample or more, so that they look uneven.

use super::super::printed::Printed;
use super::{MIN_REGULAR, SAME_RATE, STEP_TOLERANCE};

/// Parts of the times, of which one must be without a fault.
const PARTS: [usize; 4] = [1, 2, 4, 8];

/// Largest share of the whole time that rounding may hide.
const MAX_HIDDEN: f64 = 2e-3;

/// Most searches for a contradiction; a few find the steps.
const MAX_SEARCHES: usize = 64;

/// The least and the greatest step, s, of samples at equal distances that are printed as these times, or as one of the largest parts of them
/// without a fault; none if there is no such step, or if it is too uncertain.
pub(super) fn steps(times: &[f64], printed: Printed) -> Option<[f64; 2]> {
    let parts = |&count: &usize| times.chunks(times.len().div_ceil(count).max(1));
    let mut parts = PARTS.iter().flat_map(parts);
    parts.find_map(|part| steps_of_all(part, printed))
}

fn steps_of_all(times: &[f64], printed: Printed) -> Option<[f64; 2]> {
    let [first, .., last] = times else {
        return None;
    };
    let runs = || times.chunk_by(|a, b| a == b).map(<[f64]>::len);
    // Pairs may be minima and maxima, some of them torn by a fault.
    let unpaired = runs().filter(|&length| length != 2).count();
    if runs().count() <= MIN_REGULAR || unpaired <= 2 + runs().count() / 100 {
        return None;
    }
    let count = (times.len() - 1) as f64;
    let usual = (last - first) / count;
    let bounds: Vec<[f64; 2]> = times
        .iter()
        .map(|time| (time - first, printed.error(*time) + STEP_TOLERANCE * usual))
        .map(|(time, error)| [time - error, time + error])
        .collect();
    let ends = [bounds[0], bounds[times.len() - 1]];
    let least = narrowed(&bounds, (ends[1][0] - ends[0][1]) / count, 1.0);
    let most = narrowed(&bounds, (ends[1][1] - ends[0][0]) / count, -1.0);
    let is_certain = most - least <= SAME_RATE * least;
    // Lost samples that do not show narrow the range, and move it by up to their share.
    let is_long = ends[1][1] - ends[1][0] <= MAX_HIDDEN * (last - first);
    let explains = least <= most && contradiction(&bounds, 0.5 * (least + most)).is_none();
    (is_certain && is_long && explains).then_some([least, most])
}

/// Moves one end of the range of steps inwards, up or down by this `sign`, as far as contradictions demand it.
fn narrowed(bounds: &[[f64; 2]], mut end: f64, sign: f64) -> f64 {
    for _ in 0..MAX_SEARCHES {
        match contradiction(bounds, end) {
            Some(bound) if sign * (bound - end) > f64::EPSILON * end.abs() => end = bound,
            _ => break,
        }
    }
    end
}

/// The bound that the two samples which contradict this step most set to it; none if there is no contradiction.
fn contradiction(bounds: &[[f64; 2]], step: f64) -> Option<f64> {
    let (mut late, mut early) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
    for (at, [earliest, latest]) in bounds.iter().enumerate() {
        let since = at as f64 * step;
        if earliest - since > late.0 {
            late = (earliest - since, at);
        }
        if latest - since < early.0 {
            early = (latest - since, at);
        }
    }
    let apart = late.1 as f64 - early.1 as f64;
    (late.0 > early.0).then(|| (bounds[late.1][0] - bounds[early.1][1]) / apart)
}
