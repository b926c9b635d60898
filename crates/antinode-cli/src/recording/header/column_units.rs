//! The units of a header's columns: in their names, in the line below, or in the settings above.

use super::super::error::{Fault, TIME};
use super::super::lines::Lines;
use super::super::preamble::Start;
use super::super::sequence::{Counted, Sequence};
use super::super::signal_units::{Together, is_known, together};
use super::super::units::{
    are_bracketed, are_units, bare, has_unknown_unit, is_bracketed, of_name, of_time, time_exponent,
};
use super::Header;

/// The units of S_C and S_D, as a line tells them.
pub(super) struct SignalUnits {
    pub of: [String; 2],
    /// Whether they are surely units: outside of brackets, the end of a name may be a label.
    pub are_sure: bool,
    pub line: u64,
}

impl Header {
    /// The units of the signals that the settings name, unless they know neither.
    pub(super) fn units_over(&self, start: &Start) -> Option<SignalUnits> {
        let (units, line) = start.units.as_ref()?;
        let [c, d] = [1, 2].map(|role| {
            let unit = units.get(self.places[role]?);
            unit.filter(|unit| !unit.is_empty()).cloned()
        });
        let of = [c?, d?];
        of.iter().any(|unit| is_known(unit)).then_some(SignalUnits {
            of,
            are_sure: true,
            line: *line as u64,
        })
    }

    /// Reads the line of the names, and the units in these and in the fields `below` them; reads that line too if it holds units. Whether
    /// there is one of time, and those of the signals.
    pub(super) fn read_units(
        &mut self,
        lines: &mut Lines,
        names: &[String],
        below: Vec<String>,
        counted: Option<Counted>,
    ) -> Result<(bool, SignalUnits), Fault> {
        lines.advance()?;
        let name = |role: usize| self.places[role].map_or("", |place| &names[place]);
        let (time, signals) = (name(TIME), [name(1), name(2)]);
        let own = [1, 2].map(|role| {
            let unit = self.places[role].and_then(|place| below.get(place));
            unit.map_or(String::new(), |unit| bare(unit).to_owned())
        });
        let mut has_time = self.set_unit(lines.number(), of_time(time), time)?;
        let mut told = SignalUnits {
            of: signals.map(|name| of_name(name).to_owned()),
            are_sure: signals.iter().all(|name| is_bracketed(name)),
            line: lines.number(),
        };
        if let Some(unit) = self.units(below, counted, lines.separator) {
            lines.advance()?;
            let is_of_time = self.set_unit(lines.number(), &unit, &unit)?;
            // Brackets hold a unit: one that is not known cannot be taken for seconds.
            if !is_of_time && is_bracketed(&unit) {
                return Err(self.unit_fault(lines.number(), &unit));
            }
            has_time |= is_of_time;
            if own.iter().any(|unit| !unit.is_empty()) {
                told = SignalUnits {
                    of: own,
                    are_sure: true,
                    line: lines.number(),
                };
            }
        }
        Ok((has_time, told))
    }

    /// The warning about a time in brackets that hold no unit of time; fails if the settings give another unit than s.
    pub(super) fn doubt_time(
        &self,
        names: Option<&[String]>,
        start: &Start,
    ) -> Result<Option<String>, Fault> {
        let Some(place) = self.places[TIME] else {
            return Ok(None);
        };
        // Only now do the settings matter: beside a unit in the header, theirs may be that of the screen.
        let is_other = |unit: &str| time_exponent(unit).is_some_and(|own| own != Some(0));
        if let Some((unit, line)) = &start.unit
            && is_other(unit)
        {
            return Err(self.time_fault(*line as u64, &format!(
                "the settings give the time in `{unit}`, but the time column has no unit; add the right one to its name above the samples, \
                 as in `TIME [ms]`"
            )));
        }
        let name = names.map(|names| &names[place]);
        let samples = self.samples();
        Ok(name.filter(|name| has_unknown_unit(name)).map(|name| format!(
            "the unit of the time column `{name}` is not known, and its times are read as seconds; if they are not, convert them to \
             seconds, or ignore the column with --columns {samples} --rate HZ"
        )))
    }

    /// Sets the divisors that bring both signals to one unit, and warns of them; fails if they measure different things.
    pub(super) fn bring_together(&mut self, units: &SignalUnits) -> Result<(), Fault> {
        let [c, d] = units.of.each_ref().map(String::as_str);
        let told = match together([c, d], units.are_sure) {
            Together::Same => return Ok(()),
            Together::Divided(divisors) => {
                self.divisors = divisors;
                let larger = if divisors[0] > divisors[1] { d } else { c };
                &format!("both are converted to {larger}")
            }
            Together::Unsure => {
                "one of these units is not known, and both signals are read without conversion"
            }
            Together::Never => {
                return Err(Fault::line(
                    units.line,
                    format!(
                        "S_C is in {c} and S_D in {d}, which have no common unit; record the same quantity twice, correct the units in the file, \
                     or choose other columns with --columns"
                    ),
                ));
            }
        };
        self.warnings
            .push(format!("S_C is in {c} and S_D in {d}: {told}"));
        Ok(())
    }

    /// Sets the time's unit; false if it is no unit of time. `name` stands for it in an error.
    fn set_unit(&mut self, line: u64, unit: &str, name: &str) -> Result<bool, Fault> {
        match time_exponent(unit) {
            _ if self.stamp.is_some() => Ok(true),
            None => Ok(false),
            Some(Some(exponent)) => {
                self.exponent = exponent;
                Ok(true)
            }
            Some(None) => Err(self.unit_fault(line, name)),
        }
    }

    /// The time's unit, which may be empty, if these are the fields of a line of units.
    fn units(
        &mut self,
        mut found: Vec<String>,
        counted: Option<Counted>,
        separator: u8,
    ) -> Option<String> {
        if found.len() > self.width {
            return None;
        }
        if let Some(counted) = counted {
            // A time column other than the first holds the times themselves.
            let first = counted.has_numbers.then_some(0);
            let is_first = self.places[TIME].is_none() || self.places[TIME] == first;
            if is_first && counted.sequence.is_none() {
                self.sequence = Sequence::read(&found, counted, separator);
            }
            found.truncate(counted.columns);
        }
        let are_bracketed = are_bracketed(&found);
        let time = match self.places[TIME] {
            Some(place) => found.get(place).filter(|unit| {
                self.sequence.is_some()
                    || unit.is_empty()
                    || time_exponent(unit).is_some()
                    || self.stamp.is_some()
                    || are_bracketed
            })?,
            None => "",
        };
        let are_units = are_units(&found, separator);
        (are_bracketed || are_units && found.iter().any(|unit| !unit.is_empty()))
            .then(|| time.to_owned())
    }

    /// The fault of a time whose unit is none of those that are read; `name` stands for the column.
    fn unit_fault(&self, line: u64, name: &str) -> Fault {
        self.time_fault(
            line,
            &format!("the time column `{name}` is not in s, ms, us or ns; convert it to seconds"),
        )
    }
}
