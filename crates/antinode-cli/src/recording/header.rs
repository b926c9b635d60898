//! The header of a text recording: its columns and their units, from the first lines.

use super::columns::{Columns, FirstLine, Places, is_time};
use super::error::{InputError, LineFault, TimeFault};
use super::heading::is_header;
use super::lines::{Beginning, Lines};
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
    /// The power of ten of the time's unit in seconds: −3 for ms.
    pub exponent: i32,
    /// The times of the samples, if these are counted from a start in equal steps.
    pub sequence: Option<Sequence>,
    /// Divisors of S_C and S_D that bring both to one unit.
    pub divisors: [f32; 2],
    /// The units of S_C and S_D, and how they are brought together.
    units: ([String; 2], Together),
    /// The name of a time column whose brackets hold no unit of time.
    unknown: Option<String>,
    /// The start and the increment that the names announce or give, if they do.
    counted: Option<Counted>,
    /// The number of a first line that is left out, as it lacks its beginning.
    cut: Option<usize>,
}

/// What was found in the names and a line of units below them.
#[derive(Default)]
struct FoundUnits {
    /// Whether the time's unit was found.
    has_unit: bool,
    /// The line with the signals' units, and whether they are surely units.
    line: u64,
    are_signals: bool,
}

impl Header {
    /// Reads the names and the units, if there are any, and leaves the samples to be read; `beginning` shows the lines ahead.
    pub fn read(
        file: &str,
        lines: &mut Lines,
        beginning: &Beginning,
        chosen: Option<&Columns>,
    ) -> Result<Self, InputError> {
        let separator = lines.separator;
        let Beginning { first, next, start } = beginning;
        let mut names: Vec<String> = fields(first, separator).map(lossy).collect();
        let width = names.len();
        // A table for reading may have a title above its heading.
        let is_of_table = |text: &Vec<u8>| lossy(text).contains(MAIN_AMPLITUDE);
        let is_of_rows = lossy(first).contains("quadrature_amplitude")
            || is_of_table(first)
            || is_of_table(next);
        let counted = counted(&names);
        let has_numbers = counted.is_some_and(|counted| counted.has_numbers);
        let is_timed = has_numbers || names.first().is_some_and(|name| is_time(name));
        if has_numbers && chosen.is_none() {
            names[0] = "time".to_owned();
        }
        let columns = counted.map_or(width, |counted| counted.columns);
        let names = is_header(first, next, separator).then_some(&names[..columns]);
        let units = units_below(next, separator);
        lines.advance()?;
        let line = FirstLine {
            names,
            units: &units,
            width: columns,
            start,
            is_of_rows,
        };
        let places = if counted.is_some() && !is_timed && chosen.is_none() && columns != 2 {
            // No column here is a time.
            let (found, are_words) = (columns, false);
            Err(LineFault::ColumnCount { found, are_words })
        } else {
            line.places(chosen)
        };
        let places = places.map_err(|fault| InputError::line(file, lines.number(), fault))?;
        let of_names = counted.and_then(|counted| counted.sequence);
        let sequence = start.sequence.or(of_names);
        let mut header = Self {
            width,
            places,
            exponent: 0,
            sequence: sequence.filter(|_| places[0].is_none()),
            divisors: [1.0; 2],
            units: (Default::default(), Together::Same),
            unknown: None,
            counted,
            cut: start.cut,
        };
        let found = match names {
            Some(names) => header.read_units(file, lines, names)?,
            None => {
                lines.back();
                FoundUnits::default()
            }
        };
        if !found.has_unit {
            // Only now do the settings matter: beside a unit in the header, theirs may be that of the screen.
            let is_other = |unit: &str| time_exponent(unit).is_some_and(|own| own != Some(0));
            if let Some((unit, line)) = &start.unit
                && places[0].is_some()
                && is_other(unit)
            {
                let unit = unit.clone();
                return Err(header.of_time(file, *line as u64, TimeFault::UnitUnsure { unit }));
            }
            let name = names.and_then(|names| Some(&names[places[0]?]));
            header.unknown = name.filter(|name| has_unknown_unit(name)).cloned();
        }
        header
            .bring_together(found.are_signals)
            .map_err(|fault| InputError::line(file, found.line, fault))?;
        Ok(header)
    }

    /// Reads the units in the names and in the line below them; leaves that line to be read if it holds none.
    fn read_units(
        &mut self,
        file: &str,
        lines: &mut Lines,
        names: &[String],
    ) -> Result<FoundUnits, InputError> {
        let name = |role: usize| self.places[role].map_or("", |place| &names[place]);
        let (time, signals) = (name(0), [name(1), name(2)]);
        let mut found = FoundUnits {
            has_unit: false,
            line: lines.number(),
            // Outside of brackets, the end of a name may be a label.
            are_signals: signals.iter().all(|name| is_bracketed(name)),
        };
        self.units.0 = signals.map(|name| of_name(name).to_owned());
        found.has_unit = self
            .set_unit(of_name(time), time)
            .map_err(|fault| self.of_time(file, found.line, fault))?;
        if !lines.advance()? {
            return Ok(found);
        }
        let Some(unit) = self.units(lines) else {
            lines.back();
            return Ok(found);
        };
        let line = lines.number();
        match self.set_unit(&unit, &unit) {
            // Brackets hold a unit: one that is not known cannot be taken for seconds.
            Ok(false) if is_bracketed(&unit) => {
                return Err(self.of_time(file, line, TimeFault::Unit { name: unit }));
            }
            Ok(is_told) => found.has_unit |= is_told,
            Err(fault) => return Err(self.of_time(file, line, fault)),
        }
        let own = [1, 2].map(|role| self.field(lines, role));
        if own.iter().any(|unit| !unit.is_empty()) {
            (self.units.0, found.line, found.are_signals) = (own, line, true);
        }
        Ok(found)
    }

    /// The error for a fault of the time in this line.
    fn of_time(&self, file: &str, line: u64, fault: TimeFault) -> InputError {
        InputError::line(file, line, self.time_fault(fault))
    }

    /// The unit that this line holds for the column of this `role`.
    fn field(&self, lines: &Lines, role: usize) -> String {
        let field = self.places[role].and_then(|place| lines.fields().nth(place));
        bare(&lossy(field.unwrap_or_default())).to_owned()
    }

    /// Finds the divisors that bring both signals to one unit; fails if they measure different things.
    fn bring_together(&mut self, are_sure: bool) -> Result<(), LineFault> {
        let (units, outcome) = &mut self.units;
        *outcome = together([&units[0], &units[1]], are_sure);
        match outcome {
            Together::Same | Together::Unsure => {}
            Together::Divided(divisors) => self.divisors = *divisors,
            Together::Never => {
                let units = units.clone();
                return Err(LineFault::Units { units });
            }
        }
        Ok(())
    }

    /// The warnings about the first lines.
    pub fn warnings(&self) -> [Option<String>; 3] {
        [self.cut(), self.signal_units(), self.time_unit()]
    }

    /// The warning about signals in different units, or one of an unknown unit.
    fn signal_units(&self) -> Option<String> {
        let ([c, d], together) = &self.units;
        let told = match together {
            Together::Same | Together::Never => return None,
            Together::Divided(divisors) => {
                let larger = if divisors[0] > divisors[1] { d } else { c };
                format!("both are converted to {larger}")
            }
            Together::Unsure => {
                "one of these units is not known, and both signals are read without conversion"
                    .to_owned()
            }
        };
        Some(format!("S_C is in {c} and S_D in {d}: {told}"))
    }

    /// The warning about a time whose unit is not known.
    fn time_unit(&self) -> Option<String> {
        let name = self.unknown.as_ref()?;
        let samples = self.samples();
        Some(format!(
            "the unit of the time column `{name}` is not known, and its times are read as seconds; if they are not, convert them to \
             seconds, or ignore the column with --columns {samples} --rate HZ"
        ))
    }

    /// The warning about a first line that is left out.
    fn cut(&self) -> Option<String> {
        let line = self.cut?;
        Some(format!(
            "line {line} seems to lack its beginning, as if the logger had been attached in the middle of it, and is left out"
        ))
    }

    /// Sets the time's unit; false if it is no unit of time. `name` stands for it in an error.
    fn set_unit(&mut self, unit: &str, name: &str) -> Result<bool, TimeFault> {
        match time_exponent(unit) {
            None => Ok(false),
            Some(Some(exponent)) => {
                self.exponent = exponent;
                Ok(true)
            }
            Some(None) => {
                let name = name.to_owned();
                Err(TimeFault::Unit { name })
            }
        }
    }

    /// The time's unit, which may be empty, if this is a line of units.
    fn units(&mut self, lines: &Lines) -> Option<String> {
        let mut found: Vec<String> = lines.fields().map(lossy).collect();
        // A single separator at the end of a line does not begin another field.
        if found.len() == self.width + 1 && found[self.width].is_empty() {
            found.pop();
        }
        if found.len() > self.width {
            return None;
        }
        if let Some(counted) = self.counted {
            // A time column other than the first holds the times themselves.
            let first = counted.has_numbers.then_some(0);
            let is_first = self.places[0].is_none() || self.places[0] == first;
            if is_first && counted.sequence.is_none() {
                self.sequence = Sequence::read(&found, counted, lines.separator);
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
        let are_units = are_units(&found, lines.separator);
        (are_bracketed || are_units && found.iter().any(|unit| !unit.is_empty()))
            .then(|| time.to_owned())
    }

    /// The columns of the samples, as `--columns` takes them.
    pub fn samples(&self) -> String {
        let [c, d] = [1, 2].map(|role| self.places[role].map_or(0, |place| place + 1));
        format!("{c},{d}")
    }

    /// The fault of a line whose time is at fault, with the columns to read without it.
    pub fn time_fault(&self, fault: TimeFault) -> LineFault {
        let samples = self.samples();
        LineFault::Time { fault, samples }
    }
}

/// The fields of the first of these lines, if it may be one of units; otherwise none.
fn units_below(next: &[u8], separator: u8) -> Vec<String> {
    let mut lines = next.split(|&byte| byte == b'\n');
    let line = lines.find(|line| !is_skipped(line)).unwrap_or_default();
    let found: Vec<String> = fields(line, separator).map(lossy).collect();
    Some(found)
        .filter(|found| are_units(found, separator))
        .unwrap_or_default()
}

/// A field as text, whatever its encoding.
pub(super) fn lossy(field: &[u8]) -> String {
    String::from_utf8_lossy(field).into_owned()
}
