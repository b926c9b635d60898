//! One window as the tracker remembers it, with values at its middle and rates per sample.

use core::num::NonZeroU32;

use super::angle::Angle;
use super::checks::SIGNIFICANT;
use crate::arch::square_root;
use crate::double::{self, reciprocal, scaled, to_single};
use crate::estimate::{Estimate, Flags};
use crate::phase::PhaseStep;
use crate::scalar::{greater, long};

/// Largest standard deviation of an angle, rad, of which the quarter turn is certain: six reach π/4, half the ambiguity.
const MAX_ANGLE_STD: f32 = 0.13;

/// Angle, rad, that a change of the rate may add over a gap with the quarter turn still certain.
const MAX_EXTRA_TURN: f32 = 0.7;

/// Standard deviations beyond which a rate differs from the predicted one.
const CHANGED_RATE_SIGMAS: f32 = 4.0;

/// Windows over which rates are averaged across gaps, at most.
const MAX_AVERAGED: f32 = 8.0;

/// Standard deviations beyond which a window's own rate contradicts another.
const CONTRADICTION_SIGMAS: f32 = 5.0;

/// Factors that turn samples into seconds and Hz, made once: f64 is slow on a core without it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    /// In Hz.
    pub sample_rate: f32,
    /// Half a sample, s.
    half_sample: f64,
    /// 2⁻⁶⁴ turn a sample, Hz.
    turn: f64,
}

impl Units {
    /// Before a sample rate is set.
    pub(crate) const NONE: Self = Self {
        sample_rate: 0.0,
        half_sample: 0.0,
        turn: 0.0,
    };

    pub(crate) fn at(sample_rate: f64) -> Self {
        Self {
            sample_rate: to_single(sample_rate),
            half_sample: scaled(reciprocal(sample_rate), -1),
            turn: scaled(sample_rate, -64),
        }
    }
}

/// An amplitude of a window, its rate a sample, and their variances.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Amplitude {
    pub value: f32,
    pub rate: f32,
    pub variance: f32,
    pub rate_variance: f32,
}

/// Values, rates and variances of one window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Record {
    /// Middle of the window, half samples from the start of the stream.
    pub middle: u64,
    /// Sample pairs of the window; never 0, so that an `Option<Record>` takes no more room.
    pub samples: NonZeroU32,
    /// Noise variance a sample, from this window's own residual.
    pub residual: f32,
    /// Ratio of the variances stated in an estimate to those here, which the tests use.
    pub share: f32,
    pub carrier: PhaseStep,
    /// Frequency beyond the carrier, rad/sample.
    pub drift: f32,
    pub drift_variance: f32,
    pub angle: Angle,
    /// Time of `angle`, half samples: `middle`, or for a circular pattern that of the last window that had an angle.
    pub angle_middle: u64,
    pub angle_variance: f32,
    /// Angle rate, rad/sample, from this window alone.
    pub turning: f32,
    pub turning_variance: f32,
    /// Angle rate predicted for the next window, from `turning` and the windows before; its variance is infinite until a window has an
    /// angle.
    pub predicted_rate: f32,
    pub predicted_rate_variance: f32,
    /// α, paired with `angle`.
    pub phase: f32,
    pub phase_variance: f32,
    pub main: Amplitude,
    pub quadrature: Amplitude,
    /// |z|² of each raw pick-off's phasor, and the variance of one of its components.
    pub channel_power: [f32; 2],
    pub channel_variance: f32,
    pub offsets: [f32; 2],
    /// Of each offset; infinite where offsets may wander.
    pub offset_variance: f32,
}

impl Record {
    /// The window as it is reported.
    #[inline(always)]
    pub(crate) fn estimate(&self, units: &Units, flags: Flags) -> Estimate {
        // Calls come first, so that no number is kept in memory across them.
        let time = double::units(self.middle as i64, units.half_sample);
        let angle = self.angle.radians();
        let frequency = self.carrier.hertz(self.drift, units.turn);
        let rate = units.sample_rate;
        let variances = [
            self.main.variance,
            self.quadrature.variance,
            self.angle_variance,
            self.phase_variance,
            self.drift_variance,
            self.turning_variance,
            self.main.rate_variance,
        ];
        let stated = variances.map(|variance| square_root(self.share * variance));
        let [main, quadrature, of_angle, phase, drift, turning, decay] = stated;
        let per_amplitude = rate / self.main.value;
        Estimate {
            start: self.middle.wrapping_sub(u64::from(self.samples.get()) - 1) / 2,
            samples: self.samples.get(),
            time,
            main_amplitude: self.main.value,
            quadrature_amplitude: self.quadrature.value,
            angle,
            phase: self.phase,
            frequency,
            angle_rate: self.turning * rate,
            decay_rate: -self.main.rate * per_amplitude,
            offsets: self.offsets,
            main_amplitude_std: main,
            quadrature_amplitude_std: quadrature,
            angle_std: of_angle,
            phase_std: phase,
            frequency_std: drift * rate * (1.0 / core::f32::consts::TAU),
            angle_rate_std: turning * rate,
            decay_rate_std: decay * per_amplitude,
            residual_rms: square_root(self.residual),
            flags,
        }
    }

    /// Predicts the angle of a later window, `now`. Gives that angle, the rate a sample that leads there, and whether the angle is certain
    /// to less than a quarter turn: it may not be over a gap, or if the pattern turns at another rate after it.
    #[inline(always)]
    pub(crate) fn predict_angle(&self, now: &Self) -> (Angle, f32, bool) {
        let passed = 0.5 * long(now.middle.wrapping_sub(self.angle_middle));
        let is_next =
            passed < 1.5 * now.samples.get() as f32 && self.predicted_rate_variance < f32::INFINITY;
        let is_known = is_next
            || self.predicted_rate_variance * passed * passed < MAX_ANGLE_STD * MAX_ANGLE_STD;
        let rate_change = now.turning - self.predicted_rate;
        let spread = now.turning_variance + self.predicted_rate_variance;
        let turns_on = (rate_change * passed).abs() < MAX_EXTRA_TURN
            || rate_change * rate_change < CHANGED_RATE_SIGMAS * CHANGED_RATE_SIGMAS * spread;
        // Only the share of the rate that stands out of its noise: in strong noise a pattern at rest would be predicted to turn by a
        // quarter.
        let square = self.predicted_rate * self.predicted_rate;
        let share = square / (square + self.predicted_rate_variance + f32::MIN_POSITIVE);
        let rate = if is_known {
            share * self.predicted_rate
        } else {
            0.0
        };
        let is_certain = is_known && (is_next || turns_on);
        (self.angle.plus(rate * passed), rate, is_certain)
    }

    /// Averages the predicted rate with that of the windows before, whose angles tell nothing of it over gaps of unknown turns.
    pub(crate) fn average_rate(&mut self, before: &Self) {
        if before.predicted_rate_variance == f32::INFINITY {
            return;
        }
        let known = greater(
            before.predicted_rate_variance,
            self.turning_variance / (MAX_AVERAGED - 1.0),
        );
        self.predict_rate(before.predicted_rate, known);
    }

    /// Predicts the weighted mean of this window's own rate and another, unless they contradict each other: over a gap the pattern may have
    /// turned by a quarter turn more or less than angles say. Gives the difference of the two rates, and its variance.
    #[inline(never)]
    pub(crate) fn predict_rate(&mut self, rate: f32, variance: f32) -> (f32, f32) {
        let difference = self.turning - rate;
        let spread = self.turning_variance + variance;
        if difference * difference < CONTRADICTION_SIGMAS * CONTRADICTION_SIGMAS * spread {
            let share = self.turning_variance / spread;
            self.predicted_rate = self.turning - share * difference;
            self.predicted_rate_variance = share * variance;
        }
        (difference, spread)
    }

    /// True when pick-off `channel` shows no wave.
    pub(crate) fn is_silent(&self, channel: usize) -> bool {
        self.channel_power[channel]
            < SIGNIFICANT * self.channel_variance + 1e-6 * self.main.value * self.main.value
    }

    /// Phase, rad, by which this window is ahead of what the mean frequency of both windows explains, not wrapped.
    pub(crate) fn phase_advance(&self, before: &Self) -> f32 {
        let half_samples = self.middle.wrapping_sub(before.middle);
        let whole = before.carrier.after_half_samples(half_samples as i64);
        let beyond = self.frequency_beyond(before.carrier);
        let run = 0.25 * long(half_samples) * (beyond + before.drift);
        let whole = (whole.0 as i32) as f32 * (core::f32::consts::TAU / 4_294_967_296.0);
        (before.phase - self.phase) - whole - run
    }

    /// The frequency of this window beyond a carrier, rad/sample.
    fn frequency_beyond(&self, carrier: PhaseStep) -> f32 {
        let steps = self.carrier.0.wrapping_sub(carrier.0) as i32 as f32;
        steps * (core::f32::consts::TAU / 4_294_967_296.0) + self.drift
    }
}
