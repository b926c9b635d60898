//! Axes: what range they span, what their numbers are multiplied by, and how these are printed.

use std::ops::Range;

/// A clean row shares in a range by what it measured; other values, and what deviations add, by no more than so many spans of those.
const BEYOND: f64 = 1.0;
/// A range's least span in deviations.
const DEVIATIONS: f64 = 4.0;

/// Gathers the values that a range is to hold.
#[derive(Debug)]
pub struct Extent {
    clean: [f64; 2],
    /// With flagged values and deviations.
    all: [f64; 2],
    least_deviation: f64,
}

impl Extent {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self {
            clean: [f64::INFINITY, f64::NEG_INFINITY],
            all: [f64::INFINITY, f64::NEG_INFINITY],
            least_deviation: f64::INFINITY,
        }
    }

    /// Adds a value with its deviation.
    pub fn add(&mut self, value: f64, deviation: f64, is_clean: bool) {
        if is_clean {
            self.clean = [self.clean[0].min(value), self.clean[1].max(value)];
            self.least_deviation = self.least_deviation.min(deviation);
        }
        self.all = [
            self.all[0].min(value - deviation),
            self.all[1].max(value + deviation),
        ];
    }

    /// The range to draw, of so wide a span at the least and with a margin of such a share of it; none of no value.
    pub fn range(&self, least_span: f64, margin: f64) -> Option<Range<f64>> {
        let is_clean = self.clean[0] <= self.clean[1];
        let [mut from, mut to] = if is_clean { self.clean } else { self.all };
        if from > to {
            return None;
        }
        if is_clean {
            // A few that are wild would leave nothing to be seen of the others.
            let most = BEYOND * (to - from).max(DEVIATIONS * self.least_deviation);
            from = self.all[0].max(from - most);
            to = self.all[1].min(to + most);
        }
        let missing = (least_span - (to - from)).max(0.0) / 2.0;
        let margin = margin * (to - from).max(least_span);
        Some(from - missing - margin..to + missing + margin)
    }

    /// The greatest size of a value.
    pub fn size(&self) -> f64 {
        let [from, to] = if self.clean[0] <= self.clean[1] {
            self.clean
        } else {
            self.all
        };
        from.abs().max(to.abs())
    }
}

/// The decimals that tell steps of this size apart.
pub fn decimals(step: f64) -> usize {
    // A step of 0.2 has one, and what is a little less by rounding too.
    (-(step * 1.000_001).log10().floor()).clamp(0.0, 15.0) as usize
}

/// The power of a thousand that leaves numbers of this size 0.001 to 10000.
pub fn exponent(size: f64) -> i32 {
    if size > 0.0 && !(1e-3..1e4).contains(&size) {
        3 * (size.log10() / 3.0).floor() as i32
    } else {
        0
    }
}

/// An exponent as it stands above a line.
pub fn superscript(exponent: i32) -> String {
    exponent
        .to_string()
        .chars()
        .map(|digit| match digit.to_digit(10) {
            Some(digit) => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize],
            None => '⁻',
        })
        .collect()
}

/// The unit of frequency that leaves a difference of this size 1 to 1000, and how many of it are 1 Hz.
pub fn frequency_unit(size: f64) -> (&'static str, f64) {
    match size {
        1.0.. => ("Hz", 1.0),
        1e-3.. => ("mHz", 1e3),
        1e-6.. => ("µHz", 1e6),
        _ => ("nHz", 1e9),
    }
}
