//! Draws a panel as SVG and PNG.

use std::error::Error;
use std::fs;
use std::io;
use std::path::Path;

use plotters::coord::Shift;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;

use super::figure::{Curve, Figure, Name, Panel};
use crate::canvas::{self, FONT};
use crate::digits::significant;
use crate::failure::{Failure, unwritable};

/// Width and height, pixels.
const SIZE: (u32, u32) = (960, 600);
/// Size of the caption, pixels: the longest one fits even if a viewer's font is a quarter wider.
const CAPTION: u32 = 17;
/// Width of the legend, right of the chart, pixels.
const KEY_WIDTH: u32 = 220;
/// A bound's dashes and the gaps between them, pixels.
const DASH: (u32, u32) = (7, 5);

/// Writes `path`.svg and `path`.png.
pub fn write(path: &Path, figure: &Figure, panel: &Panel) -> Result<(), Failure> {
    canvas::register_fonts();
    let [svg, png] = ["svg", "png"].map(|ending| path.with_extension(ending));
    let failed = |path: &Path, fault| unwritable(&path.display().to_string(), &fault);
    let mut text = String::new();
    draw(
        &SVGBackend::with_string(&mut text, SIZE).into_drawing_area(),
        figure,
        panel,
    )
    .map_err(|error| failed(&svg, io::Error::other(error.to_string())))?;
    fs::write(&svg, text).map_err(|fault| failed(&svg, fault))?;
    draw(
        &BitMapBackend::new(&png, SIZE).into_drawing_area(),
        figure,
        panel,
    )
    .map_err(|_| failed(&png, canvas::not_stored()))
}

fn draw<B: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<B, Shift>,
    figure: &Figure,
    panel: &Panel,
) -> Result<(), Box<dyn Error>> {
    area.fill(&WHITE)?;
    let (area, beside) = area.split_horizontally(SIZE.0 - KEY_WIDTH);
    key(&beside, panel)?;
    let values = || {
        panel
            .curves
            .iter()
            .flat_map(|curve| points(figure, panel, curve))
            .map(|(_, y)| y)
    };
    let max = values().fold(f64::MIN_POSITIVE, f64::max);
    let min = values().filter(|&y| y > 0.0).fold(max, f64::min);
    let (first, last) = (
        figure.x.first().copied().unwrap_or(0.0),
        figure.x.last().copied().unwrap_or(1.0),
    );
    let margin = 0.02 * (last - first);
    let across = first - margin..last + margin;
    let mut builder = ChartBuilder::on(&area);
    builder
        .caption(
            format!("Figure {}{}: {}", figure.number, panel.letter, panel.title),
            (FONT, CAPTION),
        )
        .margin(12)
        .x_label_area_size(48)
        .y_label_area_size(84);
    if panel.logarithmic {
        let chart = builder.build_cartesian_2d(across, (0.5 * min..2.0 * max).log_scale())?;
        fill(chart, figure, panel, &|y| format!("{y:.0e}"))
    } else {
        let chart = builder.build_cartesian_2d(across, 0.0..1.05 * max)?;
        fill(chart, figure, panel, &|&y| printed(y))
    }
}

/// A number at an axis, without the rounding errors of the steps that led to it.
fn printed(x: f64) -> String {
    significant(x, 9).to_string()
}

/// The points of a curve that are drawn. Points without noise have no logarithm of the bound; figures 1 and 2 show their errors.
fn points(figure: &Figure, panel: &Panel, curve: &Curve) -> Vec<(f64, f64)> {
    let all = figure.x.iter().copied().zip(curve.y.iter().copied());
    all.filter(|&(x, y)| y.is_finite() && !(panel.logarithmic && x == 0.0))
        .collect()
}

fn fill<'a, B, Y>(
    mut chart: ChartContext<'a, B, Cartesian2d<plotters::coord::types::RangedCoordf64, Y>>,
    figure: &Figure,
    panel: &Panel,
    label: &dyn Fn(&f64) -> String,
) -> Result<(), Box<dyn Error>>
where
    B: DrawingBackend<ErrorType: 'static> + 'a,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    chart
        .configure_mesh()
        .x_desc(figure.axis)
        .y_desc(panel.axis)
        .axis_desc_style((FONT, 18))
        .label_style((FONT, 15))
        .light_line_style(RGBColor(240, 240, 240))
        .bold_line_style(canvas::GRID)
        .x_labels(11)
        .x_max_light_lines(0)
        .y_max_light_lines(if panel.logarithmic { 1 } else { 0 })
        .x_label_formatter(&|&x| printed(x))
        .y_label_formatter(&|y| label(y))
        .draw()?;
    for curve in &panel.curves {
        let (color, width) = style(curve.name);
        let points = points(figure, panel, curve);
        let line = color.stroke_width(width);
        if curve.name.is_bound() {
            chart.draw_series(DashedLineSeries::new(points, DASH.0, DASH.1, line))?;
        } else {
            chart.draw_series(LineSeries::new(points.iter().copied(), line))?;
            chart.draw_series(
                points
                    .iter()
                    .map(|&point| Circle::new(point, 3, color.filled())),
            )?;
        }
    }
    chart.plotting_area().present()?;
    Ok(())
}

/// Draws the legend.
fn key<B: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<B, Shift>,
    panel: &Panel,
) -> Result<(), Box<dyn Error>> {
    for (row, curve) in (0..).zip(&panel.curves) {
        let (color, width) = style(curve.name);
        let y = 60 + 26 * row;
        let line = color.stroke_width(width);
        if curve.name.is_bound() {
            for x in [
                4,
                4 + (DASH.0 + DASH.1) as i32,
                4 + 2 * (DASH.0 + DASH.1) as i32,
            ] {
                area.draw(&PathElement::new([(x, y), (x + DASH.0 as i32, y)], line))?;
            }
        } else {
            area.draw(&PathElement::new([(4, y), (34, y)], line))?;
            area.draw(&Circle::new((19, y), 3, color.filled()))?;
        }
        area.draw(&Text::new(curve.name.text(), (42, y - 8), (FONT, 16)))?;
    }
    Ok(())
}

/// A curve's colour and width.
fn style(name: Name) -> (RGBColor, u32) {
    match name {
        Name::Algorithm1 => (canvas::ORANGE, 2),
        Name::Algorithm2 => (canvas::SKY_BLUE, 2),
        Name::Algorithm3 => (canvas::GREEN, 2),
        Name::Algorithm4 => (canvas::VERMILLION, 2),
        Name::MeanReturn => (canvas::GREY, 2),
        Name::Difference => (canvas::PURPLE, 2),
        Name::Fractional => (RGBColor(0, 70, 140), 1),
        Name::Exact => (RGBColor(0, 0, 0), 3),
        Name::Bound => (RGBColor(200, 0, 0), 2),
        Name::CentredBound => (RGBColor(200, 120, 120), 2),
        Name::Deviation => (canvas::BLUE, 2),
    }
}
