//! The lines of a text recording, each as its time and its pair.

use super::super::Stream;
use super::super::columns::Columns;
use super::super::error::{InputError, LineFault, Place, Role, TimeFault};
use super::super::header::{Header, lossy};
use super::super::lines::Lines;
use super::super::printed::Printed;
use super::super::text::number;

/// As much of a bad field as an error shows.
const SHOWN_LETTERS: usize = 40;

/// A line's time, if there is one, and its pair.
pub(super) type Row = (Option<f64>, [f32; 2]);

/// Reads lines of numbers.
pub(super) struct Rows {
    file: String,
    lines: Lines,
    pub header: Header,
    pub printed: Printed,
    /// Of the first sample that is not a finite number.
    not_finite: Option<Place>,
}

impl Rows {
    /// Opens text and reads its header.
    pub fn open(file: &str, stream: Stream, chosen: Option<&Columns>) -> Result<Self, InputError> {
        let (mut lines, first) = Lines::open(file, stream)?;
        let header = Header::read(file, &mut lines, &first, chosen)?;
        Ok(Self {
            file: file.to_owned(),
            lines,
            header,
            printed: Printed::default(),
            not_finite: None,
        })
    }

    /// The number of the line last read.
    pub fn line(&self) -> u64 {
        self.lines.number()
    }

    /// The bytes read so far.
    pub fn bytes_read(&self) -> u64 {
        self.lines.bytes_read()
    }

    /// True when no whole line is left of what has come.
    pub fn is_drained(&self) -> bool {
        self.lines.is_drained()
    }

    /// The place of the first sample that is not a finite number.
    pub fn not_finite(&self) -> Option<Place> {
        self.not_finite
    }

    /// The next line's; none at the end.
    pub fn next(&mut self) -> Result<Option<Row>, InputError> {
        if !self.lines.advance()? {
            return Ok(None);
        }
        let mut found = [&[][..]; 3];
        let (mut count, mut last_is_blank) = (0, false);
        for field in self.lines.fields() {
            for (text, place) in found.iter_mut().zip(self.header.places) {
                if place == Some(count) {
                    *text = field;
                }
            }
            (count, last_is_blank) = (count + 1, field.is_empty());
        }
        // One mark at the end of a line ends its last field; it does not begin another.
        if count > self.header.width + usize::from(last_is_blank) {
            let fault = LineFault::FieldCount {
                found: count,
                expected: self.header.width,
            };
            return Err(InputError::line(&self.file, self.lines.number(), fault));
        }
        let mut time = None;
        if self.header.places[0].is_some() {
            let told = number::<f64>(found[0], self.lines.separator)
                .filter(|time| time.is_finite())
                .ok_or_else(|| self.no_number(0, found[0]))?;
            self.printed.see(found[0], told, self.header.exponent);
            time = Some(told / 10f64.powi(-self.header.exponent));
        }
        let signal = |role: usize| {
            number::<f32>(found[role], self.lines.separator)
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
            line: self.lines.number(),
            column: self.header.places[role].map(|place| place + 1),
        }
    }

    /// What is wrong with `text`, which is in the column of this `role` and no number.
    fn no_number(&self, role: usize, text: &[u8]) -> InputError {
        let place = self.place(role);
        let is_missing = text.is_empty();
        let text = shown(text);
        let fault = match Role::ALL[role] {
            Role::Time if is_missing => self.header.time_fault(TimeFault::Missing),
            Role::Time => self.header.time_fault(TimeFault::Number { text }),
            role if is_missing => LineFault::FieldMissing { role },
            role => LineFault::Number { role, text },
        };
        InputError::Line {
            file: self.file.clone(),
            place,
            fault,
        }
    }
}

/// A bad field as an error shows it.
fn shown(field: &[u8]) -> String {
    let text = lossy(field);
    text.chars()
        .flat_map(char::escape_debug)
        .take(SHOWN_LETTERS)
        .collect()
}
