//! Which line above the samples holds their names.

use super::{Line, are_labels, has_role, titles};
use crate::recording::header::lossy;
use crate::recording::heading::is_header;
use crate::recording::number::is_number;
use crate::recording::units::{self, bare, time_exponent};
use crate::recording::{columns, signal_units};

/// The index of the line of names above the samples, which begin at index `rows` and have `width` columns; `rows` if there is none.
pub(super) fn place(lines: &[Line], rows: usize, width: usize, separator: u8) -> usize {
    let Some(above) = rows.checked_sub(1) else {
        return rows;
    };
    let line = &lines[above];
    // Too few words are still a header, for its error to show: they may stand over numbers that are cut in two.
    // Below labels, such a line is one more label.
    let is_label = line.fields.len() < width && are_labels(&lines[..rows]);
    let is_title = |line: &Line| titles::is_title(line, &lines[rows..], separator);
    let is_number = |field: &&[u8]| is_number(field, separator);
    let are_words = line.fields.len() > 1 && !line.fields.iter().any(is_number) && !is_label;
    let mut words = line
        .text
        .split(|byte| b",;\t ".contains(byte))
        .filter_map(|word| str::from_utf8(word.trim_ascii()).ok());
    // Names separated otherwise than the numbers are no title, unless in a sentence: `Length processed: 4000 samples 0.04 seconds.`
    let are_names = if line.fields.len() == 1 {
        words.any(columns::is_known) && !line.text.trim_ascii_end().ends_with(b".")
    } else if is_title(line) {
        false
    } else {
        // The first line of the text, right above the samples, is its header.
        above == 0 || are_words || line.fields.len() >= width && has_role(line)
    };
    let is_unit_line = || {
        let below: Vec<&[&[u8]]> = lines[rows..].iter().map(|line| &line.fields[..]).collect();
        let over = &lines[above - 1];
        over.fields.len() >= width
            && !is_title(over)
            && is_header(&over.fields, &below, separator)
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

/// Whether a line holds the units of `width` columns, and no names.
fn are_units(line: &Line, width: usize, is_second: bool, separator: u8) -> bool {
    let fields = &line.fields[..width.min(line.fields.len())];
    let texts: Vec<String> = fields.iter().map(|field| lossy(field)).collect();
    let is_surely =
        |text: &String| time_exponent(text).is_some() || signal_units::is_known(bare(text));
    // In doubt the second line of a text is one of units: otherwise the first, with the names, would be lost.
    let is_wide = line.fields.len() >= width || is_second;
    units::are_units(&texts, separator)
        && (texts.iter().any(is_surely) || is_wide && !has_role(line))
}
