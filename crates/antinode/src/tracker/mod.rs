//! Turns blocks into estimates of a tracked wave: cuts windows, solves and checks them, and joins each to those before.

mod angle;
mod between;
mod checks;
mod converter;
mod failures;
mod followed;
mod judge;
mod noise;
mod record;
mod standing;
mod tracking;
mod trend;

use crate::block::Block;
use crate::calibration::Calibration;
use crate::cut::MAX_BLOCKS;
use crate::estimate::Estimate;
use crate::sample::Sample;
use crate::settings::{Settings, SettingsError};
use crate::window::Seen;
use tracking::Tracking;

/// Cuts the stream of blocks into windows and tracks the wave over them. Holds up to `BLOCKS` blocks, 11 to 65 535.
///
/// A window has at most as many blocks as periods, or 11 if that is more; `BLOCKS` must be at least two more than the periods.
///
/// It works at block rate and may run in thread context while blocks are gathered in an interrupt:
/// [its place in firmware](crate#on-a-microcontroller).
#[derive(Debug, Clone)]
pub struct Tracker<const BLOCKS: usize> {
    tracking: Tracking,
    seen: [Seen; BLOCKS],
}

impl<const BLOCKS: usize> Tracker<BLOCKS> {
    /// A tracker without settings: it finds nothing until [`configure`](Self::configure) gives it some.
    ///
    /// It is all zeros: as a static it takes no flash and is never on the stack, unlike the result of [`new`](Self::new).
    pub const UNSET: Self = Self::unset();

    /// The value of `UNSET`, made by code: the constant would be copied from flash.
    const fn unset() -> Self {
        const {
            assert!(
                BLOCKS >= MAX_BLOCKS as usize && BLOCKS <= u16::MAX as usize,
                "BLOCKS, the length of the ring, must be 11 to 65 535"
            );
        }
        Self {
            tracking: Tracking::unset(),
            seen: [Seen::EMPTY; BLOCKS],
        }
    }

    /// A tracker that waits for its first block, with the same settings as its [`Front`](crate::Front).
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`].
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        let mut tracker = Self::unset();
        tracker.configure(settings)?;
        Ok(tracker)
    }

    /// Waits for its first block anew with other settings, in place: to assign a new tracker would take its size in stack. If it had
    /// settings before, it [wants](Self::wanted_search) a new search, and blocks from before are left out, provided that the front is
    /// configured [in the right order](crate#on-a-microcontroller). The angle begins at the start angle, without a flag.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn configure(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.check(BLOCKS)?;
        self.set(&settings);
        Ok(())
    }

    /// The settings that it works by.
    pub fn settings(&self) -> &Settings {
        &self.tracking.settings
    }

    /// Waits for its first block anew with settings that have been checked.
    pub(crate) fn set(&mut self, settings: &Settings) {
        self.tracking.set(settings);
    }

    /// Takes a block; gives the estimate of the window that it completes.
    ///
    /// A block of another layout, or one that does not follow the last, starts a new window. Blocks of another search than the
    /// [wanted one](Self::wanted_search) are left out.
    #[must_use = "the estimate is given once"]
    #[inline]
    pub fn push<S: Sample>(&mut self, block: &Block<S>) -> Option<Estimate> {
        if self.tracking.gather(&mut self.seen, block) {
            self.tracking.estimate(&mut self.seen)
        } else {
            None
        }
    }

    /// As [`push`](Self::push), but hands the estimate to `report`: no stack is reserved for it while the window is fitted, which saves
    /// [`Identifier::extend`](crate::Identifier::extend) 232 bytes.
    #[inline]
    pub(crate) fn push_to<S: Sample>(
        &mut self,
        block: &Block<S>,
        report: &mut impl FnMut(Estimate),
    ) {
        if self.tracking.gather(&mut self.seen, block) {
            self.tracking.report(&mut self.seen, report);
        }
    }

    /// Number of the search whose blocks it takes, for [`Front::search_if_wanted`](crate::Front::search_if_wanted): 0 at first. It counts
    /// up, and wraps, when a new period must be searched for: when the first window showed no wave, or two in a row were
    /// [`LOST`](crate::Flags::LOST) or did not settle, or eight in a row held little of the wave compared with all else, or had samples in
    /// every block that lie beyond the wave by more than its amplitude. Overlapping windows count by the blocks they move on. It also counts
    /// up once if the first clean window shows that the blocks are some per cent too short or too long for the wave, because what came
    /// before it had misled the search: more of its harmonics would leak into every window. In noise of 5 % of a_A and more it does not.
    ///
    /// Hand it on after every block, as a first window without a wave gives no estimate, and also after [`configure`](Self::configure) and
    /// [`search`](Self::search).
    #[must_use = "a lost wave is found again only by a search"]
    pub fn wanted_search(&self) -> u32 {
        self.tracking.wanted
    }

    /// Drops the wave and the blocks gathered, but not the angle, and wants a new search, as the tracker does by itself when the wave is
    /// lost: the angle found then is the one nearest to the last.
    pub fn search(&mut self) {
        self.tracking.search();
    }

    /// True from the first window that shows a wave to the first that shows none, or to [`search`](Self::search) or
    /// [`configure`](Self::configure). If the frequency is known, but the wave is at another or there is none, no estimate, flag or search
    /// tells of it; only this stays false.
    pub fn has_wave(&self) -> bool {
        self.tracking.found
    }

    /// Changes the calibration: the next block starts a new first window, which is flagged [`REACQUIRED`](crate::Flags::REACQUIRED) and
    /// continues the angle. The front goes on as it is.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn calibrate(&mut self, calibration: Calibration) -> Result<(), SettingsError> {
        self.change(Settings {
            calibration,
            ..self.tracking.settings
        })
    }

    /// Changes all settings but the start angle: the next block starts a new first window, which is flagged
    /// [`REACQUIRED`](crate::Flags::REACQUIRED) and continues the angle. [`configure`](Self::configure) begins with the start angle
    /// instead, and must come first: otherwise the angle begins at 0.
    ///
    /// The front needs the same `sample_rate`, `frequency`, `periods`, `hop`, `detection` and `watch`, and of `hum` and `coloured` for blocks
    /// as long as these like best in windows of few samples, which makes errors up to a tenth smaller; if it is
    /// configured anew, call [`search`](Self::search) here too, [in the right order](crate#on-a-microcontroller), so that blocks from
    /// before are left out.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn change(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.check(BLOCKS)?;
        self.tracking.change(settings);
        Ok(())
    }
}
