//! Reading of rows that `antinode identify` printed as CSV or JSON lines, from a file or standard input, and the errors of other files.

mod lines;
mod objects;

use std::io::{self, BufReader, Chain, Cursor, IsTerminal, Read};
use std::path::Path;

use antinode::Flags;
use csv::{ErrorKind, Reader, ReaderBuilder, StringRecord};

use crate::failure::Failure;
use crate::recording::{STANDARD_INPUT, in_utf8, open_file};
use crate::rows::MAIN_AMPLITUDE;
use crate::tell::tell;
use lines::{Lines, head, holds};

/// Separators of fields: spreadsheets write a semicolon if their decimal mark is a comma, and a tab in files of text.
const MARKS: [u8; 3] = *b",;\t";

/// The column of times, which all rows have.
const TIME: &str = "time_s";
/// What programs write for the flags of a clean row, which are an empty text.
const NO_FLAGS: [&str; 5] = ["", "nan", "null", "none", "na"];

/// The keys that end what is typed, and their verb.
const END_OF_INPUT: &str = if cfg!(windows) {
    "Ctrl-Z and Enter end"
} else {
    "Ctrl-D ends"
};

/// All lines, beginning with those that were looked at to find the header.
type Source = Lines<Chain<Cursor<Vec<u8>>, BufReader<Box<dyn Read>>>>;

/// The records of a file, in either form.
enum Records {
    Fields(Box<Reader<Source>>),
    Objects(Source),
}

/// A file of rows, read line by line.
pub struct RowFile {
    name: String,
    records: Records,
    header: StringRecord,
    record: StringRecord,
    /// True if the file holds the table for reading, in place of rows.
    is_table: bool,
}

impl RowFile {
    /// Opens a file, or standard input if `path` is `-`.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let (name, source): (_, Box<dyn Read>) = if path == Path::new("-") {
            if io::stdin().is_terminal() {
                tell(format_args!(
                    "reading rows from standard input; {END_OF_INPUT} them"
                ));
            }
            (STANDARD_INPUT.to_owned(), Box::new(io::stdin()))
        } else {
            (path.display().to_string(), Box::new(open_file(path)?))
        };
        let text = in_utf8(source).map_err(|fault| unreadable(&name, 1, &fault.into()))?;
        Self::new(&name, text)
    }

    /// Reads the header.
    pub fn new(name: &str, source: impl Read + 'static) -> Result<Self, Failure> {
        let mut source = BufReader::new(Box::new(source) as Box<dyn Read>);
        let (head, first) =
            head(&mut source).map_err(|fault| unreadable(name, 1, &fault.into()))?;
        let first = &head[first..];
        let is_table = holds(&head, MAIN_AMPLITUDE);
        let is_objects = first.trim_ascii_start().starts_with(b"{");
        let mark = MARKS.into_iter().find(|mark| first.contains(mark));
        let of_first = is_objects.then(|| objects::names(first));
        let lines = Lines::new(Cursor::new(head.clone()).chain(source));
        let (records, header) = if let Some(names) = of_first {
            let names = names.map_err(|fault| no_object(name, 1, &fault.into()))?;
            (Records::Objects(lines), names)
        } else {
            let mut reader = ReaderBuilder::new()
                .delimiter(mark.unwrap_or(b','))
                .from_reader(lines);
            let header = reader.headers();
            let header = header.map_err(|error| unreadable(name, 1, &error))?.clone();
            (Records::Fields(Box::new(reader)), header)
        };
        if header.is_empty() {
            return Err(Failure::Fault(format!(
                "{name}: there is nothing in it, not even a header; check the messages of the command that should have written the rows"
            )));
        }
        Ok(Self {
            name: name.to_owned(),
            records,
            header,
            record: StringRecord::new(),
            is_table,
        })
    }

    /// The file's name in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The index of a column that rows may lack.
    pub fn place(&self, column: &str) -> Option<usize> {
        self.header.iter().position(|name| name == column)
    }

    /// The index of a column that rows must have.
    pub fn needed(&self, column: &str) -> Result<usize, Failure> {
        if self.header.iter().filter(|name| *name == column).count() > 1 {
            return Err(Failure::Fault(format!(
                "{}: two columns {column} in its first line, as in files that were joined side by side; give each of them on its own",
                self.name
            )));
        }
        self.place(column).ok_or_else(|| {
            let name = &self.name;
            Failure::Fault(if self.is_table {
                format!(
                    "{name}: this is the table for reading, which cannot be read back; add --output csv to the command that printed it"
                )
            } else {
                format!("{name}: no column {column} in its first line; {REMEDY}")
            })
        })
    }

    /// The row last read.
    pub fn record(&self) -> &StringRecord {
        &self.record
    }

    /// Reads the next row; false at the end.
    pub fn advance(&mut self) -> Result<bool, Failure> {
        loop {
            let more = match &mut self.records {
                Records::Fields(reader) => reader.read_record(&mut self.record),
                Records::Objects(lines) => {
                    objects::read(lines, &self.header, &mut self.record).map_err(csv::Error::from)
                }
            };
            let more = match more {
                Ok(more) => more,
                Err(error) if self.lines().is_cut && is_unfinished(&error) => {
                    tell(format_args!(
                        "warning: {}, line {}: it is incomplete, as after an interrupted write, and is left out",
                        self.name,
                        self.lines().number
                    ));
                    false
                }
                Err(error) => return Err(self.unreadable(&error)),
            };
            // Files that were joined contain their headers, which are no rows.
            if !more || self.record != self.header {
                if more && self.is_of_another_form() {
                    return Err(self.joined());
                }
                return Ok(more);
            }
        }
    }

    /// The failure if the row last read cannot be used, as this field is not what it must be.
    pub fn unusable(&self, Unusable { place, needed }: Unusable) -> Failure {
        Failure::Fault(format!(
            "{}, line {}: {} is `{}`, not {needed}; remove the line",
            self.name,
            self.lines().number,
            &self.header[place],
            &self.record[place]
        ))
    }

    /// Whether this line is a header with other columns, or a row in the other form.
    fn is_of_another_form(&self) -> bool {
        let first = self.record.get(0).unwrap_or_default();
        first.starts_with('{') || self.record.iter().any(|field| field == TIME)
    }

    /// The failure if rows of another form follow.
    fn joined(&self) -> Failure {
        Failure::Fault(format!(
            "{}, line {}: rows with other columns, or in another form, begin here; give each of the files that were joined on its own",
            self.name,
            self.lines().number
        ))
    }

    fn lines(&self) -> &Source {
        match &self.records {
            Records::Fields(reader) => reader.get_ref(),
            Records::Objects(lines) => lines,
        }
    }

    fn unreadable(&self, error: &csv::Error) -> Failure {
        let line = self.lines().number;
        if self.is_of_another_form() {
            return self.joined();
        }
        match (&self.records, error.kind()) {
            (Records::Objects(_), ErrorKind::Io(fault)) => no_object(&self.name, line, fault),
            _ => unreadable(&self.name, line, error),
        }
    }
}

/// A field of a row that is not what it must be.
#[derive(Debug)]
pub struct Unusable {
    /// The index of its column.
    pub place: usize,
    /// What it must be, as after "not".
    pub needed: &'static str,
}

/// The number in a field of a row, its decimal mark a point or a comma.
pub fn number(row: &StringRecord, place: usize) -> Option<f64> {
    let text = row.get(place)?.trim();
    let number = text.parse().ok();
    number.or_else(|| text.replacen(',', ".", 1).parse().ok())
}

/// The flags that a row's column of flags names.
pub fn flags(row: &StringRecord, place: usize) -> Result<Flags, Unusable> {
    let names = row[place].trim();
    if NO_FLAGS.iter().any(|none| none.eq_ignore_ascii_case(names)) {
        return Ok(Flags::empty());
    }
    let flags = names.split('+').map(|name| Flags::from_name(name.trim()));
    let mut all = Flags::empty();
    for flag in flags {
        let needed = "names of flags, joined by `+`";
        all = all.with(flag.ok_or(Unusable { place, needed })?);
    }
    Ok(all)
}

/// The failure if a file holds no rows, or one of its lines is none.
fn unreadable(name: &str, line: u64, error: &csv::Error) -> Failure {
    Failure::Fault(match error.kind() {
        // The header cannot be left out.
        ErrorKind::Utf8 { .. } if line <= 1 => {
            format!("{name}: this is not text; {REMEDY}")
        }
        ErrorKind::Utf8 { .. } => {
            format!("{name}, line {line}: this is not text; remove the line")
        }
        ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!(
            "{name}, line {line}: found {len} fields where the first line has {expected_len}; remove the line"
        ),
        _ => format!("{name}: {error}; {REMEDY}"),
    })
}

/// Whether a row is incomplete, as where writing was stopped.
fn is_unfinished(error: &csv::Error) -> bool {
    match error.kind() {
        ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => len < expected_len,
        ErrorKind::Io(fault) => fault.kind() == io::ErrorKind::UnexpectedEof,
        _ => false,
    }
}

/// The failure if a line is no JSON object.
fn no_object(name: &str, line: u64, fault: &io::Error) -> Failure {
    // The parser adds its own place, which begins anew with each line.
    let fault = fault.to_string();
    let fault = fault.split(" at line ").next().unwrap_or_default();
    Failure::Fault(format!(
        "{name}, line {line}: this is not a JSON object: {fault}; remove the line"
    ))
}

/// The remedy for files that hold no rows.
const REMEDY: &str = "give the rows that `antinode identify --output csv RECORDING` prints";
