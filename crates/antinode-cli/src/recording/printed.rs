//! The resolution to which the times of a text recording are printed.

/// The resolution of all times so far: that of their decimals or of their digits, or of single precision if it holds them all, whichever
/// is coarsest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Printed {
    decimals: i32,
    digits: i32,
    /// The last decimal, s, and the time, s, from which on the last digit is coarser.
    last_decimal: f64,
    full: f64,
    /// True once a time has been seen that single precision does not hold.
    is_double: bool,
    /// True once a time has been seen with a point or an exponent.
    has_point: bool,
    /// The time, s, from which on times are counted.
    origin: f64,
}

impl Default for Printed {
    /// No times yet.
    fn default() -> Self {
        Self {
            decimals: 0,
            digits: 0,
            last_decimal: 1.0,
            full: 1.0,
            is_double: false,
            has_point: false,
            origin: 0.0,
        }
    }
}

impl Printed {
    /// Takes one more time into account: `text`, whose `value` times ten to the `exponent` is in s.
    pub fn see(&mut self, text: &[u8], value: f64, exponent: i32) {
        let (mut decimals, mut digits, mut point) = (0, 0, false);
        let mut bytes = text.iter();
        let mut last = b'1';
        for byte in bytes.by_ref() {
            match byte {
                b'0'..=b'9' => {
                    decimals += i32::from(point);
                    digits += i32::from(digits > 0 || *byte != b'0');
                    last = *byte;
                }
                b'.' | b',' => point = true,
                b'e' | b'E' | b'D' => break,
                _ => {}
            }
        }
        let own = std::str::from_utf8(bytes.as_slice())
            .ok()
            .and_then(|text| text.parse::<i32>().ok());
        let decimals = decimals.saturating_sub(own.unwrap_or(0));
        let is_padded = point && last == b'0';
        self.is_double = self.is_double || !is_single(value, decimals, is_padded);
        self.has_point = self.has_point || point || own.is_some();
        let decimals = decimals.saturating_sub(exponent);
        if decimals > self.decimals || digits > self.digits {
            self.decimals = self.decimals.max(decimals);
            self.digits = self.digits.max(digits);
            self.last_decimal = 10f64.powi(-self.decimals);
            self.full = 10f64.powi(self.digits.saturating_sub(self.decimals));
        }
    }

    /// Counts times from `origin` on, s.
    pub fn count_from(&mut self, origin: f64) {
        self.origin = origin;
    }

    /// The time itself, s, of one that is counted from the origin on.
    pub fn absolute(self, seconds: f64) -> f64 {
        self.origin + seconds
    }

    /// The step between neighbouring printed times near `seconds`, s.
    pub fn step(self, seconds: f64) -> f64 {
        self.last_digit(seconds).max(self.precision(seconds))
    }

    /// Largest deviation of a printed time from the true one near `seconds`, s.
    pub fn error(self, seconds: f64) -> f64 {
        // A number of single precision is rounded twice: as a number and as the shortest text of it.
        0.5 * self.last_digit(seconds) + self.precision(seconds)
    }

    fn last_digit(self, seconds: f64) -> f64 {
        let seconds = self.absolute(seconds).abs();
        // Whole numbers have all their digits.
        if !self.has_point || seconds < self.full {
            return self.last_decimal;
        }
        let magnitude = seconds.log10().floor() as i32;
        self.last_decimal
            .max(10f64.powi(magnitude + 1 - self.digits))
    }

    fn precision(self, seconds: f64) -> f64 {
        let seconds = self.absolute(seconds).abs();
        let single = seconds as f32;
        if self.is_double {
            f64::EPSILON * seconds
        } else {
            f64::from(single.next_up()) - f64::from(single)
        }
    }

    /// True if all times so far are whole numbers of seconds.
    pub fn is_whole(self) -> bool {
        self.decimals <= 0
    }
}

/// Whether a number printed to `decimals` decimals may come from single precision: it is such a number rounded to them, or its shortest
/// text that differs from those of its neighbours.
fn is_single(value: f64, decimals: i32, is_padded: bool) -> bool {
    let single = value as f32;
    let half = 0.5 * 10f64.powi(-decimals) + f64::EPSILON * value.abs();
    (value - f64::from(single)).abs() <= half
        || !is_padded && single.to_string().parse() == Ok(value)
}
