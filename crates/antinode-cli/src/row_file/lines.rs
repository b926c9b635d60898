//! Lines of rows with their numbers, without comments and the lines that spreadsheets add.

use std::io::{self, BufRead, Read};

use super::TIME;

/// Longest header of rows, bytes.
const MAX_HEADER: u64 = 1 << 16;
/// Most lines above the heading of a table.
const MAX_ABOVE_TABLE: usize = 4;
/// Longest line, bytes: a file without ends of line must not fill the memory.
const MAX_LINE: usize = 1 << 24;

/// The beginning of a line that tells spreadsheets the separator of fields.
const MARK: &[u8] = b"sep=";

/// Whether a line holds no row: it is a comment, has only empty fields, or tells spreadsheets the separator.
pub(super) fn is_skipped(line: &[u8]) -> bool {
    let is_empty = line.iter().all(|byte| b",;\t \"\r\n".contains(byte));
    is_empty || line.starts_with(b"#") || line.starts_with(MARK)
}

/// The first lines, up to the one that may be a header, and where that begins; if it is none, also the lines that may stand above a
/// table's heading.
pub(super) fn head(source: &mut impl BufRead) -> io::Result<(Vec<u8>, usize)> {
    let mut head = Vec::new();
    let mut line = |head: &mut Vec<u8>| {
        let begun = head.len();
        let read = source.by_ref().take(MAX_HEADER).read_until(b'\n', head)?;
        io::Result::Ok((begun, read > 0))
    };
    loop {
        let (begun, is_line) = line(&mut head)?;
        if is_line && is_skipped(&head[begun..]) {
            continue;
        }
        if !holds(&head[begun..], TIME) {
            for _ in 0..MAX_ABOVE_TABLE {
                line(&mut head)?;
            }
        }
        return Ok((head, begun));
    }
}

/// Whether a text contains these words.
pub(super) fn holds(text: &[u8], words: &str) -> bool {
    text.windows(words.len())
        .any(|text| text == words.as_bytes())
}

/// Lines that end in `\n` alone, given one at a time: a reader at the end of a row has no byte of the next.
pub(super) struct Lines<R> {
    source: R,
    line: Vec<u8>,
    /// The number of bytes of the line that are given.
    read: usize,
    /// The line's number, from 1.
    pub number: u64,
    /// True if the line is the last one and has no end.
    pub is_cut: bool,
}

impl<R: BufRead> Lines<R> {
    pub fn new(source: R) -> Self {
        Self {
            source,
            line: Vec::new(),
            read: 0,
            number: 0,
            is_cut: false,
        }
    }

    /// The next line; an empty one at the end.
    pub fn next(&mut self) -> io::Result<&[u8]> {
        self.read = 0;
        loop {
            self.line.clear();
            let mut line = self.source.by_ref().take(MAX_LINE as u64);
            let read = line.read_until(b'\n', &mut self.line)?;
            if read == 0 {
                return Ok(&[]);
            }
            self.number += 1;
            if read == MAX_LINE {
                return Err(io::Error::other("more than 16 MiB without an end of line"));
            }
            if !is_skipped(&self.line) {
                break;
            }
        }
        // Old files end lines in `\r` alone, and are one line here.
        self.is_cut = !self.line.contains(&b'\n') && !self.line.contains(&b'\r');
        if self.line.ends_with(b"\r\n") {
            let end = self.line.len() - 2;
            self.line.remove(end);
        }
        Ok(&self.line)
    }
}

impl<R: BufRead> Read for Lines<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.read == self.line.len() {
            self.next()?;
        }
        let rest = &self.line[self.read..];
        let count = rest.len().min(bytes.len());
        bytes[..count].copy_from_slice(&rest[..count]);
        self.read += count;
        Ok(count)
    }
}
