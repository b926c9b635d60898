//! The header of a text recording: its columns and their units, from the first lines.

use super::columns::{Columns, FirstLine, Places};
use super::error::Fault;
use super::heading::is_header;
use super::lines::{Beginning, Lines};
use super::preamble::Start;
use super::sequence::{Counted, Sequence, counted};
use super::signal_units::{Together, together};
use super::text::{fields, is_skipped};
use super::units::{
    are_bracketed, are_units, bare, has_unknown_unit, is_bracketed, of_name, time_exponent,
};
use crate::rows::MAIN_AMPLITUDE;

/// The columns of a text recording.
pub(super) struct Header {
    pub width: usize,
    pub places: Places,
    /// The column that counts the samples, if none holds their times and none is chosen.
    pub counter: Option<usize>,
    /// The power of ten of the time's unit in seconds: −3 for ms.
    pub exponent: i32,
    /// The times of the samples, if these are counted from a start in equal steps.
    pub sequence: Option<Sequence>,
    /// Divisors of S_C and S_D that bring both to one unit.
    pub divisors: [f32; 2],
    /// The warnings about the first lines.
    pub warnings: Vec<String>,
}

impl Header {
    /// Reads the names and the units, if there are any, and leaves the samples to be read; `beginning` shows the lines ahead.
    pub fn read(
        lines: &mut Lines,
        beginning: &Beginning,
        chosen: Option<&Columns>,
    ) -> Result<Self, Fault> {
        let separator = lines.separator;
        let Beginning { first, next, start } = beginning;
        let names: Vec<&[u8]> = fields(first, separator).collect();
        let below = next.split(|&byte| byte == b'\n');
        let below: Vec<Vec<&[u8]>> = below
            .filter(|line| !is_skipped(line))
            .map(|line| fields(line, separator).collect())
            .collect();
        let rows: Vec<&[&[u8]]> = below.iter().map(Vec::as_slice).collect();
        let is_header = is_header(&names, &rows, separator);
        let [names, below] = [&names[..], rows.first().unwrap_or(&&[][..])]
            .map(|fields| fields.iter().map(|field| lossy(field)).collect::<Vec<_>>());
        let width = names.len();
        let counted = counted(&names);
        let has_numbers = counted.is_some_and(|counted| counted.has_numbers);
        let columns = counted.map_or(width, |counted| counted.columns);
        let names = is_header.then_some(&names[..columns]);
        let units = Some(&below[..]).filter(|fields| are_units(fields, separator));
        let line = FirstLine {
            names,
            units: units.unwrap_or_default(),
            width: columns,
            may_be_timed: start.sequence.is_none() && (counted.is_none() || has_numbers),
            has_numbers,
            start,
            is_of_rows: is_of_rows(first, next),
        };
        let places = line.places(chosen);
        let places = places.map_err(|fault| Fault::line(lines.number() + 1, fault))?;
        let of_names = counted.and_then(|counted| counted.sequence);
        let sequence = start.sequence.or(of_names);
        let mut header = Self {
            width,
            places,
            counter: line.counter(places).filter(|_| chosen.is_none()),
            exponent: 0,
            sequence: sequence.filter(|_| places[0].is_none()),
            divisors: [1.0; 2],
            warnings: Vec::new(),
        };
        header.warnings.extend(start.cut.map(|line| format!(
            "line {line} seems to lack its beginning, as if the logger had been attached in the middle of it, and is left out"
        )));
        let has_unit_of_time = match names {
            Some(names) => header.read_units(lines, names, below, counted)?,
            None => false,
        };
        if !has_unit_of_time {
            let doubt = header.doubt_time(names, start)?;
            header.warnings.extend(doubt);
        }
        Ok(header)
    }

    /// Reads the line of the names, and the units in these and in the fields `below` them; reads that line too if it holds units. Whether
    /// there is one of time.
    fn read_units(
        &mut self,
        lines: &mut Lines,
        names: &[String],
        below: Vec<String>,
        counted: Option<Counted>,
    ) -> Result<bool, Fault> {
        lines.advance()?;
        let name = |role: usize| self.places[role].map_or("", |place| &names[place]);
        let (time, signals) = (name(0), [name(1), name(2)]);
        let own = [1, 2].map(|role| {
            let unit = self.places[role].and_then(|place| below.get(place));
            unit.map_or(String::new(), |unit| bare(unit).to_owned())
        });
        let mut has_time = self.set_unit(lines.number(), of_name(time), time)?;
        let mut units = signals.map(|name| of_name(name).to_owned());
        // Outside of brackets, the end of a name may be a label.
        let mut are_sure = signals.iter().all(|name| is_bracketed(name));
        let mut line = lines.number();
        if let Some(unit) = self.units(below, counted, lines.separator) {
            lines.advance()?;
            let is_of_time = self.set_unit(lines.number(), &unit, &unit)?;
            // Brackets hold a unit: one that is not known cannot be taken for seconds.
            if !is_of_time && is_bracketed(&unit) {
                return Err(self.unit_fault(lines.number(), &unit));
            }
            has_time |= is_of_time;
            if own.iter().any(|unit| !unit.is_empty()) {
                (units, are_sure, line) = (own, true, lines.number());
            }
        }
        self.bring_together(units.each_ref().map(String::as_str), are_sure, line)?;
        Ok(has_time)
    }

    /// The warning about a time in brackets that hold no unit of time; fails if the settings give another unit than s.
    fn doubt_time(&self, names: Option<&[String]>, start: &Start) -> Result<Option<String>, Fault> {
        let Some(place) = self.places[0] else {
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
    fn bring_together(
        &mut self,
        [c, d]: [&str; 2],
        are_sure: bool,
        line: u64,
    ) -> Result<(), Fault> {
        let told = match together([c, d], are_sure) {
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
                    line,
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
            let is_first = self.places[0].is_none() || self.places[0] == first;
            if is_first && counted.sequence.is_none() {
                self.sequence = Sequence::read(&found, counted, separator);
            }
            found.truncate(counted.columns);
        }
        let are_bracketed = are_bracketed(&found);
        let time = match self.places[0] {
            Some(place) => found.get(place).filter(|unit| {
                self.sequence.is_some()
                    || unit.is_empty()
                    || time_exponent(unit).is_some()
                    || are_bracketed
            })?,
            None => "",
        };
        let are_units = are_units(&found, separator);
        (are_bracketed || are_units && found.iter().any(|unit| !unit.is_empty()))
            .then(|| time.to_owned())
    }

    /// The columns of the samples, as `--columns` takes them.
    pub fn samples(&self) -> String {
        let [c, d] = [1, 2].map(|role| self.places[role].map_or(0, |place| place + 1));
        format!("{c},{d}")
    }

    /// The fault of a time whose unit is none of those that are read; `name` stands for the column.
    fn unit_fault(&self, line: u64, name: &str) -> Fault {
        self.time_fault(
            line,
            &format!("the time column `{name}` is not in s, ms, us or ns; convert it to seconds"),
        )
    }

    /// The fault of a line whose time is at fault.
    pub fn time_fault(&self, line: u64, told: &str) -> Fault {
        Fault::line(line, self.or_ignore_time(told))
    }

    /// What is wrong with a time, with the columns to read without it.
    pub fn or_ignore_time(&self, told: &str) -> String {
        let samples = self.samples();
        let column = if self.counter.is_some() {
            "counting"
        } else {
            "time"
        };
        format!("{told}, or ignore the {column} column with --columns {samples} --rate HZ")
    }
}

/// Whether a text that begins with these lines is what `antinode identify` prints.
fn is_of_rows(first: &[u8], next: &[u8]) -> bool {
    // A table for reading may have a title above its heading.
    let is_of_table = |text: &[u8]| lossy(text).contains(MAIN_AMPLITUDE);
    lossy(first).contains("quadrature_amplitude") || is_of_table(first) || is_of_table(next)
}

/// A field as text, whatever its encoding.
pub(super) fn lossy(field: &[u8]) -> String {
    String::from_utf8_lossy(field).into_owned()
}
