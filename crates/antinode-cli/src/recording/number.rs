//! The numbers in fields of text, as programs in many languages write them.

use std::str::FromStr;

/// The number that a field holds, finite or not; its decimal mark may be a comma if that does not separate fields.
pub(super) fn number<T: FromStr>(field: &[u8], separator: u8) -> Option<T> {
    // An empty field is refused at once: in text without a time column every line has one.
    let text = str::from_utf8(field).ok().filter(|text| !text.is_empty())?;
    let parsed = text.parse::<T>().or_else(|_| {
        let has_comma = separator != b',' && !text.contains('.');
        let text = text.replacen(',', ".", usize::from(has_comma));
        // Only a `D` with a sign behind it is Fortran's exponent: without one it may be a hexadecimal digit.
        let other = || {
            let size = text.strip_prefix('−').unwrap_or(&text);
            let minus = if size.len() < text.len() { "-" } else { "" };
            let exponent = size.replacen("D-", "E-", 1).replacen("D+", "E+", 1);
            format!("{minus}{exponent}").parse::<T>()
        };
        text.parse::<T>().or_else(|_| other())
    });
    parsed.ok()
}

/// Whether a field holds a number, finite or not.
pub(super) fn is_number(field: &[u8], separator: u8) -> bool {
    number::<f64>(field, separator).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_may_have_a_decimal_comma() {
        assert_eq!(number::<f32>(b"-1.5e-3", b','), Some(-1.5e-3));
        assert_eq!(number::<f64>(b"1,5", b';'), Some(1.5));
        for (text, mark) in [
            ("1,5", b','),
            ("1,234.5", b';'),
            ("1,234,5", b';'),
            ("nanny", b','),
            ("1.#INF", b','),
        ] {
            assert_eq!(number::<f32>(text.as_bytes(), mark), None, "{text}");
        }
        assert_eq!(number::<f32>(b"1e39", b','), Some(f32::INFINITY));
        assert_eq!(number::<f32>(b"-Inf", b','), Some(f32::NEG_INFINITY));
        assert!(number::<f32>(b"NaN", b',').is_some_and(f32::is_nan));
        assert_eq!(number::<f32>(b"", b';'), None);
        assert_eq!(number::<f32>(b"\xff", b';'), None);
    }

    #[test]
    fn numbers_may_have_the_minus_of_print_and_the_exponent_of_fortran() {
        for (text, expected) in [
            ("−0.5", -0.5),
            ("4.9D-01", 0.49),
            ("−4.9D+01", -49.0),
            ("4,9D+01", 49.0),
        ] {
            assert_eq!(
                number::<f32>(text.as_bytes(), b';'),
                Some(expected),
                "{text}"
            );
        }
        // Possible hexadecimal digits, and too many signs.
        for text in ["1D5", "0D05", "D-01", "−−1", "−+1", "1−2", "−", "1D-1D-1"] {
            assert_eq!(number::<f32>(text.as_bytes(), b';'), None, "{text}");
        }
    }
}
