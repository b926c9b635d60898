//! Equal steps of times that are rounded to about a sample or more, so that they look uneven.

use super::super::printed::Printed;
use super::phase::Phase;
use super::{MIN_REGULAR, SAME_RATE, STEP_TOLERANCE};

/// Parts of the times, of which one must be without a fault.
const PARTS: [usize; 4] = [1, 2, 4, 8];

/// Largest share of the whole time that rounding may hide.
const MAX_HIDDEN: f64 = 2e-3;

/// Most searches for a contradiction; a few find the steps.
const MAX_SEARCHES: usize = 64;

/// Samples at equal distances that explain rounded times.
pub(super) struct Steps {
    /// The least and the greatest distance, s.
    pub range: [f64; 2],
    /// The number of one of the times, and where its sample lies.
    pub at: usize,
    pub phase: Phase,
}

impl Steps {
    /// Those of which these times are printed, or one of the largest parts of them without a fault; none if there are none, or if they are
    /// too uncertain.
    pub fn of(times: &[f64], printed: Printed) -> Option<Self> {
        let parts = |&count: &usize| {
            let length = times.len().div_ceil(count).max(1);
            times.chunks(length).zip((0..).step_by(length))
        };
        let mut parts = PARTS.iter().flat_map(parts);
        parts.find_map(|(part, at)| {
            let (range, phase) = steps_of_all(part, printed)?;
            Some(Self { range, at, phase })
        })
    }
}

/// The least and the greatest step that explain all of these times, s, and where the first sample lies.
fn steps_of_all(times: &[f64], printed: Printed) -> Option<([f64; 2], Phase)> {
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
    let step = 0.5 * (least + most);
    let explains = least <= most && contradiction(&bounds, step).is_none();
    let [(latest, _), (earliest, _)] = extremes(&bounds, step);
    let phase = Phase::between(first + latest, first + earliest).widened((most - step) * count);
    (is_certain && is_long && explains).then_some(([least, most], phase))
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
    let [late, early] = extremes(bounds, step);
    let apart = late.1 as f64 - early.1 as f64;
    (late.0 > early.0).then(|| (bounds[late.1][0] - bounds[early.1][1]) / apart)
}

/// When the first sample was taken, after which and before which one, by these bounds of all samples and this step; and which of these tell.
fn extremes(bounds: &[[f64; 2]], step: f64) -> [(f64, usize); 2] {
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
    [late, early]
}
