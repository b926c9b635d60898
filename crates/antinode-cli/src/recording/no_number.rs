//! Fields that stand for a sample without a number: out of range, or missing.

use super::number::number;

/// Words that programs and instruments write for a sample that is missing or out of range, in lower case.
const WORDS: [&str; 32] = [
    "na",
    "n/a",
    "#n/a",
    "#n/a n/a",
    "<na>",
    "null",
    "none",
    "nil",
    "missing",
    "no data",
    "invalid",
    "error",
    "err",
    "#num!",
    "#value!",
    "#div/0!",
    "#ref!",
    "over",
    "ovr",
    "ovl",
    "ovld",
    "ol",
    "o.l",
    "o.l.",
    "overload",
    "overflow",
    "overrange",
    "over range",
    "under",
    "underflow",
    "underrange",
    "clipped",
];

/// The value that a number from an instrument stands for: SCPI has numbers in place of NaN and the infinities.
pub(super) fn meant(value: f32) -> f32 {
    match value.abs() {
        9.91e37 => f32::NAN,
        9.9e37 => f32::INFINITY.copysign(value),
        _ => value,
    }
}

/// The value of a field that stands for a sample without a number, NaN or an infinity; none for any other field.
pub(super) fn stand_in(field: &[u8]) -> Option<f32> {
    let text = str::from_utf8(field).ok()?;
    let size = text.trim_start_matches(['+', '-', '−']).to_lowercase();
    let is_dashes = size.is_empty() && text.chars().count() != 1;
    // `1.#IND` and `nan(ind)` of older compilers, whose sign is taken off already.
    let is_undefined = size.starts_with("1.#") || size.starts_with("nan(");
    if size == "∞" || size.starts_with("1.#inf") {
        let is_negative = text.starts_with(['-', '−']);
        Some(if is_negative {
            f32::NEG_INFINITY
        } else {
            f32::INFINITY
        })
    } else if is_dashes || is_undefined || WORDS.contains(&size.as_str()) {
        Some(f32::NAN)
    } else {
        // An infinity or a NaN by its usual name, which no column is named.
        number::<f32>(field, b',').filter(|value| !value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_scpi_stand_for_others() {
        let read = |text: &str| meant(number(text.as_bytes(), b',').unwrap());
        assert!(read("9.91E+37").is_nan());
        assert_eq!(read("9.9E37"), f32::INFINITY);
        assert_eq!(read("-9.9000E+37"), f32::NEG_INFINITY);
        assert_eq!([read("-0.5"), read("1e38")], [-0.5, 1e38]);
    }

    #[test]
    fn stand_ins_for_a_sample_are_known() {
        for text in [
            "",
            "--",
            "---",
            "NA",
            "#N/A",
            "OVER",
            "-OVER",
            "Overrange",
            "-nan(ind)",
            "-1.#IND",
            "nan",
        ] {
            let value = stand_in(text.as_bytes());
            assert!(value.is_some_and(f32::is_nan), "{text}");
        }
        for (text, value) in [
            ("∞", f32::INFINITY),
            ("-∞", f32::NEG_INFINITY),
            ("−∞", f32::NEG_INFINITY),
            ("1.#INF", f32::INFINITY),
            ("-1.#INF", f32::NEG_INFINITY),
            ("-inf", f32::NEG_INFINITY),
        ] {
            assert_eq!(stand_in(text.as_bytes()), Some(value), "{text}");
        }
        for text in ["-", "V", "1.5", "x4", "c", "-0", "overdrive", "\u{fffd}"] {
            assert_eq!(stand_in(text.as_bytes()), None, "{text}");
        }
        assert_eq!(stand_in(b"\xff"), None);
    }
}
