//! Lines of rows, counted, without those that are none: comments, and what spreadsheets add.

use std::io::{self, BufRead, Read};

/// A line that spreadsheets take for the mark between fields.
const MARK: &[u8] = b"sep=";

/// Whether a line holds no row: a comment, fields of nothing, or a spreadsheet's note of the mark between fields.
pub(super) fn is_skipped(line: &[u8]) -> bool {
    let is_empty = line.iter().all(|byte| b",;\t \"\r\n".contains(byte));
    is_empty || line.starts_with(b"#") || line.starts_with(MARK)
}

/// Lines that end in `\n` alone, each by itself: a reader that ends a row has no byte of the next line.
pub(super) struct Lines<R> {
    source: R,
    line: Vec<u8>,
    /// How much of the line is read.
    read: usize,
    /// Its number.
    pub number: u64,
    /// True where it is the last one and does not end.
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
            if self.source.read_until(b'\n', &mut self.line)? == 0 {
                return Ok(&[]);
            }
            self.number += 1;
            if !is_skipped(&self.line) {
                break;
            }
        }
        // Old files have `\r` alone, and one line for this count.
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
