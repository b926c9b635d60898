//! What a tracker knows, and how it turns the blocks of a window into an estimate.

use super::angle::Angle;
use super::failures::Failures;
use super::followed::Followed;
use super::noise::Noise;
use super::record::{Record, Units};
use super::trend::Trend;
use crate::block::{Block, Layout};
use crate::estimate::{Estimate, Flags};
use crate::sample::Sample;
use crate::settings::Settings;
use crate::window::{Fit, Gathered, Model, Seen, solve};

/// Assumed error of the detector's frequency, or of a known one, as a share of it; a slightly larger error is corrected too.
const DETECTOR_UNCERTAINTY: f32 = 0.05;

/// What a tracker knows, besides the blocks of the window in progress, `seen`.
///
/// It is not generic over their number: a program compiles generic code with its own optimisation, and once for each number.
#[derive(Debug, Clone)]
pub(super) struct Tracking {
    pub(super) settings: Settings,
    /// Set together with the model.
    pub(super) units: Units,
    pub(super) gathered: Gathered,
    /// Index in the stream of the sample pair after the last block.
    pub(super) end: u64,
    pub(super) model: Option<Model>,
    /// Blocks in a window.
    pub(super) count: u16,
    pub(super) noise: Noise,
    pub(super) trend: Trend,
    /// The last clean window.
    pub(super) before: Option<Record>,
    /// Rates a sample at which the offsets moved from the clean window before `before` to it; 0 if there was none.
    pub(super) offset_rates: [f32; 2],
    /// Angle of the last window that had one, kept over faults so that the angle stays continuous.
    pub(super) angle: Angle,
    /// The angle followed from the last clean window on.
    pub(super) followed: Followed,
    /// True if the last window showed a wave.
    pub(super) found: bool,
    /// True once the first clean window after a search has been compared with its blocks.
    // Beside `found`, with which it is cleared: elsewhere the one store of both is not aligned.
    pub(super) is_compared: bool,
    /// True from the loss of a wave, or a change of settings, to the next unbroken window.
    pub(super) lost: bool,
    /// True once a wave was found, until the next `configure`.
    pub(super) had_wave: bool,
    /// Number of the search whose blocks are accepted.
    pub(super) wanted: u32,
    pub(super) failures: Failures,
    /// True while a fault lies between the last clean window and the next.
    pub(super) broken: bool,
}

impl Tracking {
    /// The value before there are settings: all zeros.
    pub(super) const fn unset() -> Self {
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
            is_compared: false,
        }
    }

    /// Waits for its first block anew with settings that have been checked.
    pub(super) fn set(&mut self, settings: &Settings) {
        // A tracker without settings has taken no block.
        if self.settings.periods > 0 {
            self.search();
        }
        self.settings = *settings;
        self.angle = Angle::new(settings.start_angle);
        self.had_wave = false;
    }

    /// Drops the wave and the blocks gathered, and wants a new search.
    pub(super) fn search(&mut self) {
        self.forget();
        self.is_compared = false;
        self.wanted = self.wanted.wrapping_add(1);
    }

    /// Changes all settings but the start angle, which have been checked.
    pub(super) fn change(&mut self, settings: Settings) {
        let start_angle = self.settings.start_angle;
        self.settings = settings;
        self.settings.start_angle = start_angle;
        let found = self.found;
        self.forget();
        // The wave itself is still there.
        self.found = found;
    }

    /// Solves the window gathered.
    #[inline(never)]
    pub(super) fn estimate(&mut self, seen: &mut [Seen]) -> Option<Estimate> {
        let mut fit = Fit::default();
        self.fit(seen, &mut fit);
        let estimate = self.estimate_fit(seen, &fit);
        self.advance(seen);
        estimate
    }

    /// Not inlined, so that its stack is not in use while the window is fitted.
    #[inline(never)]
    fn estimate_fit(&mut self, seen: &[Seen], fit: &Fit) -> Option<Estimate> {
        let blocks = self.gathered.blocks(seen);
        self.judged(blocks, fit, |units, record, flags| {
            record.estimate(units, flags)
        })
    }

    /// The same, but hands the estimate to `report`. Both have all of [`judged`](Self::judged) inlined; the linker keeps the one that is used.
    #[inline(never)]
    pub(super) fn report(&mut self, seen: &mut [Seen], report: &mut dyn FnMut(Estimate)) {
        let mut fit = Fit::default();
        self.fit(seen, &mut fit);
        self.report_fit(seen, &fit, report);
        self.advance(seen);
    }

    #[inline(never)]
    fn report_fit(&mut self, seen: &[Seen], fit: &Fit, report: &mut dyn FnMut(Estimate)) {
        let blocks = self.gathered.blocks(seen);
        self.judged(blocks, fit, |units, record, flags| {
            hand_over(units, record, flags, report);
        });
    }

    /// Moves on to the next window, and wants a new search if the wave is lost.
    #[inline(always)]
    fn advance(&mut self, seen: &mut [Seen]) {
        self.gathered
            .advance(seen, self.settings.hop.unwrap_or(self.count));
        if self.failures.are_enough(self.count) {
            self.search();
        } else if !self.is_compared {
            self.compare();
        }
    }

    /// Wants a search anew, though not another one after that, if the last was misled by what came before the wave: if the blocks are too
    /// short or too long for the period found by the first clean window, in noise of less than 5 % of a_A.
    #[cold]
    #[inline(never)]
    fn compare(&mut self) {
        let (Some(model), Some(wave)) = (&self.model, &self.before) else {
            return;
        };
        // More noise hides harmonics, and misleads a search by itself.
        let is_quiet = wave.residual < wave.main.value * wave.main.value * (1.0 / 400.0);
        let is_misled = is_quiet
            && self.settings.frequency.is_none()
            && (self.settings.cut()).mismatches(model.layout, wave.carrier.period());
        if is_misled {
            self.search();
        }
        self.is_compared = true;
    }

    /// Takes a block; true if it completes a window.
    #[inline(never)]
    pub(super) fn gather<S: Sample>(&mut self, seen: &mut [Seen], block: &Block<S>) -> bool {
        let is_same = self
            .model
            .as_ref()
            .is_some_and(|model| model.layout == block.layout);
        if is_same && self.end == block.start {
            self.take(seen, block)
        } else {
            self.gather_anew(seen, block, is_same)
        }
    }

    /// Takes a block that continues those gathered, or begins a window.
    #[inline(never)]
    fn take<S: Sample>(&mut self, seen: &mut [Seen], block: &Block<S>) -> bool {
        self.end = block.start.wrapping_add(u64::from(block.layout.length));
        let (Some(model), Some(place)) = (&self.model, self.gathered.next(seen)) else {
            return false;
        };
        model.see(block, place);
        self.gathered.length() >= usize::from(self.count)
    }

    /// Takes a block that does not continue those gathered. Not inlined, so that the usual path saves no registers for it.
    #[cold]
    #[inline(never)]
    fn gather_anew<S: Sample>(
        &mut self,
        seen: &mut [Seen],
        block: &Block<S>,
        is_same: bool,
    ) -> bool {
        // Checked only here: the blocks gathered are of the wanted search, and are dropped when another is wanted.
        if block.search != self.wanted {
            return false;
        }
        self.gathered.clear();
        if !is_same {
            self.begin(&block.layout, seen.len());
        }
        self.take(seen, block)
    }

    /// Drops the model: the next block begins a first window.
    fn forget(&mut self) {
        self.model = None;
        self.found = false;
    }

    /// Builds the model for blocks of another layout; their first window is compared with none.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, &layout: &Layout, ring: usize) {
        let settings = &self.settings;
        // A tracker without settings takes no block.
        if settings.periods == 0 {
            return;
        }
        self.units = Units::at(settings.sample_rate);
        self.count = settings.cut().blocks(layout).min(ring as u16).max(1);
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
    #[inline(always)]
    fn fit(&mut self, seen: &[Seen], fit: &mut Fit) {
        let Some(model) = &mut self.model else {
            return;
        };
        let rough = |model: &Model| DETECTOR_UNCERTAINTY * model.layout.step.radians();
        let (carrier, uncertainty) = match &self.before {
            None => (model.layout.step, rough(model)),
            // Where the last clean fit ended: it is near the greater wave, even if the lesser turns fast near a circle.
            Some(before) => (before.carrier, 0.0),
        };
        let blocks = self.gathered.blocks(seen);
        solve(model, blocks, carrier, uncertainty, fit);
        if !fit.settled && self.before.is_some() {
            let rough = rough(model);
            solve(model, blocks, carrier, rough, fit);
        }
    }
}

/// Makes an estimate and hands it over. Not inlined, so that stack is reserved for it only now.
#[inline(never)]
fn hand_over(units: &Units, record: &Record, flags: Flags, report: &mut dyn FnMut(Estimate)) {
    report(record.estimate(units, flags));
}
