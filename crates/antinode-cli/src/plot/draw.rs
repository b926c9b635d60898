//! The figure as SVG or PNG.

use std::error::Error;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::figure::Figure;
use super::legend::Legend;
use super::panel::Panel;
use super::reduce::Piece;
use super::values::{self, Values};
use crate::canvas::{self, FONT};
use crate::failure::{Failure, unknown_extension};
use crate::recording::extension;

/// Width of a panel's plotting area, in columns of pixels.
pub const COLUMNS: usize = 880;
/// Margins beside the panels, pixels.
const LEFT: u32 = 86;
const RIGHT: u32 = 24;
/// Space above each panel for its title, pixels.
const TITLE: u32 = 30;
/// Height of a panel, pixels.
const HEIGHT: u32 = 170;
/// Space below the last panel for the time axis, pixels.
const FOOT: u32 = 46;
pub(super) const WIDTH: u32 = LEFT + COLUMNS as u32 + RIGHT;
/// Sizes of titles and of numbers, pixels.
pub(super) const TEXT: u32 = 16;
const LABEL: u32 = 14;
/// Height of the marks of flagged rows.
const MARK: i32 = 7;
/// Width and height of the arrows to values beyond a panel.
pub(super) const ARROW: u32 = 6;
pub(super) const BEYOND: RGBColor = RGBColor(60, 60, 60);
pub(super) const FLAGGED: RGBColor = RGBColor(220, 0, 0);
/// Numbers along the time axis, at most.
const TIMES: usize = 11;

/// Properties of a format.
#[derive(Debug, Clone, Copy)]
struct Medium {
    /// Units of a drawing per pixel: coordinates are whole numbers of units.
    units: u32,
    /// False if lines are drawn segment by segment: plotters' wide lines in bitmaps grow spikes at sharp corners.
    joins: bool,
}

const SVG: Medium = Medium {
    units: 4,
    joins: true,
};
const PNG: Medium = Medium {
    units: 2,
    joins: false,
};
/// The format of a figure.
#[derive(Debug, Clone, Copy)]
pub enum Format {
    Svg,
    Png,
}

impl Format {
    /// The format that the ending of a file's name says.
    pub fn of(path: &Path) -> Result<Self, Failure> {
        match extension(path).as_str() {
            "svg" => Ok(Self::Svg),
            "png" => Ok(Self::Png),
            _ => Err(unknown_extension(
                &path.display().to_string(),
                ".svg or .png",
            )),
        }
    }
}

/// The text of an SVG.
pub fn svg(figure: &Figure, names: &[&str]) -> Result<String, Box<dyn Error>> {
    canvas::register_fonts();
    let legend = Legend::new(figure, names)?;
    let shown = size(&legend, figure, 1);
    let drawn = size(&legend, figure, SVG.units);
    let mut text = String::new();
    draw(
        &SVGBackend::with_string(&mut text, drawn).into_drawing_area(),
        figure,
        &legend,
        SVG,
    )?;
    let [drawn, shown] =
        [drawn, shown].map(|(width, height)| format!("width=\"{width}\" height=\"{height}\""));
    Ok(text.replacen(&drawn, &shown, 1))
}

/// Writes a PNG; the path must end in .png.
pub fn png(path: &Path, figure: &Figure, names: &[&str]) -> Result<(), Box<dyn Error>> {
    canvas::register_fonts();
    let legend = Legend::new(figure, names)?;
    let size = size(&legend, figure, PNG.units);
    draw(
        &BitMapBackend::new(path, size).into_drawing_area(),
        figure,
        &legend,
        PNG,
    )
}

/// Width and height, in units of which there are `units` a pixel.
fn size(legend: &Legend, figure: &Figure, units: u32) -> (u32, u32) {
    let panels = figure.panels.len() as u32;
    let height = legend.height() + panels * (TITLE + HEIGHT) + FOOT;
    (units * WIDTH, units * height)
}

fn draw<B: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<B, Shift>,
    figure: &Figure,
    legend: &Legend,
    medium: Medium,
) -> Result<(), Box<dyn Error>> {
    let units = medium.units;
    area.fill(&WHITE)?;
    let (top, mut rest) = area.split_vertically(units * legend.height());
    legend.draw(&top, units)?;
    let last = figure.panels.len() - 1;
    for (index, panel) in figure.panels.iter().enumerate() {
        let foot = if index == last { FOOT } else { 0 };
        let (area, below) = rest.split_vertically(units * (TITLE + HEIGHT + foot));
        draw_panel(&area, figure, panel, legend, (medium, foot))?;
        rest = below;
    }
    area.present()?;
    Ok(())
}

fn draw_panel<B: DrawingBackend<ErrorType: 'static>>(
    area: &DrawingArea<B, Shift>,
    figure: &Figure,
    panel: &Panel,
    legend: &Legend,
    (medium, foot): (Medium, u32),
) -> Result<(), Box<dyn Error>> {
    let units = medium.units;
    let place = ((LEFT * units) as i32, ((TITLE - TEXT - 4) * units) as i32);
    area.draw(&Text::new(
        panel.axis.title.as_str(),
        place,
        (FONT, units * TEXT),
    ))?;
    let mut chart = ChartBuilder::on(area)
        .margin_top(units * TITLE)
        .margin_right(units * RIGHT)
        .x_label_area_size(units * foot)
        .y_label_area_size(units * LEFT)
        .build_cartesian_2d(
            figure.time.values(TIMES),
            panel.axis.values(values::MAX_NUMBERS),
        )?;
    chart
        .configure_mesh()
        .x_desc(if foot > 0 {
            figure.time.title.as_str()
        } else {
            ""
        })
        .axis_desc_style((FONT, units * TEXT))
        .label_style((FONT, units * LABEL))
        .bold_line_style(canvas::GRID.stroke_width(units))
        .axis_style(canvas::GREY.stroke_width(units))
        .set_all_tick_mark_size(4 * units)
        .max_light_lines(0)
        .x_labels(TIMES)
        .y_labels(values::MAX_NUMBERS)
        .draw()?;
    let plane = chart.plotting_area();
    // From the last recording to the first, which is drawn on top.
    for (index, pieces) in panel.curves.iter().enumerate().rev() {
        let colour = legend.colour(index);
        let band = colour.mix(legend.band_opacity());
        for piece in pieces {
            draw_piece(plane, piece, (colour, band), medium)?;
        }
    }
    draw_marks(plane, figure, panel, units)
}

/// Draws the lower edge of a panel, the marks of flagged rows on it, and the arrows to values beyond.
fn draw_marks<B: DrawingBackend<ErrorType: 'static>>(
    plane: &DrawingArea<B, Cartesian2d<Values, Values>>,
    figure: &Figure,
    panel: &Panel,
    units: u32,
) -> Result<(), Box<dyn Error>> {
    let range = &panel.axis.range;
    let (width, height) = plane.dim_in_pixel();
    let foot = range.start;
    let ends = [
        (figure.time.range.start, foot),
        (figure.time.range.end, foot),
    ];
    plane.draw(&PathElement::new(ends, canvas::GREY.stroke_width(units)))?;
    let mark = (range.end - range.start) * f64::from(MARK * units as i32) / f64::from(height);
    for span in &figure.flagged {
        let mark = Rectangle::new(
            [(span.start, foot), (span.end, foot + mark)],
            FLAGGED.filled(),
        );
        plane.draw(&mark)?;
    }
    let time = &figure.time.range;
    let unit = |length: f64, pixels: u32| length * f64::from(units) / f64::from(pixels);
    let half = unit(time.end - time.start, width) * f64::from(ARROW) / 2.0;
    for &(at, is_above) in &panel.beyond {
        let (tip, inwards) = if is_above {
            (range.end, -1.0)
        } else {
            (foot, 1.0)
        };
        let base = tip + inwards * unit(range.end - range.start, height) * f64::from(ARROW);
        let arrow = [(at - half, base), (at + half, base), (at, tip)];
        plane.draw(&Polygon::new(arrow, BEYOND.filled()))?;
    }
    Ok(())
}

/// Draws a band, and its line over it; both end at the panel's edges.
fn draw_piece<B: DrawingBackend<ErrorType: 'static>>(
    plane: &DrawingArea<B, Cartesian2d<Values, Values>>,
    piece: &Piece,
    (colour, band): (RGBColor, RGBAColor),
    Medium { units, joins }: Medium,
) -> Result<(), Box<dyn Error>> {
    let edge = |which: usize| {
        let band = piece.band.iter();
        band.map(move |(time, edges)| (*time, edges[which]))
    };
    let line = &piece.line;
    let stroke = colour.stroke_width(units);
    let has_band = piece.band.iter().any(|(_, edges)| edges[0] < edges[1]);
    if let [point] = line[..] {
        if has_band {
            let bar: Vec<_> = edge(0).chain(edge(1)).collect();
            plane.draw(&PathElement::new(bar, stroke))?;
        }
        plane.draw(&Circle::new(point, 2 * units, colour.filled()))?;
        return Ok(());
    }
    if has_band {
        let around: Vec<_> = edge(0).chain(edge(1).rev()).collect();
        plane.draw(&Polygon::new(around, band))?;
    }
    for steps in line.windows(if joins { line.len() } else { 2 }) {
        plane.draw(&PathElement::new(steps, stroke))?;
    }
    Ok(())
}
