//! Errors of single lines of text.

use std::fmt;
use std::num::NonZeroU32;

use super::Channel;
use crate::digits::counted;
use crate::recording::forms::remedy;
use crate::recording::text::MAX_LINE;

/// A line, and a column in it, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The line.
    pub line: u64,
    /// The column, if the fault is in a single one.
    pub column: Option<usize>,
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.line)?;
        self.column
            .map_or(Ok(()), |column| write!(formatter, ":{column}"))
    }
}

/// Number of columns from which on a line probably holds all samples of one channel.
const MANY_COLUMNS: usize = 100;

/// Why a line of text cannot be read as a pair of samples.
#[derive(Debug, thiserror::Error)]
pub enum LineFault {
    /// No end of line within the limit: not lines of text.
    #[error(
        "more than {MAX_LINE} bytes without an end of line; give text with one sample pair a line"
    )]
    LineTooLong,
    /// More or fewer columns than can be understood.
    #[error(
        "found {}, but two (S_C, S_D) or three (time in s, S_C, S_D) are needed; {}{}",
        counted(*.found as u64, "column"),
        match *.found {
            1 => "give one sample pair a line: of two files `paste -d, c.csv d.csv`, of two variables in MATLAB or Octave \
                  `dlmwrite('both.csv', [c(:) d(:)], 'precision', 9)`",
            MANY_COLUMNS.. => "give one sample pair a line: of a line for each channel in Python `import numpy; \
                  numpy.savetxt('both.csv', numpy.loadtxt(r'FILE', delimiter=',').T, delimiter=',')`, with the file's own delimiter in \
                  `loadtxt`",
            _ => "remove the others, or choose the right ones with --columns TIME,C,D, or C,D if there is no time",
        },
        if *.are_words { "; if this line is a title, delete it or begin it with #" } else { "" }
    )]
    ColumnCount { found: usize, are_words: bool },
    /// Rows that were identified already.
    #[error(
        "these are rows printed by `antinode identify` or `monitor`, not samples; give the recording itself, or give the rows to \
         `antinode plot`, `resonator` or `calibrate`"
    )]
    Rows,
    /// A time and only one signal.
    #[error(
        "found the time and one signal, but both S_C and S_D are needed; export both channels to one file, or put their files \
         side by side with `paste -d, c.csv d.csv`, and choose the columns with --columns TIME,C,D; if these are two signals \
         without a time, give --columns C,D"
    )]
    OneSignal,
    /// A chosen column that does not exist.
    #[error("there is no column `{wanted}`; choose among {known} with --columns")]
    ColumnUnknown { wanted: String, known: String },
    /// A chosen name that is that of several columns, alike or but for units and capitals.
    #[error("`{wanted}` may be column {} or {}; choose it by its number with --columns", numbers[0], numbers[1])]
    ColumnUnsure { wanted: String, numbers: [usize; 2] },
    /// One column chosen for two of the time, S_C and S_D.
    #[error(
        "column {number} is chosen twice; choose different columns for the time, S_C and S_D with --columns"
    )]
    ColumnTwice { number: usize },
    /// Too few fields.
    #[error("{role} is missing here; complete or delete the line")]
    FieldMissing { role: Role },
    /// Too many fields.
    #[error(
        "found {found} fields where the first line has {expected}; use another separator \
         than the decimal mark, and the same one in every line{}",
        if *.found == expected + 1 { ", and write no row names (in R `row.names = FALSE`)" } else { "" }
    )]
    FieldCount { found: usize, expected: usize },
    /// A field that is no number.
    #[error(
        "{role} is `{text}`, not a number; {}",
        remedy(text).unwrap_or("correct or delete the line, or begin it with # if it is a comment")
    )]
    Number { role: Role, text: String },
    /// Units of different quantities.
    #[error(
        "S_C is in {} and S_D in {}, which have no common unit; record the same quantity twice, correct the units in the file, or choose \
         other columns with --columns",
        units[0], units[1]
    )]
    Units { units: [String; 2] },
    /// A fault of the time; `samples` names the columns to read without it.
    #[error("{fault}, or ignore the time column with --columns {samples} --rate HZ")]
    Time { fault: TimeFault, samples: String },
}

/// Why the time of a line cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TimeFault {
    /// A time in a unit other than s, ms, us and ns.
    #[error("the time column `{name}` is not in s, ms, us or ns; convert it to seconds")]
    Unit { name: String },
    /// A unit of time that the settings name, but not the header of the samples.
    #[error(
        "the settings give the time in `{unit}`, but the time column has no unit; add the right one to its name above the samples, as in \
         `TIME [ms]`"
    )]
    UnitUnsure { unit: String },
    /// A line without a time.
    #[error("the time is missing here; complete or delete the line")]
    Missing,
    /// A time that is no finite number.
    #[error(
        "the time is `{text}`, not a finite number; give it in seconds, delete the line, or begin \
         it with # if it is a comment"
    )]
    Number { text: String },
    /// Time stands still or runs backwards.
    #[error(
        "time goes from {from} s to {to} s, but must increase, and what follows is not read; sort the lines, cut the recording here, \
         print times with more digits"
    )]
    Backwards { from: f64, to: f64 },
    /// Each time stands in two lines.
    #[error(
        "each time stands in two lines; if these are a minimum and a maximum (peak detect, envelope), record or export single \
         samples; if times are rounded, print more digits"
    )]
    Paired,
    /// A gap of `lost` whole samples, the first of `gaps` gaps with `all` samples in all; reported once all is read.
    #[error(
        "{lost} {} lost before this line (time goes from {from} s to {to} s){}{}; rows whose window spans a gap are missing, \
         all others are good; record it again without loss",
        if *.lost == 1 { "sample is" } else { "samples are" },
        if *.gaps == 1 { String::new() } else { format!(", the first of {gaps} gaps with {all} samples") },
        every.map_or_else(String::new, |every| format!(
            ", one every {every} samples, as if packets had their own time stamps and nothing were lost"
        ))
    )]
    Gap {
        lost: u64,
        from: f64,
        to: f64,
        gaps: u32,
        all: u64,
        /// Pairs from each gap to the next, if they are always as many.
        every: Option<NonZeroU32>,
    },
    /// A step that is no whole number of samples.
    #[error(
        "time steps by {step:.4e} s here, but by {usual:.4e} s elsewhere; sample at a constant \
         rate, resample the recording to one"
    )]
    Uneven { step: f64, usual: f64 },
    /// The average sample rate has changed.
    #[error(
        "the sample rate has changed from {from:.3} Hz to {to:.3} Hz; sample at a constant rate, \
         resample the recording to one"
    )]
    Drift { from: f64, to: f64 },
    /// Times printed with too few digits.
    #[error(
        "times are given to {told:.0e} s only, too coarse for samples {usual:.4e} s apart; print \
         more digits, and keep times in double precision"
    )]
    Coarse { told: f64, usual: f64 },
}

/// What a column of a text recording holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The time in seconds.
    Time,
    /// One of the signals.
    Signal(Channel),
}

impl Role {
    /// All roles, in the order in which columns are kept: time, S_C, S_D.
    pub(in crate::recording) const ALL: [Self; 3] = [
        Self::Time,
        Self::Signal(Channel::C),
        Self::Signal(Channel::D),
    ];
}

impl fmt::Display for Role {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Time => "the time",
            Self::Signal(Channel::C) => "S_C",
            Self::Signal(Channel::D) => "S_D",
        })
    }
}
