//! What the first lines of a text recording tell: its columns, and the unit of its time.

use super::columns::{Columns, FirstLine, Places};
use super::error::{InputError, LineFault, TimeFault};
use super::lines::Lines;
use super::text::{fields, number};
use super::units::{is_unit, of_name, time_exponent};

/// The columns of a text recording.
pub(super) struct Header {
    pub width: usize,
    pub places: Places,
    /// The power of ten that makes seconds of the time.
    pub exponent: i32,
}

impl Header {
    /// Reads the names and the units, where there are any; `first` is the first line, which is still to be read.
    pub fn read(
        file: &str,
        lines: &mut Lines,
        first: &[u8],
        chosen: Option<&Columns>,
    ) -> Result<Self, InputError> {
        let separator = lines.separator;
        let names: Vec<String> = fields(first, separator).map(lossy).collect();
        let is_header =
            !fields(first, separator).any(|field| number::<f64>(field, separator).is_some());
        let width = names.len();
        let names = is_header.then_some(names.as_slice());
        lines.advance()?;
        let places = FirstLine { names, width }
            .places(chosen)
            .map_err(|fault| InputError::line(file, lines.number(), fault))?;
        let mut header = Self {
            width,
            places,
            exponent: 0,
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
    fn units(&self, lines: &Lines) -> Option<String> {
        let found: Vec<String> = lines.fields().map(lossy).collect();
        let is_number = |field: &str| number::<f64>(field.as_bytes(), lines.separator).is_some();
        let time = match self.places[0] {
            Some(place) => found
                .get(place)
                .filter(|unit| time_exponent(unit).is_some())?,
            None => "",
        };
        let are_units = found.iter().all(|unit| is_unit(unit) && !is_number(unit))
            && found.iter().any(|unit| !unit.is_empty());
        (are_units && found.len() <= self.width).then(|| time.to_owned())
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
