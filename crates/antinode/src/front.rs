//! Turns samples into blocks, from cold: searches for the period, then gathers blocks. This is the part that runs in an interrupt.

use crate::block::{Block, Demodulator};
use crate::cut::Cut;
use crate::period::DifferenceDetector;
#[cfg(feature = "mean-return")]
use crate::period::MeanReturnDetector;
use crate::phase::PhaseStep;
use crate::sample::{Sample, SamplePair, in_pairs};
use crate::settings::{Detection, Settings, SettingsError};

/// The detector that searches for the period.
#[derive(Debug, Clone)]
enum Detector<S: Sample> {
    Difference(DifferenceDetector<S>),
    #[cfg(feature = "mean-return")]
    MeanReturn(MeanReturnDetector),
}

impl<S: Sample> Detector<S> {
    const fn new(detection: Detection) -> Self {
        match detection {
            Detection::Difference => Self::Difference(DifferenceDetector::new()),
            #[cfg(feature = "mean-return")]
            Detection::MeanReturn => Self::MeanReturn(MeanReturnDetector::new()),
        }
    }

    fn restart(&mut self) {
        match self {
            Self::Difference(detector) => detector.restart(),
            #[cfg(feature = "mean-return")]
            Self::MeanReturn(detector) => detector.restart(),
        }
    }

    #[inline(always)]
    fn push(&mut self, pair: impl SamplePair<S>) -> Option<f32> {
        match self {
            Self::Difference(detector) => detector.push(pair),
            #[cfg(feature = "mean-return")]
            Self::MeanReturn(detector) => detector.push(pair.pair().map(S::to_f32)),
        }
    }
}

/// What a front does with its pairs.
#[derive(Debug, Clone, Copy)]
enum Stage {
    /// It has no settings yet.
    Unset,
    Searching,
    /// A period is found: the next pair begins the first block. To begin it at once would make the longest call longer.
    Found(f32),
    Gathering,
}

/// The sample-rate half of an identification on samples of type `S`, for blocks of up to `N` sample pairs:
/// [its place in firmware](crate#on-a-microcontroller).
///
/// `N` is even, 4 to 65 534, and is the longest period too: 200 is enough for every wave that can be searched for, 40 if a period has no
/// more than 40 samples; a slower wave whose frequency is known needs more. If two periods are more than `N` pairs, a block is shorter than
/// two periods, and a window may be up to a tenth off the length asked for.
#[derive(Debug, Clone)]
pub struct Front<S: Sample, const N: usize> {
    cut: Cut,
    detection: Detection,
    /// The period, if it is known and not searched for.
    known: Option<f32>,
    // Two fields, not an enum of both: to build one in the memory of the other would be the longest call of all.
    detector: Detector<S>,
    demodulator: Demodulator<S, N>,
    stage: Stage,
    /// Index in the stream of the next sample pair.
    index: u64,
}

impl<S: Sample, const N: usize> Front<S, N> {
    /// A front without settings: it counts its pairs, and finds nothing until [`configure`](Self::configure) gives it some.
    ///
    /// It is all zeros: as a static it takes no flash and is never on the stack, unlike the result of [`new`](Self::new).
    pub const UNSET: Self = Self::unset();

    /// The value of `UNSET`, made by code: the constant would be copied from flash.
    const fn unset() -> Self {
        Self {
            cut: Settings::UNSET.cut(),
            detection: Detection::Difference,
            known: None,
            detector: Detector::new(Detection::Difference),
            demodulator: Demodulator::unset(),
            stage: Stage::Unset,
            index: 0,
        }
    }

    /// A front that searches for a period, with the same settings as its [`Tracker`](crate::Tracker).
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`], except too many periods for the ring, which the tracker reports; and a known frequency whose period is
    /// longer than `N` pairs.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        let mut front = Self::unset();
        front.configure(settings)?;
        Ok(front)
    }

    /// Searches anew with other settings, in place: to assign a new front would take its size in stack. The count of sample pairs goes on.
    /// If a tracker is configured too, [the order of the two matters](crate#on-a-microcontroller).
    ///
    /// # Errors
    ///
    /// Those of [`Front::new`]; nothing is changed then.
    pub fn configure(&mut self, settings: Settings) -> Result<(), SettingsError> {
        Self::check(&settings)?;
        self.set(&settings);
        Ok(())
    }

    /// Begins anew with settings that have been checked.
    pub(crate) fn set(&mut self, settings: &Settings) {
        if settings.detection != self.detection {
            self.replace_detector(settings.detection);
        }
        self.demodulator.set_watch(settings.watch);
        (self.cut, self.detection) = (settings.cut(), settings.detection);
        self.known = settings.period();
        self.start();
    }

    /// Checks settings as [`new`](Self::new) does, in a constant too:
    ///
    /// ```
    /// use antinode::{Front, Settings};
    ///
    /// const SETTINGS: Settings = Settings { frequency: Some(5_332.0), ..Settings::new(100_000.0) };
    /// const _: () = assert!(Front::<i16, 40>::check(&SETTINGS).is_ok());
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub const fn check(settings: &Settings) -> Result<(), SettingsError> {
        Self::check_with(settings, u16::MAX as usize)
    }

    /// As [`check`](Self::check), but also for a ring of `blocks`.
    pub(crate) const fn check_with(
        settings: &Settings,
        blocks: usize,
    ) -> Result<(), SettingsError> {
        if let Err(error) = settings.check(blocks) {
            return Err(error);
        }
        match (settings.frequency, settings.period()) {
            (Some(frequency), Some(period)) if !Self::holds(period) => {
                Err(SettingsError::FrequencyTooLow {
                    frequency,
                    most: N as u16,
                })
            }
            _ => Ok(()),
        }
    }

    /// True if a block has room for a period, as the size of the ring of blocks presumes.
    const fn holds(period: f32) -> bool {
        period < N as f32 + 0.5
    }

    /// Not inlined: only here is a detector on the stack.
    #[inline(never)]
    fn replace_detector(&mut self, detection: Detection) {
        self.detector = Detector::new(detection);
    }

    /// Searches anew if `wanted`, from [`Tracker::wanted_search`](crate::Tracker::wanted_search), is not the number of the last search; the
    /// blocks then found bear this number. Gives true if a search begins.
    ///
    /// Call it before every slice of pairs: if no new search is wanted it costs a comparison.
    #[inline]
    pub fn search_if_wanted(&mut self, wanted: u32) -> bool {
        let is_wanted = wanted != self.search_number();
        if is_wanted {
            self.search_wanted(wanted);
        }
        is_wanted
    }

    #[cold]
    #[inline(never)]
    fn search_wanted(&mut self, number: u32) {
        self.demodulator.set_search(number);
        self.search();
    }

    /// Number of the last search that was wanted, which the blocks bear; 0 at first.
    #[inline]
    pub fn search_number(&self) -> u32 {
        self.demodulator.search()
    }

    /// Drops the period and searches anew, whatever is wanted. A known period is not searched for, but blocks begin anew.
    pub fn search(&mut self) {
        if !matches!(self.stage, Stage::Unset) {
            self.start();
        }
    }

    /// Searches, or begins at a known period.
    #[inline(never)]
    fn start(&mut self) {
        self.detector.restart();
        self.stage = self.known.map_or(Stage::Searching, Stage::Found);
    }

    /// True while a period is searched for: never if the frequency is known; for ever if the period has fewer than 3.8 samples, or more
    /// than 212 or `N`. Periods of 4 to 200 samples are found; with `Detection::MeanReturn`, those of 4.6 and more in its usual time.
    pub fn is_searching(&self) -> bool {
        matches!(self.stage, Stage::Searching)
    }

    /// Samples in a period by which blocks are gathered, as found or as known: a few per cent off the wave's at most, unless the search was
    /// misled; `None` while it goes on.
    pub fn period(&self) -> Option<f32> {
        match self.stage {
            Stage::Unset | Stage::Searching => None,
            Stage::Found(period) => Some(period),
            Stage::Gathering => Some(self.demodulator.layout().step.period()),
        }
    }

    /// Index in the stream of the next sample pair.
    pub fn index(&self) -> u64 {
        self.index
    }

    /// Tells that `count` sample pairs were lost before the next one: the block that they would have been part of is dropped. Indices, and
    /// so times, count them, those before the first pair too. The index is then taken modulo 2⁶², so that a count of `u64::MAX` moves it
    /// back by 1: no stream is that long.
    pub fn skip(&mut self, count: u64) {
        if count == 0 {
            return;
        }
        // A count that no stream reaches was wrong. Below 2⁶² indices can be doubled, and still go on.
        self.index = self.index.wrapping_add(count) & (u64::MAX >> 2);
        match self.stage {
            Stage::Searching => self.search(),
            Stage::Unset | Stage::Found(_) => {}
            Stage::Gathering => self.demodulator.restart(self.index),
        }
    }

    /// Takes one sample pair; gives the block, if this finished one.
    ///
    /// [`extend`](Self::extend) costs far less a pair.
    #[must_use = "the next pair overwrites the block"]
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<&Block<S>> {
        if !self.gathers() {
            self.search_slice(&[pair]);
            return None;
        }
        self.index += 1;
        self.demodulator.push(pair)
    }

    /// Takes pairs from the start of a slice up to the end of a block; gives how many it took, and the block if one is finished.
    ///
    /// Call it again with the rest until it has taken all: results are the same to the bit however a stream is cut.
    #[must_use = "it stops at the end of a block: call it again with the rest, and hand the block on"]
    #[inline]
    pub fn push_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, Option<&Block<S>>) {
        if !self.gathers() {
            return (self.search_slice(pairs), None);
        }
        let (taken, block) = self.demodulator.push_slice(pairs);
        self.index += taken as u64;
        (taken, block)
    }

    /// Takes all pairs of a slice and hands every block to `report`.
    #[inline]
    pub fn extend<P: SamplePair<S>>(&mut self, mut pairs: &[P], mut report: impl FnMut(&Block<S>)) {
        while !pairs.is_empty() {
            let (taken, block) = self.push_slice(pairs);
            pairs = pairs.get(taken..).unwrap_or(&[]);
            if let Some(block) = block {
                report(block);
            }
        }
    }

    /// Takes the samples of both pick-offs from a slice each, pair by pair up to the end of the shorter one; hands every block to `report`.
    ///
    /// It costs a copy, and 32 pairs of stack: [`extend`](Self::extend) takes pairs where they are.
    pub fn extend_separate(&mut self, c: &[S], d: &[S], mut report: impl FnMut(&Block<S>)) {
        in_pairs(c, d, |pairs| self.extend(pairs, &mut report));
    }

    /// True when the next pair belongs to a block, perhaps the first.
    #[inline(always)]
    fn gathers(&mut self) -> bool {
        if let Stage::Found(period) = self.stage {
            self.begin(period);
        }
        matches!(self.stage, Stage::Gathering)
    }

    /// Begins blocks for a wave of `period` samples.
    #[inline(never)]
    fn begin(&mut self, period: f32) {
        let step = PhaseStep::from_period(period);
        let length = self.cut.length(period, N as u16);
        let before = self.demodulator.layout();
        // At a known frequency every search begins with the same blocks, whose tables are kept.
        if step == before.step && length == before.length {
            self.demodulator.restart(self.index);
        } else {
            self.demodulator.begin(step, length, self.index);
        }
        self.stage = Stage::Gathering;
    }

    /// Takes pairs until a period is found; gives how many.
    #[inline(never)]
    fn search_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> usize {
        let searched = if self.is_searching() { pairs } else { &[] };
        for (taken, &pair) in (1..).zip(searched) {
            if let Some(period) = self.detector.push(pair) {
                self.index += taken as u64;
                // If the period is too long, the search goes on.
                if Self::holds(period) {
                    self.stage = Stage::Found(period);
                }
                return taken;
            }
        }
        self.index += pairs.len() as u64;
        pairs.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_settings_nothing_is_found_and_with_them_it_is_as_new() {
        let step = PhaseStep::from_period(18.75);
        let pairs: [[i16; 2]; 1000] = core::array::from_fn(|index| {
            let unit = step.after_half_samples(2 * index as i64).unit();
            [(10_000.0 * unit.re) as i16, (7_000.0 * unit.re) as i16]
        });
        let settings = Settings::new(1e5);
        let blocks = |front: &mut Front<i16, 200>| {
            let (mut found, mut last) = (0, None);
            front.extend(&pairs, |block| {
                found += 1;
                last = Some((block.layout, block.sums, block.watch));
            });
            (found, last)
        };
        let mut front = Front::UNSET;
        assert_eq!(blocks(&mut front), (0, None));
        front.search();
        assert!(front.period().is_none());
        assert!(front.push(pairs[0]).is_none());
        assert!(!front.is_searching());
        assert_eq!(front.index(), 1001);
        front.configure(settings).unwrap();
        assert!(front.is_searching() && front.period().is_none());
        let configured = blocks(&mut front);
        assert!(
            front
                .period()
                .is_some_and(|period| (period - 18.75).abs() < 0.2)
        );
        assert!(configured.0 > 20, "{configured:?}");
        assert_eq!(configured, blocks(&mut Front::new(settings).unwrap()));
        assert_eq!(front.index(), 2001);
    }
}
