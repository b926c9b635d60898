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
mod trend;

use crate::block::{Block, Layout};
use crate::calibration::Calibration;
use crate::cut::MAX_BLOCKS;
use crate::estimate::{Estimate, Flags};
use crate::sample::Sample;
use crate::settings::{Settings, SettingsError};
use crate::window::{Fit, Gathered, Model, solve};
use angle::Angle;
use failures::Failures;
use followed::Followed;
use noise::Noise;
use record::{Record, Units};
use trend::Trend;

/// Assumed error of the detector's frequency, or of a known one, as a share of it; a slightly larger error is corrected too.
const DETECTOR_UNCERTAINTY: f32 = 0.05;

/// Cuts the stream of blocks into windows and tracks the wave over them. Holds up to `BLOCKS` blocks, 11 to 65 535.
///
/// A window has at most as many blocks as periods, or 11 if that is more; `BLOCKS` must be at least two more than the periods.
///
/// It works at block rate and may run in thread context while blocks are gathered in an interrupt:
/// [its place in firmware](crate#on-a-microcontroller).
#[derive(Debug, Clone)]
pub struct Tracker<const BLOCKS: usize> {
    settings: Settings,
    /// Set together with the model.
    units: Units,
    gathered: Gathered<BLOCKS>,
    /// Index in the stream of the sample pair after the last block.
    end: u64,
    model: Option<Model>,
    /// Blocks in a window.
    count: u16,
    noise: Noise,
    trend: Trend,
    /// The last clean window.
    before: Option<Record>,
    /// Rates a sample at which the offsets moved from the clean window before `before` to it; 0 if there was none.
    offset_rates: [f32; 2],
    /// Angle of the last window that had one, kept over faults so that the angle stays continuous.
    angle: Angle,
    /// The angle followed from the last clean window on.
    followed: Followed,
    /// True from the loss of a wave, or a change of settings, to the next unbroken window.
    lost: bool,
    /// True once a wave was found, until the next `configure`.
    had_wave: bool,
    /// Number of the search whose blocks are accepted.
    wanted: u32,
    failures: Failures,
    /// True while a fault lies between the last clean window and the next.
    broken: bool,
    /// True if the last window showed a wave.
    found: bool,
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
            settings: Settings::UNSET,
            units: Units::NONE,
            gathered: Gathered::new(),
            end: 0,
            model: None,
            count: 0,
            noise: Noise::NONE,
            trend: Trend::new(),
            before: None,
            offset_rates: [0.0; 2],
            angle: Angle::ZERO,
            followed: Followed::begin(Angle::ZERO),
            lost: false,
            had_wave: false,
            wanted: 0,
            failures: Failures::NONE,
            broken: false,
            found: false,
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
        &self.settings
    }

    /// Waits for its first block anew with settings that have been checked.
    pub(crate) fn set(&mut self, settings: &Settings) {
        // A tracker without settings has taken no block.
        if self.settings.periods > 0 {
            self.search();
        }
        self.settings = *settings;
        self.angle = Angle::new(settings.start_angle);
        self.had_wave = false;
    }

    /// Takes a block; gives the estimate of the window that it completes.
    ///
    /// A block of another layout, or one that does not follow the last, starts a new window. Blocks of another search than the
    /// [wanted one](Self::wanted_search) are left out.
    #[must_use = "the estimate is given once"]
    #[inline]
    pub fn push<S: Sample>(&mut self, block: &Block<S>) -> Option<Estimate> {
        if self.gather(block) {
            self.estimate()
        } else {
            None
        }
    }

    /// Solves the window gathered.
    #[inline(never)]
    fn estimate(&mut self) -> Option<Estimate> {
        let mut fit = Fit::default();
        self.fit(&mut fit);
        let estimate = self.estimate_fit(&fit);
        self.advance();
        estimate
    }

    /// Not inlined, so that its stack is not in use while the window is fitted.
    #[inline(never)]
    fn estimate_fit(&mut self, fit: &Fit) -> Option<Estimate> {
        self.judged(fit, |units, record, flags| record.estimate(units, flags))
    }

    /// Moves on to the next window, and wants a new search if the wave is lost.
    fn advance(&mut self) {
        self.gathered
            .advance(self.settings.hop.unwrap_or(self.count));
        if self.failures.are_enough(self.count) {
            self.search();
        }
    }

    /// As [`push`](Self::push), but hands the estimate to `report`: no stack is reserved for it while the window is fitted, which saves
    /// [`Identifier::extend`](crate::Identifier::extend) 232 bytes.
    ///
    /// One function for both, generic over what becomes of the estimate, would cost the C library 380 bytes of flash.
    #[inline]
    pub(crate) fn push_to<S: Sample>(
        &mut self,
        block: &Block<S>,
        report: &mut impl FnMut(Estimate),
    ) {
        if self.gather(block) {
            self.report(report);
        }
    }

    #[inline(never)]
    fn report(&mut self, report: &mut impl FnMut(Estimate)) {
        let mut fit = Fit::default();
        self.fit(&mut fit);
        self.report_fit(&fit, report);
        self.advance();
    }

    #[inline(never)]
    fn report_fit(&mut self, fit: &Fit, report: &mut impl FnMut(Estimate)) {
        self.judged(fit, |units, record, flags| {
            hand_over(units, record, flags, report);
        });
    }

    /// Takes a block; true if it completes a window.
    #[inline(never)]
    fn gather<S: Sample>(&mut self, block: &Block<S>) -> bool {
        let is_same = self
            .model
            .as_ref()
            .is_some_and(|model| model.layout == block.layout);
        if is_same && self.end == block.start {
            self.take(block)
        } else {
            self.gather_anew(block, is_same)
        }
    }

    /// Takes a block that continues those gathered, or begins a window.
    #[inline(never)]
    fn take<S: Sample>(&mut self, block: &Block<S>) -> bool {
        self.end = block.start.wrapping_add(u64::from(block.layout.length));
        let (Some(model), Some(place)) = (&self.model, self.gathered.next()) else {
            return false;
        };
        model.see(block, place);
        self.gathered.length() >= usize::from(self.count)
    }

    /// Takes a block that does not continue those gathered. Not inlined, so that the usual path saves no registers for it.
    #[cold]
    #[inline(never)]
    fn gather_anew<S: Sample>(&mut self, block: &Block<S>, is_same: bool) -> bool {
        // Checked only here: the blocks gathered are of the wanted search, and are dropped when another is wanted.
        if block.search != self.wanted {
            return false;
        }
        self.gathered.clear();
        if !is_same {
            self.begin(&block.layout);
        }
        self.take(block)
    }

    /// Number of the search whose blocks it takes, for [`Front::search_if_wanted`](crate::Front::search_if_wanted): 0 at first. It counts
    /// up, and wraps, when a new period must be searched for: when the first window showed no wave, or two in a row were [`Flags::LOST`] or
    /// did not settle, or eight in a row held little of the wave compared with all else, or had samples in every block that lie beyond the
    /// wave by more than its amplitude. Overlapping windows count by the blocks they move on.
    ///
    /// Hand it on after every block, as a first window without a wave gives no estimate, and also after [`configure`](Self::configure) and
    /// [`search`](Self::search).
    #[must_use = "a lost wave is found again only by a search"]
    pub fn wanted_search(&self) -> u32 {
        self.wanted
    }

    /// Drops the wave and the blocks gathered, but not the angle, and wants a new search, as the tracker does by itself when the wave is
    /// lost: the angle found then is the one nearest to the last.
    pub fn search(&mut self) {
        self.forget();
        self.wanted = self.wanted.wrapping_add(1);
    }

    /// True from the first window that shows a wave to the first that shows none. If the frequency is known, but the wave is at another or
    /// there is none, no estimate, flag or search tells of it; only this stays false.
    pub fn has_wave(&self) -> bool {
        self.found
    }

    /// Drops the model: the next block begins a first window.
    fn forget(&mut self) {
        self.model = None;
        self.found = false;
    }

    /// Changes the calibration: the next block starts a new first window, which is flagged [`Flags::REACQUIRED`] and continues the angle.
    /// The front goes on as it is.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn calibrate(&mut self, calibration: Calibration) -> Result<(), SettingsError> {
        self.change(Settings {
            calibration,
            ..self.settings
        })
    }

    /// Changes all settings but the start angle: the next block starts a new first window, which is flagged [`Flags::REACQUIRED`] and
    /// continues the angle. [`configure`](Self::configure) begins with the start angle instead, and must come first: otherwise the angle
    /// begins at 0.
    ///
    /// The front needs the same `sample_rate`, `frequency`, `periods`, `hop`, `hum`, `coloured`, `detection` and `watch`; if it is configured
    /// anew, call [`search`](Self::search) here too, [in the right order](crate#on-a-microcontroller), so that blocks from before are left out.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn change(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.check(BLOCKS)?;
        self.settings = settings;
        let found = self.found;
        self.forget();
        // The wave itself is still there.
        self.found = found;
        Ok(())
    }

    /// Builds the model for blocks of another layout; their first window is compared with none.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, &layout: &Layout) {
        let settings = &self.settings;
        // A tracker without settings takes no block.
        if settings.periods == 0 {
            return;
        }
        self.units = Units::at(settings.sample_rate);
        self.count = settings.cut().blocks(layout).clamp(1, BLOCKS as u16);
        let rate = self.units.sample_rate;
        self.model
            .insert(Model::empty(layout, settings.calibration, rate))
            .begin(settings.hum || settings.coloured);
        self.noise = Noise::NONE;
        self.trend.forget();
        self.before = None;
        self.followed = Followed::begin(self.angle);
        self.offset_rates = [0.0; 2];
        self.lost = self.had_wave;
        self.failures = Failures::NONE;
    }

    /// Fits the waves of the window gathered, from the last clean carrier or the detector's frequency.
    fn fit(&mut self, fit: &mut Fit) {
        let Some(model) = &mut self.model else {
            return;
        };
        let rough = |model: &Model| DETECTOR_UNCERTAINTY * model.layout.step.radians();
        let (carrier, uncertainty) = match &self.before {
            None => (model.layout.step, rough(model)),
            // Where the last clean fit ended: it is near the greater wave, even if the lesser turns fast near a circle.
            Some(before) => (before.carrier, 0.0),
        };
        let blocks = self.gathered.blocks();
        solve(model, blocks, carrier, uncertainty, fit);
        if !fit.settled && self.before.is_some() {
            let rough = rough(model);
            solve(model, blocks, carrier, rough, fit);
        }
    }
}

/// Makes an estimate and hands it over. Not inlined, so that stack is reserved for it only now.
#[inline(never)]
fn hand_over(units: &Units, record: &Record, flags: Flags, report: &mut impl FnMut(Estimate)) {
    report(record.estimate(units, flags));
}
