//! One window as the tracker remembers it: values at its middle, rates a sample, variances.

use core::num::NonZeroU32;

use super::angle::Angle;
use super::checks::SIGNIFICANT;
use crate::arch::square_root;
use crate::double::{self, reciprocal, scaled, to_single};
use crate::estimate::{Estimate, Flags};
use crate::phase::PhaseStep;
use crate::scalar::{greater, long};

/// Deviation of a promised angle, rad, of which six reach the next angle that looks the same.
const UNKNOWN_TURN: f32 = 0.13;

/// What a rate that changes adds to an angle at most, rad, and is no quarter turn.
const OTHERWISE: f32 = 0.7;

/// Deviations by which a rate is another one than was promised.
const TOLD: f32 = 4.0;

/// Windows over whose gaps rates are averaged at most.
const AVERAGED: f32 = 8.0;

/// Deviations by which a window's own rate denies another.
const DENIED: f32 = 5.0;

/// What turns samples into seconds and Hz, made once: f64 is slow on a core without it.
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
    /// Those of no sample rate yet.
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

#[derive(Debug, Clone, Copy)]
pub(crate) struct Record {
    /// Middle of the window, half samples from the start of the stream.
    pub middle: u64,
    /// Sample pairs of the window; never 0, so that a record that may be none takes no more room.
    pub samples: NonZeroU32,
    /// What this window alone leaves, as a noise variance a sample.
    pub residual: f32,
    /// Variances that are stated over those here, which tests take.
    pub share: f32,
    pub carrier: PhaseStep,
    /// Frequency beyond the carrier, rad/sample.
    pub drift: f32,
    pub drift_variance: f32,
    pub angle: Angle,
    /// Where it was, half samples: the middle, but of a circular pattern that of the last one that had an angle.
    pub angle_middle: u64,
    pub angle_variance: f32,
    pub turning: f32,
    pub turning_variance: f32,
    /// The same with what the angles of the windows before say; the variance is infinite where no window has had an angle yet.
    pub promised: f32,
    pub promised_variance: f32,
    /// α, paired with `angle`.
    pub phase: f32,
    pub phase_variance: f32,
    pub main: Amplitude,
    pub quadrature: Amplitude,
    /// Power of each raw pick-off's phasor, and the variance of a part of it.
    pub channel_power: [f32; 2],
    pub channel_variance: f32,
    pub offsets: [f32; 2],
    /// Of each; infinite where it may wander.
    pub offset_variance: f32,
}

impl Record {
    /// The window as it is reported.
    #[inline(always)]
    pub(crate) fn estimate(&self, units: &Units, flags: Flags) -> Estimate {
        // First what is called, so that no number need be kept meanwhile.
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

    /// The angle that this window promises another, `now`, at which rate a sample it gets there, and whether it knows that to less than a
    /// quarter turn: over a gap it may not, nor where the pattern turns otherwise behind it.
    pub(crate) fn angle_at(&self, now: &Self) -> (Angle, f32, bool) {
        let passed = 0.5 * long(now.middle.wrapping_sub(self.angle_middle));
        let is_next =
            passed < 1.5 * now.samples.get() as f32 && self.promised_variance < f32::INFINITY;
        let is_known =
            is_next || self.promised_variance * passed * passed < UNKNOWN_TURN * UNKNOWN_TURN;
        let by = now.turning - self.promised;
        let spread = now.turning_variance + self.promised_variance;
        let turns_on = (by * passed).abs() < OTHERWISE || by * by < TOLD * TOLD * spread;
        // As much of the turning as stands out of its noise: in much of it a pattern that stands still would be promised a quarter turn.
        let square = self.promised * self.promised;
        let share = square / (square + self.promised_variance + f32::MIN_POSITIVE);
        let rate = if is_known { share * self.promised } else { 0.0 };
        let is_certain = is_known && (is_next || turns_on);
        (self.angle.plus(rate * passed), rate, is_certain)
    }

    /// Promises the rate that the windows before have too, each by itself: over gaps of unknown turns no angles tell it.
    pub(crate) fn average_rate(&mut self, before: &Self) {
        if before.promised_variance == f32::INFINITY {
            return;
        }
        let known = greater(
            before.promised_variance,
            self.turning_variance / (AVERAGED - 1.0),
        );
        self.promise(before.promised, known);
    }

    /// Promises the mean of this window's own rate and another, unless its own denies that: over a gap the pattern may have turned by a
    /// quarter more or less than angles say. Gives how far apart they are, and the variance of that.
    #[inline(never)]
    pub(crate) fn promise(&mut self, rate: f32, variance: f32) -> (f32, f32) {
        let apart = self.turning - rate;
        let spread = self.turning_variance + variance;
        if apart * apart < DENIED * DENIED * spread {
            let share = self.turning_variance / spread;
            self.promised = self.turning - share * apart;
            self.promised_variance = share * variance;
        }
        (apart, spread)
    }

    /// True when pick-off `channel` shows no wave.
    pub(crate) fn is_silent(&self, channel: usize) -> bool {
        self.channel_power[channel]
            < SIGNIFICANT * self.channel_variance + 1e-6 * self.main.value * self.main.value
    }

    /// By how much the phase has run beyond what the mean frequency of both windows explains, rad, not wrapped.
    pub(crate) fn phase_advance(&self, before: &Self) -> f32 {
        let half_samples = self.middle.wrapping_sub(before.middle);
        let whole = before.carrier.after_half_samples(half_samples as i64);
        let beyond = before.drift + self.frequency_less(before);
        let run = 0.25 * long(half_samples) * (beyond + before.drift);
        let whole = (whole.0 as i32) as f32 * (core::f32::consts::TAU / 4_294_967_296.0);
        (before.phase - self.phase) - whole - run
    }

    /// The frequency of this window less that of `before`, rad/sample.
    fn frequency_less(&self, before: &Self) -> f32 {
        self.frequency_beyond(before.carrier) - before.drift
    }

    /// The frequency of this window beyond a carrier, rad/sample.
    pub(crate) fn frequency_beyond(&self, carrier: PhaseStep) -> f32 {
        let steps = self.carrier.0.wrapping_sub(carrier.0) as i32 as f32;
        steps * (core::f32::consts::TAU / 4_294_967_296.0) + self.drift
    }
}
