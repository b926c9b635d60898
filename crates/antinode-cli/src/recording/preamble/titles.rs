//! Titles above samples, as a logger prints them when it starts: `ready`, `Teensy ADC dump v1.3`.

use super::{Line, has_role};
use crate::recording::header::lossy;
use crate::recording::signal_units::is_known;
use crate::recording::units::time_exponent;

/// Whether a line above these rows is a title, which tells nothing of their columns: it has another number of words than they have
/// fields, or a single field.
pub(super) fn is_title(line: &Line, rows: &[Line], separator: u8) -> bool {
    let has_time = rows.iter().any(|row| row.fields.len() > 2);
    if has_time && tells_time_unit(line) || tells_signal_units(line) {
        return false;
    }
    match separator {
        b' ' => {
            let is_other = |row: &Line| row.fields.len() != line.fields.len();
            !has_role(line) && rows.iter().all(is_other)
        }
        b',' => line.fields.len() == 1 && commas_separate(rows),
        _ => line.fields.len() == 1,
    }
}

/// Whether a word is a unit of time other than seconds.
fn tells_time_unit(line: &Line) -> bool {
    let is_unit = |word: &String| time_exponent(word).is_some_and(|exponent| exponent != Some(0));
    words(line).iter().any(is_unit)
}

/// Whether two words are units of signals that differ.
fn tells_signal_units(line: &Line) -> bool {
    let words = words(line);
    let mut units = words.iter().filter(|word| is_known(word));
    units
        .next()
        .is_some_and(|first| units.any(|unit| unit != first))
}

fn words(line: &Line) -> Vec<String> {
    let text = lossy(line.text);
    let words = text.split(|letter: char| !letter.is_alphanumeric() && letter != '\u{fffd}');
    words.map(str::to_owned).collect()
}

/// Whether every comma in these rows separates fields and is no decimal mark: behind each, some row has a sign or a point.
fn commas_separate(rows: &[Line]) -> bool {
    let width = rows.iter().map(|row| row.fields.len()).max().unwrap_or(0);
    let is_whole = |field: &&[u8]| field.starts_with(b"-") || field.contains(&b'.');
    (1..width).all(|place| {
        let mut fields = rows.iter().filter_map(|row| row.fields.get(place));
        fields.any(is_whole)
    })
}

#[cfg(test)]
mod tests {
    use super::super::find;

    /// The number of lines skipped `above` samples that are written so.
    fn skipped(above: &str, row: impl Fn(usize) -> String) -> Option<usize> {
        let rows: String = (0..20).map(|k| row(k) + "\n").collect();
        find(format!("{above}{rows}").as_bytes(), false).map(|start| start.lines)
    }

    #[test]
    fn titles_that_tell_nothing_of_the_columns_are_skipped() {
        for mark in ["\t", ";", " ", ",", ", "] {
            let row = |k: usize| format!("0.{k}{mark}-0.{k}");
            for (above, expected) in [
                ("ready\n", 1),
                ("Teensy ADC dump v1.3\nfs=100000\n\n", 3),
                ("HRG run 4\nADC ready at 100 kHz\n", 2),
                ("HRG run four\nready\n", 2),
                // The second line is left as a garbled sample, unless the first has as many words.
                ("low\n5\n", usize::from(mark != " ")),
                // These may be names.
                ("d c\n", 0),
            ] {
                assert_eq!(skipped(above, row), Some(expected), "{above}{mark}");
            }
        }
        // Audacity.
        let row = |k: usize| format!("0.{k}\t-0.{k}");
        let above = "Audio   2 channels (stereo)\nSample Rate: 100000 Hz.  Sample values on linear scale.\n\
            Length processed: 4000 samples 0.04000 seconds.\n\n";
        assert_eq!(skipped(above, row), Some(4));
        // As many words as columns, or one that is a known name of a column.
        let row = |k: usize| format!("0.{k} -0.{k} 7");
        for (above, expected) in [
            ("Signal one two\n", 0),
            ("time Signal 1 Signal 2\n", 0),
            ("Signal 1 Signal 2\n", 1),
        ] {
            assert_eq!(skipped(above, row), Some(expected), "{above}");
        }
    }

    #[test]
    fn units_in_a_title_are_not_lost() {
        for mark in ["\t", " ", ","] {
            let timed = |k: usize| format!("0.{k:02}{mark}0.{k}{mark}-0.{k}");
            for (above, expected) in [
                ("Zeit in ms und zwei Signale\n", 0),
                ("Run 7 (µs)\n", 0),
                ("Run 7 of two signals\n", 1),
            ] {
                assert_eq!(skipped(above, timed), Some(expected), "{above}{mark}");
            }
            let row = |k: usize| format!("0.{k}{mark}-0.{k}");
            assert_eq!(skipped("ADC every 10 us at 5 V\n", row), Some(1), "{mark}");
            assert_eq!(skipped("U1 [V] U2 [mV]\n", row), Some(0), "{mark}");
        }
    }

    #[test]
    fn titles_above_decimal_commas_are_skipped_if_commas_separate_no_fields() {
        for mark in ["\t", ";"] {
            let row = |k: usize| format!("0,{k}{mark}-0,{k}");
            assert_eq!(skipped("ready\n", row), Some(1));
        }
        let cut: [&dyn Fn(usize) -> String; 4] = [
            &|k| format!("0,{k}"),
            &|k| format!("0,{k},-0,{k}"),
            &|k| format!("-{k},-0,{k}"),
            &|k| format!("1.234,{k}"),
        ];
        for row in cut {
            assert_eq!(skipped("ready\n", row), Some(0), "{}", row(1));
        }
    }
}
