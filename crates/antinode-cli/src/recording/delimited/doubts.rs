//! What is said of times that may mean something else than seconds at the rate in use.

use super::super::time::Meaning;
use super::Delimited;
use crate::ranges::RATES;

/// Slowest rate, Hz, of times without a unit: a clock that ticks once a second may be a little slow, but whole numbers from 2 on may be ms.
const SLOWEST: f64 = 0.9;

/// What to do about slower ones.
const OTHER_UNIT: &str =
    "if its times are in us, in ms or really in s, the header must say so, as in `time (us)`";

impl Delimited {
    /// What is wrong with this rate of the times, Hz, if it is surely not meant.
    pub(super) fn absurd(&self, own: f64) -> Option<String> {
        let told = format!("the time column gives an absurd sample rate of {own} Hz; {OTHER_UNIT}");
        self.may_be_other_unit(own)
            .then(|| self.rows.header.or_ignore_time(&told))
    }

    /// Whether the times, of this rate, Hz, are too slow to be taken for seconds where no unit says so.
    fn may_be_other_unit(&self, own: f64) -> bool {
        let header = &self.rows.header;
        own < SLOWEST && !header.has_unit_of_time && header.sequence.is_none()
    }

    /// The warning about a time column that may mean something else, or a sample rate that contradicts `--rate`.
    pub(super) fn warning(&self, meaning: Meaning) -> Option<String> {
        let samples = self.rows.header.samples();
        let ignored = format!("ignore it with --columns {samples} --rate HZ");
        Some(match meaning {
            Meaning::Time => return None,
            Meaning::PerhapsIndex => format!(
                "the time column increases by 1 per line, and is read as seconds; if it is an index, {ignored}"
            ),
            Meaning::Index => {
                "the time column increases by 1 per line, and is read as an index because --rate is given: times of rows \
                 count from the first sample; if it is seconds, omit --rate"
                    .to_owned()
            }
            Meaning::OtherRate { own, asked } if self.rows.axis.is_none() => format!(
                "the sample rate is {own} Hz by its settings and {asked} Hz by --rate, which takes precedence; \
                 omit --rate if the settings are right"
            ),
            Meaning::OtherRate { own, asked } => {
                let remedy = if self.may_be_other_unit(own) {
                    OTHER_UNIT
                } else if RATES.contains(&own) {
                    "omit --rate"
                } else {
                    "correct the column's unit"
                };
                format!(
                    "the sample rate is {own} Hz by the time column and {asked} Hz by --rate, which takes precedence; {remedy}, or if the \
                     column is wrong, {ignored}"
                )
            }
        })
    }
}
