//! The header of a text recording: its columns and their units, from the first lines.

mod column_units;

use column_units::SignalUnits;

use super::clocks::{self, clocks};
use super::columns::{Columns, FirstLine, Places};
use super::error::{Fault, TIME};
use super::heading::is_header;
use super::lines::{Beginning, Lines};
use super::sequence::{Sequence, counted};
use super::signal_units::is_known;
use super::stamps::Stamped;
use super::stated::Stated;
use super::text::{fields, is_skipped};
use super::units::are_units;
use crate::rows::MAIN_AMPLITUDE;

/// The columns of a text recording.
pub(super) struct Header {
    pub width: usize,
    pub places: Places,
    /// The column that counts the samples, if none holds their times and none is chosen.
    pub counter: Option<usize>,
    /// The power of ten of the time's unit in seconds: −3 for ms.
    pub exponent: i32,
    /// Whether the file tells that unit; otherwise it is taken to be s.
    pub has_unit_of_time: bool,
    /// What the time column is if it holds clock times, which have no unit.
    pub stamp: Option<Stamped>,
    /// The times of the samples, if these are counted from a start in equal steps.
    pub sequence: Option<Sequence>,
    /// The sample rate that the lines above state.
    pub stated: Option<Stated>,
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
        let Beginning {
            first,
            next,
            start,
            stated,
        } = beginning;
        let names: Vec<&[u8]> = fields(first, separator).collect();
        let below = next.split(|&byte| byte == b'\n');
        let below: Vec<Vec<&[u8]>> = below
            .filter(|line| !is_skipped(line))
            .map(|line| fields(line, separator).collect())
            .collect();
        let rows: Vec<&[&[u8]]> = below.iter().map(Vec::as_slice).collect();
        let names = &names[..without_padding(&names, &rows)];
        let is_header = is_header(names, &rows, separator);
        let clocks = clocks(&rows, separator);
        let [names, below] = [names, rows.first().unwrap_or(&&[][..])]
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
            stamped: (0..columns)
                .filter(|&place| lines.stamps.at(place).is_some())
                .collect(),
            clocks: clocks.iter().map(|clock| clock.place).collect(),
            start,
            is_of_rows: is_of_rows(first, next),
        };
        let places = line.places(chosen);
        let number = lines.number() + start.silent_lines as u64 + 1;
        let places = places.map_err(|fault| Fault::line(number, fault))?;
        let of_names = counted.and_then(|counted| counted.sequence);
        let sequence = start.sequence.or(of_names);
        let mut header = Self {
            width,
            places,
            counter: line.counter(places).filter(|_| chosen.is_none()),
            exponent: 0,
            has_unit_of_time: false,
            stamp: places[TIME].and_then(|place| lines.stamps.at(place)),
            sequence: sequence.filter(|_| places[TIME].is_none()),
            stated: *stated,
            divisors: [1.0; 2],
            warnings: Vec::new(),
        };
        header.warnings.extend(start.cut.map(|line| format!(
            "line {line} seems to lack its beginning, as if the logger had been attached in the middle of it, and is left out"
        )));
        let (has_time, told) = match names {
            Some(names) => {
                let (has_time, told) = header.read_units(lines, names, below, counted)?;
                (has_time, Some(told))
            }
            None => (false, None),
        };
        let is_sure =
            |told: &SignalUnits| told.are_sure && told.of.iter().any(|unit| is_known(unit));
        let units = match header.units_over(start) {
            Some(over) if !told.as_ref().is_some_and(is_sure) => Some(over),
            _ => told,
        };
        if let Some(units) = units {
            header.bring_together(&units)?;
        }
        header.has_unit_of_time = has_time || header.stamp.is_some() || start.unit.is_some();
        if !has_time {
            let doubt = header.doubt_time(names, start)?;
            header.warnings.extend(doubt);
        }
        let differ = clocks::warning(&clocks, places, header.exponent);
        header.warnings.extend(differ);
        Ok(header)
    }

    /// Takes the rate that the lines above state, if no times give one.
    pub fn use_stated_rate(&mut self) {
        if let (Some(Stated { rate, line }), None, None) =
            (self.stated, self.places[TIME], self.sequence)
        {
            self.sequence = Some(Sequence {
                start: 0.0,
                step: rate.recip(),
                is_counted: false,
            });
            self.warnings.push(format!(
                "the sample rate is {rate} Hz, as line {line} says; if it is not, give the right one as --rate HZ"
            ));
        }
    }

    /// The columns of the samples, as `--columns` takes them.
    pub fn samples(&self) -> String {
        let [c, d] = [1, 2].map(|role| self.places[role].map_or(0, |place| place + 1));
        format!("{c},{d}")
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

/// The number of columns without those at the end that are empty in all of these lines, as spreadsheets pad them.
fn without_padding(names: &[&[u8]], rows: &[&[&[u8]]]) -> usize {
    let is_empty =
        |fields: &[&[u8]], place: usize| fields.get(place).is_none_or(|field| field.is_empty());
    let is_used =
        |&place: &usize| !is_empty(names, place) || !rows.iter().all(|row| is_empty(row, place));
    (0..names.len())
        .rfind(is_used)
        .map_or(names.len(), |last| last + 1)
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
