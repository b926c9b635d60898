//! What the first lines of a text recording tell: its columns, and the unit of its time.

use super::columns::{Columns, FirstLine, Places};
use super::error::{InputError, LineFault, TimeFault};
use super::heading::is_header;
use super::lines::{Beginning, Lines};
use super::sequence::{Sequence, names_end};
use super::text::{fields, number};
use super::units::{is_unit, of_name, time_exponent};

/// The columns of a text recording.
pub(super) struct Header {
    pub width: usize,
    pub places: Places,
    /// The power of ten that makes seconds of the time.
    pub exponent: i32,
    /// The times of the samples, where the first column counts them.
    pub sequence: Option<Sequence>,
    /// The columns that have units.
    columns: usize,
}

impl Header {
    /// Reads the names and the units, where there are any; what begins the text is still to be read.
    pub fn read(
        file: &str,
        lines: &mut Lines,
        beginning: &Beginning,
        chosen: Option<&Columns>,
    ) -> Result<Self, InputError> {
        let separator = lines.separator;
        let Beginning { first, next } = beginning;
        let mut names: Vec<String> = fields(first, separator).map(lossy).collect();
        let width = names.len();
        let end = names_end(&names);
        if end.is_some() && chosen.is_none() {
            names[0] = "time".to_owned();
        }
        let columns = end.unwrap_or(width);
        let names = is_header(first, next, separator).then_some(&names[..columns]);
        lines.advance()?;
        let line = FirstLine {
            names,
            width: columns,
        };
        let places = line
            .places(chosen)
            .map_err(|fault| InputError::line(file, lines.number(), fault))?;
        let mut header = Self {
            width,
            places,
            exponent: 0,
            sequence: None,
            columns,
        };
        let Some(names) = names else {
            lines.back();
            return Ok(header);
        };
        let fault = |header: &Self, line, fault| {
            Err(InputError::line(file, line, header.time_fault(fault)))
        };
        if let Some(time) = places[0] {
            let name = &names[time];
            if let Err(unit) = header.set_unit(of_name(name), name) {
                return fault(&header, lines.number(), unit);
            }
        }
        if lines.advance()? {
            match header.units(lines) {
                None => lines.back(),
                Some(unit) => {
                    if let Err(unit) = header.set_unit(&unit, &unit) {
                        return fault(&header, lines.number(), unit);
                    }
                }
            }
        }
        Ok(header)
    }

    /// Takes the time's unit, which stands in a column of this name, if it is one.
    fn set_unit(&mut self, unit: &str, name: &str) -> Result<(), TimeFault> {
        match time_exponent(unit) {
            None => {}
            Some(Some(exponent)) => self.exponent = exponent,
            Some(None) => {
                let name = name.to_owned();
                return Err(TimeFault::Unit { name });
            }
        }
        Ok(())
    }

    /// The time's unit, if this is a line of units.
    fn units(&mut self, lines: &Lines) -> Option<String> {
        let mut found: Vec<String> = lines.fields().map(lossy).collect();
        if found.len() > self.width {
            return None;
        }
        if self.columns < self.width {
            // Another column than the first holds times of its own.
            let is_first = self.places[0].is_none_or(|time| time == 0);
            let told = || Sequence::read(&found, self.columns, lines.separator);
            self.sequence = is_first.then(told).flatten();
            found.truncate(self.columns);
        }
        let is_number = |field: &str| number::<f64>(field.as_bytes(), lines.separator).is_some();
        let time = match self.places[0] {
            Some(place) => found
                .get(place)
                .filter(|unit| self.sequence.is_some() || time_exponent(unit).is_some())?,
            None => "",
        };
        let are_units = found.iter().all(|unit| is_unit(unit) && !is_number(unit))
            && found.iter().any(|unit| !unit.is_empty());
        are_units.then(|| time.to_owned())
    }

    /// The columns of the samples, as they are asked for.
    pub fn samples(&self) -> String {
        let [c, d] = [1, 2].map(|role| self.places[role].map_or(0, |place| place + 1));
        format!("{c},{d}")
    }

    /// A fault of the time, with the way around it.
    pub fn time_fault(&self, fault: TimeFault) -> LineFault {
        let samples = self.samples();
        LineFault::Time { fault, samples }
    }
}

/// A field as text, whatever its code.
pub(super) fn lossy(field: &[u8]) -> String {
    String::from_utf8_lossy(field).into_owned()
}
