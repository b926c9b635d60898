//! The lines of a text recording, cut into fields.

use std::io::{self, BufReader, Cursor, Read};

use csv::{ByteRecord, ReaderBuilder, Terminator};

use super::Stream;
use super::error::{InputError, LineFault};
use super::preamble::{self, STEADY_LINES, Start};
use super::quoted::{self, Quoted, has_decimal_commas};
use super::text::{self, LineEnds, MAX_LINE, Text, bare};

/// The beginning of a text below its settings, which [`Lines`] has still to read.
pub(super) struct Beginning {
    /// The first line.
    pub first: Vec<u8>,
    /// The lines behind it.
    pub next: Vec<u8>,
    /// What was found above and in these lines.
    pub start: Start,
}

/// Reads lines that are neither blank nor comments.
pub(super) struct Lines {
    file: String,
    reader: csv::Reader<Text>,
    record: ByteRecord,
    pub separator: u8,
    /// The lines and bytes before those that `reader` has.
    skipped: (u64, u64),
    /// True if the line last read is to be read again.
    again: bool,
}

impl Lines {
    /// Opens text, and gives its first lines beside the reader.
    pub fn open(file: &str, stream: Stream) -> Result<(Self, Beginning), InputError> {
        let mut stream = BufReader::with_capacity(MAX_LINE, LineEnds::new(stream));
        let (mut begun, line, before) = text::first_line(file, &mut stream)?;
        // Reading these lines ahead delays no row of a pipe: each row needs at least as many lines.
        let mut is_quoted = false;
        let mut start = loop {
            let next = text::next_lines(&mut stream, STEADY_LINES)
                .map_err(|fault| InputError::io(file, fault))?;
            begun.extend_from_slice(&next);
            is_quoted = is_quoted || has_decimal_commas(&begun);
            if is_quoted {
                quoted::separate(&mut begun, &mut false);
            }
            let is_all = next.iter().filter(|&&byte| byte == b'\n').count() < STEADY_LINES;
            if let Some(start) = preamble::find(&begun, is_all) {
                break start;
            }
        };
        let begun = begun.split_off(start.bytes);
        let skipped = (line - 1 + start.lines as u64, before + start.bytes as u64);
        if let Some((_, unit)) = &mut start.unit {
            *unit += line as usize;
        }
        if let Some(cut) = &mut start.cut {
            *cut += line as usize;
        }
        let end = begun.iter().position(|&byte| byte == b'\n');
        let (first, next) = begun.split_at(end.map_or(begun.len(), |end| end + 1));
        let beginning = Beginning {
            first: first.to_vec(),
            next: next.to_vec(),
            start,
        };
        let separator = text::separator(&beginning.first);
        let rest: Stream = if is_quoted {
            Box::new(Quoted::new(Box::new(stream)))
        } else {
            Box::new(stream)
        };
        let text = Text::new(Box::new(Cursor::new(begun).chain(rest)));
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(separator)
            .terminator(Terminator::Any(b'\n'))
            // A stray quote must not swallow the lines that follow.
            .quoting(false)
            .buffer_capacity(MAX_LINE)
            .from_reader(text);
        let lines = Self {
            file: file.to_owned(),
            reader,
            record: ByteRecord::new(),
            separator,
            skipped,
            again: false,
        };
        Ok((lines, beginning))
    }

    /// The number of the line last read.
    pub fn number(&self) -> u64 {
        self.skipped.0 + self.reader.position().line() - 1
    }

    /// The bytes read so far.
    pub fn bytes_read(&self) -> u64 {
        self.skipped.1 + self.reader.position().byte()
    }

    /// True when no whole line is left of what has come.
    pub fn is_drained(&self) -> bool {
        self.reader.position().byte() >= self.reader.get_ref().lines_end()
    }

    /// Has [`advance`](Self::advance) give the line last read once more.
    pub fn back(&mut self) {
        self.again = true;
    }

    /// Goes to the next line; false at the end.
    pub fn advance(&mut self) -> Result<bool, InputError> {
        if std::mem::take(&mut self.again) {
            return Ok(true);
        }
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

    /// The fields of this line; where blanks separate them, only those that are not empty.
    pub fn fields(&self) -> impl Iterator<Item = &[u8]> {
        let fields = self.record.iter().map(bare);
        fields.filter(|field| self.separator != b' ' || !field.is_empty())
    }

    fn broken(&self, fault: csv::Error) -> InputError {
        match fault.into_kind() {
            csv::ErrorKind::Io(fault) if fault.kind() == io::ErrorKind::InvalidData => {
                let fault = LineFault::LineTooLong { limit: MAX_LINE };
                InputError::line(&self.file, self.number() + 1, fault)
            }
            csv::ErrorKind::Io(fault) => InputError::io(&self.file, fault),
            other => InputError::io(&self.file, io::Error::other(format!("{other:?}"))),
        }
    }
}
