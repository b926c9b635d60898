//! A first line that lacks its beginning, as where a logger is attached in the middle of one.
//!
//! It is recognised only if all lines below it hold samples in the same columns, so that no other line can be lost.

use super::super::heading::is_header;
use super::super::number::number;
use super::{Line, MAX_STEP_RATIO, MAX_STEP_RATIO_ALONE, Start, has_samples, is_clock, is_sample};

/// Finds where the lines below such a first line begin; none if the first line is whole.
pub(super) fn start(lines: &[Line], numbers: &[usize], separator: u8) -> Option<Start> {
    let [first, rows @ ..] = lines else {
        return None;
    };
    let width = numbers.last()? + 1;
    let are_rows = rows.iter().all(|row| has_samples(row, numbers, separator));
    let is_cut = lacks_fields(&first.fields, width, separator)
        || width > 2 && lacks_digits(first, rows, separator) == Some(true);
    let below: Vec<&[&[u8]]> = rows.iter().map(|row| &row.fields[..]).collect();
    let is_whole = !is_cut || is_header(&first.fields, &below, separator);
    (are_rows && !is_whole).then(|| Start {
        cut: Some(first.before),
        lines: rows[0].before,
        bytes: rows[0].start,
        is_surely_clocked: is_clock(rows, numbers[0], separator, MAX_STEP_RATIO_ALONE),
        numbers: numbers.to_vec(),
        // As in a text without a preamble: a signal may go up as evenly as this.
        is_clocked: false,
        ..Start::default()
    })
}

/// Whether there are fewer than `width` fields, all of them samples but the first, which may be the end of one.
fn lacks_fields(fields: &[&[u8]], width: usize, separator: u8) -> bool {
    let is_part = |field: &[u8]| {
        let has_digit = field.iter().any(u8::is_ascii_digit);
        let is_of_number = |byte: &u8| byte.is_ascii_digit() || b"+-.,eED".contains(byte);
        field.is_empty() || has_digit && field.iter().all(is_of_number)
    };
    let Some((part, whole)) = fields.split_first() else {
        return false;
    };
    fields.len() < width && is_part(part) && whole.iter().all(|field| is_sample(field, separator))
}

/// Whether a line's time is only the last digits of the one extrapolated from the lines below; none if that is not known.
fn lacks_digits(line: &Line, rows: &[Line], separator: u8) -> Option<bool> {
    let text = |line: &Line| Some(str::from_utf8(line.fields.first()?).ok()?.to_owned());
    let time = |line: &Line| number::<f64>(line.fields.first()?, separator);
    let (own, next) = (text(line)?, text(rows.first()?)?);
    let (second, third) = (time(rows.first()?)?, time(rows.get(1)?)?);
    let whole = 2.0 * second - third;
    let decimals = next.split(['.', ',']).nth(1).map_or(0, str::len);
    let printed = format!("{whole:.decimals$}");
    // What is printed without the 0 before its point is whole.
    let is_other = time(line).is_none_or(|own| (own - whole).abs() > 0.5 * (third - second));
    let is_end = printed.ends_with(&own.replace(',', "."));
    Some(is_other && is_end && is_clock(rows, 0, separator, MAX_STEP_RATIO))
}

#[cfg(test)]
mod tests {
    use super::super::{Start, find};

    /// What is found in rows below a first line, if that is recognised as cut.
    fn cut(first: &str, row: impl Fn(usize) -> String) -> Option<Start> {
        let rows: String = (1..20).map(|k| row(k) + "\n").collect();
        let start = find(format!("{first}\n{rows}").as_bytes(), false)?;
        start.cut.is_some().then_some(start)
    }

    fn three(k: usize) -> String {
        format!("12.{:05},0.{k},-0.{k}", 340 + k)
    }

    fn two(k: usize) -> String {
        format!("{},-{k}", 5 * k % 17)
    }

    #[test]
    fn a_line_cut_anywhere_is_recognised() {
        let whole = "12.00340,0.2,-0.2";
        for at in 1..whole.len() {
            let first = &whole[at..];
            let start = cut(first, three).unwrap_or_else(|| panic!("{first} is cut"));
            assert_eq!((start.lines, start.bytes), (1, first.len() + 1));
            assert_eq!((start.cut, start.numbers), (Some(0), vec![0, 1, 2]));
        }
        for first in ["e-3,0.5", "-05,NA", "OVER"] {
            assert_eq!(cut(first, three).is_some(), first != "OVER", "{first}");
        }
        for first in ["5", "-5", ".5"] {
            assert!(cut(first, two).is_some(), "{first}");
        }
    }

    #[test]
    fn whole_lines_and_names_are_not_taken_for_cut_ones() {
        for first in [
            "12.00340,0.2,-0.2",
            "12.00339,0.2,-0.2",
            "0.00000,0.2,-0.2",
            "c,d",
            "volts,1",
            "time,c,d",
        ] {
            assert_eq!(cut(first, three), None, "{first}");
        }
        // Column numbers in place of names.
        let wave = |k: usize| (0.9 * k as f64 + 1.0).sin_cos();
        assert_eq!(
            cut("0,1,2", |k| format!(
                "{k}0.0,{:?},{:?}",
                wave(k).0,
                wave(k).1
            )),
            None
        );
        assert_eq!(
            cut(",0,1", |k| format!("{k},{:?},{:?}", wave(k).0, wave(k).1)),
            None
        );
        // Some print no 0 before the point.
        for before in ["", "0"] {
            let row = |k: usize| format!("{before}.{:05},0.{k},-0.{k}", 340 + k);
            assert_eq!(cut(".00340,0.2,-0.2", row), None, "{before}");
        }
        // A first sample may be the end of any other.
        for first in ["2,0", "0,0", "12,-3", "E", "c,d", "c 1"] {
            assert_eq!(cut(first, two), None, "{first}");
        }
        assert_eq!(cut("0,0.5", |k| format!("{},0.5", 10 + k)), None);
        let signals = |k: usize| format!("{},0.5,0.5", [7, 27, 37].get(k).unwrap_or(&9));
        assert_eq!(cut(&signals(0), signals), None);
        // Names below, or rows of fewer fields.
        assert_eq!(cut("5\nc,d", two), None);
        assert_eq!(cut("5\n7", two), None);
    }
}
