//! The whole path in one: samples in, estimates out.

use crate::calibration::Calibration;
use crate::estimate::Estimate;
use crate::front::Front;
use crate::sample::{Sample, SamplePair, in_pairs};
use crate::settings::{Settings, SettingsError};
use crate::tracker::Tracker;

/// Identifies the wave in a stream of sample pairs: a [`Front`] and a [`Tracker`] in one thread.
///
/// `S` is the type of its samples, `f32`, `i16` or `i32`. `N` is the most sample pairs that a block may have, and so the longest period, as
/// in a [`Front`]. `BLOCKS` is the length of the ring, as in a [`Tracker`]: at least two more than the periods of a window, and at least
/// 11.
///
/// # Example
///
/// A known frequency, and codes of which some were lost:
///
/// ```
/// use antinode::{Identifier, Settings};
///
/// let settings = Settings { frequency: Some(5_332.0), resolution: Some(1.0), ..Settings::new(100_000.0) };
/// let mut identifier = Identifier::<i32, 200, 16>::new(settings)?;
/// # let signal = |k: u32| {
/// #     let (sine, cosine) = (core::f64::consts::TAU * 0.05332 * f64::from(k)).sin_cos();
/// #     let (s2, c2) = 0.6f64.sin_cos();
/// #     [cosine * c2 - 0.1 * sine * s2, cosine * s2 + 0.1 * sine * c2].map(|x| (1e6 * x) as i32)
/// # };
/// let pairs: Vec<[i32; 2]> = (0..10_000).map(signal).collect();
/// let mut estimates = Vec::new();
/// identifier.extend(&pairs[..5_000], |estimate| estimates.push(estimate));
/// // Time and phase go on over what is skipped, and no window reaches across it.
/// identifier.skip(700);
/// identifier.extend(&pairs[5_700..], |estimate| estimates.push(estimate));
///
/// assert_eq!(estimates[0].start, 0);
/// assert!(estimates.iter().all(|estimate| estimate.end() <= 5_000 || estimate.start >= 5_700));
/// assert!(estimates.iter().all(|estimate| estimate.flags.is_empty()));
/// # Ok::<(), antinode::SettingsError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Identifier<S: Sample, const N: usize, const BLOCKS: usize> {
    front: Front<S, N>,
    tracker: Tracker<BLOCKS>,
}

impl<S: Sample, const N: usize, const BLOCKS: usize> Identifier<S, N, BLOCKS> {
    /// An identification without settings: a [`Front::UNSET`] and a [`Tracker::UNSET`]. It finds nothing until
    /// [`configure`](Self::configure) gives it some.
    pub const UNSET: Self = Self {
        front: Front::UNSET,
        tracker: Tracker::UNSET,
    };

    /// An identification from cold.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`] and [`Front::new`].
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        Ok(Self {
            front: Front::new(settings)?,
            tracker: Tracker::new(settings)?,
        })
    }

    /// Checks settings as [`new`](Self::new) does, in a constant too: a [`Front`] and a [`Tracker`] of these sizes must both take them.
    ///
    /// ```
    /// use antinode::{Identifier, Settings};
    ///
    /// const SETTINGS: Settings = Settings { periods: 14, frequency: Some(5_332.0), ..Settings::new(100_000.0) };
    /// const _: () = assert!(Identifier::<i16, 40, 16>::check(&SETTINGS).is_ok());
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    pub const fn check(settings: &Settings) -> Result<(), SettingsError> {
        Front::<S, N>::check_with(settings, BLOCKS)
    }

    /// Begins anew from cold with other settings, in place. The count of sample pairs goes on.
    ///
    /// # Errors
    ///
    /// Those of [`Identifier::new`]; nothing is changed then.
    pub fn configure(&mut self, settings: Settings) -> Result<(), SettingsError> {
        Self::check(&settings)?;
        self.tracker.set(&settings);
        self.front.set(&settings);
        self.search_if_wanted();
        Ok(())
    }

    /// The settings that it works by, to be changed in part: `change(Settings { periods: 20, ..*identifier.settings() })`.
    pub fn settings(&self) -> &Settings {
        self.tracker.settings()
    }

    /// Changes all settings but the start angle, and [searches](Self::search) anew: the first window from then on is flagged
    /// [`Flags::REACQUIRED`](crate::Flags::REACQUIRED) and continues the angle. [`configure`](Self::configure) begins with the start angle
    /// instead, and must come first after [`UNSET`](Self::UNSET): otherwise the angle begins at 0.
    ///
    /// # Errors
    ///
    /// Those of [`Identifier::new`]; nothing is changed then.
    pub fn change(&mut self, settings: Settings) -> Result<(), SettingsError> {
        Self::check(&settings)?;
        self.tracker.search();
        self.tracker.change(settings)?;
        self.front.set(&settings);
        self.search_if_wanted();
        Ok(())
    }

    /// Changes the calibration and keeps the period: see [`Tracker::calibrate`].
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn calibrate(&mut self, calibration: Calibration) -> Result<(), SettingsError> {
        self.tracker.calibrate(calibration)
    }

    /// Takes one sample pair; gives the estimate of the window that it completes.
    ///
    /// [`extend`](Self::extend) costs far less a pair.
    #[must_use = "the estimate is given once"]
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) -> Option<Estimate> {
        let estimate = self.tracker.push(self.front.push(pair)?);
        self.search_if_wanted();
        estimate
    }

    /// Takes pairs from the start of a slice up to the end of a window; gives how many it took and the estimate, if any.
    ///
    /// Call it again with the rest until it has taken all: results are the same to the bit however a stream is cut.
    #[must_use = "it stops at the end of a window: call it again with the rest"]
    pub fn push_slice<P: SamplePair<S>>(&mut self, pairs: &[P]) -> (usize, Option<Estimate>) {
        let mut rest = pairs;
        while !rest.is_empty() {
            let (taken, block) = self.front.push_slice(rest);
            rest = rest.get(taken..).unwrap_or(&[]);
            if let Some(block) = block {
                let estimate = self.tracker.push(block);
                self.search_if_wanted();
                if estimate.is_some() {
                    return (pairs.len() - rest.len(), estimate);
                }
            }
        }
        (pairs.len(), None)
    }

    /// Takes all pairs of a slice and hands every estimate to `report`.
    pub fn extend<P: SamplePair<S>>(&mut self, mut pairs: &[P], mut report: impl FnMut(Estimate)) {
        while !pairs.is_empty() {
            let (taken, block) = self.front.push_slice(pairs);
            pairs = pairs.get(taken..).unwrap_or(&[]);
            if let Some(block) = block {
                self.tracker.push_to(block, &mut report);
                self.search_if_wanted();
            }
        }
    }

    /// Takes the samples of both pick-offs from a slice each, pair by pair up to the end of the shorter one; hands every estimate to
    /// `report`.
    ///
    /// It costs a copy, and 32 pairs of stack: [`extend`](Self::extend) takes pairs where they are.
    pub fn extend_separate(&mut self, c: &[S], d: &[S], mut report: impl FnMut(Estimate)) {
        in_pairs(c, d, |pairs| self.extend(pairs, &mut report));
    }

    /// Searches for a new period if the tracker wants one.
    #[inline]
    fn search_if_wanted(&mut self) {
        self.front.search_if_wanted(self.tracker.wanted_search());
    }

    /// Drops the wave and searches anew, as happens by itself when a wave is lost: the first window from then on is flagged
    /// [`Flags::REACQUIRED`](crate::Flags::REACQUIRED) and continues the angle. A known frequency is not searched for, but windows begin
    /// anew.
    pub fn search(&mut self) {
        self.tracker.search();
        self.search_if_wanted();
    }

    /// Tells that `count` sample pairs were lost before the next one; the window that they would have been part of is dropped.
    pub fn skip(&mut self, count: u64) {
        self.front.skip(count);
    }

    /// True while a period is searched for: at the start, and after a wave is lost; never if the frequency is known.
    pub fn is_searching(&self) -> bool {
        self.front.is_searching()
    }

    /// Samples in a period by which blocks are gathered, as [`Front::period`].
    pub fn period(&self) -> Option<f32> {
        self.front.period()
    }

    /// True from the first window that shows a wave to the first that shows none, or to [`search`](Self::search),
    /// [`change`](Self::change) or [`configure`](Self::configure), as [`Tracker::has_wave`].
    pub fn has_wave(&self) -> bool {
        self.tracker.has_wave()
    }

    /// Sample pairs taken so far, including lost ones.
    pub fn index(&self) -> u64 {
        self.front.index()
    }
}
