//! Which columns of a text recording hold the time and the two signals.

mod roles;
mod suggested;

pub(super) use roles::{are_swapped, is_known, is_time};

use std::fmt;
use std::str::FromStr;

use roles::{is_count, is_index};

use super::error::{ROLES, TIME};
use super::preamble::Start;
use super::units::without_unit;

/// The columns to read, chosen by the user: `c,d` or `time,c,d`, each a name from the header or a number from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Columns {
    time: Option<String>,
    signals: [String; 2],
}

/// The error for a choice of columns that cannot be understood.
const WANTED: &str =
    "give two (S_C, S_D) or three (time, S_C, S_D) names or numbers, separated by commas";

impl FromStr for Columns {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
        let (time, signals) = match names.as_slice() {
            _ if names.iter().any(String::is_empty) => return Err(WANTED),
            [c, d] => (None, [c.clone(), d.clone()]),
            [time, c, d] => (Some(time.clone()), [c.clone(), d.clone()]),
            _ => return Err(WANTED),
        };
        Ok(Self { time, signals })
    }
}

impl Columns {
    /// S_C and S_D if no time is chosen.
    pub fn without_time(&self) -> Option<&[String; 2]> {
        self.time.is_none().then_some(&self.signals)
    }

    /// The numbers of S_C and S_D, from 1; none unless both are numbers, they differ, and no time is chosen.
    pub(super) fn numbers(&self) -> Option<[usize; 2]> {
        let [c, d] = self.signals.each_ref().map(|name| name.parse().ok());
        match (&self.time, c?, d?) {
            (None, c, d) if c != d => Some([c, d]),
            _ => None,
        }
    }
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(time) = &self.time {
            write!(f, "{time},")?;
        }
        write!(f, "{}", self.signals.join(","))
    }
}

/// The positions of the time, S_C and S_D among the columns, from 0.
pub(super) type Places = [Option<usize>; ROLES.len()];

/// The first line of a text recording.
pub(super) struct FirstLine<'a> {
    /// The names, if the line is a header.
    pub names: Option<&'a [String]>,
    /// The fields of the line below, if that may hold units; otherwise none.
    pub units: &'a [String],
    pub width: usize,
    /// False if a start and a step give the times, so that no column need be one.
    pub may_be_timed: bool,
    /// True if the first column numbers the samples, which stands for the time.
    pub has_numbers: bool,
    /// The columns of clock times.
    pub stamped: Vec<usize>,
    /// The columns that go up as times do.
    pub clocks: Vec<usize>,
    /// What was found in the lines above and below.
    pub start: &'a Start,
    /// True for what `antinode identify` prints, as CSV, as JSON lines or as a table.
    pub is_of_rows: bool,
}

impl FirstLine<'_> {
    /// The places of the `chosen` columns, or else of those that the names or the number of columns suggest.
    pub fn places(&self, chosen: Option<&Columns>) -> Result<Places, String> {
        match chosen {
            Some(columns) => self.chosen(columns),
            None => self.suggested(),
        }
    }

    /// The place of a column that counts the samples, by its name, where these suggested places have no time.
    pub fn counter(&self, places: Places) -> Option<usize> {
        let names = self
            .names
            .filter(|_| self.may_be_timed && places[TIME].is_none())?;
        let mut unused = (0..names.len()).filter(|&place| !places.contains(&Some(place)));
        unused.find(|&place| is_count(&names[place]) || names.len() == 3 && is_index(&names[place]))
    }

    fn chosen(&self, columns: &Columns) -> Result<Places, String> {
        let [c, d] = &columns.signals;
        let wanted = [columns.time.as_ref(), Some(c), Some(d)];
        // Names may be numbers too: if all that is chosen can be column numbers, it is.
        let is_number = |wanted: &&String| self.number(wanted).is_some();
        let are_numbers = wanted.iter().flatten().all(is_number);
        let mut places = [None; 3];
        for (place, wanted) in places.iter_mut().zip(wanted) {
            if let Some(wanted) = wanted {
                *place = Some(self.find(wanted, are_numbers)?);
            }
        }
        let [time, c, d] = places;
        let twice = c
            .filter(|_| c == d || c == time)
            .or(d.filter(|_| d == time));
        match twice {
            Some(place) => Err(format!(
                "column {} is chosen twice; choose different columns for the time, S_C and S_D with --columns",
                place + 1
            )),
            None => Ok(places),
        }
    }

    /// The place of a column given by its number, from 1.
    fn number(&self, wanted: &str) -> Option<usize> {
        let place = wanted.parse::<usize>().ok()?.checked_sub(1)?;
        (place < self.width).then_some(place)
    }

    fn find(&self, wanted: &str, is_number: bool) -> Result<usize, String> {
        let names = self.names.filter(|_| !is_number).unwrap_or_default();
        let lower = wanted.to_lowercase();
        let tests: [&dyn Fn(&str) -> bool; 3] = [
            &|name| name == wanted,
            &|name| without_unit(name) == wanted,
            &|name| without_unit(name).to_lowercase() == lower,
        ];
        for is_wanted in tests {
            let mut places = (0..names.len()).filter(|&place| is_wanted(&names[place]));
            match (places.next(), places.next()) {
                (None, _) => {}
                (Some(place), None) => return Ok(place),
                (Some(one), Some(other)) => {
                    return Err(format!(
                        "`{wanted}` may be column {} or {}; choose it by its number with --columns",
                        one + 1,
                        other + 1
                    ));
                }
            }
        }
        self.number(wanted).ok_or_else(|| {
            let numbers = format!("the numbers 1 to {}", self.width);
            let known = self
                .names
                .map_or(numbers, |names| format!("`{}`", names.join("`, `")));
            format!("there is no column `{wanted}`; choose among {known} with --columns")
        })
    }
}

#[cfg(test)]
mod tests;
