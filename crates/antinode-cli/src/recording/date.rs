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
