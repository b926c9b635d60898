//! Columns of clock times, `2026-11-28T13:45:01.5Z` or `28.11.2026 1:45:01.5 PM`, or `13:45:01.5` of a day that is not told: they are read
//! as if they were written in seconds, since 1970 or since midnight.

use jiff::Timestamp;
use jiff::civil::Date;

use super::text::{all_fields, bare, is_skipped, raw_fields, separator};

/// The seconds after which a clock without a date begins anew.
pub(super) const DAY: u32 = 86_400;

/// Lines looked at, the last of those that are read ahead.
const LINES: usize = 16;

/// Fewest fields of a line with a time and two samples: behind a terminal's stamp and a tab, other separators divide the samples.
const MIN_FIELDS: usize = 3;

/// Most decimals kept: no clock has more.
const MAX_DECIMALS: usize = 12;

/// A column of clock times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamped {
    place: usize,
    pub has_date: bool,
}

/// The columns of clock times in a text.
#[derive(Debug, Default)]
pub(super) struct Stamps {
    columns: Vec<Stamped>,
    separator: u8,
}

impl Stamps {
    /// Those that hold clock times in at least half of the last of these lines: above them there may be settings.
    pub fn of(text: &[u8]) -> Self {
        let lines = text.rsplit(|&byte| byte == b'\n');
        let lines: Vec<&[u8]> = lines.filter(|line| !is_skipped(line)).take(LINES).collect();
        let separator = separator(lines.first().copied().unwrap_or_default());
        let stamped = |(place, field)| {
            let (_, has_date) = seconds(field)?;
            Some(Stamped { place, has_date })
        };
        let wide = lines
            .iter()
            .filter(|line| all_fields(line, separator).count() >= MIN_FIELDS);
        let found: Vec<Stamped> = wide
            .flat_map(|line| all_fields(line, separator).enumerate())
            .filter_map(stamped)
            .collect();
        let are_most = |column: &&Stamped| {
            let alike = found.iter().filter(|other| other == column);
            2 * alike.count() >= lines.len()
        };
        let mut columns: Vec<Stamped> = found.iter().filter(are_most).copied().collect();
        columns.sort_unstable_by_key(|column| column.place);
        columns.dedup();
        Self { columns, separator }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// The column at this place, if it holds clock times.
    pub fn at(&self, place: usize) -> Option<Stamped> {
        let mut columns = self.columns.iter();
        columns.find(|column| column.place == place).copied()
    }

    /// Writes seconds in place of the clock times in these columns.
    pub fn convert(&self, text: &mut Vec<u8>) {
        if self.is_empty() {
            return;
        }
        let mut converted = Vec::with_capacity(text.len());
        for line in text.split_inclusive(|&byte| byte == b'\n') {
            let inner = line.strip_suffix(b"\n").unwrap_or(line);
            let mut place = 0;
            for (at, raw) in raw_fields(inner, self.separator).enumerate() {
                if at > 0 {
                    converted.push(self.separator);
                }
                let field = bare(raw);
                let seconds = self.at(place).and_then(|_| seconds(field));
                converted
                    .extend_from_slice(seconds.as_ref().map_or(raw, |(text, _)| text.as_bytes()));
                // Of several blanks in a row, all but the last separate nothing.
                place += usize::from(self.separator != b' ' || !field.is_empty());
            }
            converted.extend_from_slice(&line[inner.len()..]);
        }
        *text = converted;
    }
}

/// Whether a field is a clock time, or the date before one where blanks separate fields.
pub(super) fn is_stamp(field: &[u8]) -> bool {
    seconds(field).is_some() || str::from_utf8(field).is_ok_and(|text| date(text).is_some())
}

/// The clock time in a field in seconds, with all its decimals, and whether it has a date; none if the field holds anything else.
fn seconds(field: &[u8]) -> Option<(String, bool)> {
    let (before, rest) = str::from_utf8(field).ok()?.split_once(':')?;
    let day = before.trim_end_matches(is_digit);
    let hour = &before[day.len()..];
    let hour = (hour.len() <= 2).then(|| hour.parse().ok())??;
    let day = match day {
        "" => None,
        day => Some(date(day.strip_suffix(['T', ' '])?.trim_end())?),
    };
    let (rest, hour) = without_half(rest.trim_end(), hour)?;
    let (clock, rest) = rest.split_at_checked("mm:ss".len())?;
    let (decimals, zone) = match rest.strip_prefix(['.', ',']) {
        Some(rest) => {
            let zone = rest.trim_start_matches(is_digit);
            (&rest[..rest.len() - zone.len()], zone)
        }
        None => ("", rest),
    };
    let zone = match zone.trim_start() {
        "" => "Z",
        zone => zone,
    };
    // Without a date any will do.
    let time = format!("{}T{hour:02}:{clock}{zone}", day.unwrap_or_default());
    let whole = time.parse::<Timestamp>().ok()?.as_second();
    let whole = match day {
        Some(_) => whole,
        None => whole.rem_euclid(DAY.into()),
    };
    let kept = &decimals[..decimals.len().min(MAX_DECIMALS)];
    let mark = if kept.is_empty() { "" } else { "." };
    (whole >= 0).then(|| (format!("{whole}{mark}{kept}"), day.is_some()))
}

/// A date, `2026-11-28` with dashes, slashes or points, or `28.11.2026`. Dates with slashes whose year is last have no order of their own.
fn date(text: &str) -> Option<Date> {
    let mark = text.find(['-', '/', '.'])?;
    let parts: Vec<&str> = text.split(char::from(text.as_bytes()[mark])).collect();
    let [first, month, last] = parts[..] else {
        return None;
    };
    let (year, day) = match (first.len(), last.len()) {
        (4, ..=2) => (first, last),
        (..=2, 4) if text.as_bytes()[mark] == b'.' => (last, first),
        _ => return None,
    };
    Date::new(year.parse().ok()?, month.parse().ok()?, day.parse().ok()?).ok()
}

/// What stands before AM or PM, and the hour as clocks of 24 hours show it.
fn without_half(text: &str, hour: u8) -> Option<(&str, u8)> {
    let Some((rest, half)) = text.split_at_checked(text.len().saturating_sub("AM".len())) else {
        return Some((text, hour));
    };
    let later = match half {
        _ if half.eq_ignore_ascii_case("AM") => 0,
        _ if half.eq_ignore_ascii_case("PM") => 12,
        _ => return Some((text, hour)),
    };
    (1..=12)
        .contains(&hour)
        .then_some((rest.trim_end(), hour % 12 + later))
}

/// Whether a letter is a digit.
fn is_digit(letter: char) -> bool {
    letter.is_ascii_digit()
}

#[cfg(test)]
mod tests;
