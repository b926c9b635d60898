//! The range of an axis.

use std::ops::Range;

use super::values::to_marks;
use crate::median::median;

/// Widening of a range on either side, at most, in units of its span, by values that it need not hold and by deviations.
const MAX_WIDENING: f64 = 0.5;
/// A range holds the values of clean rows, and all others but the outermost on either side: one in `OUTERMOST` values, or one for every
/// `CLEAN` clean rows if these are more.
const OUTERMOST: usize = 20;
const CLEAN: usize = 4;
/// Multiple of the median deviation beyond which a row has no influence on a range, such as at the end of a ring-down.
const MAX_DEVIATION_RATIO: f64 = 3.0;
/// A row keeps its influence as long as its deviation is below this share of the span of the others.
const MAX_DEVIATION_SHARE: f64 = 0.05;
/// Span of a range, at least, in deviations.
const MIN_SPAN: f64 = 4.0;
/// Lower end of a logarithmic axis, as a share of the smallest deviation, or of the largest value if none is known: smaller values are
/// passages through zero.
const SHARE_OF_DEVIATION: f64 = 0.3;
const SHARE_OF_LARGEST: f64 = 1e-9;

/// A value of a quantity.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    pub value: f64,
    /// One standard deviation; 0 if there is none.
    pub deviation: f64,
    pub is_clean: bool,
}

/// Gathers the values that a range is to hold.
#[derive(Debug)]
pub struct Extent {
    held: [f64; 2],
    /// The same with values that need not be held, and with the deviations of clean ones.
    all: [f64; 2],
    smallest_deviation: f64,
}

impl Extent {
    /// No values yet.
    pub fn new() -> Self {
        Self {
            held: [f64::INFINITY, f64::NEG_INFINITY],
            all: [f64::INFINITY, f64::NEG_INFINITY],
            smallest_deviation: f64::INFINITY,
        }
    }

    /// The values of rows. Rows far less certain than the others count as flagged ones, which are held if they are many.
    pub fn of(rows: &[Measured]) -> Self {
        let deviations = rows.iter().map(|row| row.deviation);
        let mut deviations: Vec<f64> = deviations.filter(|&deviation| deviation > 0.0).collect();
        let usual =
            median(&mut deviations).map_or(f64::INFINITY, |median| MAX_DEVIATION_RATIO * median);
        let seen = held(rows, usual).map_or(0.0, |[from, to]| MAX_DEVIATION_SHARE * (to - from));
        let limit = usual.max(seen);
        let mut extent = Self::new();
        for row in rows {
            let is_held = row.is_clean && row.deviation <= limit;
            extent.add(row.value, row.deviation, is_held);
        }
        for end in held(rows, limit).into_iter().flatten() {
            extent.hold(end);
        }
        extent
    }

    /// Adds a value with its deviation, to be held or not.
    pub fn add(&mut self, value: f64, deviation: f64, is_held: bool) {
        let mut about = 0.0;
        if is_held {
            self.hold(value);
            self.smallest_deviation = self.smallest_deviation.min(deviation);
            about = deviation;
        }
        self.all = [
            self.all[0].min(value - about),
            self.all[1].max(value + about),
        ];
    }

    fn hold(&mut self, value: f64) {
        self.held = [self.held[0].min(value), self.held[1].max(value)];
    }

    /// True if each clean value has a deviation.
    pub fn has_deviation(&self) -> bool {
        self.smallest_deviation > 0.0 && self.smallest_deviation.is_finite()
    }

    /// True if any value is to be held.
    fn is_held(&self) -> bool {
        self.held[0] <= self.held[1]
    }

    /// The smallest and the largest of the values to be held, or else of all.
    fn measured(&self) -> [f64; 2] {
        if self.is_held() { self.held } else { self.all }
    }

    /// The range to draw, which spans at least `min_span`, with margins of the share `margin`; `None` without values.
    pub fn range(&self, min_span: f64, margin: f64) -> Option<Range<f64>> {
        let [mut from, mut to] = self.measured();
        if from > to {
            return None;
        }
        if self.is_held() {
            // A few outliers would otherwise leave nothing to be seen of the others.
            let min = if self.has_deviation() {
                MIN_SPAN * self.smallest_deviation
            } else {
                0.0
            };
            let widening = MAX_WIDENING * (to - from).max(min);
            from = self.all[0].max(from - widening);
            to = self.all[1].min(to + widening);
        }
        let missing = (min_span - (to - from)).max(0.0) / 2.0;
        let margin = margin * (to - from).max(min_span);
        Some(from - missing - margin..to + missing + margin)
    }

    /// The range to draw on a logarithmic axis, which begins and ends at numbers of the axis; `None` without values above 0.
    pub fn log_range(&self) -> Option<Range<f64>> {
        let [mut from, mut to] = self.measured();
        if to <= 0.0 {
            return None;
        }
        let min = if self.smallest_deviation > 0.0 && self.smallest_deviation < to {
            SHARE_OF_DEVIATION * self.smallest_deviation
        } else {
            SHARE_OF_LARGEST * to
        };
        from = from.max(min);
        if self.is_held() {
            let widening = (to / from).powf(MAX_WIDENING);
            (from, to) = (
                self.all[0].max(min).max(from / widening).min(from),
                self.all[1].min(to * widening),
            );
        }
        let Range { start, end } = to_marks(&(from.log10()..to.log10()));
        Some(10f64.powf(start)..10f64.powf(end))
    }

    /// The largest magnitude of a value; 0 without values.
    pub fn size(&self) -> f64 {
        let [from, to] = self.measured();
        if from <= to {
            from.abs().max(to.abs())
        } else {
            0.0
        }
    }
}

/// The smallest and the largest value of rows with at most this deviation: of the clean ones, and of all but the outermost.
fn held(rows: &[Measured], max_deviation: f64) -> Option<[f64; 2]> {
    let certain = || rows.iter().filter(|row| row.deviation <= max_deviation);
    let clean = certain().filter(|row| row.is_clean).map(|row| row.value);
    let mut values: Vec<f64> = certain().map(|row| row.value).collect();
    values.sort_unstable_by(f64::total_cmp);
    let outermost = (values.len() / OUTERMOST).max(clean.clone().count().div_ceil(CLEAN));
    let last = values.len().saturating_sub(outermost);
    let middle = values.get(outermost..last).unwrap_or_default();
    let ends = middle.first().into_iter().chain(middle.last()).copied();
    clean
        .chain(ends)
        .map(|value| [value; 2])
        .reduce(|[min, max], [value, _]| [min.min(value), max.max(value)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The range of values with their deviations, clean or not.
    fn range(values: &[(f64, f64, bool)], min_span: f64) -> Option<Range<f64>> {
        let mut extent = Extent::new();
        for &(value, deviation, is_clean) in values {
            extent.add(value, deviation, is_clean);
        }
        extent.range(min_span, 0.0)
    }

    #[test]
    fn a_range_holds_the_clean_rows() {
        let clean = [(1.0, 0.0, true), (3.0, 0.0, true)];
        assert_eq!(range(&clean, 0.0), Some(1.0..3.0));
        // Flagged rows near them are shown, and outliers widen the range by half of its span.
        let with = |value, deviation, is_clean| {
            range(&[clean[0], clean[1], (value, deviation, is_clean)], 0.0)
        };
        assert_eq!(with(3.5, 9.0, false), Some(1.0..3.5));
        assert_eq!(with(99.0, 0.0, false), Some(1.0..4.0));
        assert_eq!(with(2.0, 99.0, true), Some(0.0..4.0));
        // If all are flagged, the range holds them.
        assert_eq!(
            range(&[(2.0, 0.0, false), (9.0, 0.0, false)], 0.0),
            Some(2.0..9.0)
        );
        assert_eq!(range(&[], 1.0), None);
    }

    /// The range of rows with these values, some of which are clean.
    fn of(values: impl Iterator<Item = f64>, is_clean: impl Fn(usize) -> bool) -> Range<f64> {
        let rows = values.enumerate().map(|(k, value)| Measured {
            value,
            deviation: 0.0,
            is_clean: is_clean(k),
        });
        Extent::of(&rows.collect::<Vec<_>>())
            .range(0.0, 0.0)
            .unwrap()
    }

    #[test]
    fn flagged_rows_count_if_few_are_clean() {
        let decay = || (0..1000).map(|k| (-0.005 * f64::from(k)).exp());
        let all = decay().next_back().unwrap()..1.0;
        for is_clean in [
            |k: usize| (500..503).contains(&k),
            |k| k < 300,
            |k| k % 3 == 0,
            |_| false,
        ] {
            assert_eq!(of(decay(), is_clean), all);
            // A few outliers do not.
            let wild = decay().enumerate().map(|(k, value)| match k {
                700..730 => 1e6,
                _ => value,
            });
            let range = of(wild, |k| is_clean(k) && !(700..730).contains(&k));
            assert!(range.start == all.start && range.end < 1.6, "{range:?}");
        }
        // If most are clean, a fifth of all do not.
        let wild = decay().enumerate();
        let wild = wild.map(|(k, value)| if k % 5 == 0 { 1e6 } else { value });
        assert!(of(wild, |k| k % 5 != 0).end < 1.6);
    }

    #[test]
    fn rows_less_certain_than_most_do_not_count() {
        let rows: Vec<_> = (0..100)
            .map(|k| Measured {
                value: f64::from(k % 10) + if k < 60 { 0.0 } else { 1e3 },
                deviation: if k < 60 { 0.1 } else { 100.0 },
                is_clean: k == 0,
            })
            .collect();
        assert_eq!(Extent::of(&rows).range(0.0, 0.0), Some(-0.1..13.5));
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
        let texts = |from: &str, to: &str| Some([from.to_owned(), to.to_owned()]);
        assert_eq!(
            range(&[(0.3, 0.0, true), (0.003, 0.0, true)]),
            texts("2.0e-3", "5.0e-1")
        );
        assert_eq!(
            range(&[(0.3, 0.01, true), (1e-7, 0.01, true)]),
            texts("2.0e-3", "5.0e-1")
        );
        assert_eq!(
            range(&[(0.3, 0.0, true), (0.0, 0.0, true)]),
            texts("2.0e-10", "5.0e-1")
        );
        // A flagged value widens the range by half of its span, at most.
        assert_eq!(
            range(&[(1.0, 0.0, true), (0.01, 0.0, true), (1e9, 0.0, false)]),
            texts("1.0e-2", "1.0e1")
        );
        assert_eq!(range(&[(0.5, 0.0, true)]), texts("2.0e-1", "1.0e0"));
        assert_eq!(range(&[(0.0, 0.0, true)]), None);
        assert_eq!(range(&[]), None);
    }

    #[test]
    fn a_constant_has_a_range_too() {
        assert_eq!(range(&[(5.0, 0.0, true)], 1.0), Some(4.5..5.5));
        assert_eq!(range(&[(5.0, 0.25, true)], 0.0), Some(4.75..5.25));
    }
}
