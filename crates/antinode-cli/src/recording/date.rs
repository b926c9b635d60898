//! Times that are dates, s or ns since 1970: a double has too few digits for them, so that they are counted from a whole number on.

/// Times from which on they are, in their own unit: up to there a double resolves 2 ns of a second.
const MIN_DATE: i64 = 10_000_000;

/// The time from which on times are counted, in their own unit; 0 unless they are dates.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Origin(i64);

impl Origin {
    /// The whole part of the first time.
    pub fn of(first: &[u8]) -> Self {
        let whole = parts(first).map(|(whole, _)| whole);
        Self(whole.filter(|&whole| whole >= MIN_DATE).unwrap_or(0))
    }

    /// The origin itself.
    pub fn value(self) -> f64 {
        self.0 as f64
    }

    /// The time in `text`, which was read as this `value`, from the origin on.
    pub fn since(self, text: &[u8], value: f64) -> f64 {
        if self.0 == 0 {
            return value;
        }
        parts(text).map_or(value - self.value(), |(whole, rest)| {
            (whole - self.0) as f64 + rest
        })
    }
}

/// The digits before and behind the decimal mark, each as a number; none if there is anything else, or more than a number holds.
fn parts(text: &[u8]) -> Option<(i64, f64)> {
    let text = str::from_utf8(text).ok()?;
    let (whole, rest) = text.split_once(['.', ',']).unwrap_or((text, "0"));
    let digits = |text: &str| {
        let are_digits = text.bytes().all(|byte| byte.is_ascii_digit());
        text.parse::<i64>().ok().filter(|_| are_digits)
    };
    Some((
        digits(whole)?,
        digits(rest)? as f64 / 10f64.powi(rest.len() as i32),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_counted_from_the_first_whole_one() {
        let origin = Origin::of(b"1700000000.00817");
        assert_eq!(origin.value(), 1.7e9);
        let since = |text: &str| origin.since(text.as_bytes(), text.parse().unwrap());
        for (text, expected) in [
            ("1700000000.00817", 0.00817),
            ("1700000012.5", 12.5),
            ("1699999999", -1.0),
            // With digits of a double.
            ("1.70000000025e9", 0.25),
            ("-1", -1_700_000_001.0),
        ] {
            assert_eq!(since(text), expected, "{text}");
        }
        assert_eq!(origin.since(b"1700000000,25", f64::NAN), 0.25);
        for text in ["0.5", "9999999.5", "-1700000000.5", "1.7e9", "inf", ""] {
            assert_eq!(Origin::of(text.as_bytes()).value(), 0.0, "{text}");
        }
    }
}
