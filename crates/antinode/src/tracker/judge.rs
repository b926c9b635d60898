//! Turns a fit into a record with flags, and keeps what the next windows need of it.

use super::angle::wrap;
use super::between;
use super::checks::{self, Levels};
use super::converter::{self, Coding};
use super::failures::{Failures, LITTLE};
use super::followed::Followed;
use super::record::{Record, Units};
use super::standing::Standing;
use super::tracking::Tracking;
use crate::estimate::Flags;
use crate::scalar::greater;
use crate::window::{Fit, Seen};

/// Flags of a window with which those after it are not compared.
const BROKEN: Flags = Flags::LOST
    .with(Flags::MISFIT)
    .with(Flags::NOT_FINITE)
    .with(Flags::DEAD_CHANNEL);

/// Flags of a window that has no angle of its own.
const UNSEEN: Flags = BROKEN.without(Flags::MISFIT).with(Flags::CIRCULAR);

/// Highest frequency, rad a sample: one of half a turn or more, 3.14 rad, would be stated as a negative one.
const MAX_RADIANS: f32 = 3.1;

impl Tracking {
    /// Judges a fit of blocks and hands its record and flags to `make`; `None` if there is no wave to be tracked.
    #[inline(always)]
    pub(super) fn judged<R>(
        &mut self,
        blocks: &[Seen],
        fit: &Fit,
        make: impl FnOnce(&Units, &Record, Flags) -> R,
    ) -> Option<R> {
        let model = self.model.as_ref()?;
        let own = fit.remains.variance();
        let [noise, stated] = self.noise.blended(own, fit.remains.freedom);
        // Rounding of f32 is an error too, and does not average out; that of offsets does but for a part, and the residual shows the rest.
        let [c, d] = fit.offsets;
        let offsets = c * c + d * d;
        let rounding = 1e-14 * (offsets + model.half * (fit.waves.power() + offsets / 128.0));
        let least = self.noise.least(noise);
        let coding = Coding::new(&self.settings, [noise, least], model, fit);
        // The squared rounding of a tiny wave is 0 in f32, and 0/0 would be no share.
        let errors = rounding + coding.expected + f32::MIN_POSITIVE;
        let share = (stated + errors) / (noise + errors);
        let mut wave = Standing::new(model, fit, [noise + errors, share], own, self.end);
        let flags = self.judge(blocks, fit, coding.max, stated, &mut wave)?;
        Some(make(&self.units, &wave.record, flags))
    }

    /// Tests a window's wave and joins it to those before; `None` if a first window shows no wave. `coding` is the noise variance that the
    /// converter's steps may add, `stated` that for which standard deviations are stated.
    #[inline(always)]
    fn judge(
        &mut self,
        blocks: &[Seen],
        fit: &Fit,
        coding: f32,
        stated: f32,
        wave: &mut Standing,
    ) -> Option<Flags> {
        let model = self.model.as_ref()?;
        let record = &mut wave.record;
        let (expected, rate, mut is_certain) = match &self.before {
            Some(before) => before.predict_angle(record),
            None => (self.angle, 0.0, true),
        };
        let (mut angle, mut quarters) = expected.nearest(record.angle.rest);
        if self.broken && self.before.is_some() {
            let predicted = quarters;
            let followed = self.followed.at(record.middle, rate);
            (angle, quarters) = followed.nearest(record.angle.rest);
            is_certain &= quarters == predicted;
        }
        record.angle = angle;
        record.phase = wrap(record.phase + (quarters & 1) as f32 * core::f32::consts::PI);

        let own = wave.record.residual;
        let advance = self
            .settings
            .hop
            .map_or(self.count, |hop| hop.min(self.count));
        let colour = if self.settings.coloured {
            f32::INFINITY
        } else {
            checks::MAX_COLOUR
        };
        let mut flags = checks::within(
            model,
            fit,
            wave,
            Levels {
                own,
                stated,
                coding,
                colour,
            },
            &mut self.noise,
            advance,
        );
        flags = flags.with(converter::sample_flags(
            &self.settings,
            blocks,
            model.layout.step,
            fit,
            wave,
            greater(own, wave.noise),
            self.before.as_ref(),
        ));
        let (mut between, mut offset_rates) = (Flags::empty(), self.offset_rates);
        if let Some(before) = &self.before {
            between = between::flags(before, &wave.record, &mut offset_rates, is_certain);
            // A circular pattern has neither an angle nor a phase of its own.
            if !flags.intersects(Flags::CIRCULAR.with(Flags::LOST)) {
                flags = flags.with(between);
            }
        }
        let fault = self.broken || flags.intersects(Flags::MISFIT.with(Flags::STEP));
        flags = flags.with_if(
            self.has_fallen_silent(&wave.record, fault),
            Flags::DEAD_CHANNEL,
        );
        if flags.contains(Flags::DEAD_CHANNEL) {
            // What the other pick-off sees of the quadrature wave moves its phase.
            flags = flags.without(Flags::PHASE_JUMP);
        }
        let is_circular = flags.contains(Flags::CIRCULAR);
        // If the angle is known modulo π/2 only, the angles before tell nothing of its rate.
        if is_circular || !is_certain {
            self.trend.clear();
        }
        if let (false, Some(before)) = (is_certain, &self.before) {
            wave.record.average_rate(before);
        }
        // The pattern is taken to be at rest in a wave's first window and where it is circular, as it cannot be seen to turn.
        let is_first = self.before.is_none() && !is_circular;
        if is_circular || is_first || !self.trend.is_empty() {
            self.trend
                .take_turning_out(wave, model, is_first, is_circular);
        }
        let is_misfit = flags.contains(Flags::MISFIT);
        let is_no_wave =
            (is_misfit || self.before.is_none()) && checks::is_no_wave(model, fit, wave);
        if self.before.is_none() && is_no_wave {
            // The detector was deceived: no estimate is given, and the search goes on.
            self.failures = Failures::ENOUGH;
            return None;
        }
        let record = &wave.record;

        // No wave has a frequency of zero or less, or beyond the highest.
        let turned = model.carrier.radians() + record.drift;
        if turned <= 0.0 || turned > MAX_RADIANS {
            flags = flags.with(Flags::LOST);
        }

        let is_faded_from = |before: &Record| record.main.value < LITTLE * before.main.value;
        let is_faded = self.before.as_ref().is_some_and(is_faded_from);
        // A wave at another frequency counts as little of one too: its sums here are small, but its samples are not.
        let is_elsewhere = is_misfit && converter::are_all_beyond(blocks, fit, record.main.value);
        let is_little = is_no_wave || is_faded || is_elsewhere;
        if is_faded || checks::is_hidden(wave) || flags.contains(Flags::DEAD_CHANNEL) {
            // A wave or a pick-off that goes is no new level of noise.
            self.noise.clear_raised();
        }
        self.failures.take(flags, fit.settled, is_little, advance);
        self.found = !flags.contains(Flags::LOST);
        if fit.settled && !flags.contains(Flags::LOST) {
            let is_clean = !flags.intersects(BROKEN);
            if self.lost || !is_certain && is_clean && !flags.contains(Flags::CIRCULAR) {
                flags = flags.with(Flags::REACQUIRED);
                // The flag stands up to the first unbroken window, for users who leave out windows with other flags.
                self.lost = !is_clean;
            }
            self.had_wave = true;
        }
        if fit.settled && !flags.intersects(UNSEEN) {
            if flags.intersects(BROKEN) {
                self.followed.follow(record, rate);
            } else {
                self.followed = Followed::from(record);
            }
        }
        self.remember(record, flags, between, offset_rates);
        Some(flags)
    }

    /// True when one pick-off that showed the wave in the last clean window shows none now, while the other does, and there is a fault or a
    /// jump of the angle rate: a pattern that turns on steadily may leave a pick-off silent too.
    #[inline(always)]
    fn has_fallen_silent(&self, now: &Record, fault: bool) -> bool {
        self.before.as_ref().is_some_and(|before| {
            let [c, d] = [now.is_silent(0), now.is_silent(1)];
            let silent = usize::from(d);
            (fault || between::turns_at_another_rate(before, now))
                && c != d
                && before.channel_power[silent] > 4.0 * now.channel_power[silent]
                && !before.is_silent(silent)
        })
    }

    /// Keeps what the next windows need.
    #[inline(always)]
    fn remember(&mut self, record: &Record, flags: Flags, between: Flags, offset_rates: [f32; 2]) {
        self.broken = flags.intersects(BROKEN);
        if self.broken {
            // The next window is judged by itself: a change between it and the last clean one is already flagged.
            self.trend.clear();
            if let Some(before) = &mut self.before {
                // The phase is still compared: it tells missing samples from a spike or a dropout.
                for amplitude in [&mut before.main, &mut before.quadrature] {
                    amplitude.rate_variance = f32::INFINITY;
                }
                before.angle_variance = f32::INFINITY;
                before.offset_variance = f32::INFINITY;
            }
            return;
        }
        self.offset_rates = offset_rates;
        if !between.is_empty() {
            self.trend.clear();
        }
        if !flags.contains(Flags::CIRCULAR) {
            self.trend.keep(
                record.middle,
                record.samples.get(),
                record.angle,
                record.angle_variance,
            );
            self.angle = record.angle;
        }
        let angle = self.angle;
        let last = self.before;
        let before = self.before.insert(*record);
        if flags.contains(Flags::CIRCULAR) {
            // A circular pattern has neither an angle nor a phase of its own.
            before.angle = angle;
            // The pattern may have turned on since the last angle; if there was none, it is not known how fast.
            (before.predicted_rate, before.predicted_rate_variance) = (0.0, f32::INFINITY);
            if let Some(last) = last {
                before.angle_middle = last.angle_middle;
                (before.predicted_rate, before.predicted_rate_variance) =
                    (last.predicted_rate, last.predicted_rate_variance);
            }
            before.angle_variance = f32::INFINITY;
            before.phase_variance = f32::INFINITY;
        }
    }
}
