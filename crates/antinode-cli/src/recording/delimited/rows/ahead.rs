//! What the lines ahead tell: the rate of times, whether a column counts the samples, and which times are wrong.

use super::super::super::date::Origin;
use super::super::super::error::{Fault, TIME};
use super::super::super::time::TimeAxis;
use super::super::fields::Cut;
use super::Rows;

/// Lines that are read ahead of a time that does not follow the last one, to see whether it alone is wrong: first a few, and then as many
/// as are sent twice at most.
const FEW_AHEAD: usize = 3;
const MOST_AHEAD: usize = 32;

/// Lines whose time may lie between samples by accident: so many, and one more for each so many lines read.
const MIN_ODD: u64 = 4;
const READ_PER_ODD: u64 = 256;

impl Rows {
    /// Finds the rate of the times in the next lines, as many as `lines`, and gives these times from the origin on, s.
    pub fn look_ahead(&mut self, lines: usize) -> Result<Vec<f64>, Fault> {
        self.lines.look_ahead(lines)?;
        let (mut times, mut printed, mut wrapped) = (Vec::new(), self.printed, self.wrapped);
        let texts = || {
            self.lines
                .ahead()
                .map(|line| Cut::of(line, &self.header).texts[TIME])
        };
        let first = texts().find(|text| self.time(text).is_some());
        self.origin = first.map_or(Origin::default(), Origin::of);
        printed.count_from(self.origin.value() / 10f64.powi(-self.header.exponent));
        for text in texts() {
            if let Some(time) = self.time(text) {
                printed.see(text, time, self.header.exponent);
                times.push(self.seconds(text, time, &mut wrapped));
            }
        }
        self.printed = printed;
        self.axis = TimeAxis::of(&times, printed);
        Ok(times)
    }

    /// Reads the column that counts the samples, if there is one, as their times, unless the next `lines` do not count.
    pub fn find_counter(&mut self, lines: usize) -> Result<(), Fault> {
        if self.header.counter.is_some() {
            self.header.places[TIME] = self.header.counter;
            self.look_ahead(lines)?;
            let axis = self.axis.as_ref();
            if axis.is_none_or(|axis| !axis.is_count(self.printed)) {
                self.ignore_counter();
            }
        }
        Ok(())
    }

    /// Reads the samples as if they were not counted.
    pub fn ignore_counter(&mut self) {
        self.axis = None;
        self.header.places[TIME] = None;
    }

    /// Whether this time, s from the origin on, is wrong, as the lines behind it continue those before it.
    pub(super) fn is_odd(&mut self, time: f64) -> Result<bool, Fault> {
        for lines in [FEW_AHEAD, MOST_AHEAD] {
            let Some(axis) = &self.axis else {
                return Ok(false);
            };
            if self.pairs == 0 {
                return Ok(time != axis.start());
            }
            if axis.is_next(time, self.printed) {
                return Ok(false);
            }
            self.lines.look_ahead(lines)?;
            let ahead = self.lines.ahead().take(lines);
            let texts = ahead.map(|line| Cut::of(line, &self.header).texts[TIME]);
            let mut wrapped = self.wrapped;
            let ahead: Vec<f64> = texts
                .filter_map(|text| Some(self.seconds(text, self.time(text)?, &mut wrapped)))
                .collect();
            let may_be_between = self.odd < MIN_ODD + self.read / READ_PER_ODD;
            if let Some(is_odd) = axis.is_odd(time, &ahead, self.printed, may_be_between) {
                self.odd += u64::from(is_odd);
                return Ok(is_odd);
            }
        }
        Ok(false)
    }
}
