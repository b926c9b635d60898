//! The lines of a text recording, each as its time and its pair.

mod ahead;

use super::super::Stream;
use super::super::columns::Columns;
use super::super::date::Origin;
use super::super::error::{CHANNELS, Fault, Place, ROLES, TIME};
use super::super::forms::remedy;
use super::super::header::{Header, lossy};
use super::super::left_out::LeftOut;
use super::super::lines::{Line, Lines};
use super::super::no_number::{meant, stand_in};
use super::super::not_finite::Flaw;
use super::super::number::number;
use super::super::printed::Printed;
use super::super::stamps::DAY;
use super::super::time::TimeAxis;
use super::super::wrapped::Wrapped;
use super::fields::{Cut, missing, place};

/// Characters of a bad field that an error shows, at most.
const MAX_SHOWN: usize = 40;

/// Garbled lines before the first good one from which on the text is refused: fewer may be a glitch.
const MIN_GARBLED_BEGINNING: u64 = 2;

/// The content of one line.
pub(super) enum Row {
    /// Its time, if there is a time column, and its pair.
    Pair(Option<f64>, [f32; 2]),
    /// Nothing: the line is left out, as its time is not known.
    LeftOut,
}

/// Reads lines of numbers.
pub(super) struct Rows {
    pub lines: Lines,
    pub header: Header,
    pub printed: Printed,
    /// From where on times are counted.
    origin: Origin,
    /// The counter that the times may come from.
    wrapped: Wrapped,
    /// The times so far, once their rate is known.
    pub axis: Option<TimeAxis>,
    /// The first sample that is not a finite number, and the first behind a pair with a value.
    pub not_finite: [Option<Flaw>; 2],
    /// Whether there was such a pair.
    has_value: bool,
    /// The lines that are left out.
    pub left_out: LeftOut,
    /// The lines read, and the pairs among them.
    pub read: u64,
    pub pairs: u64,
    /// Lines among them with too many or too few fields, or one that is neither a number nor stands for a missing one.
    garbled: u64,
    /// Lines left out as their time is wrong.
    odd: u64,
    /// The first garbled line: the pairs before it, and its fault.
    first_garbled: Option<(u64, Fault)>,
    /// Garbled lines before the first good one.
    garbled_before: u64,
}

impl Rows {
    /// Opens text and reads its header.
    pub fn open(stream: Stream, chosen: Option<&Columns>) -> Result<Self, Fault> {
        let (mut lines, beginning) = Lines::open(stream)?;
        let header = Header::read(&mut lines, &beginning, chosen)?;
        let wrapped = match header.stamp {
            Some(stamp) if !stamp.has_date => Wrapped::after(DAY.into()),
            _ => Wrapped::default(),
        };
        Ok(Self {
            lines,
            header,
            printed: Printed::default(),
            origin: Origin::default(),
            wrapped,
            axis: None,
            not_finite: [None, None],
            has_value: false,
            left_out: LeftOut::default(),
            read: 0,
            pairs: 0,
            garbled: 0,
            odd: 0,
            first_garbled: None,
            garbled_before: 0,
        })
    }

    /// True if the text begins with more garbled lines than a glitch leaves.
    pub fn begin_garbled(&self) -> bool {
        self.garbled_before >= MIN_GARBLED_BEGINNING
    }

    /// True if a line was garbled.
    pub fn is_garbled(&self) -> bool {
        self.garbled > 0
    }

    /// If most lines are garbled, the first of them: the pairs before it, and its fault. It is given only once.
    pub fn mostly_garbled(&mut self) -> Option<(u64, Fault)> {
        let are_most = 2 * self.garbled > self.read || self.begin_garbled();
        let first = self.first_garbled.take_if(|_| are_most);
        if first.is_some() {
            self.left_out.clear();
        }
        first
    }

    /// The time in this field, in its own unit.
    fn time(&self, text: &[u8]) -> Option<f64> {
        number::<f64>(text, self.lines.separator).filter(|time| time.is_finite())
    }

    /// The time in `text` from the origin on, s, which was read as this `time`, with what a counter counted before it began anew.
    fn seconds(&self, text: &[u8], time: f64, wrapped: &mut Wrapped) -> f64 {
        let time = wrapped.unwrapped(self.origin.since(text, time));
        time / 10f64.powi(-self.header.exponent)
    }

    /// The next line's row; none at the end.
    pub fn next(&mut self) -> Result<Option<Row>, Fault> {
        if !self.advance()? {
            return Ok(None);
        }
        // Taken out, so that lines may be read ahead of it.
        let line = self.lines.take();
        let row = self.row(Line::new(&line, self.lines.separator));
        self.lines.give_back(line);
        row.map(Some)
    }

    /// The row of a line.
    fn row(&mut self, line: Line) -> Result<Row, Fault> {
        let cut = Cut::of(line, &self.header);
        let texts = cut.texts;
        let own_time = self.time(texts[TIME]);
        let mut wrapped = self.wrapped;
        let time = own_time.map(|time| self.seconds(texts[TIME], time, &mut wrapped));
        let is_odd = match time {
            Some(time) => self.is_odd(time)?,
            None => false,
        };
        let time = time.filter(|_| !is_odd);
        let (broken, broken_line) = cut.broken(&self.lines, &self.header).unzip();
        let mut pair = [f32::NAN; 2];
        // The roles of the first field that is no finite number, and of the first that does not even stand for one.
        let (mut odd, mut garbled) = (None, None);
        for (channel, value) in pair.iter_mut().enumerate() {
            let (role, text) = (channel + 1, texts[channel + 1]);
            let read = number(text, self.lines.separator).map(meant);
            if let Some(read) = read.or_else(|| stand_in(text)) {
                *value = read / self.header.divisors[channel];
            } else {
                garbled = garbled.or(Some(role));
            }
            if !value.is_finite() {
                odd = odd.or(Some((role, read)));
            }
        }
        if let Some(time) = own_time.filter(|_| !is_odd) {
            self.printed.see(texts[TIME], time, self.header.exponent);
            self.wrapped = wrapped;
        }
        let is_left_out = time.is_none() && self.header.places[TIME].is_some();
        if is_left_out {
            let mut flaw = self.flaw(TIME, texts[TIME], None, broken_line);
            if is_odd {
                flaw.description = format!(
                    "the time `{}` does not follow that of the line before, but the lines behind do",
                    shown(texts[TIME])
                );
            }
            self.left_out.add(flaw);
            garbled = Some(TIME).filter(|_| !is_odd);
        } else {
            self.has_value |= pair.iter().any(|value| !value.is_nan());
            let which = usize::from(self.has_value);
            if let (Some((role, read)), None) = (odd, &self.not_finite[which]) {
                self.not_finite[which] = Some(self.flaw(role, texts[role], read, broken_line));
            }
        }
        let garbled = garbled.map(|role| self.no_number(role, texts[role]));
        self.count(broken.or(garbled));
        if is_left_out {
            return Ok(Row::LeftOut);
        }
        self.pairs += 1;
        Ok(Row::Pair(time, pair))
    }

    /// Goes to the next line that is not blank; false at the end.
    fn advance(&mut self) -> Result<bool, Fault> {
        // Separators alone are a blank line of a spreadsheet if lines have a time; without a time column they are a missing pair.
        let is_timed = self.header.places[TIME].is_some();
        while self.lines.advance()? {
            if !(is_timed && self.lines.line().fields().all(<[u8]>::is_empty)) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The flaw of this line, whose `text` in the column of this `role` is no finite number; `broken` describes a line of too many or too
    /// few fields.
    fn flaw(&self, role: usize, text: &[u8], read: Option<f32>, broken: Option<String>) -> Flaw {
        let mut place = self.place(role);
        if broken.is_some() {
            place.column = None;
        }
        let description = match broken {
            Some(broken) if role == TIME => broken,
            Some(broken) => format!("{broken}, so a sample is missing"),
            None => describe(role, text, read),
        };
        Flaw {
            pair: self.pairs,
            place: Some(place),
            description,
        }
    }

    /// Counts this line, which is garbled if it has a `fault`.
    fn count(&mut self, fault: Option<Fault>) {
        if let Some(fault) = fault {
            if self.garbled == 0 {
                self.first_garbled = Some((self.pairs, fault));
            }
            self.garbled += 1;
        }
        self.read += 1;
        if self.garbled == self.read {
            self.garbled_before = self.garbled;
        }
    }

    fn place(&self, role: usize) -> Place {
        place(&self.lines, &self.header, role)
    }

    /// The fault of `text` in the column of this `role`, which is no number.
    fn no_number(&self, role: usize, text: &[u8]) -> Fault {
        if text.is_empty() {
            return missing(&self.header, self.place(role), role);
        }
        let text = shown(text);
        // A tab behind a stamp may be the terminal's, and other separators divide the numbers.
        let may_be_left_out = role == TIME || self.lines.separator != b'\t';
        let told = match (role, remedy(&text, may_be_left_out)) {
            (TIME, None) => self.header.or_ignore_time(&format!(
                "the time is `{text}`, not a finite number; give it in seconds or as 2026-11-28T13:45:01.5, delete the line, or begin it with # if it is a comment"
            )),
            (role, remedy) => format!(
                "{} is `{text}`, not a number; {}",
                ROLES[role],
                remedy.unwrap_or("correct or delete the line, or begin it with # if it is a comment")
            ),
        };
        Fault::at(Some(self.place(role)), told)
    }
}

/// Describes a field that is no finite number; `read` is the NaN or infinity that it was read as, if any.
fn describe(role: usize, text: &[u8], read: Option<f32>) -> String {
    let value = match read {
        _ if text.is_empty() => "missing".to_owned(),
        Some(read) => format!("{read}, not a finite number"),
        None => format!("`{}`, not a finite number", shown(text)),
    };
    match role {
        TIME => format!("the time is {value}"),
        signal => format!("{}: the value is {value}", CHANNELS[signal - 1]),
    }
}

/// A bad field as an error shows it: escaped and cut short.
fn shown(field: &[u8]) -> String {
    let text = lossy(field);
    text.chars()
        .flat_map(|letter| {
            // A quote is shown without its backslash.
            let escape = usize::from(matches!(letter, '"' | '\''));
            letter.escape_debug().skip(escape)
        })
        .take(MAX_SHOWN)
        .collect()
}
