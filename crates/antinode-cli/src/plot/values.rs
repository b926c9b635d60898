//! The numbers that an axis shows, linear or logarithmic.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;

use super::numbers::{decimals, printed};

/// Numbers along a vertical axis, at most.
pub const MAX_NUMBERS: usize = 6;
/// Numbers in a decade that an axis shows, and the number of decades below which it shows all of these.
const OF_DECADE: [f64; 3] = [1.0, 2.0, 5.0];
const FEW_DECADES: f64 = 1.6;
/// Powers of ten that are printed in full.
const PRINTED_IN_FULL: Range<i32> = -4..6;

/// Rounding of the logarithms of marks.
const ROUNDING: f64 = 1e-9;

/// An axis with its marks.
pub struct Values {
    inner: RangedCoordf64,
    marks: Vec<(f64, String)>,
}

impl Values {
    /// An axis of this range, with at most `max` numbers.
    pub fn linear(range: &Range<f64>, max: usize) -> Self {
        let inner = RangedCoordf64::from(range.clone());
        let places = inner.key_points(max);
        let decimals = match places.as_slice() {
            [one, other, ..] => decimals(other - one),
            _ => decimals(range.end - range.start),
        };
        let marks = places.into_iter();
        let marks = marks.map(|at| (at, printed(at, decimals))).collect();
        Self { inner, marks }
    }

    /// An axis of numbers whose decimal logarithms have this range.
    pub fn logarithmic(range: &Range<f64>) -> Self {
        let inner = RangedCoordf64::from(range.clone());
        let marks = marks(range)
            .map(|(power, times)| (logarithm(power, times), number(power, times)))
            .collect();
        Self { inner, marks }
    }
}

/// The smallest range that begins and ends at marks and holds this one.
pub fn to_marks(range: &Range<f64>) -> Range<f64> {
    let powers = range.start.floor() as i32 - 1..=range.end.ceil() as i32 + 1;
    let marks: Vec<f64> = powers
        .flat_map(|power| OF_DECADE.map(|times| logarithm(power, times)))
        .collect();
    // A single value that is a mark lies between the neighbouring marks.
    let rounding = if range.end - range.start > ROUNDING {
        ROUNDING
    } else {
        -ROUNDING
    };
    let mut below = marks.iter().rev().copied();
    let mut above = marks.iter().copied();
    let from = below.find(|&mark| mark <= range.start + rounding);
    let to = above.find(|&mark| mark >= range.end - rounding);
    from.unwrap_or(range.start)..to.unwrap_or(range.end)
}

/// The decimal logarithm of `times` a power of ten.
fn logarithm(power: i32, times: f64) -> f64 {
    f64::from(power) + times.log10()
}

/// The marks, as powers of ten and multiples of these: no more than there is room for.
fn marks(range: &Range<f64>) -> impl Iterator<Item = (i32, f64)> {
    let powers = range.start.floor() as i32..=range.end.ceil() as i32;
    let decades = range.end - range.start;
    let (step, of_decade): (_, &[f64]) = if decades < FEW_DECADES {
        (1, &OF_DECADE)
    } else {
        (
            (decades / MAX_NUMBERS as f64).ceil() as i32,
            &OF_DECADE[..1],
        )
    };
    let range = range.clone();
    powers
        .filter(move |power| power.rem_euclid(step) == 0)
        .flat_map(move |power| of_decade.iter().map(move |&times| (power, times)))
        .filter(move |&(power, times)| {
            let mark = logarithm(power, times);
            (range.start - ROUNDING..range.end + ROUNDING).contains(&mark)
        })
}

/// `times` a power of ten, as text.
fn number(power: i32, times: f64) -> String {
    if PRINTED_IN_FULL.contains(&power) {
        let decimals = usize::try_from(-power).unwrap_or(0);
        format!("{:.decimals$}", times * 10f64.powi(power))
    } else {
        format!("{times}e{power}").replace('-', "−")
    }
}

impl Ranged for Values {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.inner.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // There are no light marks between the bold ones.
        let is_bold = !hint.weight().allow_light_points();
        let marks = self.marks.iter().filter(|_| is_bold);
        marks.map(|&(at, _)| at).collect()
    }

    fn range(&self) -> Range<f64> {
        self.inner.range()
    }
}

impl ValueFormatter<f64> for Values {
    fn format_ext(&self, value: &f64) -> String {
        let mark = self.marks.iter().find(|(at, _)| at == value);
        mark.map_or_else(String::new, |(_, text)| text.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(values: Values) -> Vec<String> {
        values.marks.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn logarithms_have_round_numbers() {
        let log = |from: f64, to: f64| texts(Values::logarithmic(&(from.log10()..to.log10())));
        assert_eq!(log(0.0015, 0.9), ["0.01", "0.1"]);
        assert_eq!(log(0.09, 0.6), ["0.1", "0.2", "0.5"]);
        assert_eq!(log(0.0015, 0.009), ["0.002", "0.005"]);
        assert_eq!(log(9e-8, 1.1e-6), ["1e−7", "2e−7", "5e−7", "1e−6"]);
        assert_eq!(log(9e5, 2e7), ["1e6", "2e6", "5e6", "1e7", "2e7"]);
        // Of many decades, no more marks than there is room for.
        assert_eq!(log(0.5e-12, 2.0).len(), 5);
        assert_eq!(
            texts(Values::linear(&(-0.2..0.45), MAX_NUMBERS)),
            ["−0.2", "0.0", "0.2", "0.4"]
        );
    }

    #[test]
    fn a_range_may_end_at_marks() {
        let near = |one: f64, other: f64| (one - other).abs() < 1e-9;
        let range = to_marks(&(0.0034f64.log10()..0.0036f64.log10()));
        assert!(near(range.start, 0.002f64.log10()) && near(range.end, 0.005f64.log10()));
        let range = to_marks(&(-3.0..0.0));
        assert!(near(range.start, -3.0) && near(range.end, 0.0));
    }
}
