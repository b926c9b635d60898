//! Blocks become estimates of a tracked wave: windows are cut, solved, checked, and joined to those before.

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
use crate::cut::MOST_BLOCKS;
use crate::estimate::{Estimate, Flags};
use crate::sample::Sample;
use crate::settings::{Settings, SettingsError};
use crate::window::{CARRIER_REACH, Fit, Gathered, Model, solve};
use angle::Angle;
use failures::Failures;
use followed::Followed;
use noise::Noise;
use record::{Record, Units};
use trend::Trend;

/// How far the detector's frequency is taken to be off, or a known one, as a share of it: a little more is found too.
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
    /// Made with the model.
    units: Units,
    gathered: Gathered<BLOCKS>,
    /// Index in the stream of the sample pair after the last block.
    end: u64,
    model: Option<Model>,
    /// Blocks a window.
    count: u16,
    noise: Noise,
    trend: Trend,
    /// The last clean window.
    before: Option<Record>,
    /// By how much the offsets had moved to that from the one before it, a sample; 0 where none was.
    offset_rates: [f32; 2],
    /// The angle of the last window that had one: continuity is kept over faults.
    angle: Angle,
    /// From the last clean window on.
    followed: Followed,
    /// True from the loss of a wave to the first window after it.
    lost: bool,
    /// True where a wave was found since the settings were configured.
    had_wave: bool,
    /// Number of the search whose blocks are taken.
    wanted: u32,
    failures: Failures,
    /// True while a fault lies between the last clean window and the next.
    broken: bool,
    /// True where the last window showed a wave.
    found: bool,
}

impl<const BLOCKS: usize> Tracker<BLOCKS> {
    /// A tracker without settings: it finds nothing until [`configure`](Self::configure) gives it some.
    ///
    /// It is all zeros: as a static it takes no flash and is never on the stack, unlike the result of [`new`](Self::new).
    pub const UNSET: Self = Self::unset();

    /// In code, where the constant would be copied from flash.
    const fn unset() -> Self {
        const {
            assert!(
                BLOCKS >= MOST_BLOCKS as usize && BLOCKS <= u16::MAX as usize,
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

    /// Waits for its first block anew with settings that are checked.
    pub(crate) fn set(&mut self, settings: &Settings) {
        // What had no settings took no block.
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

    /// By itself, so that what it needs of the stack is not there while the window is fitted.
    #[inline(never)]
    fn estimate_fit(&mut self, fit: &Fit) -> Option<Estimate> {
        self.judged(fit, |units, record, flags| record.estimate(units, flags))
    }

    /// Begins the next window, or has the wave searched anew where it is lost.
    fn advance(&mut self) {
        self.gathered
            .advance(self.settings.hop.unwrap_or(self.count));
        if self.failures.are_enough(self.count) {
            self.search();
        }
    }

    /// As [`push`](Self::push), but hands the estimate to `report`: it has no place in the stack while the window is fitted, which is 232
    /// bytes less of [`Identifier::extend`](crate::Identifier::extend).
    ///
    /// That a function generic over what becomes of the estimate would serve both costs the C library 380 bytes of flash.
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
            tell(units, record, flags, report);
        });
    }

    /// Takes a block; true where it completes a window.
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

    /// Takes a block that does not continue those gathered: by itself, so that the others need keep nothing meanwhile.
    #[cold]
    #[inline(never)]
    fn gather_anew<S: Sample>(&mut self, block: &Block<S>, is_same: bool) -> bool {
        // Only here: what is gathered is of the search wanted, or is dropped when another one is.
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
    /// did not settle, or eight in a row held little of the wave beside all else, or had samples in every block that lie beyond the wave by
    /// more than its amplitude. Overlapping windows count by the blocks they move on.
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

    /// With the next block a first window begins.
    fn forget(&mut self) {
        self.model = None;
        self.failures = Failures::NONE;
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
    /// The front needs the same `sample_rate`, `frequency`, `periods`, `hop`, `detection` and `watch`; if it is configured anew, call
    /// [`search`](Self::search) here too, [in the right order](crate#on-a-microcontroller), so that blocks from before are left out.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn change(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.check(BLOCKS)?;
        self.settings = settings;
        let found = self.found;
        self.forget();
        // The wave is there as before.
        self.found = found;
        Ok(())
    }

    /// Begins with blocks of another layout.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, &layout: &Layout) {
        let settings = &self.settings;
        // Only without settings: no block is taken then.
        if settings.periods == 0 {
            return;
        }
        self.units = Units::at(settings.sample_rate);
        self.count = settings.cut().blocks(layout).clamp(1, BLOCKS as u16);
        let rate = self.units.sample_rate;
        self.model
            .insert(Model::empty(layout, settings.calibration, rate))
            .begin(layout.step, self.count, settings.hum || settings.coloured);
        self.noise = Noise::NONE;
        self.trend.forget();
        self.before = None;
        self.followed = Followed::begin(self.angle);
        self.offset_rates = [0.0; 2];
        self.lost = self.had_wave;
        self.failures = Failures::NONE;
    }

    /// Solves for the waves, from the last clean frequency or the detector's.
    fn fit(&mut self, fit: &mut Fit) {
        let Some(model) = &mut self.model else {
            return;
        };
        let rough = |model: &Model| DETECTOR_UNCERTAINTY * model.layout.step.radians();
        let (carrier, uncertainty) = match &self.before {
            None => (model.layout.step, rough(model)),
            Some(before) => {
                // A model that is near enough is kept: its matrix need not be built anew.
                let drift = before.frequency_beyond(model.carrier);
                let near = (drift * model.half).abs() < CARRIER_REACH;
                (
                    if near {
                        model.carrier
                    } else {
                        before.carrier.shifted(before.drift)
                    },
                    0.0,
                )
            }
        };
        let blocks = self.gathered.blocks();
        solve(model, blocks, carrier, uncertainty, fit);
        if !fit.settled && self.before.is_some() {
            let rough = rough(model);
            solve(model, blocks, carrier, rough, fit);
        }
    }
}

/// Hands an estimate over: by itself, so that there is room for it only now.
#[inline(never)]
fn tell(units: &Units, record: &Record, flags: Flags, report: &mut impl FnMut(Estimate)) {
    report(record.estimate(units, flags));
}
