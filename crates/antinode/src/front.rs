//! Samples become blocks, from cold: the period is searched, then blocks are gathered. This is what runs in an interrupt.

use crate::block::{Block, Demodulator};
use crate::period::{DifferenceDetector, MeanReturnDetector};
use crate::sample::{Sample, SamplePair};
use crate::settings::{Detection, Settings, SettingsError};

/// What the front is doing with samples.
#[derive(Debug, Clone)]
#[expect(
    clippy::large_enum_variant,
    reason = "the stages share one place on purpose: there is no heap"
)]
enum Stage<S: Sample, const N: usize> {
    Difference(DifferenceDetector<S>),
    MeanReturn(MeanReturnDetector),
    Gather(Demodulator<S, N>),
}

/// The sample-rate half of an identification on samples of type `S`, for blocks of up to `N` sample pairs; `N` bounds the period
/// (200 for all).
#[derive(Debug, Clone)]
pub struct Front<S: Sample, const N: usize> {
    settings: Settings,
    stage: Stage<S, N>,
    /// Index in the stream of the next sample pair.
    index: u64,
}

impl<S: Sample, const N: usize> Front<S, N> {
    /// A front that searches for a period.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.check(usize::from(u16::MAX))?;
        Ok(Self {
            settings,
            stage: Self::cold(&settings),
            index: 0,
        })
    }

    fn cold(settings: &Settings) -> Stage<S, N> {
        match settings.detection {
            Detection::Difference => Stage::Difference(DifferenceDetector::new()),
            Detection::MeanReturn => Stage::MeanReturn(MeanReturnDetector::new()),
        }
    }

    /// Drops the period and searches anew.
    pub fn search(&mut self) {
        self.stage = Self::cold(&self.settings);
    }

    /// True while a period is searched.
    pub fn is_searching(&self) -> bool {
        !matches!(self.stage, Stage::Gather(_))
    }

    /// Index in the stream of the next sample pair.
    pub fn index(&self) -> u64 {
        self.index
    }

    /// Tells that `count` sample pairs were lost before the next one: the block that they would have been part of is dropped.
    pub fn skip(&mut self, count: u64) {
        self.index += count;
        if let Stage::Gather(demodulator) = &mut self.stage {
            demodulator.restart(self.index);
        } else {
            self.search();
        }
    }

    /// Takes one sample pair; gives the block that it finished.
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<&Block<S>> {
        if self.is_searching() {
            self.search_slice(&[pair]);
            return None;
        }
        let Stage::Gather(demodulator) = &mut self.stage else {
            return None;
        };
        self.index += 1;
        demodulator.push(pair)
    }

    /// Takes pairs from the start of a slice up to the end of a block; gives how many it took and the block if one is finished.
    ///
    /// Call it again with the rest until it has taken all: results are the same to the bit however a stream is cut.
    #[inline]
    pub fn push_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, Option<&Block<S>>) {
        if !self.is_searching() {
            return self.gather(pairs);
        }
        (self.search_slice(pairs), None)
    }

    #[inline]
    fn gather<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, Option<&Block<S>>) {
        let Stage::Gather(demodulator) = &mut self.stage else {
            return (0, None);
        };
        let (taken, block) = demodulator.push_slice(pairs);
        self.index += taken as u64;
        (taken, block)
    }

    /// Takes pairs until a period is found; gives how many.
    fn search_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> usize {
        for (taken, &pair) in pairs.iter().enumerate() {
            self.index += 1;
            let found = match &mut self.stage {
                Stage::Difference(detector) => detector.push(pair),
                Stage::MeanReturn(detector) => detector.push(pair.pair().map(S::to_f32)),
                Stage::Gather(_) => None,
            };
            if let Some(period) = found {
                let layout = self.settings.layout(period);
                if usize::from(layout.length) <= N {
                    self.stage =
                        Stage::Gather(Demodulator::new(layout, self.index, self.settings.watch));
                } else {
                    self.search();
                }
                return taken + 1;
            }
        }
        pairs.len()
    }
}
