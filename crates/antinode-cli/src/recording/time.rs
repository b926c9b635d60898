//! The time column of a text recording: its sample rate, and whether it keeps to it.

use super::error::InputError;

/// How far a step may be off, in samples.
const STEP_TOLERANCE: f64 = 0.01;

/// Above this many samples, rounding hides a lost one.
const COARSE: f64 = 0.25;

/// How many lines the rate is averaged over before it is compared.
const RATE_LINES: u64 = 1 << 16;

/// A line's time in s.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stamp {
    pub line: u64,
    pub seconds: f64,
}

/// How finely times are printed: with so many decimals, or so many digits.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Printed {
    decimals: i32,
    digits: i32,
}

impl Printed {
    /// Takes the digits of one more number into account.
    pub fn see(&mut self, text: &[u8]) {
        let (mut decimals, mut digits, mut point) = (0, 0, false);
        let mut bytes = text.iter();
        for byte in bytes.by_ref() {
            match byte {
                b'0'..=b'9' => {
                    decimals += i32::from(point);
                    digits += i32::from(digits > 0 || *byte != b'0');
                }
                b'.' | b',' => point = true,
                b'e' | b'E' => break,
                _ => {}
            }
        }
        let exponent = std::str::from_utf8(bytes.as_slice()).ok().and_then(|text| text.parse::<i32>().ok());
        self.decimals = self.decimals.max(decimals.saturating_sub(exponent.unwrap_or(0)));
        self.digits = self.digits.max(digits);
    }

    /// The step between neighbouring numbers printed near `seconds`.
    fn step(self, seconds: f64) -> f64 {
        let magnitude = seconds.abs().log10().floor().max(-300.0) as i32;
        let by_digits = 10f64.powi(magnitude + 1 - self.digits);
        10f64.powi(-self.decimals).max(by_digits).max(f64::EPSILON * seconds.abs())
    }
}

/// A constant sample rate, and the last line that kept to it.
pub(super) struct TimeAxis {
    step: f64,
    last: Stamp,
    /// The step between numbers printed near the last.
    rounding: f64,
    /// Where the current average of the rate began.
    anchor: Stamp,
    lines: u64,
    /// The uncertainty of `step` from the rounding of the first lines.
    uncertainty: f64,
    /// Whether many of the first steps are off by more than the tolerance, as rounding makes them.
    ragged: bool,
}

impl TimeAxis {
    /// The rate of the `first` lines; none if there are not two, or if time mostly stands still.
    pub fn of(first: &[Stamp], printed: Printed) -> Option<Self> {
        let [start, .., end] = first else { return None };
        let steps: Vec<f64> = first.windows(2).map(|pair| pair[1].seconds - pair[0].seconds).collect();
        let (_, &mut median, _) = steps.clone().select_nth_unstable_by(steps.len() / 2, f64::total_cmp);
        if median <= 0.0 {
            return None;
        }
        // The mean of all but the gaps: a lost sample must not bias the rate it is to be measured by.
        let usual = steps.iter().filter(|&step| (step - median).abs() < 0.5 * median);
        let (count, sum) = usual.fold((0.0, 0.0), |(count, sum), step| (count + 1.0, sum + step));
        let runs = (steps.len() + 1) as f64 - count;
        let rounding = printed.step(start.seconds).max(printed.step(end.seconds));
        let uncertainty = runs * rounding / count;
        let mean = sum / count;
        let step = 1.0 / roundest(1.0 / mean, uncertainty / mean / mean);
        let ragged = steps.iter().filter(|&step| (step / mean - 1.0).abs() > STEP_TOLERANCE).count();
        Some(Self {
            step,
            last: *start,
            rounding: printed.step(start.seconds),
            anchor: *start,
            lines: 0,
            uncertainty,
            ragged: 10 * ragged > steps.len(),
        })
    }

    /// The sample rate in Hz.
    pub fn rate(&self) -> f64 {
        1.0 / self.step
    }

    /// Takes the next line, or says how it breaks the rate.
    pub fn check(&mut self, file: &str, now: Stamp, printed: Printed) -> Result<(), InputError> {
        let step = now.seconds - self.last.seconds;
        let printed = printed.step(now.seconds);
        let rounding = printed.max(self.rounding) / self.step;
        let off = (step / self.step - 1.0).abs();
        if off > STEP_TOLERANCE + rounding.min(0.5 - STEP_TOLERANCE) {
            return Err(self.broken(file, now, rounding));
        }
        self.last = now;
        self.rounding = printed;
        self.lines += 1;
        if self.lines < RATE_LINES {
            return Ok(());
        }
        let length = now.seconds - self.anchor.seconds;
        let lines = self.lines as f64;
        // A few ppm of drift are the clock's; half a sample in this many is not.
        let allowed = (0.5 + 2.0 * rounding) * self.step + 2.0 * lines * self.uncertainty;
        if (length - lines * self.step).abs() > allowed {
            let (from, to) = (self.rate(), lines / length);
            return Err(InputError::TimeDrift { file: file.to_owned(), line: now.line, from, to });
        }
        self.anchor = now;
        self.lines = 0;
        Ok(())
    }

    fn broken(&self, file: &str, now: Stamp, rounding: f64) -> InputError {
        let (file, line) = (file.to_owned(), now.line);
        let (from, to, usual) = (self.last.seconds, now.seconds, self.step);
        let step = to - from;
        let samples = step / usual;
        let tolerance = STEP_TOLERANCE + rounding.min(COARSE) + samples * self.uncertainty / usual;
        // Even steps show that rounding does no harm, however few the digits.
        if rounding > COARSE && self.ragged {
            InputError::TimeCoarse { file, line, printed: rounding * usual, usual }
        } else if step <= 0.0 {
            InputError::TimeBackwards { file, line, from, to }
        } else if samples > 1.5 && (samples - samples.round()).abs() <= tolerance {
            InputError::TimeGap { file, line, lost: samples.round() as u64 - 1, from, to }
        } else {
            InputError::TimeUneven { file, line, step, usual }
        }
    }
}

/// The first line of `stamps` at which time does not go up.
pub(super) fn standstill(file: &str, stamps: &[Stamp], printed: Printed) -> Option<(usize, InputError)> {
    let at = stamps.windows(2).position(|pair| pair[1].seconds <= pair[0].seconds)?;
    let (from, to, line) = (stamps[at].seconds, stamps[at + 1].seconds, stamps[at + 1].line);
    let file = file.to_owned();
    let (start, end) = (stamps.first()?.seconds, stamps.last()?.seconds);
    let usual = (end - start) / (stamps.len() - 1) as f64;
    let fault = if from == to && usual > 0.0 {
        InputError::TimeCoarse { file, line, printed: printed.step(to), usual }
    } else {
        InputError::TimeBackwards { file, line, from, to }
    };
    Some((at + 1, fault))
}

/// The number of fewest digits within `uncertainty` of `value`.
fn roundest(value: f64, uncertainty: f64) -> f64 {
    let magnitude = value.log10().floor() as i32;
    (0..=15)
        .map(|digits| format!("{:.*e}", digits, value))
        .filter_map(|text| text.parse::<f64>().ok())
        .find(|round| (round - value).abs() <= uncertainty.max(10f64.powi(magnitude - 14)))
        .unwrap_or(value)
}

#[cfg(test)]
mod tests;
