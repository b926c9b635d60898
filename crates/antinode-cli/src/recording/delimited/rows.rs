//! The lines of a text recording, each as its time and its pair.

use super::super::Stream;
use super::super::columns::Columns;
use super::super::error::{InputError, LineFault, Place, Role, TimeFault};
use super::super::header::{Header, lossy};
use super::super::lines::Lines;
use super::super::no_number::stand_in;
use super::super::not_finite::Written;
use super::super::printed::Printed;
use super::super::text::number;

/// How much of a bad field an error shows.
const SHOWN_LETTERS: usize = 40;

/// So many bad lines before the first good one are no glitch, but something other than samples.
const NO_GLITCH: u64 = 2;

/// A line's time, if it is known, and its pair.
pub(super) type Row = (Option<f64>, [f32; 2]);

/// Reads lines of numbers.
pub(super) struct Rows {
    file: String,
    lines: Lines,
    pub header: Header,
    pub printed: Printed,
    /// The first sample that is not a finite number.
    not_finite: Option<Written>,
    /// The lines read.
    read: u64,
    /// Those of them with a field that is no number and stands for none.
    garbled: u64,
    /// The first of those: the lines before it, and what is wrong with it.
    first_garbled: Option<(u64, InputError)>,
    /// Those before the first that was good.
    garbled_before: u64,
}

impl Rows {
    /// Opens text and reads its header.
    pub fn open(file: &str, stream: Stream, chosen: Option<&Columns>) -> Result<Self, InputError> {
        let (mut lines, beginning) = Lines::open(file, stream)?;
        let header = Header::read(file, &mut lines, &beginning, chosen)?;
        Ok(Self {
            file: file.to_owned(),
            lines,
            header,
            printed: Printed::default(),
            not_finite: None,
            read: 0,
            garbled: 0,
            first_garbled: None,
            garbled_before: 0,
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

    /// The first sample that is not a finite number.
    pub fn not_finite(&self) -> Option<Written> {
        self.not_finite.clone()
    }

    /// The first line with a field that is no number, told once, where most lines have one: the lines before it, and its fault.
    pub fn mostly_garbled(&mut self) -> Option<(u64, InputError)> {
        let are_most = 2 * self.garbled > self.read || self.garbled_before >= NO_GLITCH;
        self.first_garbled.take_if(|_| are_most)
    }

    /// The next line's; none at the end.
    pub fn next(&mut self) -> Result<Option<Row>, InputError> {
        loop {
            if !self.lines.advance()? {
                return Ok(None);
            }
            // Without a time and a sample a line is blank, as spreadsheets fill it with marks; without a time for any it is a pair.
            let is_blank = || self.lines.fields().all(<[u8]>::is_empty);
            if self.header.places[0].is_none() || !is_blank() {
                break;
            }
        }
        let texts = texts(&self.file, &self.lines, &self.header)?;
        let mut pair = [f32::NAN; 2];
        // The role of the field that is no finite number, and of the one that is nothing at all.
        let (mut odd, mut garbled) = (None, None);
        for (channel, value) in pair.iter_mut().enumerate() {
            let (role, text) = (channel + 1, texts[channel + 1]);
            let read = number::<f32>(text, self.lines.separator);
            if let Some(read) = read.or_else(|| stand_in(text)) {
                *value = read / self.header.divisors[channel];
            } else {
                garbled = garbled.or(Some(role));
            }
            if !value.is_finite() {
                odd = odd.or(Some((role, read)));
            }
        }
        let mut time =
            number::<f64>(texts[0], self.lines.separator).filter(|time| time.is_finite());
        if let Some(time) = &mut time {
            self.printed.see(texts[0], *time, self.header.exponent);
            *time /= 10f64.powi(-self.header.exponent);
        } else if self.header.places[0].is_some() {
            // Where in time the pair belongs is not certain: one of both is enough to say so.
            pair[0] = f32::NAN;
            (odd, garbled) = (Some((0, None)), Some(0));
        }
        if let (None, Some((role, read))) = (&self.not_finite, odd) {
            let told = told(Role::ALL[role], texts[role], read);
            let place = self.place(role);
            let pair = self.read;
            self.not_finite = Some(Written { pair, place, told });
        }
        if let Some(role) = garbled {
            if self.garbled == 0 {
                self.first_garbled = Some((self.read, self.no_number(role, texts[role])));
            }
            self.garbled += 1;
        }
        self.read += 1;
        if self.garbled == self.read {
            self.garbled_before = self.garbled;
        }
        Ok(Some((time, pair)))
    }

    fn place(&self, role: usize) -> Place {
        place(&self.lines, &self.header, role)
    }

    /// What is wrong with `text`, which is in the column of this `role` and no number.
    fn no_number(&self, role: usize, text: &[u8]) -> InputError {
        if text.is_empty() {
            return missing(&self.file, &self.header, self.place(role), role);
        }
        let text = shown(text);
        let fault = match Role::ALL[role] {
            Role::Time => self.header.time_fault(TimeFault::Number { text }),
            role => LineFault::Number { role, text },
        };
        InputError::Line {
            file: self.file.clone(),
            place: self.place(role),
            fault,
        }
    }
}

/// What a field that is no finite number is, in words; `read` is the number that it holds all the same.
fn told(role: Role, text: &[u8], read: Option<f32>) -> String {
    let value = match read {
        _ if text.is_empty() => "missing".to_owned(),
        Some(read) => read.to_string(),
        None => format!("`{}`", shown(text)),
    };
    match role {
        Role::Time => format!("the time is {value}"),
        Role::Signal(channel) => format!("{channel}: the value is {value}"),
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

/// The time and the two samples of this line as they are written; nothing for a time that is not asked for.
fn texts<'a>(file: &str, lines: &'a Lines, header: &Header) -> Result<[&'a [u8]; 3], InputError> {
    let mut found = [None; 3];
    let (mut count, mut last_is_blank) = (0, false);
    for field in lines.fields() {
        for (text, place) in found.iter_mut().zip(header.places) {
            if place == Some(count) {
                *text = Some(field);
            }
        }
        (count, last_is_blank) = (count + 1, field.is_empty());
    }
    // One mark at the end of a line ends its last field; it does not begin another.
    if count > header.width + usize::from(last_is_blank) {
        let fault = LineFault::FieldCount {
            found: count,
            expected: header.width,
        };
        return Err(InputError::line(file, lines.number(), fault));
    }
    let mut texts = [&[][..]; 3];
    for (role, text) in found.into_iter().enumerate() {
        if header.places[role].is_some() {
            texts[role] =
                text.ok_or_else(|| missing(file, header, place(lines, header, role), role))?;
        }
    }
    Ok(texts)
}

/// This line, and the column of this `role`.
fn place(lines: &Lines, header: &Header, role: usize) -> Place {
    Place {
        line: lines.number(),
        column: header.places[role].map(|place| place + 1),
    }
}

/// The error for a line in which there is nothing of this `role`.
fn missing(file: &str, header: &Header, place: Place, role: usize) -> InputError {
    let fault = match Role::ALL[role] {
        Role::Time => header.time_fault(TimeFault::Missing),
        role => LineFault::FieldMissing { role },
    };
    InputError::Line {
        file: file.to_owned(),
        place,
        fault,
    }
}
