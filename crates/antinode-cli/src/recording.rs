//! Recordings of the two pick-off signals: read from WAV, text, NPY and raw samples, and written.

mod by_content;
mod clocks;
mod codes;
mod columns;
mod content;
mod date;
mod delimited;
mod error;
mod foreign;
mod forms;
mod frame;
mod gaps;
mod header;
mod heading;
mod left_out;
mod lines;
mod no_number;
mod not_finite;
mod npy;
mod number;
mod preamble;
mod printed;
mod quoted;
mod raw;
mod resolution;
mod sample;
mod sequence;
mod signal_units;
mod source;
mod stamps;
mod stated;
mod text;
mod time;
mod units;
mod wav;
mod wrapped;
mod write;

use std::cell::Cell;
use std::fs::Metadata;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::rc::Rc;

pub use by_content::OpenOptions;
use codes::Lowest;
pub use columns::Columns;
use delimited::Delimited;
use error::Fault;
pub use error::{STANDARD_INPUT, unreadable};
pub use gaps::Gap;
use not_finite::NotFinite;
pub use sample::Kind;
use source::{Counting, Known, Opened, Source, Stream};
pub use source::{extension, in_utf8, open_file, place};
pub use write::{RecordingWriter, SampleFormat};

use crate::failure::Failure;

/// Capacity, in pairs, given to a buffer that has none: small enough to stay in the cache.
pub const BLOCK_PAIRS: usize = 1 << 14;

/// Step between 32-bit integers as they are decoded, full scale 1: the finest of all.
const MIN_UNIT: f32 = 1.0 / 2_147_483_648.0;

/// A recording of S_C and S_D, read once from its beginning to its end in constant memory.
pub struct Recording {
    /// The path, or "standard input".
    pub name: String,
    /// The size of the file, bytes; none for a pipe.
    pub bytes_total: Option<u64>,
    bytes_read: Rc<Cell<u64>>,
    /// What its header tells.
    pub opened: Opened,
    /// Pairs read ahead to find the resolution, not yet delivered.
    head: std::vec::IntoIter<[f32; 2]>,
    /// Step between codes, as found in the first samples.
    step: Option<f32>,
    /// The lowest bits of integer samples; none for floats and text.
    lowest: Option<Lowest>,
    not_finite: NotFinite,
    /// A fault that was met while good pairs were still to be delivered.
    fault: Option<Fault>,
    ended: bool,
}

impl Recording {
    /// Opens a file or pipe by its content or else its extension, or standard input if `path` is `-`.
    pub fn open(path: &Path, options: &OpenOptions) -> Result<Self, Failure> {
        let (name, stream, known): (_, Stream, _) = if path == Path::new("-") {
            let (name, stdin) = (STANDARD_INPUT.to_owned(), io::stdin());
            let is_described = options.raw.is_some() || options.columns.is_some();
            if !is_described && stdin.is_terminal() {
                let told = "this is a terminal; pipe a recording into the command, or name a file";
                return Err(Fault::new(told).of(&name));
            }
            (name, Box::new(stdin), Known::default())
        } else {
            let name = path.display().to_string();
            let io = |fault| unreadable(&name, fault);
            let file = open_file(path)?;
            // Windows tells nothing of its devices and pipes.
            let there = file.metadata().ok().filter(Metadata::is_file);
            let length = there.map(|there| there.len());
            let known = Known {
                is_named: true,
                extension: extension(path),
                length,
                again: length.map(|_| file.try_clone()).transpose().map_err(io)?,
                read: Rc::default(),
            };
            (name, Box::new(file), known)
        };
        let (length, bytes_read) = (known.length, Rc::clone(&known.read));
        let count = Rc::clone(&known.read);
        match by_content::open(Box::new(Counting { stream, count }), known, options) {
            Ok(opened) => Ok(Self {
                bytes_read,
                ..Self::new(name, opened, length)
            }),
            Err(fault) => Err(fault.of(&name)),
        }
    }

    fn new(name: String, mut opened: Opened, bytes_total: Option<u64>) -> Self {
        let unit = opened.integers.map(|code| unit(code.full_scale()));
        let (head, step, fault) = if bytes_total.is_some() {
            // Found in the first samples that are not silent: integers, too, may come from a converter of fewer bits.
            let (head, step, fault) = resolution::of_head(&mut opened.source);
            let step = step.or_else(|| codes::of_integers(&head, unit?));
            (head, step, fault)
        } else {
            // A pipe must not be waited for, and how much has come is chance: only what the source has read ahead anyway is used.
            let ahead = opened.source.text().map_or(&[][..], Delimited::ahead);
            let step = resolution::resolution(ahead);
            (Vec::new(), step, None)
        };
        Self {
            name,
            bytes_total,
            bytes_read: Rc::default(),
            opened,
            head: head.into_iter(),
            step,
            lowest: unit.map(Lowest::new),
            not_finite: NotFinite::default(),
            fault,
            ended: false,
        }
    }

    /// The warnings that can be given only once all is read.
    pub fn late_warnings(&self) -> impl Iterator<Item = String> {
        let text = self.opened.source.text();
        let of_edges = (!self.edges_count()).then(|| self.not_finite.edge_warnings());
        let of_text = text.into_iter().flat_map(Delimited::late_warnings);
        of_text.chain(of_edges.into_iter().flatten())
    }

    /// Whether pairs without values count as faults even at the beginning and the end: among broken lines they may be broken themselves.
    fn edges_count(&self) -> bool {
        let text = self.opened.source.text();
        text.is_some_and(Delimited::is_garbled)
    }

    /// The bytes read so far.
    pub fn bytes_read(&self) -> u64 {
        self.bytes_read.get()
    }

    /// The magnitude from which an integer sample is at its rail, 32767/32768 for 16 bits, 2047/2048 where only the upper 12 are in use;
    /// none for floats.
    pub fn full_scale(&self) -> Option<f32> {
        let largest = self.opened.integers?.full_scale();
        // Full scale reads as 1: the largest code is a step below it.
        Some(self.step.map_or(largest, |step| largest.min(1.0 - step)))
    }

    /// The warning about `rails` given for integer samples that do not fit their scale.
    pub fn rails_warning(&self, rails: [f32; 2]) -> Option<String> {
        self.opened.integers?.rails_warning(rails)
    }

    /// The step between two codes of the converter: of integers, and of text and floats that are multiples of one.
    ///
    /// In a pipe it is found only in text with a time, of which many lines are read ahead; otherwise it is that of the integers' bits.
    pub fn resolution(&self) -> Option<f32> {
        let of_integers = self.full_scale().map(|largest| 1.0 - largest);
        of_integers.filter(|&step| step > 0.0).or(self.step)
    }

    /// The step of all integers looked at so far, a power of two. One coarser than [`resolution`](Self::resolution) was found too late for
    /// that, as in a pipe or where the wave repeats a few codes at first.
    pub fn resolution_so_far(&self) -> Option<f32> {
        self.lowest.as_ref()?.step()
    }

    /// The error for those of the samples looked at so far that are not finite numbers, if any are.
    pub fn not_finite(&self) -> Option<Failure> {
        let (first, count) = self.not_finite.reported(self.edges_count())?;
        // Text knows the place, unless the first that it met is none of those looked at.
        let written = self.opened.source.text();
        let written = written.and_then(|text| text.not_finite(first.pair));
        let first = written.unwrap_or(&first);
        let told = format!(
            "sample pair {} (from 0), {}{}; \
             rows whose window contains one are flagged or missing, all others are good; check the instrument or program that wrote it",
            first.pair,
            first.description,
            first_of(count)
        );
        Some(Fault::at(first.place, told).of(&self.name))
    }

    /// The next gap in the samples' own time; each gap among delivered pairs must be passed by [`pass_gap`](Self::pass_gap), in order.
    pub fn next_gap(&self) -> Option<Gap> {
        self.opened.source.text()?.gaps.next()
    }

    /// Passes the next gap, which `is_reported` at the end unless it lies outside the span asked for.
    pub fn pass_gap(&mut self, is_reported: bool) {
        if let Source::Text(text) = &mut self.opened.source {
            text.gaps.pass(is_reported);
        }
    }

    /// The error for the gaps passed so far that are to be reported and for the lines left out, if there are any.
    pub fn lost(&self) -> Option<Failure> {
        Some(self.opened.source.text()?.lost()?.of(&self.name))
    }

    /// Clears `buffer` and fills it to its capacity with the next pairs [S_C, S_D]; `Ok(0)` at the end.
    ///
    /// A pipe gives what is there instead of waiting for more. All good pairs before a fault are delivered first; the next call gives the
    /// error, and those after it `Ok(0)`. Samples that are not finite numbers are delivered as they are: [`look`](Self::look) finds them.
    pub fn read(&mut self, buffer: &mut Vec<[f32; 2]>) -> Result<usize, Failure> {
        buffer.clear();
        if buffer.capacity() == 0 {
            buffer.reserve_exact(BLOCK_PAIRS);
        }
        let capacity = buffer.capacity();
        buffer.extend(self.head.by_ref().take(capacity));
        if self.fault.is_none() && !self.ended {
            self.fault = self.opened.source.fill(buffer, capacity).err();
        }
        if buffer.is_empty() {
            self.ended = true;
            let fault = self.fault.take();
            return fault.map_or(Ok(0), |fault| Err(fault.of(&self.name)));
        }
        Ok(buffer.len())
    }

    /// Looks through `pairs`, which begin at pair `before` of the recording, for samples that are not finite and lines that are left out:
    /// only those found here are reported.
    pub fn look(&mut self, before: u64, pairs: &[[f32; 2]]) {
        if let Source::Text(text) = &mut self.opened.source {
            text.look(before, before + pairs.len() as u64);
        }
        match &mut self.lowest {
            // Integers are all finite.
            Some(lowest) => lowest.look(pairs),
            None => self.not_finite.look(before, pairs),
        }
    }
}

/// The words for a fault that is the first of so many; none if it is the only one.
fn first_of(count: u64) -> String {
    match count {
        1 => String::new(),
        count => format!(", the first of {count}"),
    }
}

/// The step between integers whose largest code is decoded to `largest`, which rounds to 1 in single precision if they have many bits.
fn unit(largest: f32) -> f32 {
    (1.0 - largest).max(MIN_UNIT)
}

#[cfg(test)]
mod tests;
