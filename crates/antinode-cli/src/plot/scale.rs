//! Axes: what range they span, what their numbers are multiplied by, and how these are printed.

use std::ops::Range;

use super::values::to_marks;
use crate::digits::fixed;

/// A range holds what clean rows measured; flagged values and deviations widen it on either side by no more than so many spans of that.
const BEYOND: f64 = 0.5;
/// A range's least span in deviations.
const DEVIATIONS: f64 = 4.0;
/// The least of an axis of logarithms, as a share of the least deviation, and of the largest value where none is known: what is less is
/// a passage through zero.
const SHARE_OF_DEVIATION: f64 = 0.3;
const LEAST_OF_LOG: f64 = 1e-9;
/// Numbers from this size on cannot be drawn, and up to this one they are 0.
const GREATEST: f64 = 1e290;
const LEAST: f64 = 1e-280;

/// A number as an axis can hold it: the steps of one that is too large or too small are none.
pub fn drawable(number: f64) -> Option<f64> {
    let size = number.abs();
    (size < GREATEST).then_some(if size > LEAST { number } else { 0.0 })
}

/// Gathers the values that a range is to hold.
#[derive(Debug)]
pub struct Extent {
    clean: [f64; 2],
    /// With flagged values, and the clean ones' deviations.
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
        let mut about = 0.0;
        if is_clean {
            self.clean = [self.clean[0].min(value), self.clean[1].max(value)];
            self.least_deviation = self.least_deviation.min(deviation);
            about = deviation;
        }
        self.all = [
            self.all[0].min(value - about),
            self.all[1].max(value + about),
        ];
    }

    /// True where each clean value has a deviation.
    pub fn has_deviation(&self) -> bool {
        self.least_deviation > 0.0 && self.least_deviation.is_finite()
    }

    /// True where any value is a clean row's.
    fn is_clean(&self) -> bool {
        self.clean[0] <= self.clean[1]
    }

    /// The least and the greatest of the clean values, or else of all.
    fn measured(&self) -> [f64; 2] {
        if self.is_clean() {
            self.clean
        } else {
            self.all
        }
    }

    /// The range to draw, of so wide a span at the least and with a margin of such a share of it; none of no value.
    pub fn range(&self, least_span: f64, margin: f64) -> Option<Range<f64>> {
        let is_clean = self.is_clean();
        let [mut from, mut to] = self.measured();
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

    /// The range of logarithms to draw, from number to number of the axis; none of no value above 0.
    pub fn log_range(&self) -> Option<Range<f64>> {
        let [mut from, mut to] = self.measured();
        if to <= 0.0 {
            return None;
        }
        let least = if self.least_deviation > 0.0 && self.least_deviation < to {
            SHARE_OF_DEVIATION * self.least_deviation
        } else {
            LEAST_OF_LOG * to
        };
        from = from.max(least);
        if self.is_clean() {
            let most = (to / from).powf(BEYOND);
            (from, to) = (
                self.all[0].max(least).max(from / most).min(from),
                self.all[1].min(to * most),
            );
        }
        let Range { start, end } = to_marks(&(from.log10()..to.log10()));
        Some(10f64.powf(start)..10f64.powf(end))
    }

    /// The greatest size of a value; 0 of no value.
    pub fn size(&self) -> f64 {
        let [from, to] = self.measured();
        if from <= to {
            from.abs().max(to.abs())
        } else {
            0.0
        }
    }
}

/// The decimals that tell steps of this size apart.
pub fn decimals(step: f64) -> usize {
    // A step of 0.2 has one, and what is a little less by rounding too.
    (-(step * 1.000_001).log10().floor()).clamp(0.0, 15.0) as usize
}

/// A number with so many decimals, and a minus as long as a digit.
pub fn printed(number: f64, decimals: usize) -> String {
    fixed(decimals, number).replace('-', "−")
}

/// What numbers of this size are multiplied by so that few digits tell them, and how a title says so.
pub fn factor(size: f64) -> (f64, String) {
    if size == 0.0 || (1e-3..1e6).contains(&size) {
        return (1.0, String::new());
    }
    let power = -3 * (size.log10() / 3.0).floor() as i32;
    // The font has no raised minus.
    let sign = if power > 0 { '×' } else { '÷' };
    let raised: String = power
        .unsigned_abs()
        .to_string()
        .bytes()
        .map(|digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][usize::from(digit - b'0')])
        .collect();
    (10f64.powi(power), format!(" {sign} 10{raised}"))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The range of values with their deviations, clean or not.
    fn range(values: &[(f64, f64, bool)], least_span: f64) -> Option<Range<f64>> {
        let mut extent = Extent::new();
        for &(value, deviation, is_clean) in values {
            extent.add(value, deviation, is_clean);
        }
        extent.range(least_span, 0.0)
    }

    #[test]
    fn a_range_is_made_for_clean_rows() {
        let clean = [(1.0, 0.0, true), (3.0, 0.0, true)];
        assert_eq!(range(&clean, 0.0), Some(1.0..3.0));
        // Flagged ones near them are seen, and wild ones take half of a span.
        let with = |value, deviation, is_clean| {
            range(&[clean[0], clean[1], (value, deviation, is_clean)], 0.0)
        };
        assert_eq!(with(3.5, 9.0, false), Some(1.0..3.5));
        assert_eq!(with(99.0, 0.0, false), Some(1.0..4.0));
        assert_eq!(with(2.0, 99.0, true), Some(0.0..4.0));
        // Where all are flagged, they are all that there is.
        assert_eq!(
            range(&[(2.0, 0.0, false), (9.0, 0.0, false)], 0.0),
            Some(2.0..9.0)
        );
        assert_eq!(range(&[], 1.0), None);
    }

    #[test]
    fn logarithms_have_a_range_without_passages_through_zero() {
        let range = |values: &[(f64, f64, bool)]| {
            let mut extent = Extent::new();
            for &(value, deviation, is_clean) in values {
                extent.add(value, deviation, is_clean);
            }
            let range = extent.log_range()?;
            Some([range.start, range.end].map(|end| format!("{end:.1e}")))
        };
        let told = |from: &str, to: &str| Some([from.to_owned(), to.to_owned()]);
        assert_eq!(
            range(&[(0.3, 0.0, true), (0.003, 0.0, true)]),
            told("2.0e-3", "5.0e-1")
        );
        assert_eq!(
            range(&[(0.3, 0.01, true), (1e-7, 0.01, true)]),
            told("2.0e-3", "5.0e-1")
        );
        assert_eq!(
            range(&[(0.3, 0.0, true), (0.0, 0.0, true)]),
            told("2.0e-10", "5.0e-1")
        );
        // A flagged value takes half of a span at the most.
        assert_eq!(
            range(&[(1.0, 0.0, true), (0.01, 0.0, true), (1e9, 0.0, false)]),
            told("1.0e-2", "1.0e1")
        );
        assert_eq!(range(&[(0.5, 0.0, true)]), told("2.0e-1", "1.0e0"));
        assert_eq!(range(&[(0.0, 0.0, true)]), None);
        assert_eq!(range(&[]), None);
    }

    #[test]
    fn a_constant_has_a_range_too() {
        assert_eq!(range(&[(5.0, 0.0, true)], 1.0), Some(4.5..5.5));
        assert_eq!(range(&[(5.0, 0.25, true)], 0.0), Some(4.75..5.25));
    }

    #[test]
    fn numbers_have_the_digits_that_tell_them_apart() {
        assert_eq!([20.0, 1.0, 0.5, 0.2, 0.01].map(decimals), [0, 0, 1, 1, 2]);
        assert_eq!(decimals(0.3 - 0.2), 1);
        assert_eq!(factor(0.05), (1.0, String::new()));
        assert_eq!(factor(4.2e-6).1, " × 10⁶");
        let (by, told) = factor(4.2e7);
        assert_eq!(told, " ÷ 10⁶");
        assert!((1e6 * by - 1.0).abs() < 1e-12);
        assert_eq!(frequency_unit(0.02), ("mHz", 1e3));
    }
}
