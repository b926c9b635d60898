//! Rows as `antinode identify --output csv` prints them, from a file or standard input, and what is told where they are not.

use std::io::{self, IsTerminal, Read};
use std::path::Path;

use antinode::Flags;
use csv::{Position, Reader, StringRecord};

use crate::failure::Failure;
use crate::recording::{in_utf8, open_file};

/// A file of rows, read line by line.
pub struct RowFile<R> {
    name: String,
    reader: Reader<R>,
    header: StringRecord,
    record: StringRecord,
}

impl RowFile<Box<dyn Read>> {
    /// Opens a file, or standard input if `path` is `-`.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            if io::stdin().is_terminal() {
                eprintln!("reading rows from standard input; Ctrl-D ends them");
            }
            return Self::new("standard input", Box::new(in_utf8(io::stdin())));
        }
        let name = path.display().to_string();
        Self::new(&name, Box::new(in_utf8(open_file(path)?)))
    }
}

impl<R: Read> RowFile<R> {
    /// Reads the header.
    pub fn new(name: &str, source: R) -> Result<Self, Failure> {
        let mut reader = Reader::from_reader(source);
        let header = reader.headers().map_err(|error| unreadable(name, &error))?;
        Ok(Self {
            name: name.to_owned(),
            header: header.clone(),
            reader,
            record: StringRecord::new(),
        })
    }

    /// As messages call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where a column stands that rows may lack.
    pub fn place(&self, column: &str) -> Option<usize> {
        self.header.iter().position(|name| name == column)
    }

    /// Where a column stands that rows must have.
    pub fn needed(&self, column: &str) -> Result<usize, Failure> {
        self.place(column).ok_or_else(|| {
            Failure::Recording(format!(
                "{}: no column {column} in its first line; give rows as `antinode identify --output csv` prints them",
                self.name
            ))
        })
    }

    /// The next row; none at the end.
    pub fn next(&mut self) -> Result<Option<&StringRecord>, Failure> {
        loop {
            let more = self.reader.read_record(&mut self.record);
            let more = more.map_err(|error| unreadable(&self.name, &error))?;
            // Files that were put together bring their headers along.
            if !more || self.record != self.header {
                return Ok(more.then_some(&self.record));
            }
        }
    }

    /// What is told where the last row cannot be used.
    pub fn fault(&self, what: &str) -> Failure {
        let line = self.record.position().map_or(0, Position::line);
        Failure::Recording(format!(
            "{}, line {line}: {what}; leave the line out",
            self.name
        ))
    }
}

/// The number in a field of a row.
pub fn number(row: &StringRecord, place: usize) -> Option<f64> {
    row.get(place)?.trim().parse().ok()
}

/// Whether a row's column `flags` has a flag.
pub fn has_flag(flags: &str, flag: Flags) -> bool {
    flags
        .split('+')
        .any(|name| flag.names().any(|one| one == name))
}

/// What is told where there are no rows.
fn unreadable(name: &str, error: &csv::Error) -> Failure {
    Failure::Recording(format!(
        "{name}: {error}; give rows as `antinode identify --output csv` prints them"
    ))
}
