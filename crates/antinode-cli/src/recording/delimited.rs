//! Text recordings: one pair a line, with or without the time before it.

use std::io::{self, BufReader, Cursor, Read};

use csv::{ByteRecord, ReaderBuilder, Terminator};

use super::columns::{Columns, FirstLine, Places};
use super::error::{InputError, LineFault, Place, Role};
use super::text::{self, MAX_LINE, Text, bare, fields, number};
use super::time::{Printed, TimeAxis, standstill};
use super::{Opened, Source, Stream};

/// The lines read ahead to tell the sample rate, whose times are rounded as they are printed.
const HEAD_LINES: usize = 1 << 16;

/// As much of a bad field as an error shows.
const SHOWN_LETTERS: usize = 40;

/// Opens text; `chosen` are the columns the user asks for, and a `live` stream is handed over as it comes.
pub(super) fn open(
    file: &str,
    stream: Stream,
    chosen: Option<&Columns>,
    live: bool,
) -> Result<Opened, InputError> {
    let mut source = Delimited::open(file, stream, chosen)?;
    source.live = live;
    source.read_ahead();
    if source.ahead.len() == 0 {
        let none = InputError::NoPairs {
            file: file.to_owned(),
        };
        return Err(source.fault.take().unwrap_or(none));
    }
    let sample_rate = source.axis.as_ref().map(TimeAxis::rate);
    Ok(Opened {
        source: Box::new(source),
        sample_rate,
        pairs: None,
        full_scale: None,
    })
}

/// Reads lines of numbers.
struct Delimited {
    file: String,
    reader: csv::Reader<Text>,
    record: ByteRecord,
    separator: u8,
    /// The lines and bytes before those that `reader` has.
    skipped: (u64, u64),
    width: usize,
    places: Places,
    printed: Printed,
    axis: Option<TimeAxis>,
    live: bool,
    /// Of the first sample that is not a finite number.
    not_finite: Option<Place>,
    /// Pairs read to tell the sample rate, and not yet delivered.
    ahead: std::vec::IntoIter<[f32; 2]>,
    /// Met behind the last of them.
    fault: Option<InputError>,
}

/// A line's time, if there is one, and its pair.
type Row = (Option<f64>, [f32; 2]);

impl Delimited {
    fn open(file: &str, stream: Stream, chosen: Option<&Columns>) -> Result<Self, InputError> {
        let mut stream = BufReader::with_capacity(MAX_LINE, stream);
        let (first, line, before) = text::first_line(file, &mut stream)?;
        let separator = text::separator(&first);
        let text = Text::new(Box::new(Cursor::new(first.clone()).chain(stream)));
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(separator)
            .terminator(Terminator::Any(b'\n'))
            // A stray quote must not swallow the lines that follow.
            .quoting(false)
            .buffer_capacity(MAX_LINE)
            .from_reader(text);
        let names: Vec<String> = fields(&first, separator)
            .map(|name| String::from_utf8_lossy(name).into_owned())
            .collect();
        let is_header =
            !fields(&first, separator).any(|field| number::<f64>(field, separator).is_some());
        let width = names.len();
        let names = is_header.then_some(names.as_slice());
        let places = FirstLine { names, width }
            .places(chosen)
            .map_err(|fault| InputError::line(file, line, fault))?;
        let mut source = Self {
            file: file.to_owned(),
            reader,
            record: ByteRecord::new(),
            separator,
            skipped: (line - 1, before),
            width,
            places,
            printed: Printed::default(),
            axis: None,
            live: false,
            not_finite: None,
            ahead: Vec::new().into_iter(),
            fault: None,
        };
        if is_header {
            source.next_record()?;
        }
        Ok(source)
    }

    /// Reads as many lines as it takes to tell the sample rate, and checks their times.
    fn read_ahead(&mut self) {
        let head = if self.places[0].is_some() {
            HEAD_LINES
        } else {
            1
        };
        let (mut pairs, mut times, mut lines) = (Vec::new(), Vec::new(), Vec::new());
        while pairs.len() < head && self.fault.is_none() {
            match self.row() {
                Ok(Some((time, pair))) => {
                    pairs.push(pair);
                    times.extend(time);
                    lines.push(self.line());
                }
                Ok(None) => break,
                Err(fault) => self.fault = Some(fault),
            }
        }
        self.axis = TimeAxis::of(&times, self.printed);
        let broken = match &mut self.axis {
            Some(axis) => times.iter().enumerate().skip(1).find_map(|(index, &time)| {
                let fault = axis.check(time, self.printed).err()?;
                Some((index, fault))
            }),
            None => standstill(&times, self.printed),
        };
        if let Some((index, fault)) = broken {
            pairs.truncate(index);
            self.fault = Some(InputError::line(&self.file, lines[index], fault));
        }
        self.ahead = pairs.into_iter();
    }

    /// The number of the line last read.
    fn line(&self) -> u64 {
        self.skipped.0 + self.reader.position().line() - 1
    }

    /// Goes to the next line that is neither blank nor a comment.
    fn next_record(&mut self) -> Result<bool, InputError> {
        loop {
            let read = self.reader.read_byte_record(&mut self.record);
            if !read.map_err(|fault| self.broken(fault))? {
                return Ok(false);
            }
            // A line of nothing but separators is not blank: its numbers are missing.
            let whole = self.record.len() <= 1 || self.separator == b' ';
            let start = if whole {
                self.record.as_slice()
            } else {
                &self.record[0]
            };
            if !(text::is_skipped(start) && (whole || text::is_comment(start))) {
                return Ok(true);
            }
        }
    }

    fn broken(&self, fault: csv::Error) -> InputError {
        match fault.into_kind() {
            csv::ErrorKind::Io(fault) if fault.kind() == io::ErrorKind::InvalidData => {
                let fault = LineFault::LineTooLong { limit: MAX_LINE };
                InputError::line(&self.file, self.line() + 1, fault)
            }
            csv::ErrorKind::Io(fault) => InputError::io(&self.file, fault),
            other => InputError::io(&self.file, io::Error::other(format!("{other:?}"))),
        }
    }

    fn row(&mut self) -> Result<Option<Row>, InputError> {
        if !self.next_record()? {
            return Ok(None);
        }
        let mut found = [&[][..]; 3];
        let (mut count, mut last_is_blank) = (0, false);
        for field in self.record.iter().map(bare) {
            if field.is_empty() && self.separator == b' ' {
                continue;
            }
            for (text, place) in found.iter_mut().zip(self.places) {
                if place == Some(count) {
                    *text = field;
                }
            }
            count += 1;
            last_is_blank = field.is_empty();
        }
        if count > self.width + usize::from(last_is_blank) {
            let fault = LineFault::FieldCount {
                found: count,
                expected: self.width,
            };
            return Err(InputError::line(&self.file, self.line(), fault));
        }
        let time = self.places[0].map(|_| {
            let time = number::<f64>(found[0], self.separator).filter(|time| time.is_finite());
            time.ok_or_else(|| self.no_number(0, found[0]))
        });
        let time = time.transpose()?;
        if time.is_some() {
            self.printed.see(found[0]);
        }
        let signal = |role: usize| {
            number::<f32>(found[role], self.separator)
                .ok_or_else(|| self.no_number(role, found[role]))
        };
        let pair = [signal(1)?, signal(2)?];
        if self.not_finite.is_none()
            && let Some(channel) = pair.iter().position(|value| !value.is_finite())
        {
            self.not_finite = Some(self.place(channel + 1));
        }
        Ok(Some((time, pair)))
    }

    /// This line, and the column of this `role`.
    fn place(&self, role: usize) -> Place {
        Place {
            line: self.line(),
            column: self.places[role].map(|place| place + 1),
        }
    }

    /// What is wrong with `text`, which is in the column of this `role` and no number.
    fn no_number(&self, role: usize, text: &[u8]) -> InputError {
        let place = self.place(role);
        let role = Role::ALL[role];
        let fault = if text.is_empty() {
            LineFault::FieldMissing { role }
        } else {
            let text = String::from_utf8_lossy(text);
            let shown = text
                .chars()
                .flat_map(char::escape_debug)
                .take(SHOWN_LETTERS);
            LineFault::Number {
                role,
                text: shown.collect(),
            }
        };
        InputError::Line {
            file: self.file.clone(),
            place,
            fault,
        }
    }
}

impl Source for Delimited {
    fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), InputError> {
        pairs.extend(self.ahead.by_ref().take(capacity));
        while pairs.len() < capacity {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            let Some((time, pair)) = self.row()? else {
                break;
            };
            if let (Some(axis), Some(time)) = (&mut self.axis, time) {
                let checked = axis.check(time, self.printed);
                checked.map_err(|fault| InputError::line(&self.file, self.line(), fault))?;
            }
            pairs.push(pair);
            // The next line may take its time.
            if self.live && self.reader.position().byte() >= self.reader.get_ref().lines_end() {
                break;
            }
        }
        Ok(())
    }

    fn bytes_read(&self) -> u64 {
        self.skipped.1 + self.reader.position().byte()
    }

    fn not_finite_place(&self) -> Option<Place> {
        self.not_finite
    }
}

#[cfg(test)]
mod tests;
