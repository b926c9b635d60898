//! Tests of a window against the clean one before it: phase, amplitudes, angle and offsets must not step.
//!
//! Thresholds are as those of a window by itself. A change has the variances of both levels and both rates; in adjacent windows its
//! standard deviation is √8 times that of a level.

use super::angle::wrap;
use super::checks::SIGMAS;
use super::record::{Amplitude, Record};
use crate::estimate::Flags;
use crate::exponential::exponential;
use crate::scalar::{greater, lesser, long};

/// Below this share of a_A a step of an amplitude or an offset between windows is no fault.
const AMPLITUDE_FLOOR: f32 = 2e-3;
/// Below this a step of the pattern angle between windows is no fault, rad.
const ANGLE_FLOOR: f32 = 2e-3;
/// Below this a step of the phase is no fault, rad: a lost sample makes 2π/200 or more.
const PHASE_FLOOR: f32 = 0.02;

/// Tests a window against the clean one before. Unless `knows_angle`, the angle is known modulo π/2 only: neither it nor the phase that
/// goes with it is tested.
///
/// `offset_rates` are the rates a sample at which the offsets moved to the window before, and become those to this one.
#[inline(never)]
pub(super) fn flags(
    before: &Record,
    now: &Record,
    offset_rates: &mut [f32; 2],
    knows_angle: bool,
) -> Flags {
    let interval = Interval::new(before, now);
    let phase = wrap(now.phase_advance(before));
    let phase_variance = interval.variance(
        before.phase_variance + now.phase_variance,
        before.drift_variance + now.drift_variance,
    );
    // A phase known to 0.45 rad or worse is never seen to jump: seven standard deviations are beyond half a turn.
    let jump = beyond(phase, phase_variance, PHASE_FLOOR);

    let amplitude_floor = AMPLITUDE_FLOOR * before.main.value;
    let main = interval.change(&before.main, &now.main, amplitude_floor);
    let quadrature = interval.change(&before.quadrature, &now.quadrature, amplitude_floor);
    let angle = beyond(
        now.angle.less(before.angle) - interval.predicted([before.turning, now.turning]),
        interval.variance(
            now.angle_variance + before.angle_variance,
            now.turning_variance + before.turning_variance,
        ),
        ANGLE_FLOOR,
    );
    let offset_variance = now.offset_variance + before.offset_variance;
    let (mut step, per_sample) = (0.0, 1.0 / interval.samples);
    for (i, rate) in offset_rates.iter_mut().enumerate() {
        let moved = now.offsets[i] - before.offsets[i];
        // An offset that goes on as it moved before wanders, and does not step.
        let beside = moved - *rate * interval.samples;
        *rate = moved * per_sample;
        step = greater(lesser(moved.abs(), beside.abs()), step);
    }
    let offsets = beyond(step, offset_variance, amplitude_floor);
    Flags::empty()
        .with_if(knows_angle && jump, Flags::PHASE_JUMP)
        .with_if(knows_angle && angle || offsets, Flags::STEP)
        .with(main)
        .with(quadrature)
}

/// True if the pattern turns at another rate than in the window before: a step in the middle of a window looks like a turn.
pub(super) fn turns_at_another_rate(before: &Record, now: &Record) -> bool {
    // Not by `beyond`, to which NaN is a step: other tests see a rate that is NaN, and this takes 28 bytes less.
    let rate_change = now.turning - before.turning;
    rate_change * rate_change > SIGMAS * SIGMAS * (now.turning_variance + before.turning_variance)
}

/// The time between the middles of two windows, and the growth over it.
struct Interval {
    samples: f32,
    /// Half the later window.
    half: f32,
    /// Growth of the main amplitude in each window, as a share of itself a sample: the same in both if a wave rings down.
    growth: [f32; 2],
    /// Factor by which amplitudes grow from one middle to the other.
    factor: f32,
}

impl Interval {
    fn new(before: &Record, now: &Record) -> Self {
        let samples = 0.5 * long(now.middle.wrapping_sub(before.middle));
        // Each rate over its own amplitude, with a single division.
        let values = [before.main.value, now.main.value];
        let per_both = 1.0 / (values[0] * values[1]);
        let growth = [
            before.main.rate * (values[1] * per_both),
            now.main.rate * (values[0] * per_both),
        ];
        Self {
            samples,
            half: 0.5 * now.samples.get() as f32,
            growth,
            factor: exponential(0.5 * (growth[0] + growth[1]) * samples),
        }
    }

    /// The change that both windows' own rates predict, by the trapezoidal rule: exact for a rate that itself changes steadily.
    fn predicted(&self, rates: [f32; 2]) -> f32 {
        0.5 * (rates[0] + rates[1]) * self.samples
    }

    /// The variance of a change less the predicted one, from the variances of both levels and of both rates.
    fn variance(&self, levels: f32, rates: f32) -> f32 {
        levels + 0.25 * self.samples * self.samples * rates
    }

    /// Tests an amplitude and its rate.
    #[inline]
    fn change(&self, before: &Amplitude, now: &Amplitude, floor: f32) -> Flags {
        let (values, rates) = ([before.value, now.value], [before.rate, now.rate]);
        let rate_variance = before.rate_variance + now.rate_variance;
        // The change besides the growth that both amplitudes share, by the trapezoidal rule.
        let own: [f32; 2] = core::array::from_fn(|i| rates[i] - self.growth[i] * values[i]);
        let beside = self.predicted([self.factor * own[0], own[1]]);
        // Errors of the growth weigh more the more an amplitude has grown.
        let grown = greater(self.factor * self.factor, 1.0);
        let step = beyond(
            values[1] - self.factor * values[0] - beside,
            grown * self.variance(before.variance + now.variance, rate_variance),
            floor,
        );
        // A step within a window also looks like growth that the window before did not have.
        let bent = self.samples <= 4.0 * self.half
            && beyond(
                self.half * (rates[1] - self.factor * rates[0]),
                self.half * self.half * rate_variance,
                floor,
            );
        Flags::empty()
            .with_if(step, Flags::STEP)
            .with_if(bent, Flags::MISFIT)
    }
}

/// True if a step is NaN, or more than chance and a floor explain.
#[inline(always)]
fn beyond(step: f32, variance: f32, floor: f32) -> bool {
    let rest = step.abs() - floor;
    let is_explained = rest <= 0.0 || rest * rest <= SIGMAS * SIGMAS * variance;
    !is_explained
}
