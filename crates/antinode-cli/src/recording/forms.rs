//! Fields that contain a number but are none: with a label, a time stamp or a unit, in brackets, or in hexadecimal digits.

use super::number::is_number;

/// Whether two fields differ in nothing but their numbers, as samples do from one another; a name above a sample differs otherwise.
pub(super) fn are_alike(one: &[u8], other: &[u8]) -> bool {
    let one = form(one);
    one.contains(&b'#') && one == form(other)
}

/// A field with `#` for each of its numbers and the sign before it.
fn form(field: &[u8]) -> Vec<u8> {
    let (mut form, mut is_number) = (Vec::new(), false);
    for &byte in field {
        let goes_on = is_number && (byte.is_ascii_hexdigit() || b".xX".contains(&byte));
        if byte.is_ascii_digit() && !is_number {
            form.pop_if(|last| b"+-".contains(last));
            form.push(b'#');
        } else if !goes_on {
            form.push(byte);
        }
        is_number = byte.is_ascii_digit() || goes_on;
    }
    form
}

/// Whether a field is a number with its unit.
pub(super) fn is_measured(text: &str) -> bool {
    let is_digit = |letter: char| letter.is_ascii_digit();
    let unit = text.trim_start_matches(|letter| is_digit(letter) || "+-−.,eE".contains(letter));
    let base = unit.trim_start().trim_start_matches(['m', 'u', 'µ', 'n']);
    text[..text.len() - unit.len()].contains(is_digit) && ["V", "s", "sec"].contains(&base)
}

/// Whether a field begins as a line of ESP-IDF's logger does, `I (12345) adc: `.
fn is_of_esp(text: &str) -> bool {
    let level = text.strip_prefix(|letter: char| letter.is_ascii_uppercase());
    let parts = level
        .and_then(|rest| rest.strip_prefix(" ("))
        .and_then(|rest| rest.split_once(") "));
    parts.is_some_and(|(time, rest)| {
        time.starts_with(|letter: char| letter.is_ascii_digit()) && rest.contains(':')
    })
}

/// The advice on how to turn lines with such a field into lines of numbers; none if its form is not known, or if it is a time stamp whose
/// column `may_be_left_out`.
pub(super) fn remedy(text: &str, may_be_left_out: bool) -> Option<&'static str> {
    let is_stamp = |word: &str| {
        let mut parts = word.trim_start_matches('[').split(':');
        word.contains(':')
            && parts.all(|part| part.starts_with(|letter: char| letter.is_ascii_digit()))
    };
    let words: Vec<&str> = text
        .split([' ', '\t', ']'])
        .filter(|word| !word.is_empty())
        .collect();
    let stamp = words.iter().rposition(|word| is_stamp(word));
    // `Thu Nov 26 10:00:00 2026`
    let has_year = stamp == Some(3) && words[2].len() <= 2;
    let is_behind = |stamp: usize| {
        words.len() > stamp + 1 + usize::from(has_year)
            && (words
                .last()
                .is_some_and(|last| is_number(last.as_bytes(), b','))
                || text.contains("->"))
    };
    // A stamp without a number behind it has a column of its own.
    if may_be_left_out && stamp.is_some_and(|stamp| !is_behind(stamp)) {
        return None;
    }
    let label = text.split([':', '=']).next().unwrap_or_default().trim_end();
    let is_label = label.len() < text.len()
        && label.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_')
        && label
            .chars()
            .all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    let is_hexadecimal = text.starts_with(|letter: char| letter.is_ascii_digit())
        && text
            .trim_start_matches("0x")
            .trim_start_matches("0X")
            .chars()
            .all(|letter| letter.is_ascii_hexdigit());
    Some(if stamp.is_some() {
        r"switch the terminal's time stamps off, or remove them, `sed -E 's/^.*([a-z] [A-Z][a-z]+ +[0-9]+ [0-9:.]+ [0-9]{4}|[0-9]:[0-9.]+)( ->|\])?[[:blank:]]*//' FILE | antinode identify -`"
    } else if text.starts_with("b'") {
        r#"write text instead of bytes, in Python by `line.decode()`; convert this file by `sed -E "s/^b'|(\\\\[rn])+'$//g" FILE | antinode identify -`"#
    } else if text.starts_with("{\"") {
        "convert the JSON lines to CSV, `jq -r '[.c,.d]|@csv' FILE | antinode identify -`, with the names of your two signals for c and d"
    } else if text.starts_with(['[', '(', '{', '>']) || text.ends_with([']', ')', '}']) {
        "remove the brackets, `tr -d '[](){}>' < FILE | antinode identify -`"
    } else if is_of_esp(text) {
        r"print without a logger, or remove what it adds, `sed -E 's/^[A-Z] \([0-9:.]+\) [^:]*: *//' FILE | antinode identify -`"
    } else if is_measured(text) {
        r"remove the units, `sed -E 's/([0-9]\.?) *(V|s|sec)/\1/g; s/([0-9]\.?) *m(V|s|sec)/\1e-3/g; s/([0-9]\.?) *(u|µ)(V|s|sec)/\1e-6/g; s/([0-9]\.?) *n(V|s|sec)/\1e-9/g' FILE | antinode identify -`"
    } else if is_label {
        "remove the labels, `sed -E 's/[A-Za-z_][A-Za-z_0-9]* *[:=]//g' FILE | antinode identify -`"
    } else if is_hexadecimal {
        r"write the codes in decimal digits; unsigned ones are converted by `perl -pe 's/\b(0x)?([0-9a-f]+)\b/hex $2/gie' FILE | antinode identify -`"
    } else {
        return None;
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_differ_in_their_numbers_alone_are_alike() {
        for (one, other, expected) in [
            ("C:691", "C:-12", true),
            ("[3300", "[-0.5", true),
            ("0x0ACC", "0x12", true),
            ("12:34:56.000 -> 755", "12:34:57.001 -> -7", true),
            ("C:691", "D:691", false),
            ("c", "c", false),
            ("CH1", "7", false),
        ] {
            assert_eq!(
                are_alike(one.as_bytes(), other.as_bytes()),
                expected,
                "{one} {other}"
            );
        }
    }

    #[test]
    fn each_form_has_its_remedy() {
        for (text, expected) in [
            ("12:34:56.000 -> 755", Some("switch")),
            ("[2024-05-01 12:34:56.000] 755", Some("switch")),
            ("2024-05-01 12:34:56.000 755", Some("switch")),
            ("[12:34:56.000] -755", Some("switch")),
            ("12:34:56.000 -> C:691", Some("switch")),
            ("5/1/2024 12:34:56 PM", None),
            ("{\"c\": 2945", Some("convert the JSON")),
            ("b'2945", Some("write text")),
            ("[3300", Some("remove the brackets")),
            ("2033)", Some("remove the brackets")),
            ("C:691", Some("remove the labels")),
            ("adc_0 = 5", Some("remove the labels")),
            ("0x0ACC", Some("write the codes")),
            ("0ACC", Some("write the codes")),
            ("2024-05-01 12:34:56.000", None),
            ("12:34:56", None),
            ("1x", None),
            ("x", None),
            ("low", None),
            ("[12:34:56.000]", None),
            ("[12:34:56.000]755", Some("switch")),
            ("Thu Nov 26 10:00:00 2026", None),
            ("Thu Nov 26 10:00:00 2026 -755", Some("switch")),
            ("[Thu Nov 26 10:00:00.460 2026] -755", Some("switch")),
            ("I (12345) adc: 755", Some("print without a logger")),
            ("I (12345) 755", None),
            ("> 755", Some("remove the brackets")),
            (">", Some("remove the brackets")),
            ("0.398V", Some("remove the units")),
            ("−398 mV", Some("remove the units")),
            ("1e-05 sec", Some("remove the units")),
            ("1e-05 min", None),
            ("V", None),
            ("", None),
        ] {
            let found = remedy(text, true);
            let is_expected = match expected {
                Some(expected) => found.is_some_and(|found| found.starts_with(expected)),
                None => found.is_none(),
            };
            assert!(is_expected, "{text}: {found:?}");
        }
        let told = remedy("2024-05-01 12:34:56.000", false);
        assert!(told.is_some_and(|told| told.starts_with("switch")));
    }
}
