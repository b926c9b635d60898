//! Units of the columns of a text recording, in its header or in a line of their own.

use super::forms::is_measured;
use super::no_number::stand_in;
use super::number::is_number;
use super::signal_units::is_known;

/// The power of ten of a unit of time in seconds: −3 for ms. `Some(None)` for units of time that are not read, `None` for other units.
pub(super) fn time_exponent(unit: &str) -> Option<Option<i32>> {
    match bare(unit).to_lowercase().as_str() {
        "s" | "sec" | "secs" | "second" | "seconds" | "sekunde" | "sekunden" | "с" | "сек"
        | "秒" => Some(Some(0)),
        "ms" | "timems" | "tms" | "msec" | "millis" | "millisecond" | "milliseconds" | "мс"
        | "毫秒" => Some(Some(-3)),
        // Both letters µ of Unicode, and the replacement of a µ in an older encoding.
        "us" | "µs" | "μs" | "\u{fffd}s" | "timeus" | "tus" | "usec" | "micros" | "microsecond"
        | "microseconds" | "мкс" | "微秒" => Some(Some(-6)),
        "ns" | "timens" | "tns" | "nsec" | "nanosecond" | "nanoseconds" | "нс" | "纳秒" => {
            Some(Some(-9))
        }
        "min" | "minute" | "minutes" | "minuten" | "мин" | "分" | "h" | "hour" | "hours"
        | "day" | "days" => Some(None),
        _ => None,
    }
}

/// A unit without the brackets around it.
pub(super) fn bare(unit: &str) -> &str {
    unit.trim_matches(|letter: char| "()[]{} ".contains(letter))
}

/// The unit at the end of a column's name: `time [ms]`, `time (ms)`, `time/ms`, `time_ms`, and as R and MATLAB write such names,
/// `time..ms.` and `time_ms_`.
pub(super) fn of_name(name: &str) -> &str {
    let end = name.trim_end_matches([']', ')', ' ', '.', '_', '-']);
    let unit = end.rsplit(['[', '(', '/', ' ', '.', '_', '-']).next();
    unit.unwrap_or_default().trim()
}

/// The unit of time in a column's name, at its end or, if that is none, wherever it stands: `time_ms_since_boot`.
pub(super) fn of_time(name: &str) -> &str {
    let last = of_name(name);
    if time_exponent(last).is_some() {
        return last;
    }
    let mut words = name.split(|letter: char| !letter.is_alphanumeric() && letter != '\u{fffd}');
    words
        .rfind(|word| matches!(time_exponent(word), Some(Some(_))))
        .unwrap_or(last)
}

/// The unit that a column's name surely tells: `U [V]`, `in s`, `C1 in V`; empty if there is none.
pub(super) fn sure_unit_of(name: &str) -> &str {
    if is_bracketed(name) {
        return of_name(name);
    }
    let (before, unit) = name.rsplit_once("in ").unwrap_or(("-", ""));
    if before.is_empty() || before.ends_with(' ') {
        unit
    } else {
        ""
    }
}

/// Whether a column's name has something in brackets at its end.
pub(super) fn is_bracketed(name: &str) -> bool {
    name.trim_end().ends_with([']', ')'])
}

/// A column's name without the brackets at its end: `U` of `U [V]`.
pub(super) fn without_unit(name: &str) -> &str {
    let start = name.rfind(['[', '(']).filter(|_| is_bracketed(name));
    name[..start.unwrap_or(name.len())].trim_end()
}

/// Whether the brackets at the end of a time column's name hold something that is no known unit of time.
pub(super) fn has_unknown_unit(name: &str) -> bool {
    let unit = of_time(name);
    is_bracketed(name) && !unit.is_empty() && time_exponent(unit).is_none()
}

/// Whether all of these fields are in brackets or empty, and not all empty: samples never are.
pub(super) fn are_bracketed(fields: &[String]) -> bool {
    let is_in_brackets = |field: &String| field.starts_with(['(', '[']) && is_bracketed(field);
    let mut named = fields.iter().filter(|field| !field.is_empty()).peekable();
    named.peek().is_some() && named.all(is_in_brackets)
}

/// Whether a field may be a unit: a short word, or empty.
fn is_unit(field: &str) -> bool {
    let is_sample = is_measured(field);
    let field = bare(field).to_lowercase();
    // A word that stands for a missing number is no unit.
    let is_missing = !field.is_empty() && stand_in(field.as_bytes()).is_some();
    let is_word = field.chars().any(|letter| !letter.is_ascii_digit());
    let is_short = field.chars().count() <= 8 || is_known(&field);
    !is_missing && !is_sample && is_short && (is_word || field.is_empty())
}

/// Whether all fields may be units: short words or empty, and no numbers.
pub(super) fn are_units(fields: &[String], separator: u8) -> bool {
    let mut fields = fields.iter();
    fields.all(|field| is_unit(field) && !is_number(field.as_bytes(), separator))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_time_are_known_however_they_are_written() {
        for (unit, exponent) in [
            ("s", Some(Some(0))),
            ("[s]", Some(Some(0))),
            ("(ms)", Some(Some(-3))),
            ("µs", Some(Some(-6))),
            ("us", Some(Some(-6))),
            ("NS", Some(Some(-9))),
            ("毫秒", Some(Some(-3))),
            ("millis", Some(Some(-3))),
            ("micros", Some(Some(-6))),
            ("min", Some(None)),
            ("Minuten", Some(None)),
            ("V", None),
            ("", None),
        ] {
            assert_eq!(time_exponent(unit), exponent, "{unit}");
        }
        for (name, unit) in [
            ("time [ms]", "ms"),
            ("Time (us)", "us"),
            ("t/ns", "ns"),
            ("time_ms", "ms"),
            ("time..ms.", "ms"),
            ("Channel.A..mV.", "mV"),
            ("ChannelA_mV_", "mV"),
            ("U-mV", "mV"),
            ("time", "time"),
        ] {
            assert_eq!(of_name(name), unit);
        }
        for (name, unit) in [
            ("time_ms_since_boot", "ms"),
            ("ms since start", "ms"),
            ("Time (s) of the \u{fffd}s clock", "\u{fffd}s"),
            ("time_us", "us"),
            ("time_ms_min", "min"),
            ("hours of time", "time"),
            ("samples", "samples"),
        ] {
            assert_eq!(of_time(name), unit);
        }
        for (name, unit) in [
            ("in s", "s"),
            ("C1 in V", "V"),
            ("[s]", "s"),
            ("Zeit (ms)", "ms"),
            ("sin s", ""),
            ("time_ms", ""),
            ("time", ""),
        ] {
            assert_eq!(sure_unit_of(name), unit, "{name}");
        }
    }

    #[test]
    fn units_are_short_words() {
        for field in ["V", "(mV)", "", "m/s", "LSB", "-", "°/s"] {
            assert!(is_unit(field), "{field}");
        }
        for field in ["NA", "n/a", "12", "0.398V", "-5 mV", "no signal here"] {
            assert!(!is_unit(field), "{field}");
        }
    }
}
