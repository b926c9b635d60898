//! The contents of a figure.

/// A figure: several panels over one axis.
#[derive(Debug, Clone)]
pub struct Figure {
    pub number: u8,
    /// Quantity of the horizontal axis, with its unit.
    pub axis: &'static str,
    pub x: Vec<f64>,
    /// Simulated conditions of each `x`.
    pub points: Vec<Point>,
    /// Runs a point, and the seed of their noise; `None` without noise.
    pub runs: Option<(u32, u64)>,
    pub panels: Vec<Panel>,
}

/// Conditions of a point, beside the wave.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Periods in a window.
    pub periods: u32,
    /// Sample rate, Hz.
    pub rate: f64,
}

/// One sub-figure.
#[derive(Debug, Clone)]
pub struct Panel {
    /// a to e, for the paper's а, б, в, г, д.
    pub letter: char,
    pub title: String,
    /// Quantity of the vertical axis, with its unit.
    pub axis: &'static str,
    /// False: the axis starts at 0 and is linear.
    pub logarithmic: bool,
    pub curves: Vec<Curve>,
}

/// One curve; NaN if it has no value.
#[derive(Debug, Clone)]
pub struct Curve {
    pub name: Name,
    pub y: Vec<f64>,
}

/// The method or bound that a curve shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name {
    Algorithm1,
    Algorithm2,
    Algorithm3,
    Algorithm4,
    /// Formula (9): the paper's curve 5.
    MeanReturn,
    /// Formula (10): the paper's curve 6.
    Difference,
    /// Algorithm 2 with a fractional delay.
    Fractional,
    /// Least squares without condition (8).
    Exact,
    /// The Cramér–Rao bound with both offsets unknown, as for the exact solution.
    Bound,
    /// The Cramér–Rao bound of centred signals, as the four algorithms take them.
    CentredBound,
    /// n/(N·P) − 1 of the window itself.
    Deviation,
}

impl Name {
    /// True for a bound, which no window gave.
    pub fn is_bound(self) -> bool {
        matches!(self, Self::Bound | Self::CentredBound)
    }

    /// The name in the legend.
    pub fn text(self) -> &'static str {
        match self {
            Self::Algorithm1 => "1: algorithm 1",
            Self::Algorithm2 => "2: algorithm 2",
            Self::Algorithm3 => "3: algorithm 3",
            Self::Algorithm4 => "4: algorithm 4",
            Self::MeanReturn => "5: formula (9)",
            Self::Difference => "6: formula (10)",
            Self::Fractional => "2, fractional delay",
            Self::Exact => "exact solution",
            Self::Bound => "Cramér-Rao bound",
            Self::CentredBound => "bound, no offsets",
            Self::Deviation => "sampled span",
        }
    }
}

impl Figure {
    /// The values of a curve; empty if the panel or the curve is missing.
    pub fn curve(&self, letter: char, name: Name) -> &[f64] {
        let panel = self.panels.iter().find(|panel| panel.letter == letter);
        let curve = panel.and_then(|panel| panel.curves.iter().find(|curve| curve.name == name));
        curve.map_or(&[], |curve| &curve.y)
    }
}
