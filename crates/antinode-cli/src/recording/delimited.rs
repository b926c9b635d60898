//! Text recordings: one pair a line, with or without the time before it.

use super::columns::Columns;
use super::error::{COLUMNS_OPTION, InputError, LineFault, Place, RATE_OPTION, Role, TimeFault};
use super::header::{Header, lossy};
use super::lines::Lines;
use super::printed::Printed;
use super::text::number;
use super::time::{Meaning, TimeAxis, standstill};
use super::{OpenOptions, Opened, Source, Stream};

/// The lines read ahead to tell the sample rate, whose times are rounded as they are printed.
const HEAD_LINES: usize = 1 << 16;

/// As much of a bad field as an error shows.
const SHOWN_LETTERS: usize = 40;

/// Opens text; a `live` stream is handed over as it comes.
pub(super) fn open(
    file: &str,
    stream: Stream,
    options: &OpenOptions,
    live: bool,
) -> Result<Opened, InputError> {
    let mut source = Delimited::open(file, stream, options.columns.as_ref())?;
    source.live = live;
    source.read_ahead();
    if source.ahead.len() == 0 {
        let none = InputError::NoPairs {
            file: file.to_owned(),
        };
        return Err(source.fault.take().unwrap_or(none));
    }
    let meaning = source
        .axis
        .as_ref()
        .map(|axis| axis.meaning(source.printed, options.rate));
    if meaning == Some(Meaning::Index) {
        source.start = 0.0;
    }
    Ok(Opened {
        format: "CSV".to_owned(),
        sample_rate: source.axis.as_ref().map(TimeAxis::rate),
        start: source.start,
        warning: meaning.and_then(|meaning| source.warning(meaning)),
        source: Box::new(source),
        pairs: None,
        full_scale: None,
    })
}

/// Reads lines of numbers.
struct Delimited {
    file: String,
    lines: Lines,
    header: Header,
    printed: Printed,
    /// The first time, or 0.
    start: f64,
    axis: Option<TimeAxis>,
    live: bool,
    /// Of the first sample that is not a finite number.
    not_finite: Option<Place>,
    /// Pairs read to tell the sample rate, and not yet delivered.
    ahead: std::vec::IntoIter<[f32; 2]>,
    /// Met behind the last of them.
    fault: Option<InputError>,
}

/// A line's time, if there is one, and its pair.
type Row = (Option<f64>, [f32; 2]);

impl Delimited {
    fn open(file: &str, stream: Stream, chosen: Option<&Columns>) -> Result<Self, InputError> {
        let (mut lines, first) = Lines::open(file, stream)?;
        let header = Header::read(file, &mut lines, &first, chosen)?;
        Ok(Self {
            file: file.to_owned(),
            lines,
            header,
            printed: Printed::default(),
            start: 0.0,
            axis: None,
            live: false,
            not_finite: None,
            ahead: Vec::new().into_iter(),
            fault: None,
        })
    }

    /// Reads as many lines as it takes to tell the sample rate, and checks their times.
    fn read_ahead(&mut self) {
        let head = if self.header.places[0].is_some() {
            HEAD_LINES
        } else {
            1
        };
        let (mut pairs, mut times, mut lines) = (Vec::new(), Vec::new(), Vec::new());
        while pairs.len() < head && self.fault.is_none() {
            match self.row() {
                Ok(Some((time, pair))) => {
                    pairs.push(pair);
                    times.extend(time);
                    lines.push(self.lines.number());
                }
                Ok(None) => break,
                Err(fault) => self.fault = Some(fault),
            }
        }
        self.start = times.first().copied().unwrap_or(0.0);
        self.axis = TimeAxis::of(&times, self.printed);
        let broken = match &mut self.axis {
            Some(axis) => times.iter().enumerate().skip(1).find_map(|(index, &time)| {
                let fault = axis.check(time, self.printed).err()?;
                Some((index, fault))
            }),
            None => standstill(&times, self.printed),
        };
        if let Some((index, fault)) = broken {
            pairs.truncate(index);
            self.fault = Some(self.time_fault(lines[index], fault));
        }
        self.ahead = pairs.into_iter();
    }

    /// What is understood, but hardly meant.
    fn warning(&self, meaning: Meaning) -> Option<String> {
        let samples = self.header.samples();
        let ignored = format!("ignore it with {COLUMNS_OPTION} {samples} {RATE_OPTION} HZ");
        let told = match meaning {
            Meaning::Time => return None,
            Meaning::PerhapsIndex => format!(
                "the time column goes up by 1 a line, and is read as seconds; if it is an index, {ignored}"
            ),
            Meaning::Index => format!(
                "the time column goes up by 1 a line, and is taken for an index because of {RATE_OPTION}: times of rows \
                 are from the first sample on; if it is seconds, leave {RATE_OPTION} out"
            ),
            Meaning::OtherRate { own, asked } => format!(
                "by the time column the sample rate is {own} Hz, but {RATE_OPTION} makes it {asked} Hz, and goes before; \
                 leave {RATE_OPTION} out, or if the column is wrong, {ignored}"
            ),
        };
        Some(format!("{}: {told}", self.file))
    }

    fn row(&mut self) -> Result<Option<Row>, InputError> {
        if !self.lines.advance()? {
            return Ok(None);
        }
        let mut found = [&[][..]; 3];
        let (mut count, mut last_is_blank) = (0, false);
        for field in self.lines.fields() {
            for (text, place) in found.iter_mut().zip(self.header.places) {
                if place == Some(count) {
                    *text = field;
                }
            }
            (count, last_is_blank) = (count + 1, field.is_empty());
        }
        // One mark at the end of a line ends its last field; it does not begin another.
        if count > self.header.width + usize::from(last_is_blank) {
            let fault = LineFault::FieldCount {
                found: count,
                expected: self.header.width,
            };
            return Err(InputError::line(&self.file, self.lines.number(), fault));
        }
        let mut time = None;
        if self.header.places[0].is_some() {
            let told = number::<f64>(found[0], self.lines.separator)
                .filter(|time| time.is_finite())
                .ok_or_else(|| self.no_number(0, found[0]))?;
            self.printed.see(found[0], told, self.header.exponent);
            time = Some(told / 10f64.powi(-self.header.exponent));
        }
        let signal = |role: usize| {
            number::<f32>(found[role], self.lines.separator)
                .ok_or_else(|| self.no_number(role, found[role]))
        };
        let pair = [signal(1)?, signal(2)?];
        if self.not_finite.is_none()
            && let Some(channel) = pair.iter().position(|value| !value.is_finite())
        {
            self.not_finite = Some(self.place(channel + 1));
        }
        Ok(Some((time, pair)))
    }

    /// This line, and the column of this `role`.
    fn place(&self, role: usize) -> Place {
        Place {
            line: self.lines.number(),
            column: self.header.places[role].map(|place| place + 1),
        }
    }

    /// What is wrong with `text`, which is in the column of this `role` and no number.
    fn no_number(&self, role: usize, text: &[u8]) -> InputError {
        let place = self.place(role);
        let is_missing = text.is_empty();
        let text = shown(text);
        let fault = match Role::ALL[role] {
            Role::Time if is_missing => self.header.time_fault(TimeFault::Missing),
            Role::Time => self.header.time_fault(TimeFault::Number { text }),
            role if is_missing => LineFault::FieldMissing { role },
            role => LineFault::Number { role, text },
        };
        InputError::Line {
            file: self.file.clone(),
            place,
            fault,
        }
    }

    fn time_fault(&self, line: u64, fault: TimeFault) -> InputError {
        InputError::line(&self.file, line, self.header.time_fault(fault))
    }
}

/// A bad field as an error shows it.
fn shown(field: &[u8]) -> String {
    let text = lossy(field);
    text.chars()
        .flat_map(char::escape_debug)
        .take(SHOWN_LETTERS)
        .collect()
}

impl Source for Delimited {
    fn fill(&mut self, pairs: &mut Vec<[f32; 2]>, capacity: usize) -> Result<(), InputError> {
        pairs.extend(self.ahead.by_ref().take(capacity));
        while pairs.len() < capacity {
            if let Some(fault) = self.fault.take() {
                return Err(fault);
            }
            let Some((time, pair)) = self.row()? else {
                break;
            };
            if let (Some(axis), Some(time)) = (&mut self.axis, time) {
                let checked = axis.check(time, self.printed);
                checked.map_err(|fault| self.time_fault(self.lines.number(), fault))?;
            }
            pairs.push(pair);
            // The next line may take its time.
            if self.live && self.lines.is_drained() {
                break;
            }
        }
        Ok(())
    }

    fn bytes_read(&self) -> u64 {
        self.lines.bytes_read()
    }

    fn ahead(&self) -> &[[f32; 2]] {
        self.ahead.as_slice()
    }

    fn late_warning(&self) -> Option<String> {
        let axis = self.axis.as_ref()?;
        let (rate, late) = axis.drift()?;
        let side = if late < 0.0 { "before" } else { "after" };
        Some(format!(
            "{}: in the time column the sample rate has gone slowly from {:.3} Hz to {rate:.3} Hz; times and frequencies of rows are by \
             the first of them, and the last sample's own time is {:.1e} s {side} that: resample it to a constant rate where that matters",
            self.file,
            axis.rate(),
            late.abs()
        ))
    }

    fn not_finite_place(&self) -> Option<Place> {
        self.not_finite
    }
}

#[cfg(test)]
mod tests;
