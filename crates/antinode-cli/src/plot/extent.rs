//! What range an axis spans.

use std::ops::Range;

use super::rows::median;
use super::values::to_marks;

/// Other values than those a range holds, and deviations, widen it on either side by no more than so many spans of that.
const BEYOND: f64 = 0.5;
/// A range holds what clean rows measured, and all values but the outermost on either side: one of so many, or one for so many clean
/// rows if these are more.
const OUTERMOST: usize = 20;
const CLEAN: usize = 4;
/// Rows whose deviation is so many times the median have no say in a range, as those at the end of a ring-down.
const UNCERTAIN: f64 = 3.0;
/// They have one as long as their deviation is less than this share of what the others span.
const SEEN: f64 = 0.05;
/// A range's least span in deviations.
const DEVIATIONS: f64 = 4.0;
/// The least of an axis of logarithms, as a share of the least deviation, and of the largest value where none is known: what is less is
/// a passage through zero.
const SHARE_OF_DEVIATION: f64 = 0.3;
const LEAST_OF_LOG: f64 = 1e-9;

/// What was measured of a quantity.
#[derive(Debug, Clone, Copy)]
pub struct Measured {
    pub value: f64,
    /// One standard deviation; 0 where there is none.
    pub deviation: f64,
    pub is_clean: bool,
}

/// Gathers the values that a range is to hold.
#[derive(Debug)]
pub struct Extent {
    held: [f64; 2],
    /// With values that need not be held, and the clean ones' deviations.
    all: [f64; 2],
    least_deviation: f64,
}

impl Extent {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self {
            held: [f64::INFINITY, f64::NEG_INFINITY],
            all: [f64::INFINITY, f64::NEG_INFINITY],
            least_deviation: f64::INFINITY,
        }
    }

    /// Of what rows measured: those far less certain than the others are taken for flagged ones, and these are held where they are many.
    pub fn of(rows: &[Measured]) -> Self {
        let deviations = rows.iter().map(|row| row.deviation);
        let mut deviations: Vec<f64> = deviations.filter(|&deviation| deviation > 0.0).collect();
        let usual = median(&mut deviations).map_or(f64::INFINITY, |median| UNCERTAIN * median);
        let seen = held(rows, usual).map_or(0.0, |[from, to]| SEEN * (to - from));
        let most = usual.max(seen);
        let mut extent = Self::new();
        for row in rows {
            let is_held = row.is_clean && row.deviation <= most;
            extent.add(row.value, row.deviation, is_held);
        }
        for end in held(rows, most).into_iter().flatten() {
            extent.hold(end);
        }
        extent
    }

    /// Adds a value with its deviation, to be held or not.
    pub fn add(&mut self, value: f64, deviation: f64, is_held: bool) {
        let mut about = 0.0;
        if is_held {
            self.hold(value);
            self.least_deviation = self.least_deviation.min(deviation);
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

    /// True where each clean value has a deviation.
    pub fn has_deviation(&self) -> bool {
        self.least_deviation > 0.0 && self.least_deviation.is_finite()
    }

    /// True where any value is to be held.
    fn is_held(&self) -> bool {
        self.held[0] <= self.held[1]
    }

    /// The least and the greatest of the values that are to be held, or else of all.
    fn measured(&self) -> [f64; 2] {
        if self.is_held() { self.held } else { self.all }
    }

    /// The range to draw, of so wide a span at the least and with a margin of such a share of it; none of no value.
    pub fn range(&self, least_span: f64, margin: f64) -> Option<Range<f64>> {
        let [mut from, mut to] = self.measured();
        if from > to {
            return None;
        }
        if self.is_held() {
            // A few that are wild would leave nothing to be seen of the others.
            let least = if self.has_deviation() {
                DEVIATIONS * self.least_deviation
            } else {
                0.0
            };
            let most = BEYOND * (to - from).max(least);
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
        if self.is_held() {
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

/// The least and the greatest value of rows with no more than this deviation: of the clean ones, and of all but the outermost.
fn held(rows: &[Measured], most: f64) -> Option<[f64; 2]> {
    let certain = || rows.iter().filter(|row| row.deviation <= most);
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
        .reduce(|[least, greatest], [value, _]| [least.min(value), greatest.max(value)])
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

    /// What rows measured, whose values are these, of which some are clean.
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
    fn flagged_rows_have_a_say_where_few_are_clean() {
        let decay = || (0..1000).map(|k| (-0.005 * f64::from(k)).exp());
        let all = decay().next_back().unwrap()..1.0;
        for is_clean in [
            |k: usize| (500..503).contains(&k),
            |k| k < 300,
            |k| k % 3 == 0,
            |_| false,
        ] {
            assert_eq!(of(decay(), is_clean), all);
            // A few that are absurd do not.
            let wild = decay().enumerate().map(|(k, value)| match k {
                700..730 => 1e6,
                _ => value,
            });
            let range = of(wild, |k| is_clean(k) && !(700..730).contains(&k));
            assert!(range.start == all.start && range.end < 1.6, "{range:?}");
        }
        // Where most are clean, as many as a fifth do not.
        let wild = decay().enumerate();
        let wild = wild.map(|(k, value)| if k % 5 == 0 { 1e6 } else { value });
        assert!(of(wild, |k| k % 5 != 0).end < 1.6);
    }

    #[test]
    fn rows_less_certain_than_most_have_no_say() {
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
}
