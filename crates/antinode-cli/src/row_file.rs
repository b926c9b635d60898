//! Rows as `antinode identify --output csv` prints them, from a file or standard input, and what is told where they are not.

use std::io::{self, BufRead, BufReader, Chain, Cursor, IsTerminal, Read};
use std::path::Path;

use antinode::Flags;
use csv::{ErrorKind, Position, Reader, ReaderBuilder, StringRecord};

use crate::failure::Failure;
use crate::recording::{in_utf8, open_file};

const STANDARD_INPUT: &str = "standard input";
/// No header of rows is longer, bytes.
const LONGEST_HEADER: u64 = 1 << 16;

/// A file of rows, read line by line.
pub struct RowFile<R> {
    name: String,
    reader: Reader<Chain<Cursor<Vec<u8>>, BufReader<R>>>,
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
            return Self::new(STANDARD_INPUT, Box::new(in_utf8(io::stdin())));
        }
        let name = path.display().to_string();
        Self::new(&name, Box::new(in_utf8(open_file(path)?)))
    }
}

impl<R: Read> RowFile<R> {
    /// Reads the header.
    pub fn new(name: &str, source: R) -> Result<Self, Failure> {
        let mut source = BufReader::new(source);
        // Spreadsheets whose decimal mark is a comma separate fields by a semicolon.
        let mut first = Vec::new();
        let mut head = (&mut source).take(LONGEST_HEADER);
        head.read_until(b'\n', &mut first)
            .map_err(|fault| unreadable(name, &fault.into()))?;
        let is_by_semicolon = first.contains(&b';') && !first.contains(&b',');
        let delimiter = if is_by_semicolon { b';' } else { b',' };
        let mut reader = ReaderBuilder::new()
            .delimiter(delimiter)
            .from_reader(Cursor::new(first).chain(source));
        let header = reader.headers().map_err(|error| unreadable(name, &error))?;
        if header.is_empty() {
            return Err(Failure::Recording(format!(
                "{name}: there is nothing in it, not even a header: see what the command that should have written rows has to say"
            )));
        }
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
            let remedy = if self.header.iter().any(|name| name.starts_with('{')) {
                "these are JSON lines, give the rows with `--output csv`".to_owned()
            } else {
                remedy(&self.name)
            };
            let name = &self.name;
            Failure::Recording(format!(
                "{name}: no column {column} in its first line; {remedy}"
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

/// The number in a field of a row, its decimal mark a point or a comma.
pub fn number(row: &StringRecord, place: usize) -> Option<f64> {
    let text = row.get(place)?.trim();
    let number = text.parse().ok();
    number.or_else(|| text.replacen(',', ".", 1).parse().ok())
}

/// The flags in a row's column of that name; those of no known name are none.
pub fn flags(column: &str) -> Flags {
    let flags = column.split('+').filter_map(Flags::from_name);
    flags.fold(Flags::empty(), Flags::with)
}

/// What is told where there are no rows, or a line is none.
fn unreadable(name: &str, error: &csv::Error) -> Failure {
    let line = error.position().map_or(0, Position::line);
    Failure::Recording(match error.kind() {
        // Of the header there is no other line to leave out.
        ErrorKind::Utf8 { .. } if line <= 1 => {
            format!("{name}: this is no text; {}", remedy(name))
        }
        ErrorKind::Utf8 { .. } => {
            format!("{name}, line {line}: this is no text; leave the line out")
        }
        ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!(
            "{name}, line {line}: found {len} fields where the first line has {expected_len}; leave the line out"
        ),
        _ => format!("{name}: {error}; {}", remedy(name)),
    })
}

/// How to come by rows.
fn remedy(name: &str) -> String {
    let file = if name == STANDARD_INPUT { "-" } else { name };
    format!("give the rows that `antinode identify --output csv {file}` prints of a recording")
}
