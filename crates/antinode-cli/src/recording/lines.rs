//! The lines of a text recording, cut into fields.

use std::io::{BufRead, BufReader, Chain, Cursor, Read};

use super::Stream;
use super::error::Fault;
use super::preamble::{self, STEADY_LINES, Start};
use super::quoted::{self, has_decimal_commas};
use super::text::{self, MAX_LINE};

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
    /// The lines read ahead, and those behind them.
    stream: Chain<Cursor<Vec<u8>>, BufReader<Stream>>,
    /// The line last read, without its end.
    line: Vec<u8>,
    pub separator: u8,
    /// Whether numbers are in quotes, with decimal commas.
    is_quoted: bool,
    number: u64,
}

impl Lines {
    /// Opens text, and gives its first lines beside the reader.
    pub fn open(stream: Stream) -> Result<(Self, Beginning), Fault> {
        let mut stream = BufReader::with_capacity(MAX_LINE, text::with_line_ends(stream)?);
        let (mut begun, line) = text::first_line(&mut stream)?;
        // Reading these lines ahead delays no row of a pipe: each row needs at least as many lines.
        let mut is_quoted = false;
        let mut start = loop {
            let next = text::next_lines(&mut stream, STEADY_LINES)?;
            begun.extend_from_slice(&next);
            is_quoted = is_quoted || has_decimal_commas(&begun);
            if is_quoted {
                quoted::separate(&mut begun);
            }
            let is_all = next.iter().filter(|&&byte| byte == b'\n').count() < STEADY_LINES;
            if let Some(start) = preamble::find(&begun, is_all) {
                break start;
            }
        };
        let begun = begun.split_off(start.bytes);
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
        let lines = Self {
            separator: text::separator(&beginning.first),
            stream: Cursor::new(begun).chain(stream),
            line: Vec::new(),
            is_quoted,
            number: line - 1 + beginning.start.lines as u64,
        };
        Ok((lines, beginning))
    }

    /// The number of the line last read.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// True when no whole line is left of what has come.
    pub fn is_drained(&self) -> bool {
        let (begun, rest) = self.stream.get_ref();
        let is_begun = begun.position() < begun.get_ref().len() as u64;
        !is_begun && !rest.buffer().contains(&b'\n')
    }

    /// Goes to the next line; false at the end.
    pub fn advance(&mut self) -> Result<bool, Fault> {
        loop {
            self.line.clear();
            let mut line = self.stream.by_ref().take(MAX_LINE as u64);
            let read = line.read_until(b'\n', &mut self.line)?;
            if read == 0 {
                return Ok(false);
            }
            self.number += 1;
            if read == MAX_LINE {
                return Err(Fault::line_too_long(self.number));
            }
            self.line.pop_if(|last| *last == b'\n');
            if self.is_quoted {
                quoted::separate(&mut self.line);
            }
            if !self.is_skipped() {
                return Ok(true);
            }
        }
    }

    /// Whether this line is blank or a comment. One of nothing but separators is not blank: its numbers are missing.
    fn is_skipped(&self) -> bool {
        let is_field = |part: &&[u8]| self.separator != b' ' || !part.is_empty();
        let parts = self.line.split(|&byte| byte == self.separator);
        let mut parts = parts.filter(is_field);
        let first = parts.next().unwrap_or_default();
        text::is_comment(first) || first.trim_ascii().is_empty() && parts.next().is_none()
    }

    /// The fields of this line; where blanks separate them, only those that are not empty.
    pub fn fields(&self) -> impl Iterator<Item = &[u8]> {
        text::all_fields(&self.line, self.separator)
    }
}
