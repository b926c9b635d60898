//! The lines of a text recording, cut into fields.

use std::io::{self, BufRead, BufReader, Read};

use super::Stream;
use super::error::Fault;
use super::preamble::{self, STEADY_LINES, Start};
use super::quoted::{self, has_decimal_commas};
use super::stamps::Stamps;
use super::stated::Stated;
use super::text::{self, MAX_LINE};

/// The beginning of a text below its settings, which [`Lines`] has still to read.
pub(super) struct Beginning {
    /// The first line.
    pub first: Vec<u8>,
    /// The lines behind it.
    pub next: Vec<u8>,
    /// What was found above and in these lines.
    pub start: Start,
    /// The sample rate that the lines above state.
    pub stated: Option<Stated>,
}

/// Reads lines that are neither blank nor comments.
pub(super) struct Lines {
    /// Whole lines read ahead, of which those up to `passed` are done with, and what is behind them.
    ahead: Vec<u8>,
    passed: usize,
    rest: BufReader<Stream>,
    /// The line last read, without its end.
    line: Vec<u8>,
    pub separator: u8,
    /// Whether numbers are in quotes, with decimal commas.
    is_quoted: bool,
    /// The columns of clock times, which are read as seconds.
    pub stamps: Stamps,
    number: u64,
}

impl Lines {
    /// Opens text, and gives its first lines beside the reader.
    pub fn open(stream: Stream) -> Result<(Self, Beginning), Fault> {
        let mut stream = BufReader::with_capacity(MAX_LINE, text::with_line_ends(stream)?);
        let mut above = Vec::new();
        let (mut begun, line) = text::first_line(&mut stream, &mut above)?;
        // Reading these lines ahead delays no row of a pipe: each row needs at least as many lines.
        let (mut is_quoted, mut stamps) = (false, Stamps::default());
        let mut start = loop {
            let next = text::next_lines(&mut stream, STEADY_LINES)?;
            begun.extend_from_slice(&next);
            is_quoted = is_quoted || has_decimal_commas(&begun);
            if is_quoted {
                quoted::separate(&mut begun);
            }
            if stamps.is_empty() {
                stamps = Stamps::of(&begun);
            }
            stamps.convert(&mut begun);
            let is_all = next.iter().filter(|&&byte| byte == b'\n').count() < STEADY_LINES;
            if let Some(start) = preamble::find(&begun, is_all) {
                break start;
            }
        };
        let samples = begun.split_off(start.bytes);
        above.append(&mut begun);
        let begun = samples;
        let unit = start.unit.as_mut().map(|(_, line)| line);
        let units = start.units.as_mut().map(|(_, line)| line);
        for number in [unit, units, start.cut.as_mut()].into_iter().flatten() {
            *number += line as usize;
        }
        let shown = &begun[start.silent_bytes..];
        let end = shown.iter().position(|&byte| byte == b'\n');
        let (first, next) = shown.split_at(end.map_or(shown.len(), |end| end + 1));
        let beginning = Beginning {
            first: first.to_vec(),
            next: next.to_vec(),
            start,
            stated: Stated::above(&above),
        };
        let lines = Self {
            separator: text::separator(&beginning.first),
            ahead: begun,
            passed: 0,
            rest: stream,
            line: Vec::new(),
            is_quoted,
            stamps,
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
        self.passed == self.ahead.len() && !self.rest.buffer().contains(&b'\n')
    }

    /// Reads lines ahead until there are `lines` of any kind; fewer at the end, or at one that is too long.
    pub fn look_ahead(&mut self, lines: usize) -> io::Result<()> {
        let ahead = self.ahead[self.passed..].split(|&byte| byte == b'\n');
        // Behind the last end of line there is one part more, which is empty.
        if let Some(more @ 1..) = (lines + 1).checked_sub(ahead.take(lines + 1).count()) {
            self.ahead.drain(..self.passed);
            self.passed = 0;
            let mut next = text::next_lines(&mut self.rest, more)?;
            if self.is_quoted {
                quoted::separate(&mut next);
            }
            self.stamps.convert(&mut next);
            self.ahead.append(&mut next);
        }
        Ok(())
    }

    /// The lines read ahead that are neither blank nor comments.
    pub fn ahead(&self) -> impl Iterator<Item = Line<'_>> {
        let texts = self.ahead[self.passed..].split(|&byte| byte == b'\n');
        let lines = texts.map(|text| Line::new(text, self.separator));
        lines.filter(|line| !line.is_skipped())
    }

    /// Goes to the next line; false at the end.
    pub fn advance(&mut self) -> Result<bool, Fault> {
        loop {
            self.line.clear();
            let read = if self.passed < self.ahead.len() {
                let rest = &self.ahead[self.passed..];
                let end = rest.iter().position(|&byte| byte == b'\n');
                self.line
                    .extend_from_slice(&rest[..end.map_or(rest.len(), |end| end + 1)]);
                self.passed += self.line.len();
                self.line.len()
            } else {
                let mut line = self.rest.by_ref().take(MAX_LINE as u64);
                line.read_until(b'\n', &mut self.line)?
            };
            if read == 0 {
                return Ok(false);
            }
            self.number += 1;
            if read >= MAX_LINE {
                return Err(Fault::line_too_long(self.number));
            }
            self.line.pop_if(|last| *last == b'\n');
            if self.is_quoted {
                quoted::separate(&mut self.line);
            }
            self.stamps.convert(&mut self.line);
            if !self.line().is_skipped() {
                return Ok(true);
            }
        }
    }

    /// This line.
    pub fn line(&self) -> Line<'_> {
        Line::new(&self.line, self.separator)
    }

    /// Takes this line out, so that others may be read ahead while it is looked at.
    pub fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.line)
    }

    /// Gives back what was taken out: its memory holds the next line.
    pub fn give_back(&mut self, line: Vec<u8>) {
        self.line = line;
    }
}

/// A line without its end.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    text: &'a [u8],
    separator: u8,
}

impl<'a> Line<'a> {
    pub fn new(text: &'a [u8], separator: u8) -> Self {
        Self { text, separator }
    }

    /// Whether this line is blank or a comment. One of nothing but separators is not blank: its numbers are missing.
    fn is_skipped(self) -> bool {
        let is_field = |part: &&[u8]| self.separator != b' ' || !part.is_empty();
        let parts = self.text.split(|&byte| byte == self.separator);
        let mut parts = parts.filter(is_field);
        let first = parts.next().unwrap_or_default();
        text::is_comment(first) || first.trim_ascii().is_empty() && parts.next().is_none()
    }

    /// The fields of this line; where blanks separate them, only those that are not empty.
    pub fn fields(self) -> impl Iterator<Item = &'a [u8]> {
        text::all_fields(self.text, self.separator)
    }
}
