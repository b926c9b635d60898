//! The panel of a quantity: its axis, and the lines in it.

use std::f64::consts::PI;
use std::ops::Range;

use super::axis::{Axis, Scale};
use super::extent::{Extent, Measured};
use super::numbers::{decimals, drawable, factor, frequency_unit};
use super::reduce::{Piece, Sample, column, reduce};
use super::rows::{QUANTITIES, Row, Trace, Trust};
use crate::median::median;

/// Titles of the panels, in the order of [`QUANTITIES`].
const TITLES: [&str; QUANTITIES.len()] = [
    "main amplitude",
    "quadrature amplitude",
    "pattern angle, °",
    "frequency",
    "residual rms",
];
const QUADRATURE: usize = 1;
const ANGLE: usize = 2;
const FREQUENCY: usize = 3;
const RESIDUAL: usize = 4;
/// Span of an axis, at least, as a share of its values' magnitude: less is rounding, and would need too many digits.
const MIN_SPAN: f64 = 2e-6;
/// The same for the residual, which scatters far more.
const MIN_SPAN_OF_RESIDUAL: f64 = 0.02;
/// The same for the frequency, which has thirteen digits.
const MIN_SPAN_OF_FREQUENCY: f64 = 1e-11;
/// Margins above and below all values, as a share of their span.
const MARGIN: f64 = 0.08;
/// Columns that share one arrow to values beyond a panel.
const ARROW_COLUMNS: usize = 8;

/// The panel of one quantity.
#[derive(Debug)]
pub struct Panel {
    pub axis: Axis,
    /// The curves of each trace, in the axes' numbers.
    pub curves: Vec<Vec<Piece>>,
    /// Times at which values lie beyond the panel, and whether above it.
    pub beyond: Vec<(f64, bool)>,
}

/// The value of a row's quantity to be drawn, with its deviation; `None` without a number. Logarithms are those of its magnitude.
fn sample(row: &Row, quantity: usize, is_log: bool) -> Option<(f64, f64)> {
    let value = drawable(row.values[quantity])?;
    let deviation = f64::from(row.deviations[quantity]);
    let known = deviation.is_finite() && deviation > 0.0;
    let value = if is_log { value.abs() } else { value };
    (row.trust != Trust::Lost).then_some((value, if known { deviation } else { 0.0 }))
}

/// The panel of a quantity over this span, scale and number of columns of time; logarithmic for amplitudes and residual if `is_log`.
pub fn panel(
    traces: &[Trace],
    quantity: usize,
    is_log: bool,
    (span, time, columns): (&Range<f64>, Scale, usize),
) -> Panel {
    let is_log = is_log && !matches!(quantity, ANGLE | FREQUENCY);
    let (axis, range, scale) = axis(traces, quantity, is_log);
    let mut beyond = vec![[None; 2]; columns.div_ceil(ARROW_COLUMNS)];
    let curves = traces
        .iter()
        .map(|trace| {
            let samples = trace.rows.iter().map(|row| Sample {
                time: row.time,
                value: sample(row, quantity, is_log),
                begins: row.begins,
            });
            let mut pieces = reduce(samples, span, columns);
            for piece in &mut pieces {
                for &(at, value) in &piece.line {
                    let sides = &mut beyond[column(at, span, columns) / ARROW_COLUMNS];
                    for (side, is_beyond) in sides
                        .iter_mut()
                        .zip([value < range.start, value > range.end])
                    {
                        if is_beyond {
                            let (first, last) = side.unwrap_or((at, at));
                            *side = Some((at.min(first), at.max(last)));
                        }
                    }
                }
                on_axes(piece, time, scale, &axis.range);
            }
            pieces
        })
        .collect();
    Panel {
        axis,
        curves,
        beyond: beyond_at(&beyond, time),
    }
}

/// The axis of a quantity, the range of its values, and their scale.
fn axis(traces: &[Trace], quantity: usize, is_log: bool) -> (Axis, Range<f64>, Scale) {
    let extent = extent(traces, quantity, is_log);
    if is_log {
        let range = extent.log_range().unwrap_or(0.1..1.0);
        let title = match quantity {
            QUADRATURE => format!("|{}|", TITLES[quantity]),
            _ => TITLES[quantity].to_owned(),
        };
        let scale = Scale::Logarithmic;
        return (scale.axis(title, &range), range, scale);
    }
    let min_span = match (quantity, extent.size()) {
        // If all are 0, their deviations give the span.
        (_, 0.0) if extent.has_deviation() => 0.0,
        (_, 0.0) => 1.0,
        (FREQUENCY, size) => MIN_SPAN_OF_FREQUENCY * size,
        (RESIDUAL, size) => MIN_SPAN_OF_RESIDUAL * size,
        (_, size) => MIN_SPAN * size,
    };
    // A quantity without a number has an empty panel.
    let range = extent.range(min_span, MARGIN).unwrap_or(0.0..1.0);
    let (scale, title) = scale(traces, quantity, &range, extent.size());
    (scale.axis(title, &range), range, scale)
}

/// The times of arrows, in the middle between the first and the last value of a place beyond the panel; and whether above.
fn beyond_at(places: &[[Option<(f64, f64)>; 2]], time: Scale) -> Vec<(f64, bool)> {
    let sides = places
        .iter()
        .flat_map(|&[below, above]| [(below, false), (above, true)]);
    sides
        .filter_map(|(times, is_above)| {
            let (first, last) = times?;
            Some((time.of(0.5 * (first + last)), is_above))
        })
        .collect()
}

/// The values that a quantity's axis is to hold.
fn extent(traces: &[Trace], quantity: usize, is_log: bool) -> Extent {
    let rows = traces.iter().flat_map(|trace| &trace.rows);
    let drawn: Vec<_> = rows
        .filter_map(|row| {
            let (value, deviation) = sample(row, quantity, is_log)?;
            // 0 has no logarithm.
            let is_drawn = !is_log || value > 0.0;
            is_drawn.then_some(Measured {
                value,
                deviation,
                is_clean: row.trust == Trust::Clean,
            })
        })
        .collect();
    Extent::of(&drawn)
}

/// The scale of a quantity, and the title that states it.
fn scale(traces: &[Trace], quantity: usize, range: &Range<f64>, size: f64) -> (Scale, String) {
    let title = TITLES[quantity];
    let (less, times, title) = match quantity {
        ANGLE => (0.0, 180.0 / PI, title.to_owned()),
        FREQUENCY => {
            let wide = range.end - range.start;
            let (unit, times) = frequency_unit(wide / 2.0);
            let decimals = decimals(wide / 100.0);
            let middle = median_frequency(traces);
            // Exactly the printed value is subtracted.
            let text = format!("{middle:.decimals$}");
            let less = text.parse().unwrap_or(middle);
            let title = format!("{title} less its median of {text} Hz, {unit}");
            (less, times, title)
        }
        _ => {
            let (times, text) = factor(if size > 0.0 { size } else { range.end });
            (0.0, times, format!("{title}{text}"))
        }
    };
    (Scale::Linear { less, times }, title)
}

/// The median frequency of the clean rows if most are clean, or else of all.
fn median_frequency(traces: &[Trace]) -> f64 {
    let rows = traces.iter().flat_map(|trace| &trace.rows);
    let (mut all, mut clean) = (Vec::new(), Vec::new());
    for row in rows {
        let Some((frequency, _)) = sample(row, FREQUENCY, false) else {
            continue;
        };
        all.push(frequency);
        if row.trust == Trust::Clean {
            clean.push(frequency);
        }
    }
    let frequencies = if 2 * clean.len() > all.len() {
        &mut clean
    } else {
        &mut all
    };
    median(frequencies).unwrap_or(0.0)
}

/// Converts a piece to the axes' scales; values beyond the panel are put at its edge.
fn on_axes(piece: &mut Piece, time: Scale, scale: Scale, range: &Range<f64>) {
    // Far below the range, plotters' integers overflow, and the value would be drawn at the upper edge.
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

#[cfg(test)]
mod tests {
    use super::super::figure::{Figure, figure};
    use super::super::rows::read;
    use super::*;
    use crate::row_file::RowFile;

    /// The figure of a recording whose third row is this.
    fn with(row: &str) -> Figure {
        let mut text = "time_s,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,residual_rms,flags\n".to_owned();
        for time in 0..6 {
            text += &match time {
                2 => format!("2,{row}\n"),
                _ => format!("{time},0.{time},NaN,0.{time},533{time},0.{time},\n"),
            };
        }
        let traces =
            read(RowFile::new("it", std::io::Cursor::new(text.to_owned())).unwrap()).unwrap();
        figure(&traces, 800, false).unwrap()
    }

    #[test]
    fn values_far_beyond_a_panel_are_drawn_at_its_edge() {
        for wild in ["-1e12", "1e12", "-900", "1e289"] {
            let figure = with(&format!("{wild},NaN,{wild},{wild},{wild},misfit"));
            for quantity in [0, ANGLE, FREQUENCY, RESIDUAL] {
                let Panel {
                    axis,
                    curves,
                    beyond,
                } = &figure.panels[quantity];
                let Range { start, end } = axis.range;
                let edge = if wild.starts_with('-') { start } else { end };
                let line = &curves[0][0].line;
                assert_eq!(line[2].1, edge, "{wild}: {}", axis.title);
                assert_eq!(beyond.len(), 1, "{beyond:?}");
                assert_eq!(beyond[0], (line[2].0, !wild.starts_with('-')));
                assert!(line.iter().all(|(_, value)| (start..=end).contains(value)));
            }
        }
    }

    #[test]
    fn a_quantity_without_a_number_has_an_empty_panel() {
        let Panel {
            axis,
            curves,
            beyond,
        } = &with("0.2,NaN,0.2,5332,0.2,").panels[1];
        assert_eq!((axis.title.as_str(), &axis.range), (TITLES[1], &(0.0..1.0)));
        assert!(curves[0].is_empty() && beyond.is_empty());
    }
}
