//! Figures of `antinode plot`, taken apart.

use std::fs;
use std::ops::Range;
use std::path::Path;

use super::run_with;

/// Titles of the panels, from above.
pub const TITLES: [&str; 5] = [
    "main amplitude",
    "quadrature amplitude",
    "pattern angle, °",
    "frequency less its median of ",
    "residual rms",
];
/// The columns that `plot` needs, and one deviation.
pub const HEADER: &str = "time_s,main_amplitude,main_amplitude_std,quadrature_amplitude,angle_rad,frequency_hz,residual_rms,flags,file\n";
/// Colours of the first recordings, of arrows, of flags, and of axes.
pub const FIRST: &str = "#0072B2";
pub const SECOND: &str = "#D55E00";
pub const DARK: &str = "#3C3C3C";
const RED: &str = "#DC0000";
const GREY: &str = "#969696";

/// An SVG as `plot` writes it: one element a line.
pub struct Svg(pub String);

/// Where a panel is, in the units of the drawing.
#[derive(Debug)]
pub struct Panel {
    pub across: Range<f64>,
    /// The greatest value is at the start, for a drawing counts downwards.
    pub down: Range<f64>,
}

impl Svg {
    pub fn open(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        assert!(text.starts_with("<svg ") && text.trim_end().ends_with("</svg>"));
        Self(text)
    }

    /// Points of all elements of a kind and colour.
    pub fn points(&self, element: &str, colour: &str) -> Vec<Vec<(f64, f64)>> {
        let start = format!("<{element} ");
        let lines = self.0.lines();
        lines
            .filter(|line| line.starts_with(&start) && line.contains(colour))
            .map(|line| {
                let points = attribute(line, "points").split_whitespace();
                points
                    .map(|point| {
                        let (x, y) = point.split_once(',').unwrap();
                        (x.parse().unwrap(), y.parse().unwrap())
                    })
                    .collect()
            })
            .collect()
    }

    /// Panels, from above: each has a long vertical axis and a long line at its foot.
    pub fn panels(&self) -> Vec<Panel> {
        let lines = self.points("polyline", GREY);
        let long = |one: f64, other: f64| (one - other).abs() > 500.0;
        let mut feet = lines.iter().filter(|line| long(line[0].0, line[1].0));
        let axes = lines.iter().filter(|line| long(line[0].1, line[1].1));
        let panels: Vec<_> = axes
            .map(|axis| {
                let foot = feet.next().unwrap();
                Panel {
                    across: foot[0].0..foot[1].0,
                    down: axis[0].1..axis[1].1,
                }
            })
            .collect();
        assert_eq!(panels.len(), TITLES.len());
        panels
    }

    /// Lines of a colour within a panel; all must end within it.
    pub fn lines(&self, panel: &Panel, colour: &str) -> Vec<Vec<(f64, f64)>> {
        let mut lines = self.points("polyline", colour);
        lines.retain(|line| panel.down.contains(&line[0].1) && line[0].0 >= panel.across.start);
        for (x, y) in lines.iter().flatten() {
            assert!(
                panel.across.contains(x) && (panel.down.start..=panel.down.end).contains(y),
                "{x} {y}"
            );
        }
        lines
    }

    /// Left and right edges of the red marks at a panel's foot.
    pub fn marks(&self, panel: &Panel) -> Vec<Range<f64>> {
        let lines = self.0.lines();
        let red = lines.filter(|line| line.starts_with("<rect ") && line.contains(RED));
        red.filter_map(|line| {
            let number = |name| attribute(line, name).parse::<f64>().unwrap();
            let (x, foot) = (number("x"), number("y") + number("height"));
            ((foot - panel.down.end).abs() <= 1.0).then(|| x..x + number("width"))
        })
        .collect()
    }

    pub fn texts(&self) -> Vec<&str> {
        let lines: Vec<_> = self.0.lines().collect();
        let pairs = lines.windows(2);
        pairs
            .filter(|pair| pair[0].starts_with("<text "))
            .map(|pair| pair[1])
            .collect()
    }
}

fn attribute<'a>(line: &'a str, name: &str) -> &'a str {
    let (_, rest) = line.split_once(&format!(" {name}=\"")).unwrap();
    rest.split_once('"').unwrap().0
}

/// Draws rows from standard input as `it.svg`, and tells so.
pub fn drawn(here: &Path, rows: &str, told: &str) -> Svg {
    let made = run_with(here, "plot - -o it.svg", rows.as_bytes().into());
    assert_eq!((made.code, made.err.as_str()), (0, ""));
    assert_eq!(made.out, format!("it.svg: {told}\n"));
    Svg::open(&here.join("it.svg"))
}
