//! Text recordings: one pair a line, with or without the time before it.

use std::io::{self, BufReader, Cursor, Read};

use csv::{ByteRecord, ReaderBuilder, Terminator};

use super::columns::{Columns, FirstLine, Places};
use super::error::{InputError, LineFault, Place, Role};
use super::text::{self, MAX_LINE, Number, Text, bare, fields, number};
use super::time::{Printed, TimeAxis, standstill};
use super::{Opened, Source, Stream};

/// The lines read ahead to tell the sample rate, whose times are rounded as they are printed.
const HEAD_LINES: usize = 1 << 16;

/// Opens text; `chosen` are the columns the user asks for.
pub(super) fn open(
    file: &str,
    stream: Stream,
    chosen: Option<&Columns>,
) -> Result<Opened, InputError> {
    let mut source = Delimited::open(file, stream, chosen)?;
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
    /// Pairs read to tell the sample rate, and not yet delivered.
    ahead: std::vec::IntoIter<[f32; 2]>,
    /// Met behind the last of them.
    fault: Option<InputError>,
}

/// A line's numbers.
struct Row {
    time: Option<Stamp>,
    pair: [f32; 2],
}

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
        let places = FirstLine {
            file,
            line,
            names,
            width,
        }
        .places(chosen)?;
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
        let lines = if self.places[0].is_some() {
            HEAD_LINES
        } else {
            1
        };
        let (mut pairs, mut stamps) = (Vec::new(), Vec::new());
        while pairs.len() < lines && self.fault.is_none() {
            match self.row() {
                Ok(Some(row)) => {
                    pairs.push(row.pair);
                    stamps.extend(row.time);
                }
                Ok(None) => break,
                Err(fault) => self.fault = Some(fault),
            }
        }
        self.axis = TimeAxis::of(&stamps, self.printed);
        let broken = match &mut self.axis {
            Some(axis) => stamps
                .iter()
                .enumerate()
                .skip(1)
                .find_map(|(index, &stamp)| {
                    let fault = axis.check(&self.file, stamp, self.printed).err()?;
                    Some((index, fault))
                }),
            None => standstill(&self.file, &stamps, self.printed),
        };
        if let Some((index, fault)) = broken {
            pairs.truncate(index);
            self.fault = Some(fault);
        }
        self.ahead = pairs.into_iter();
    }

    /// The number of the line last read.
    fn line(&self) -> u64 {
        self.skipped.0 + self.reader.position().line() - 1
    }

    /// Goes to the next line that is neither blank nor a comment.
    fn next_record(&mut self) -> Result<bool, InputError> {
        while self
            .reader
            .read_byte_record(&mut self.record)
            .map_err(|fault| self.broken(fault))?
        {
            if !text::is_skipped(self.record.as_slice()) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn broken(&self, fault: csv::Error) -> InputError {
        let file = self.file.clone();
        match fault.into_kind() {
            csv::ErrorKind::Io(fault) if fault.kind() == io::ErrorKind::InvalidData => {
                InputError::LineTooLong {
                    file,
                    line: self.line() + 1,
                    limit: MAX_LINE,
                }
            }
            csv::ErrorKind::Io(source) => InputError::io(&file, source),
            other => InputError::Io {
                file,
                source: io::Error::other(format!("{other:?}")),
            },
        }
    }

    fn row(&mut self) -> Result<Option<Row>, InputError> {
        if !self.next_record()? {
            return Ok(None);
        }
        let mut found = [None; 3];
        let (mut count, mut last_is_blank) = (0, false);
        for field in self.record.iter().map(bare) {
            if field.is_empty() && self.separator == b' ' {
                continue;
            }
            for (text, place) in found.iter_mut().zip(self.places) {
                if place == Some(count) {
                    *text = Some(field);
                }
            }
            count += 1;
            last_is_blank = field.is_empty();
        }
        let line = self.line();
        if count > self.width + usize::from(last_is_blank) {
            let file = self.file.clone();
            return Err(InputError::FieldCount {
                file,
                line,
                found: count,
                expected: self.width,
            });
        }
        let time = match self.places[0] {
            Some(_) => {
                let seconds = self.number(Role::Time, found[0])?;
                self.printed.see(found[0].unwrap_or_default());
                Some(Stamp { line, seconds })
            }
            None => None,
        };
        let pair = [
            self.number(Role::ALL[1], found[1])?,
            self.number(Role::ALL[2], found[2])?,
        ];
        Ok(Some(Row { time, pair }))
    }

    fn number<T: Number>(&self, role: Role, text: Option<&[u8]>) -> Result<T, InputError> {
        let text = text.unwrap_or_default();
        number(text, self.separator).ok_or_else(|| {
            let (file, line) = (self.file.clone(), self.line());
            let place = Role::ALL
                .iter()
                .position(|&other| other == role)
                .and_then(|index| self.places[index]);
            let column = place.unwrap_or(0) + 1;
            if text.is_empty() {
                return InputError::FieldMissing {
                    file,
                    line,
                    column,
                    role,
                };
            }
            let text = String::from_utf8_lossy(text)
                .chars()
                .flat_map(char::escape_debug)
                .take(40)
                .collect();
            InputError::Number {
                file,
                line,
                column,
                role,
                text,
            }
        })
    }
}

impl Source for Delimited {
    fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), InputError> {
        pairs.extend(self.ahead.by_ref().take(capacity));
        while pairs.len() < capacity {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            let Some(row) = self.row()? else { break };
            if let (Some(axis), Some(stamp)) = (&mut self.axis, row.time) {
                axis.check(&self.file, stamp, self.printed)?;
            }
            pairs.push(row.pair);
        }
        Ok(())
    }

    fn bytes_read(&self) -> u64 {
        self.skipped.1 + self.reader.position().byte()
    }
}

#[cfg(test)]
mod tests;
