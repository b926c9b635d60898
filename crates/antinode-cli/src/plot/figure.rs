//! The contents of the figure: panels over one time axis, and marks where rows are flagged.

use std::ops::Range;

use super::axis::{Axis, Scale};
use super::panel::{Panel, panel};
use super::reduce::column;
use super::rows::{QUANTITIES, Row, Trace, Trust, span};

/// Length of the time axis of a single row, s.
const SINGLE_ROW: f64 = 1.0;
/// Margins before and after all rows, as a share of their span.
const MARGIN: f64 = 0.01;
/// Distance of times from 0, in spans, from which on they are shown as differences.
const MIN_FAR: f64 = 1e4;

/// The figure.
#[derive(Debug)]
pub struct Figure {
    pub time: Axis,
    pub panels: Vec<Panel>,
    /// Spans of columns that hold flagged rows, in the time axis's numbers.
    pub flagged: Vec<Range<f64>>,
}

/// The figure of some traces, `columns` pixels wide, with logarithmic axes for amplitudes and residual if `is_log`; `None` if no row has
/// a number.
pub fn figure(traces: &[Trace], columns: usize, is_log: bool) -> Option<Figure> {
    let rows = || traces.iter().flat_map(|trace| &trace.rows);
    let [first, last] = span(traces)?;
    let missing = if last > first { 0.0 } else { SINGLE_ROW / 2.0 };
    let margin = MARGIN * (last - first + 2.0 * missing);
    let span = first - missing - margin..last + missing + margin;
    let (scale, title) = time_scale(&span, first);
    let time = scale.axis(title, &span);
    let panels: Vec<_> = (0..QUANTITIES.len())
        .map(|quantity| panel(traces, quantity, is_log, (&span, scale, columns)))
        .collect();
    let mut pieces = panels.iter().flat_map(|panel| &panel.curves);
    if pieces.all(Vec::is_empty) {
        return None;
    }
    let flagged = flagged(rows(), &span, columns)
        .into_iter()
        .map(|range| scale.of(range.start)..scale.of(range.end))
        .collect();
    Some(Figure {
        time,
        panels,
        flagged,
    })
}

/// The scale and the title of the time axis: times of a clock that began long ago are relative to their first whole second.
fn time_scale(span: &Range<f64>, first: f64) -> (Scale, String) {
    let is_far = span.start.abs().max(span.end.abs()) > MIN_FAR * (span.end - span.start);
    let less = if is_far { first.floor() } else { 0.0 };
    let title = match less {
        0.0 => "time, s".to_owned(),
        less => format!("time − {less} s, s"),
    };
    (Scale::Linear { less, times: 1.0 }, title)
}

/// Spans of columns that hold flagged rows.
fn flagged<'a>(
    rows: impl Iterator<Item = &'a Row>,
    span: &Range<f64>,
    columns: usize,
) -> Vec<Range<f64>> {
    let mut has = vec![false; columns];
    for row in rows {
        if row.trust != Trust::Clean {
            has[column(row.time, span, columns)] = true;
        }
    }
    let at = |column: usize| span.start + (span.end - span.start) * column as f64 / columns as f64;
    let mut spans = Vec::new();
    let mut from = 0;
    for of in has.chunk_by(|one, next| one == next) {
        let to = from + of.len();
        if of[0] {
            spans.push(at(from)..at(to));
        }
        from = to;
    }
    spans
}
