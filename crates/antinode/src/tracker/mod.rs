//! Blocks become estimates of a tracked wave: windows are cut, solved, checked, and joined to those before.

mod between;
mod checks;
mod converter;
mod failures;
mod record;
mod trend;

use crate::arch::square_root;
use crate::block::{Block, Layout};
use crate::calibration::Calibration;
use crate::estimate::{Estimate, Flags};
use crate::order::greater;
use crate::sample::Sample;
use crate::settings::{MOST_BLOCKS, Settings, SettingsError};
use crate::wave::{Angle, Standing, wrap};
use crate::window::{CARRIER_REACH, Fit, Gathered, Model, solve};
use checks::Noise;
use converter::Coding;
use failures::{Failures, LEFT};
use record::Units;
pub(crate) use record::{Amplitude, Record};
use trend::Trend;

/// How far the detector's frequency may be off, as a share of it.
const DETECTOR_UNCERTAINTY: f32 = 0.05;
/// Flags of a window that says nothing about those after it.
const BROKEN: Flags = Flags::LOST
    .with(Flags::MISFIT)
    .with(Flags::NOT_FINITE)
    .with(Flags::DEAD_CHANNEL);

/// Cuts the stream of blocks into windows and tracks the wave over them. Holds up to `BLOCKS` blocks, 11 to 65 535.
///
/// A window has as many blocks as periods at most, or 11 where that is more; `BLOCKS` is two more than the periods.
///
/// It works at block rate and may run in thread context while blocks are gathered in an interrupt.
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
    /// The angle of the last window that had one: continuity is kept over faults.
    angle: Angle,
    /// True from the loss of a wave to the first window after it.
    lost: bool,
    ever: bool,
    failures: Failures,
    /// True while a fault lies between the last clean window and the next.
    broken: bool,
}

impl<const BLOCKS: usize> Tracker<BLOCKS> {
    /// A tracker without settings: nothing may be pushed before [`configure`](Self::configure) has given it some; an estimate would mean
    /// nothing.
    ///
    /// It is all zeros: as a static it takes no flash and is nowhere on the stack, as what [`new`](Self::new) gives is.
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
            angle: Angle::ZERO,
            lost: false,
            ever: false,
            failures: Failures::NONE,
            broken: false,
        }
    }

    /// A tracker that waits for its first block, with the settings that its [`Front`](crate::Front) has.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`].
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        let mut tracker = Self::unset();
        tracker.configure(settings)?;
        Ok(tracker)
    }

    /// Waits for its first block anew with other settings, in place: a new tracker in this one's place would take its size in stack.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn configure(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.check(BLOCKS)?;
        self.settings = settings;
        // All else begins anew with the next block.
        self.forget();
        self.angle = Angle::new(settings.start_angle);
        self.ever = false;
        Ok(())
    }

    /// Takes a block; gives the estimate of the window that it completes.
    ///
    /// A block of another layout, or one that does not follow the last, starts a new window.
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
        let estimate = self.judge(&fit);
        self.advance();
        estimate
    }

    /// Begins the next window.
    fn advance(&mut self) {
        self.gathered
            .advance(self.settings.hop.unwrap_or(self.count));
    }

    /// Takes a block and hands the estimate of the window that it completes to `report`: without room for it in the stack while the
    /// window is fitted.
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
    }

    #[inline(never)]
    fn report_fit(&mut self, fit: &Fit, report: &mut impl FnMut(Estimate)) {
        let estimate = self.judge(fit);
        self.advance();
        if let Some(estimate) = estimate {
            report(estimate);
        }
    }

    /// Takes a block; true where it completes a window.
    #[inline(never)]
    fn gather<S: Sample>(&mut self, block: &Block<S>) -> bool {
        self.follow(block.layout, block.start);
        self.end = block.start + u64::from(block.layout.length);
        let (Some(model), Some(place)) = (&self.model, self.gathered.next()) else {
            return false;
        };
        model.see(block, place);
        self.gathered.blocks().len() >= usize::from(self.count)
    }

    /// True when the wave has been lost for so long that a new period must be searched: two windows, or eight with little of the wave
    /// beside all else, or the first one where that shows no wave. Ask after every block: a first window without a wave gives no estimate.
    ///
    /// Then call [`Front::search`](crate::Front::search), drop the blocks that were gathered before it, and [`forget`](Self::forget).
    pub fn has_lost(&self) -> bool {
        self.failures.are_enough()
    }

    /// Drops the wave and the blocks gathered, but not the angle: with the next block a first window begins, and the angle found there is
    /// the one nearest to the last.
    pub fn forget(&mut self) {
        self.model = None;
        self.gathered.clear();
        self.failures = Failures::NONE;
    }

    /// Changes the calibration: the next block starts a new first window, flagged [`Flags::REACQUIRED`], its angle continued. The front
    /// goes on as it is.
    ///
    /// # Errors
    ///
    /// Those of [`Settings::check`]; nothing is changed then.
    pub fn calibrate(&mut self, calibration: Calibration) -> Result<(), SettingsError> {
        let settings = Settings {
            calibration,
            ..self.settings
        };
        settings.check(BLOCKS)?;
        self.settings = settings;
        self.forget();
        Ok(())
    }

    /// Starts a new window when a block does not continue those gathered.
    fn follow(&mut self, layout: Layout, start: u64) {
        let same = self
            .model
            .as_ref()
            .is_some_and(|model| model.layout == layout);
        if same && (self.gathered.is_new() || self.end == start) {
            return;
        }
        self.gathered.clear();
        if !same {
            self.begin(layout);
        }
    }

    /// Begins with blocks of another layout.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, layout: Layout) {
        let settings = &self.settings;
        self.units = Units::at(settings.sample_rate);
        self.count = settings.blocks(layout).clamp(1, BLOCKS as u16);
        let rate = self.units.sample_rate;
        self.model
            .insert(Model::empty(layout, settings.calibration, rate))
            .begin(layout.step, self.count, settings.hum);
        self.noise = Noise::NONE;
        self.trend.clear();
        self.before = None;
        self.lost = self.ever;
        self.failures = Failures::NONE;
    }

    /// Makes an estimate of a fit: by itself, so that what it needs of the stack is not there while the window is fitted.
    #[inline(never)]
    fn judge(&mut self, fit: &Fit) -> Option<Estimate> {
        let model = self.model.as_ref()?;
        let half = model.half;
        let own = fit.remains.variance();
        let noise = self.noise.beside(own, fit.remains.freedom);
        // Rounding of f32 sums is an error too, where there is no other, and part of it does not average.
        let size = fit.offsets[0].abs() + fit.offsets[1].abs() + square_root(fit.waves.power());
        let rounding = 1e-7 * size;
        let coding = Coding::new(&self.settings, noise, model, fit);
        let errors = rounding * rounding * (1.0 + half) + coding.expected;
        let samples = u32::from(self.count) * u32::from(model.layout.length);
        let middle = 2 * self.end - u64::from(samples) - 1;
        let mut wave = Standing::new(model, fit, noise + errors, own, middle);
        let is_no_wave = checks::is_no_wave(fit, &wave, self.count, model.layout.length);
        if self.before.is_none() && is_no_wave {
            // The detector was deceived: nothing is reported, and the search goes on.
            self.failures = Failures::ENOUGH;
            return None;
        }

        let (expected, is_certain) = match &self.before {
            Some(before) => before.angle_at(middle, samples),
            None => (self.angle, true),
        };
        let record = &mut wave.record;
        let (angle, quarters) = expected.nearest(record.angle.rest);
        record.angle = angle;
        record.phase = wrap(record.phase + (quarters & 1) as f32 * core::f32::consts::PI);

        let mut flags = checks::within(model, fit, &wave, [own, coding.most], &mut self.noise);
        flags = flags.with(converter::sample_flags(
            &self.settings,
            self.gathered.blocks(),
            model.layout.step,
            fit,
            &wave,
            greater(own, wave.noise),
        ));
        let mut between = Flags::empty();
        if let Some(before) = &self.before {
            between = between::flags(before, &wave.record, is_certain);
            // A circular pattern has neither an angle nor a phase of its own.
            if !flags.intersects(Flags::CIRCULAR.with(Flags::LOST)) {
                flags = flags.with(between);
            }
        }
        let fault = self.broken || flags.intersects(Flags::MISFIT.with(Flags::STEP));
        flags = flags.with_if(
            fault && self.has_fallen_silent(&wave.record),
            Flags::DEAD_CHANNEL,
        );
        let is_circular = flags.contains(Flags::CIRCULAR);
        // Of an angle that is known modulo π/2 only those before tell no rate.
        if is_circular || !is_certain {
            self.trend.clear();
        }
        if let (false, Some(before)) = (is_certain, &self.before) {
            wave.record.average_rate(before);
        }
        // A wave's first window takes its pattern to stand still, and so does one that cannot see it turn.
        if is_circular || self.before.is_none() || !self.trend.is_empty() {
            let drift = wave.record.drift;
            self.trend.take_turning_out(&mut wave, model);
            if self.before.is_none() && !is_circular {
                // It may have turned by as much as it seems to.
                let moved = wave.record.drift - drift;
                wave.record.drift_variance += moved * moved;
            }
        }
        let record = &wave.record;

        let left = |before: &Record| record.main.value < LEFT * before.main.value;
        let is_little = is_no_wave || self.before.as_ref().is_some_and(left);
        self.failures.take(flags, fit.settled, is_little);
        if fit.settled && !flags.contains(Flags::LOST) {
            let is_clean = !flags.intersects(BROKEN);
            if self.lost || !is_certain && is_clean {
                flags = flags.with(Flags::REACQUIRED);
                self.trend.clear();
                self.lost = false;
            }
            self.ever = true;
        }
        let drift = if is_circular {
            fit.waves.drift() * model.per_half
        } else {
            record.drift
        };
        self.remember(record, flags, between, drift);
        Some(record.estimate(&self.units, flags))
    }

    /// True when a pick-off that showed the wave in the last clean window shows none now.
    fn has_fallen_silent(&self, now: &Record) -> bool {
        self.before.as_ref().is_some_and(|before| {
            (0..2).any(|i| {
                now.is_silent(i)
                    && before.channel_power[i] > 4.0 * now.channel_power[i]
                    && !before.is_silent(i)
            })
        })
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

    /// Keeps what the next windows need; `drift` is the frequency beyond the carrier weighted by power, rad a sample.
    fn remember(&mut self, record: &Record, flags: Flags, between: Flags, drift: f32) {
        self.broken = flags.intersects(BROKEN);
        if self.broken {
            // The next window is judged by itself: what lies between it and the last clean one is already flagged.
            self.trend.clear();
            if let Some(before) = &mut self.before {
                // But for the phase, where a wave went on: it tells samples that are missing from a spike.
                if flags.intersects(BROKEN.without(Flags::MISFIT)) {
                    before.phase_variance = f32::INFINITY;
                }
                for amplitude in [&mut before.main, &mut before.quadrature] {
                    amplitude.variance = f32::INFINITY;
                    amplitude.rate_variance = f32::INFINITY;
                }
                before.angle_variance = f32::INFINITY;
                before.offset_variance = [f32::INFINITY; 2];
            }
            return;
        }
        if !between.is_empty() {
            self.trend.clear();
        }
        if !flags.contains(Flags::CIRCULAR) {
            self.trend.keep(
                record.middle,
                record.samples,
                record.angle,
                record.angle_variance,
            );
            self.angle = record.angle;
        }
        let angle = self.angle;
        let before = self.before.insert(*record);
        if flags.contains(Flags::CIRCULAR) {
            // It has neither an angle nor a phase of its own, and of its two waves one knows the frequency.
            before.drift = drift;
            before.angle = angle;
            (before.turning, before.turning_variance) = (0.0, 0.0);
            (before.promised, before.promised_variance) = (0.0, 0.0);
            before.angle_variance = f32::INFINITY;
            before.phase_variance = f32::INFINITY;
        }
    }
}
