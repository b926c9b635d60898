//! Which columns hold the time and the two signals, by their names or their number.

use super::super::error::TIME;
use super::super::signal_units;
use super::super::units::{bare, sure_unit_of, time_exponent};
use super::roles::{bare_name, is_count, is_index, role};
use super::{FirstLine, Places};
use crate::digits::counted;

/// Number of columns from which on a line probably holds all samples of one channel.
const MANY_COLUMNS: usize = 100;

/// What is wrong with rows that were identified already.
const ROWS: &str = "these are rows printed by `antinode identify` or `monitor`, not samples; give the recording itself, or give the rows to \
                    `antinode plot`, `resonator` or `calibrate`";
/// What is wrong with a time and only one signal.
const ONE_SIGNAL: &str = "found the time and one signal, but both S_C and S_D are needed; export both channels to one file, or put their \
                          files side by side with `paste -d, c.csv d.csv`, and choose the columns with --columns TIME,C,D; if these are two \
                          signals without a time, give --columns C,D";

/// The end of the names of columns that hold the other extreme of a channel beside it.
const PEAKS: &str = "peak detect";

/// The names of the first two of four channels, the others being `C` and `D`.
const OTHER_CHANNELS: [&str; 2] = ["a", "b"];

impl FirstLine<'_> {
    /// The places that the names or the number of columns suggest.
    pub(super) fn suggested(&self) -> Result<Places, String> {
        self.check_is_sampled()?;
        let all: Vec<usize> = (0..self.width).collect();
        let numbers: Vec<usize> = self
            .start
            .numbers
            .iter()
            .copied()
            .filter(|&place| place < self.width)
            .collect();
        // A clock beside numbers that may be a time and both signals is one column more.
        let is_plain = |place: &usize| !self.stamped.contains(place);
        let plain: Vec<usize> = numbers.iter().copied().filter(is_plain).collect();
        let numbers = if plain.len() > 2 { plain } else { numbers };
        // Beside the samples there may be settings, and other columns without numbers.
        let is_partial = !numbers.is_empty() && numbers.len() < self.width;
        if is_partial && self.start.lines > 0 {
            return self.among(&numbers);
        }
        let places = self.among(&all);
        if is_partial && places.is_err() && self.names.is_none() {
            return self.among(&numbers);
        }
        places
    }

    /// The one column of these with a unit of time, provided that the others have no unit or that of a signal.
    fn timed(&self, columns: &[usize]) -> Option<usize> {
        let names = self.names?;
        let unit = |place: usize| match sure_unit_of(&names[place]) {
            "" => self.units.get(place).map_or("", |unit| bare(unit)),
            unit => unit,
        };
        let (times, others): (Vec<usize>, Vec<usize>) =
            columns.iter().partition(|&&place| is_of_time(unit(place)));
        let is_signal = |&place: &usize| {
            let unit = unit(place);
            unit.is_empty() || signal_units::is_known(unit)
        };
        match times.as_slice() {
            [time] if others.iter().all(is_signal) => Some(*time),
            _ => None,
        }
    }

    /// Fails if the names tell that there are minima and maxima: the two of a channel look like two signals.
    fn check_is_sampled(&self) -> Result<(), String> {
        let names = self.names.unwrap_or_default();
        let mut peaks = names
            .iter()
            .filter(|name| name.to_lowercase().ends_with(PEAKS));
        let Some(first) = peaks.next() else {
            return Ok(());
        };
        let remedy = peaks.next().map_or(
            "",
            |_| ", or choose one column of each channel with --columns TIME,C,D",
        );
        Err(format!(
            "the column `{first}` shows that these are a minimum and a maximum (peak detect, envelope); record or export single samples of \
             both channels, in sample mode{remedy}"
        ))
    }

    /// Fails if the names of S_C and S_D are given twice among these columns, or are those of two channels of four.
    fn check_unique(&self, columns: &[usize]) -> Result<(), String> {
        let names = self.names.unwrap_or_default();
        let is_signal = |place: usize| matches!(role(&names[place]), Some(1 | 2));
        let is_other = |place: usize| {
            let name = bare_name(&names[place]);
            OTHER_CHANNELS.contains(&name.trim_start_matches("channel"))
        };
        let others = columns.iter().filter(|&&place| is_other(place)).count();
        let may_be =
            |place: usize| is_signal(place) || others == OTHER_CHANNELS.len() && is_other(place);
        let found: Vec<String> = columns
            .iter()
            .filter(|&&place| may_be(place))
            .map(|&place| format!("`{}` ({})", names[place], place + 1))
            .collect();
        if found.len() == 2 {
            return Ok(());
        }
        Err(format!(
            "S_C and S_D may be any of the columns {}; choose two of them by their numbers, with --columns TIME,C,D, or C,D if there is no \
             time",
            found.join(", ")
        ))
    }

    /// Whether a column has the name of a count, or none, but holds times: the index that pandas writes.
    fn is_index_of_times(&self, place: usize) -> bool {
        let start = self.start;
        self.may_be_timed
            && self.names.is_some_and(|names| is_count(&names[place]))
            && start.numbers.first() == Some(&place)
            && start.is_surely_clocked
            && start.has_fractions
    }

    /// The places that the names or the number of these columns suggest.
    fn among(&self, columns: &[usize]) -> Result<Places, String> {
        let role = |place: usize| match place {
            0 if self.has_numbers => Some(TIME),
            _ if self.is_index_of_times(place) => Some(TIME),
            _ => self.names.and_then(|names| role(&names[place])),
        };
        let places = || columns.iter().copied();
        let place = |wanted: usize| places().find(|&place| role(place) == Some(wanted));
        let [time, c, d] = [TIME, 1, 2].map(place);
        // The same name over all columns does not make one of them the time: `HUnit,s,s` of Yokogawa.
        let name = |place: usize| self.names.map(|names| &names[place]);
        let time = time.filter(|&time| places().any(|place| name(place) != name(time)));
        // Names in another order than usual must not swap the signals.
        if c.is_some() && d.is_some() {
            self.check_unique(columns)?;
            let unnamed = places().find(|&place| role(place).is_none());
            let index = |place: &usize| self.names.is_some_and(|names| is_index(&names[*place]));
            let other =
                unnamed.filter(|place| self.may_be_timed && columns.len() == 3 && !index(place));
            return Ok([time.or(other), c, d]);
        }
        // With settings above or beside it, the first column may be a time without a name.
        let is_instrument = self.start.lines > 0 || columns.len() < self.width;
        let is_count = |place: usize| self.names.is_some_and(|names| is_count(&names[place]));
        let first = columns.first().copied();
        let clock = first.filter(|&first| {
            self.may_be_timed
                && !is_count(first)
                && (columns.len() == 3
                    || columns.len() == 2
                        && self.names.is_none()
                        && (is_instrument && self.start.is_clocked || self.start.is_surely_clocked))
        });
        let is_stamped = |place: &usize| self.stamped.contains(place);
        let time = time
            .or(self.timed(columns))
            .or(places().find(is_stamped))
            .or(clock);
        // `#,Time(ms),CH1(mV),CH2(mV)`, or `Sample,ADC1,ADC2`.
        let count = first.filter(|&first| {
            let is_beside_time = time.is_some() && time == columns.get(1).copied();
            is_count(first) && (is_beside_time || time.is_none() && columns.len() == 3)
        });
        let is_other = |place: &usize| [time, count].contains(&Some(*place)) || is_stamped(place);
        let mut signals = places().filter(|place| !is_other(place));
        match (signals.next(), signals.next(), signals.next()) {
            (Some(c), Some(d), None) => Ok([time, Some(c), Some(d)]),
            (Some(_), None, None) if time.is_some() => Err(ONE_SIGNAL.to_owned()),
            _ if self.is_of_rows => Err(ROWS.to_owned()),
            _ => {
                let are_words = self.names.is_some() && self.start.numbers.is_empty();
                Err(self
                    .pasted(columns)
                    .unwrap_or_else(|| wrong_count(columns.len(), are_words)))
            }
        }
    }

    /// What is wrong with these columns if they are those of two files of one channel each, with a time each.
    fn pasted(&self, columns: &[usize]) -> Option<String> {
        let [time, c, other, d] = columns else {
            return None;
        };
        let is_clock = |place| self.clocks.contains(place);
        let are_pasted = [time, other].into_iter().all(is_clock) && !is_clock(c) && !is_clock(d);
        let [time, c, other, d] = [time, c, other, d].map(|place| place + 1);
        are_pasted.then(|| format!(
            "found 4 columns, but two (S_C, S_D) or three (time in s, S_C, S_D) are needed; if {time} and {other} are the times of {c} and \
             {d}, give --columns {time},{c},{d}"
        ))
    }
}

/// What is wrong with so many columns, which cannot be understood.
fn wrong_count(columns: usize, are_words: bool) -> String {
    let remedy = match columns {
        1 => {
            "give one sample pair a line: of two files `paste -d, c.csv d.csv`, of two variables in MATLAB or Octave \
             `dlmwrite('both.csv', [c(:) d(:)], 'precision', 9)`"
        }
        MANY_COLUMNS.. => {
            "give one sample pair a line: of a line for each channel in Python `import numpy; \
             numpy.savetxt('both.csv', numpy.loadtxt(r'FILE', delimiter=',').T, delimiter=',')`, with the file's own delimiter in \
             `loadtxt`"
        }
        _ => {
            "remove the others, or choose the right ones with --columns TIME,C,D, or C,D if there is no time"
        }
    };
    let title = if are_words {
        "; if this line is a title, delete it or begin it with #"
    } else {
        ""
    };
    format!(
        "found {}, but two (S_C, S_D) or three (time in s, S_C, S_D) are needed; {remedy}{title}",
        counted(columns as u64, "column")
    )
}

/// Whether a unit is one of time, s or a decimal part of it.
fn is_of_time(unit: &str) -> bool {
    matches!(time_exponent(unit), Some(Some(_)))
}
