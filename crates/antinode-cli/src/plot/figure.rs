//! What the figure holds: panels with their axes, and the lines in them.

use std::f64::consts::PI;
use std::ops::Range;

use super::reduce::{Piece, Sample, column, reduce};
use super::rows::{COLUMNS, Row, Trace, Trust, median};
use super::scale::{Extent, decimals, drawable, factor, frequency_unit};

/// Titles of the panels, in the order of [`COLUMNS`].
const TITLES: [&str; COLUMNS.len()] = [
    "main amplitude",
    "quadrature amplitude",
    "pattern angle, °",
    "frequency",
    "residual rms",
];
const ANGLE: usize = 2;
const FREQUENCY: usize = 3;
const RESIDUAL: usize = 4;
/// An axis spans no less than this share of its numbers' size: less is rounding, and would need too many digits.
const LEAST_SHARE: f64 = 2e-6;
/// What is left over scatters far more than that.
const LEAST_OF_RESIDUAL: f64 = 0.02;
/// Frequencies have thirteen digits.
const LEAST_OF_FREQUENCY: f64 = 1e-11;
/// The time axis of one row, s.
const LONE: f64 = 1.0;
/// Margins beside all rows, and above and below all values, as shares of their span.
const BESIDE: f64 = 0.01;
const ABOVE: f64 = 0.08;
/// Times this many spans from 0 are told as differences.
const FAR: f64 = 1e4;

/// The figure.
#[derive(Debug)]
pub struct Figure {
    pub time: Axis,
    pub panels: Vec<Panel>,
    /// Columns that hold flagged rows, from and to, in the time axis's numbers.
    pub flagged: Vec<Range<f64>>,
}

/// An axis: its title, and the range of its numbers.
#[derive(Debug)]
pub struct Axis {
    pub title: String,
    pub range: Range<f64>,
}

/// A quantity.
#[derive(Debug)]
pub struct Panel {
    pub axis: Axis,
    /// Those of each trace, in the axes' numbers.
    pub curves: Vec<Vec<Piece>>,
}

/// What numbers become on an axis.
#[derive(Debug, Clone, Copy)]
struct Scale {
    less: f64,
    times: f64,
}

impl Scale {
    fn of(self, number: f64) -> f64 {
        (number - self.less) * self.times
    }

    fn axis(self, title: String, range: &Range<f64>) -> Axis {
        let range = self.of(range.start)..self.of(range.end);
        Axis { title, range }
    }
}

/// The figure of some traces, so many pixels wide; none where no row has a number.
pub fn figure(traces: &[Trace], columns: usize) -> Option<Figure> {
    let rows = || traces.iter().flat_map(|trace| &trace.rows);
    let mut extent = Extent::new();
    for row in rows() {
        extent.add(row.time, 0.0, true);
    }
    let span = extent.range(0.0, BESIDE)?;
    let span = match span.is_empty() {
        true => extent.range(LONE, BESIDE)?,
        false => span,
    };
    let (scale, title) = time_scale(
        &span,
        rows().map(|row| row.time).fold(f64::INFINITY, f64::min),
    );
    let time = scale.axis(title, &span);
    let panels: Vec<_> = (0..COLUMNS.len())
        .map(|quantity| panel(traces, quantity, &span, scale, columns))
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

/// Times of a clock that began long ago are told from their first second on.
fn time_scale(span: &Range<f64>, first: f64) -> (Scale, String) {
    let is_far = span.start.abs().max(span.end.abs()) > FAR * (span.end - span.start);
    let less = if is_far { first.floor() } else { 0.0 };
    let title = match less {
        0.0 => "time, s".to_owned(),
        less => format!("time − {less} s, s"),
    };
    (Scale { less, times: 1.0 }, title)
}

/// What is drawn of a row's quantity; none where it has no number.
fn sample(row: &Row, quantity: usize) -> Option<(f64, f64)> {
    let value = drawable(row.values[quantity])?;
    let deviation = f64::from(row.deviations[quantity]);
    let known = deviation.is_finite() && deviation > 0.0;
    (row.trust != Trust::Lost).then_some((value, if known { deviation } else { 0.0 }))
}

fn panel(
    traces: &[Trace],
    quantity: usize,
    span: &Range<f64>,
    time: Scale,
    columns: usize,
) -> Panel {
    let mut extent = Extent::new();
    for row in traces.iter().flat_map(|trace| &trace.rows) {
        if let Some((value, deviation)) = sample(row, quantity) {
            extent.add(value, deviation, row.trust == Trust::Clean);
        }
    }
    let least = match (quantity, extent.size()) {
        (_, 0.0) => 1.0,
        (FREQUENCY, size) => LEAST_OF_FREQUENCY * size,
        (RESIDUAL, size) => LEAST_OF_RESIDUAL * size,
        (_, size) => LEAST_SHARE * size,
    };
    // A quantity without a number has an empty panel.
    let range = extent.range(least, ABOVE).unwrap_or(0.0..1.0);
    let (scale, title) = scale(traces, quantity, &range, extent.size());
    let axis = scale.axis(title, &range);
    let curves = traces
        .iter()
        .map(|trace| {
            let samples = trace.rows.iter().map(|row| {
                let (value, deviation) = sample(row, quantity).unzip();
                Sample {
                    time: row.time,
                    value,
                    deviation: deviation.unwrap_or(0.0),
                    begins: row.begins,
                }
            });
            let mut pieces = reduce(samples, span, columns);
            for piece in &mut pieces {
                on_axes(piece, time, scale, &axis.range);
            }
            pieces
        })
        .collect();
    Panel { axis, curves }
}

/// How a quantity is told, and the title that says so.
fn scale(traces: &[Trace], quantity: usize, range: &Range<f64>, size: f64) -> (Scale, String) {
    let title = TITLES[quantity];
    match quantity {
        ANGLE => {
            let (less, times) = (0.0, 180.0 / PI);
            (Scale { less, times }, title.to_owned())
        }
        FREQUENCY => {
            let wide = range.end - range.start;
            let (unit, times) = frequency_unit(wide / 2.0);
            let decimals = decimals(wide / 100.0);
            let middle = median_frequency(traces);
            // What is told is what is taken off.
            let told = format!("{middle:.decimals$}");
            let less = told.parse().unwrap_or(middle);
            (
                Scale { less, times },
                format!("{title} less its median of {told} Hz, {unit}"),
            )
        }
        _ => {
            let (times, told) = factor(size);
            (Scale { less: 0.0, times }, format!("{title}{told}"))
        }
    }
}

/// That of the clean rows, or else of all.
fn median_frequency(traces: &[Trace]) -> f64 {
    let of = |is_used: fn(Trust) -> bool| {
        let rows = traces.iter().flat_map(|trace| &trace.rows);
        let mut numbers: Vec<_> = rows
            .filter(|row| is_used(row.trust))
            .filter_map(|row| Some(sample(row, FREQUENCY)?.0))
            .collect();
        median(&mut numbers)
    };
    of(|trust| trust == Trust::Clean)
        .or_else(|| of(|_| true))
        .unwrap_or(0.0)
}

/// Brings a piece to the axes' scales; what lies beyond the panel is held at its edge.
fn on_axes(piece: &mut Piece, time: Scale, scale: Scale, range: &Range<f64>) {
    // Far below the range plotters' whole numbers overflow, and it would be drawn at the upper edge.
    let held = |value| scale.of(value).clamp(range.start, range.end);
    for (t, value) in &mut piece.line {
        *t = time.of(*t);
        *value = held(*value);
    }
    for (t, edges) in &mut piece.band {
        *t = time.of(*t);
        *edges = edges.map(held);
    }
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

#[cfg(test)]
mod tests {
    use super::super::rows::read;
    use super::*;
    use crate::row_file::RowFile;

    /// The figure of a recording's rows, of which this is the third.
    fn with(row: &str) -> Figure {
        let mut text = "time_s,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,residual_rms,flags\n".to_owned();
        for time in 0..6 {
            text += &match time {
                2 => format!("2,{row}\n"),
                _ => format!("{time},0.{time},NaN,0.{time},533{time},0.{time},\n"),
            };
        }
        let traces = read(RowFile::new("it", text.as_bytes()).unwrap()).unwrap();
        figure(&traces, 800).unwrap()
    }

    #[test]
    fn what_lies_far_beyond_a_panel_is_at_its_edge() {
        for wild in ["-1e12", "1e12", "-900", "1e289"] {
            let figure = with(&format!("{wild},NaN,{wild},{wild},{wild},misfit"));
            for quantity in [0, ANGLE, FREQUENCY, RESIDUAL] {
                let Panel { axis, curves } = &figure.panels[quantity];
                let Range { start, end } = axis.range;
                let edge = if wild.starts_with('-') { start } else { end };
                let line = &curves[0][0].line;
                assert_eq!(line[2].1, edge, "{wild}: {}", axis.title);
                assert!(line.iter().all(|(_, value)| (start..=end).contains(value)));
            }
        }
    }

    #[test]
    fn a_quantity_without_a_number_has_an_empty_panel() {
        let Panel { axis, curves } = &with("0.2,NaN,0.2,5332,0.2,").panels[1];
        assert_eq!((axis.title.as_str(), &axis.range), (TITLES[1], &(0.0..1.0)));
        assert!(curves[0].is_empty());
    }
}
