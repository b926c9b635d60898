//! Where the samples of a text begin: behind the settings that oscilloscopes and recorders write above them.
//!
//! Settings are skipped only where no number can be lost: lines of numbers in the same columns follow, and no line that is skipped has
//! numbers in all of these, or begins with one. A first line that lacks its beginning is skipped too, and told.

mod clock;
mod cut;
mod titles;

use clock::{UNBENT, UNEVEN, is_clock};

use super::header::lossy;
use super::heading::is_header;
use super::no_number::stand_in;
use super::number::is_number;
use super::sequence::Sequence;
use super::text::{fields, is_skipped, separator};
use super::units::{self, bare, time_exponent};
use super::{columns, signal_units};

/// So many lines with numbers in the same columns are samples.
pub(super) const STEADY_LINES: usize = 16;

/// No preamble is longer.
const MOST_LINES: usize = 256;
/// Nor with blank lines and comments: all of it is looked at again when more is read.
const MOST_IN_ALL: usize = 4096;
const MOST_BYTES: usize = 4 << 20;

/// So many settings without names below them are surely no samples.
const FEWEST_LABELS: usize = 4;

/// Where to read from, and what was seen on the way.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Start {
    /// The lines of settings, or the one that is cut, and their bytes.
    pub lines: usize,
    pub bytes: usize,
    /// The line that is cut at its beginning.
    pub cut: Option<usize>,
    /// The columns that hold numbers, from 0; none where that is not known.
    pub numbers: Vec<usize>,
    /// Whether the first of these goes up as time does.
    pub is_clocked: bool,
    /// Whether it does so as no signal does.
    pub is_surely_clocked: bool,
    /// The unit of time among the settings, and its line.
    pub unit: Option<(String, usize)>,
    /// The times of samples that have none beside them, by the settings.
    pub sequence: Option<Sequence>,
}

/// A line that is neither blank nor a comment.
struct Line<'a> {
    /// The lines and bytes before it.
    before: usize,
    start: usize,
    text: &'a [u8],
    fields: Vec<&'a [u8]>,
}

/// Where the text goes on to the samples; none where more lines are needed to tell. `is_all` where there are no more.
pub(super) fn find(text: &[u8], is_all: bool) -> Option<Start> {
    let separator = last_separator(text);
    let lines = lines(text, separator);
    // Numbers at the front are samples: nothing is above them.
    let begins_with_word = lines.first().is_some_and(|line| {
        let lead = lead(line);
        !lead.is_some_and(|field| is_sample(field, separator))
    });
    let found = steady(&lines, separator).map(|numbers| {
        cut::start(&lines, &numbers, separator).or_else(|| start(&lines, numbers, separator))
    });
    match found {
        None if begins_with_word && !is_all && lines.len() < MOST_LINES && is_short(text) => None,
        found => Some(found.flatten().unwrap_or_default()),
    }
}

/// Whether text may still be above samples.
fn is_short(text: &[u8]) -> bool {
    let ends = text.iter().filter(|&&byte| byte == b'\n');
    text.len() < MOST_BYTES && ends.count() < MOST_IN_ALL
}

/// What separates the fields of the samples: they come last.
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

/// Whether a line has samples in all of these columns, and a number in one.
fn has_samples(line: &Line, columns: &[usize], separator: u8) -> bool {
    let field = |&column: &usize| line.fields.get(column).copied();
    let are_samples = columns
        .iter()
        .all(|column| field(column).is_some_and(|field| is_sample(field, separator)));
    let mut found = columns.iter().filter_map(field);
    are_samples && found.any(|field| is_number(field, separator))
}

/// The columns of the last lines that hold numbers, mostly, and what stands for one.
fn steady(lines: &[Line], separator: u8) -> Option<Vec<usize>> {
    let last = &lines[lines.len().checked_sub(STEADY_LINES)?..];
    let width = last.iter().map(|line| line.fields.len()).max()?;
    let is_steady = |&column: &usize| {
        let fields = || last.iter().map(|line| line.fields.get(column).copied());
        let numbers =
            fields().filter(|field| field.is_some_and(|field| is_number(field, separator)));
        let mut all = fields();
        all.all(|field| field.is_some_and(|field| is_sample(field, separator)))
            && 2 * numbers.count() > last.len()
    };
    let columns: Vec<usize> = (0..width).filter(is_steady).collect();
    (columns.len() >= 2).then_some(columns)
}

/// Where the lines with samples in these columns and the names above them begin; none where others would be lost.
fn start(lines: &[Line], numbers: Vec<usize>, separator: u8) -> Option<Start> {
    let is_row = |line: &Line| has_samples(line, &numbers, separator);
    let last_other = lines.iter().rposition(|line| !is_row(line));
    let rows = last_other.map_or(0, |last| last + 1);
    let width = numbers[numbers.len() - 1] + 1;
    let is_word = |field: &[u8]| !is_sample(field, separator);
    // Whether a line has words over all of these columns.
    let is_named = |line: &Line| {
        let has_word = |&place: &usize| line.fields.get(place).is_some_and(|field| is_word(field));
        has_word(&0) && numbers.iter().all(has_word)
    };
    let names = names(lines, rows, width, separator);
    let roles = lines
        .iter()
        .rposition(|line| is_named(line) && has_role(line));
    // Samples right below names stay, garbled though the first of them may be.
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
    // A first line that may be the names stays it.
    let is_header_lost = settings.first().is_some_and(|line| {
        let is_other = are_surely || is_title(line) || header.first().is_some_and(has_role);
        line.fields.len() >= width && (has_role(line) || !is_other)
    });
    // Names over all of these columns divide settings from samples, of which neither is the other then.
    let is_divided = header.first().is_some_and(is_named);
    let is_safe = |line: &Line| lead(line).is_none_or(is_word) && (is_divided || !is_row(line));
    let are_told = !header.is_empty() || are_surely || settings.iter().all(is_title);
    let are_safe = settings.iter().all(is_safe) && (settings.is_empty() || are_told);
    let fields: Vec<&[&[u8]]> = lines[..rows].iter().map(|line| &line.fields[..]).collect();
    (are_safe && !is_header_lost).then(|| Start {
        lines: lines[first].before,
        bytes: lines[first].start,
        is_clocked: is_clock(&lines[rows..], numbers[0], separator, UNEVEN),
        is_surely_clocked: is_clock(&lines[rows..], numbers[0], separator, UNBENT),
        unit: settings.iter().find_map(unit),
        sequence: Sequence::of_settings(&fields, separator),
        cut: None,
        numbers,
    })
}

/// Whether these lines begin with labels, which samples that are garbled do not.
fn are_labels(settings: &[Line]) -> bool {
    let label = |line: &Line| lead(line).unwrap_or_default().to_ascii_lowercase();
    let labels: Vec<Vec<u8>> = settings
        .iter()
        .map(label)
        .filter(|label| !label.is_empty())
        .collect();
    let is_label = |text: &Vec<u8>| text[0].is_ascii_alphabetic() || text.starts_with(b"*");
    let are_other = (1..labels.len()).all(|place| !labels[..place].contains(&labels[place]));
    labels.len() >= FEWEST_LABELS && are_other && labels.iter().all(is_label)
}

/// The line of names above those of samples, which have so many columns, or the first of these where there is none.
fn names(lines: &[Line], rows: usize, width: usize, separator: u8) -> usize {
    let Some(above) = rows.checked_sub(1) else {
        return rows;
    };
    let line = &lines[above];
    // Words that are too few are told of as a header, for they may be one over numbers that are cut in two.
    // Among labels it is one more of them.
    let is_label = line.fields.len() < width && are_labels(&lines[..rows]);
    let is_title = |line: &Line| titles::is_title(line, &lines[rows..], separator);
    let is_number = |field: &&[u8]| is_number(field, separator);
    let are_words = line.fields.len() > 1 && !line.fields.iter().any(is_number) && !is_label;
    let mut words = line
        .text
        .split(|byte| b",;\t ".contains(byte))
        .filter_map(|word| str::from_utf8(word.trim_ascii()).ok());
    // Names between other marks than the numbers are no title, but those in a sentence are: `Length processed: 4000 samples 0.04 seconds.`
    let are_names = if line.fields.len() == 1 {
        words.any(columns::is_known) && !line.text.trim_ascii_end().ends_with(b".")
    } else if is_title(line) {
        false
    } else {
        // A first line is what it always was.
        above == 0 || are_words || line.fields.len() >= width && has_role(line)
    };
    let is_unit_line = || {
        let below: Vec<u8> = lines[rows..]
            .iter()
            .flat_map(|line| line.text.to_vec())
            .collect();
        let over = &lines[above - 1];
        over.fields.len() >= width
            && !is_title(over)
            && is_header(over.text, &below, separator)
            && are_units(line, width, above == 1, separator)
    };
    if above > 0 && is_unit_line() {
        above - 1
    } else if are_names {
        above
    } else {
        rows
    }
}

/// Whether one of the fields says what its column holds.
fn has_role(line: &Line) -> bool {
    let mut names = line
        .fields
        .iter()
        .filter_map(|field| str::from_utf8(field).ok());
    names.any(columns::is_known)
}

/// Whether a line holds the units of so many columns, and no names.
fn are_units(line: &Line, width: usize, is_second: bool, separator: u8) -> bool {
    let fields = &line.fields[..width.min(line.fields.len())];
    let texts: Vec<String> = fields.iter().map(|field| lossy(field)).collect();
    let is_surely =
        |text: &String| time_exponent(text).is_some() || signal_units::is_known(bare(text));
    // The second line of a text is one of units wherever it may be: its first would be lost.
    let is_wide = line.fields.len() >= width || is_second;
    units::are_units(&texts, separator)
        && (texts.iter().any(is_surely) || is_wide && !has_role(line))
}

/// The unit that a line of settings tells of the time.
fn unit(line: &Line) -> Option<(String, usize)> {
    let text = |field: &[u8]| lossy(field).trim_matches([':', ' ']).to_owned();
    let label = text(line.fields.first()?)
        .to_lowercase()
        .replace(['_', ' '], "");
    let is_told = ["horizontalunit", "horzunit", "hunit", "xunit", "timeunit"]
        .iter()
        .any(|name| label.starts_with(name));
    let unit = line.fields[1..].iter().find(|field| !field.is_empty());
    unit.filter(|_| is_told)
        .map(|unit| (text(unit), line.before))
}

#[cfg(test)]
mod tests;
