//! Where the samples of a text begin: below the settings that oscilloscopes and recorders write above them.
//!
//! Settings are skipped only where no number can be lost: lines of numbers in the same columns follow, and no line that is skipped has
//! numbers in all of these, or begins with one. A first line that lacks its beginning is skipped too, with a warning.

mod clock;
mod cut;
mod names;
mod settings;
mod silent;
mod titles;

pub(super) use clock::{MAX_STEP_RATIO, are_even};
use clock::{MAX_STEP_RATIO_ALONE, has_fractions, is_clock};

use super::columns;
use super::no_number::stand_in;
use super::number::is_number;
use super::sequence::Sequence;
use super::text::{fields, is_skipped, separator};

/// Lines in a row with numbers in the same columns that are taken for samples.
pub(super) const STEADY_LINES: usize = 16;

/// Lines among the first samples that may be garbled.
const MAX_GARBLED: usize = 2;

/// Longest preamble, in lines that are neither blank nor comments.
const MAX_LINES: usize = 256;
/// Longest preamble, in lines of any kind: all of it is looked at again when more is read.
const MAX_ALL_LINES: usize = 4096;
/// Longest preamble, bytes.
const MAX_BYTES: usize = 4 << 20;

/// Fewest labelled lines that are surely settings, and no samples, even without names below them.
const MIN_LABELS: usize = 4;

/// Where the names or samples begin, and what was found up to the first samples.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Start {
    /// The lines skipped, settings or one that lacks its beginning, and their bytes.
    pub lines: usize,
    pub bytes: usize,
    /// The sample pairs without values that the rest begins with, in lines of any kind, and their bytes.
    pub silent_lines: usize,
    pub silent_bytes: usize,
    /// The line that lacks its beginning.
    pub cut: Option<usize>,
    /// The columns that hold numbers, from 0; none if that is not known.
    pub numbers: Vec<usize>,
    /// Whether the first of these columns goes up as time does.
    pub is_clocked: bool,
    /// Whether it does so more evenly than any signal.
    pub is_surely_clocked: bool,
    /// Whether it then holds fractions, and so does not count the samples.
    pub has_fractions: bool,
    /// The unit of time that the settings name, and its line.
    pub unit: Option<(String, usize)>,
    /// The units that the settings name over each column, and their line.
    pub units: Option<(Vec<String>, usize)>,
    /// The times of the samples by the settings, for samples without a time column.
    pub sequence: Option<Sequence>,
}

impl Start {
    /// With the lines without values right above the first of the samples.
    fn with_silent(mut self, silent: &[Line], below: &Line, separator: u8) -> Self {
        if let Some(first) = silent.first()
            && self.bytes == below.start
            && has_samples(below, &self.numbers, separator)
        {
            (self.lines, self.bytes) = (first.before, first.start);
            self.silent_lines = below.before - first.before;
            self.silent_bytes = below.start - first.start;
        }
        self
    }
}

/// A line that is neither blank nor a comment.
struct Line<'a> {
    /// The number of lines before it.
    before: usize,
    /// The number of bytes before it.
    start: usize,
    text: &'a [u8],
    fields: Vec<&'a [u8]>,
}

/// Finds where the names or samples begin; none if more lines are needed to tell. `is_all`: there are no more lines.
pub(super) fn find(text: &[u8], is_all: bool) -> Option<Start> {
    let separator = last_separator(text);
    let all = lines(text, separator);
    let (silent, lines) = all.split_at(silent::count(&all, separator));
    // A first line that begins with a sample has no settings above it.
    let begins_with_word = lines.first().is_some_and(|line| {
        let lead = lead(line);
        !lead.is_some_and(|field| is_sample(field, separator))
    });
    let may_begin_below = begins_with_word || !silent.is_empty();
    let may_go_on = may_begin_below && !is_all && lines.len() < MAX_LINES && is_short(text);
    // A column in which a line is garbled is one more, once the lines below that line are seen.
    let is_whole =
        |numbers: &Vec<usize>| steady(lines, separator, MAX_GARBLED).as_ref() == Some(numbers);
    let numbers = steady(lines, separator, 0).filter(|all| !may_go_on || is_whole(all));
    let found = numbers.map(|numbers| {
        cut::start(lines, &numbers, separator)
            .or_else(|| start(lines, &numbers, separator, 0))
            .or_else(|| start(lines, &numbers, separator, MAX_GARBLED))
            .map(|start| start.with_silent(silent, &lines[0], separator))
    });
    match found {
        None if may_go_on => None,
        found => Some(found.flatten().unwrap_or_default()),
    }
}

/// Whether a preamble may be as long as this text.
fn is_short(text: &[u8]) -> bool {
    let ends = text.iter().filter(|&&byte| byte == b'\n');
    text.len() < MAX_BYTES && ends.count() < MAX_ALL_LINES
}

/// The separator of the samples' fields, from the last line: samples come last.
fn last_separator(text: &[u8]) -> u8 {
    let mut lines = text.rsplit(|&byte| byte == b'\n');
    let last = lines.find(|line| !is_skipped(line));
    separator(last.unwrap_or_default())
}

fn lines(text: &[u8], separator: u8) -> Vec<Line<'_>> {
    let mut start = 0;
    let mut found = Vec::new();
    for (before, text) in text.split_inclusive(|&byte| byte == b'\n').enumerate() {
        if !is_skipped(text) {
            let fields = fields(text, separator).collect();
            found.push(Line {
                before,
                start,
                text,
                fields,
            });
        }
        start += text.len();
    }
    found
}

/// The first field that is not empty.
fn lead<'a>(line: &Line<'a>) -> Option<&'a [u8]> {
    line.fields.iter().copied().find(|field| !field.is_empty())
}

/// Whether a field is a number, or stands for one that is missing.
fn is_sample(field: &[u8], separator: u8) -> bool {
    is_number(field, separator) || stand_in(field).is_some()
}

/// Whether a line has samples in all of these columns, and a number in at least one.
fn has_samples(line: &Line, columns: &[usize], separator: u8) -> bool {
    let field = |&column: &usize| line.fields.get(column).copied();
    let are_samples = columns
        .iter()
        .all(|column| field(column).is_some_and(|field| is_sample(field, separator)));
    let mut found = columns.iter().filter_map(field);
    are_samples && found.any(|field| is_number(field, separator))
}

/// The columns in which the last [`STEADY_LINES`] lines, all but up to `garbled` of them, have a sample, most of them a number; none if
/// there are not two.
fn steady(lines: &[Line], separator: u8, garbled: usize) -> Option<Vec<usize>> {
    let last = &lines[lines.len().checked_sub(STEADY_LINES)?..];
    let width = last.iter().map(|line| line.fields.len()).max()?;
    let is_steady = |&column: &usize| {
        let fields = last.iter().filter_map(|line| line.fields.get(column));
        let samples = fields.clone().filter(|field| is_sample(field, separator));
        let numbers = fields.filter(|field| is_number(field, separator));
        samples.count() + garbled >= last.len() && 2 * numbers.count() > last.len()
    };
    let columns: Vec<usize> = (0..width).filter(is_steady).collect();
    (columns.len() >= 2).then_some(columns)
}

/// The index of the first of the samples at the end, of which up to `garbled` lines may be garbled.
fn first_row(lines: &[Line], numbers: &[usize], separator: u8, garbled: usize) -> usize {
    let (mut first, mut others) = (lines.len(), 0);
    for (place, line) in lines.iter().enumerate().rev() {
        let is_row = has_samples(line, numbers, separator);
        others += usize::from(!is_row);
        if others > garbled {
            break;
        }
        // The first line of all may be the garbled one.
        if is_row || lead(line).is_some_and(|field| is_number(field, separator)) {
            first = place;
        }
    }
    first
}

/// Finds where the samples in these columns, or the names above them, begin; none if a sample might be lost. Up to `garbled` of the first
/// samples may be garbled.
fn start(lines: &[Line], numbers: &[usize], separator: u8, garbled: usize) -> Option<Start> {
    let is_row = |line: &Line| has_samples(line, numbers, separator);
    let rows = first_row(lines, numbers, separator, garbled);
    let width = numbers[numbers.len() - 1] + 1;
    let is_word = |field: &[u8]| !is_sample(field, separator);
    // Whether a line has words over all of these columns.
    let is_named = |line: &Line| {
        let has_word = |&place: &usize| line.fields.get(place).is_some_and(|field| is_word(field));
        has_word(&0) && numbers.iter().all(has_word)
    };
    let names = names::place(lines, rows, width, separator);
    let roles = lines
        .iter()
        .rposition(|line| is_named(line) && has_role(line));
    // A line of names is no garbled one.
    if garbled > 0 && roles.is_some_and(|roles| roles >= rows) {
        return None;
    }
    // Samples right below names must stay, even if the first of them are garbled.
    let are_samples = |roles: &usize| {
        let begins = |line: &Line| line.fields.first().is_some_and(|field| !is_word(field));
        let mut below = lines[(roles + 1).min(rows)..rows].iter();
        roles + 1 == names || below.all(begins)
    };
    let first = roles
        .filter(are_samples)
        .map_or(names, |roles| roles.min(names));
    let (settings, rest) = lines.split_at(first);
    let header = &rest[..rows - first];
    let are_surely = are_labels(settings);
    let is_title = |line: &Line| titles::is_title(line, &lines[rows..], separator);
    // A first line that may be the names must not be skipped.
    let is_header_lost = settings.first().is_some_and(|line| {
        let is_other = are_surely || is_title(line) || header.first().is_some_and(has_role);
        line.fields.len() >= width && (has_role(line) || !is_other)
    });
    // Names over all of these columns divide settings from samples: no setting can be a sample then.
    let is_divided = header.first().is_some_and(is_named);
    let is_safe = |line: &Line| lead(line).is_none_or(is_word) && (is_divided || !is_row(line));
    let are_told = !header.is_empty() || are_surely || settings.iter().all(is_title);
    let are_safe = settings.iter().all(is_safe) && (settings.is_empty() || are_told);
    let fields: Vec<&[&[u8]]> = lines[..rows].iter().map(|line| &line.fields[..]).collect();
    (are_safe && !is_header_lost).then(|| Start {
        lines: lines[first].before,
        bytes: lines[first].start,
        is_clocked: is_clock(&lines[rows..], numbers[0], separator, MAX_STEP_RATIO),
        has_fractions: has_fractions(&lines[rows..], numbers[0], separator),
        is_surely_clocked: is_clock(&lines[rows..], numbers[0], separator, MAX_STEP_RATIO_ALONE),
        unit: settings.iter().find_map(settings::unit_of_time),
        units: settings
            .iter()
            .find_map(|line| settings::units_over(line, numbers)),
        sequence: Sequence::of_settings(&fields, separator),
        numbers: numbers.to_vec(),
        ..Start::default()
    })
}

/// Whether these lines begin with labels, all different, as settings do and garbled samples do not.
fn are_labels(settings: &[Line]) -> bool {
    let label = |line: &Line| lead(line).unwrap_or_default().to_ascii_lowercase();
    let labels: Vec<Vec<u8>> = settings
        .iter()
        .map(label)
        .filter(|label| !label.is_empty())
        .collect();
    let is_label = |text: &Vec<u8>| text[0].is_ascii_alphabetic() || text.starts_with(b"*");
    let are_other = (1..labels.len()).all(|place| !labels[..place].contains(&labels[place]));
    labels.len() >= MIN_LABELS && are_other && labels.iter().all(is_label)
}

/// Whether one of the fields says what its column holds.
fn has_role(line: &Line) -> bool {
    let mut names = line
        .fields
        .iter()
        .filter_map(|field| str::from_utf8(field).ok());
    names.any(columns::is_known)
}

#[cfg(test)]
mod tests;
