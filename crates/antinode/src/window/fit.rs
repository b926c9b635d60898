//! The exact least-squares fit of a window's waves to the sums of any run of blocks.
//!
//! Each pick-off is Re(z(t)·e^{jωt}) + d with a slowly changing z. About a carrier near ω it has five linear parameters, z, z′ and d at the
//! middle of the window, and both pick-offs share one 5×5 matrix that does not depend on the data. The part that is not linear, the
//! exponential course of the two travelling waves, is predicted exactly and fitted by Gauss–Newton steps on the rest. The linear solution
//! comes first; a steady wave then needs one step, in the pass that computes its residual anyway.

use super::examine::{Remains, examine};
use super::gradient::{self, Gradient};
use super::model::Model;
use super::normal::Covariance;
use super::seen::Seen;
use super::waves::{Parameters, Step, Waves};
use crate::arch::square_root;
use crate::phase::PhaseStep;
use crate::scalar::lesser;

/// Beyond this phase (rad) between a window's middle and its end the carrier is moved before the fit is believed.
const CARRIER_REACH: f32 = 0.05;
/// Beyond this phase, rad per half window, the wave is nowhere near the carrier.
const MAX_DRIFT: f32 = 1.5;
/// The highest carrier, 0.45 turns a sample: a known frequency is at most 0.42, and near half a turn sine and cosine cannot be told apart.
const MAX_CARRIER: u32 = 1_932_735_283;
/// The lowest carrier is that of the blocks over this: in a window of two periods a wandering offset would pass for a wave of almost no
/// frequency.
const MIN_CARRIER_DIVISOR: u32 = 2;
/// A fit whose last step exceeds this share of the wave has found nothing.
const MAX_LAST_STEP: f32 = 0.01;
/// After a step below this share of the wave the next is rounding; one of 10⁻⁶ left undone would stand out of the noise of 10⁵ samples.
const SETTLED: f32 = 2.5e-7;
/// What a step may take off the residual, in noise variances over the number of blocks, without a new pass over the blocks: until then it
/// looks like a jump between the first block and the others, larger by the number of blocks.
const NEGLIGIBLE: f32 = 0.5;
/// A step that explains less than this share of the noise variance moves nothing by more than a hundredth of its standard deviation.
const FUTILE: f32 = 1e-4;
/// From fit to fit the span grows by at least a share of one over this: 78 000 windows in noise of half the wave or more were judged as if it
/// had grown by one block, but for four.
const SLOWEST_GROWTH: u16 = 8;
/// A drift of more variance, rad² per half window squared, is not followed: noise alone would be, to any frequency. Of 115 000 windows in
/// noise of any strength, 30 more were clean than if all were followed, and 10 fewer of them wrong.
const MAX_DRIFT_VARIANCE: f32 = 0.25;
/// Share of both waves' power up to which a wave's course is taken to be noise, before that is known.
const SMALL: f32 = 1e-4;
/// What each step adds to it: this times the variance of a wave in the noise then known. After two steps it is that of a circle.
const HIDDEN: f32 = 9.0;
/// The most that it may become.
const MAX_SMALL: f32 = 0.25;
/// Gauss–Newton steps at most.
const MAX_STEPS: usize = 6;

/// The result of a fit.
#[derive(Debug, Clone, Default)]
pub(crate) struct Fit {
    pub waves: Waves,
    pub offsets: [f32; 2],
    /// |z|² of each raw pick-off: nothing for a dead one, whatever the calibration adds from the other.
    pub power: [f32; 2],
    /// Upper bound, squared, of the amplitude of each raw pick-off's wave within the window.
    pub reach: [f32; 2],
    /// The residual that the waves leave.
    pub remains: Remains,
    /// False when the steps did not settle.
    pub settled: bool,
}

impl Model {
    /// The carrier moved by `drift` rad per half window; `None` if that is too far, or a frequency that samples cannot show.
    fn moved(&self, drift: f32) -> Option<PhaseStep> {
        let moved = (drift.abs() <= MAX_DRIFT).then(|| self.carrier.shifted(drift * self.per_half));
        moved.filter(|carrier| {
            (self.layout.step.0 / MIN_CARRIER_DIVISOR..=MAX_CARRIER).contains(&carrier.0)
        })
    }

    /// The carrier moved to where `fit` sees the waves; `None` if they are nowhere near, or if noise hides them in a fit of all blocks.
    #[inline(never)]
    fn followed(&self, fit: &Fit, is_whole: bool) -> Option<PhaseStep> {
        let is_hidden = is_whole && self.drift_variance(fit) > MAX_DRIFT_VARIANCE;
        if is_hidden {
            None
        } else {
            self.moved(fit.waves.drift())
        }
    }

    /// Variance that noise gives the drift of the waves, rad² per half window squared.
    #[inline(never)]
    fn drift_variance(&self, fit: &Fit) -> f32 {
        let Covariance { even, odd } = &self.covariance;
        (even[1][1] + odd[1][1]) * fit.remains.variance() / fit.waves.power()
    }

    /// The number of blocks, of `count`, for which a carrier is good that was found by a fit of `span` of them.
    #[inline(never)]
    fn next_span(&self, fit: &Fit, carrier: PhaseStep, span: u16, count: u16) -> u16 {
        // Four standard deviations of the frequency.
        let uncertainty = 4.0 * square_root(self.drift_variance(fit)) * self.per_half;
        // One block more at a time, fits of zeros or noise would take as their count squared.
        let least = span.saturating_add(span / SLOWEST_GROWTH + 1);
        let next = reach(self, count, carrier, uncertainty).max(least);
        // A fit that would leave out a single block tells hardly less than one of all.
        if next < count.saturating_sub(1) {
            next
        } else {
            count
        }
    }

    /// Fits `blocks`, which are as many as the model was built for, into `fit`.
    #[inline(never)]
    fn fit(&self, blocks: &[Seen], fit: &mut Fit) {
        let mut gradients = gradient::of_sums(self, blocks);
        let mut parameters = Parameters::default();
        fit.offsets = [0.0; 2];
        self.step(&gradients, &mut parameters, fit);
        // If blocks have offsets of their own, the linear solution ignores what the waves add to the blocks' means.
        let mut knows_offset = self.shared > 0.0;
        let mut small = SMALL;
        for _ in 0..MAX_STEPS {
            fit.waves.choose_courses(small);
            examine(
                self,
                blocks,
                &fit.waves,
                &fit.offsets,
                &mut fit.remains,
                &mut gradients,
            );
            if knows_offset && self.is_futile(&gradients, fit) {
                fit.settled = true;
                break;
            }
            if self.step(&gradients, &mut parameters, fit) && knows_offset {
                break;
            }
            knows_offset = true;
            self.raise_small(fit, &mut small);
        }
        let Parameters { z, slope, .. } = &parameters;
        fit.power = z.map(|z| z.norm_sqr());
        for (i, reach) in fit.reach.iter_mut().enumerate() {
            // At least (|z| + |z′|)²: without a change this is half a per cent more than |z|.
            *reach = 1.01 * fit.power[i] + 101.0 * slope[i].norm_sqr();
        }
    }

    /// Raises the share of both waves' power up to which noise hides a wave's course: what noise makes of it would not settle, nor would a
    /// wave at the limit if that did not rise with every step.
    #[inline(never)]
    fn raise_small(&self, fit: &Fit, small: &mut f32) {
        let variance = self.drift_variance(fit);
        let [gain, share] = self.correction.noise_gains;
        // A level has a third of the variance of a slope.
        let hidden = HIDDEN / 3.0 * variance * (1.0 + gain * gain + share * share);
        *small = lesser(*small + hidden, MAX_SMALL);
    }

    /// True when the step that these gradients call for would be lost in the noise, and the noise is far below the wave.
    #[inline(never)]
    fn is_futile(&self, gradients: &[Gradient; 2], fit: &Fit) -> bool {
        let Covariance { even, odd } = &self.covariance;
        let (of_level, of_slope) = (even[0][0] + odd[0][0], even[1][1] + odd[1][1]);
        let of_mean = even[2][2] * self.response.offset * self.response.offset;
        let explained = gradients.iter().map(|Gradient { level, slope, mean }| {
            of_level * level.norm_sqr() + of_slope * slope.norm_sqr() + of_mean * mean * mean
        });
        // Correlated parameters may explain more than the sum of each alone, by a factor of up to their number.
        let explained = 3.0 * explained.sum::<f32>();
        let most = explained * fit.remains.freedom;
        let residual = fit.remains.residual;
        most <= FUTILE * residual && of_slope * residual <= fit.remains.freedom * fit.waves.power()
    }

    /// Moves to where the gradients vanish; true when no further step is needed.
    #[inline(never)]
    fn step(&self, gradients: &[Gradient; 2], parameters: &mut Parameters, fit: &mut Fit) -> bool {
        let step = Step::new(self, gradients);
        let [moved, explained] = parameters.take(&step, gradients, self);
        fit.waves.set(self, parameters);
        for (offset, by) in fit.offsets.iter_mut().zip(step.offset) {
            *offset += by;
        }
        let size = 0.5 * fit.waves.power();
        fit.settled = moved <= MAX_LAST_STEP * MAX_LAST_STEP * size;
        // The new residual has no part along the parameters: the step has taken this off it.
        let explained = lesser(explained, fit.remains.residual);
        fit.remains.residual -= explained;
        let left = explained * fit.remains.freedom * f32::from(self.blocks);
        let negligible = left <= NEGLIGIBLE * fit.remains.residual;
        // An offset far above the wave may move by so much that next to nothing of the residual seen is left.
        let is_seen = explained <= fit.remains.residual;
        fit.settled && (negligible || is_seen && moved <= SETTLED * SETTLED * size)
    }
}

/// Solves a run of blocks into `fit`, from a carrier known to `uncertainty` rad a sample.
///
/// A carrier too rough for the whole window is first refined in the middle of it: a single jump to a long window could slip a turn.
pub(crate) fn solve(
    model: &mut Model,
    blocks: &[Seen],
    mut carrier: PhaseStep,
    uncertainty: f32,
    fit: &mut Fit,
) {
    let count = blocks.len() as u16;
    let mut span = if uncertainty > 0.0 {
        reach(model, count, carrier, uncertainty)
    } else {
        count
    };
    let mut moves = 0;
    loop {
        model.retune(carrier, span);
        let skipped = usize::from((count - span) / 2);
        let part = blocks
            .get(skipped..skipped + usize::from(span))
            .unwrap_or(blocks);
        model.fit(part, fit);
        let is_whole = span == count;
        if is_whole && (fit.waves.drift().abs() <= CARRIER_REACH || moves >= 4) {
            return;
        }
        let Some(moved) = model.followed(fit, is_whole) else {
            // The wave is nowhere near: the caller gets a fit that did not settle.
            if !is_whole {
                model.retune(carrier, count);
                model.fit(blocks, fit);
            }
            fit.settled = false;
            return;
        };
        carrier = moved;
        if is_whole {
            moves += 1;
        } else {
            span = model.next_span(fit, carrier, span, count);
        }
    }
}

/// The number of blocks, of `count`, for which a carrier known to `uncertainty` rad a sample is good.
#[inline(never)]
fn reach(model: &Model, count: u16, carrier: PhaseStep, uncertainty: f32) -> u16 {
    let length = f32::from(model.layout.length);
    let whole = uncertainty * length;
    // At least 2.5 periods; the period of a carrier that noise has led towards zero may have any length.
    let shortest = (2.5 * carrier.period() / length + 1.0) as u16;
    ((1.0 / whole) as u16).max(shortest.max(3)).min(count)
}

#[cfg(test)]
mod tests {
    use num_complex::Complex32;

    use super::*;
    use crate::block::Layout;
    use crate::calibration::Calibration;

    #[test]
    fn a_carrier_near_zero_is_good_for_all_blocks() {
        let carrier = PhaseStep::from_period(2.79);
        let layout = Layout::unrounded(carrier, 1);
        let model = Model::new(layout, carrier, 11, Calibration::IDEAL, 1e5, false);
        for (step, blocks) in [(0, 11), (1, 11), (1 << 18, 11), (carrier.0, 7)] {
            assert_eq!(reach(&model, 11, PhaseStep(step), 0.3), blocks, "{step}");
        }
    }

    #[test]
    fn a_window_without_a_wave_is_fitted_in_few_spans() {
        let carrier = PhaseStep::from_period(18.75);
        let layout = Layout::unrounded(carrier, 37);
        let model = Model::new(layout, carrier, 3, Calibration::IDEAL, 1e5, false);
        // Of zeros the uncertainty is NaN.
        for (count, most) in [(5u16, 3), (50, 25), (500, 45), (u16::MAX, 90)] {
            let (mut span, mut spans) = (3, 1);
            while span < count {
                let next = model.next_span(&Fit::default(), carrier, span, count);
                assert!(next > span && next <= count, "{span}, {next}");
                (span, spans) = (next, spans + 1);
            }
            assert!(spans < most, "{count} blocks: {spans}");
        }
    }

    #[test]
    fn a_carrier_is_not_moved_to_a_frequency_that_samples_cannot_show() {
        // A window of six samples: 1.4 rad per half window are 0.074 turns a sample.
        for (period, drift, is_moved) in [
            (2.5, 0.6, true),
            (2.5, 1.4, false),
            (2.5, -1.4, true),
            (10.0, -0.9, true),
            (10.0, -1.1, false),
            (50.0, 1.4, true),
            (50.0, -1.4, false),
        ] {
            let carrier = PhaseStep::from_period(period);
            let layout = Layout::unrounded(carrier, 1);
            let model = Model::new(layout, carrier, 6, Calibration::IDEAL, 1e5, false);
            let moved = model.moved(drift);
            assert_eq!(moved.is_some(), is_moved, "{period}, {drift}: {moved:?}");
        }
    }

    #[test]
    fn what_noise_alone_moves_is_not_followed_in_a_fit_of_all_blocks() {
        let carrier = PhaseStep::from_period(18.75);
        let layout = Layout::unrounded(carrier, 37);
        let model = Model::new(layout, carrier, 5, Calibration::IDEAL, 1e5, false);
        let mut fit = Fit::default();
        fit.remains.freedom = model.freedom();
        fit.remains.residual = fit.remains.freedom;
        fit.waves.change[0].im = 0.3;
        // A deviation of the drift of 0.7 and of 0.35 rad per half window.
        let least = model.covariance.even[1][1] + model.covariance.odd[1][1];
        for (power, is_followed) in [(2.0 * least, false), (8.0 * least, true)] {
            fit.waves.value[0].re = square_root(power);
            assert_eq!(model.followed(&fit, true).is_some(), is_followed, "{power}");
            assert!(model.followed(&fit, false).is_some(), "{power}");
        }
    }

    #[test]
    fn a_futile_step_is_lost_in_the_noise() {
        let mut seed = 1u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        // A fifth of a period, two fifths, one and two, and windows of two periods and more.
        for (length, blocks) in [(4u16, 11u16), (8, 5), (19, 4), (37, 5), (37, 50)] {
            let carrier = PhaseStep::from_period(18.75);
            let layout = Layout::unrounded(carrier, length);
            let model = Model::new(layout, carrier, blocks, Calibration::IDEAL, 1e5, false);
            let (mut futile, mut others) = (0, 0);
            for i in 0..2000 {
                // From 10⁻⁶ of the noise's standard deviation up to all of it; in every other one the offset's part is next to nothing.
                let scale = square_root(f32::from(length) * f32::from(blocks))
                    * libm::powf(10.0, -6.0 * (i % 500) as f32 / 500.0);
                let share = if i % 2 == 0 { 1.0 } else { 1e-6 };
                let gradients = core::array::from_fn(|_| Gradient {
                    level: Complex32::new(random(), random()) * scale,
                    slope: Complex32::new(random(), random()) * scale,
                    mean: random() * scale * share,
                });
                let mut fit = Fit::default();
                fit.remains.freedom = model.freedom();
                fit.remains.residual = fit.remains.freedom;
                // A wave no greater than the noise of its own rate of change.
                let least = model.covariance.even[1][1] + model.covariance.odd[1][1];
                fit.waves.value[0].re = 1.001 * square_root(least);
                let is_futile = model.is_futile(&gradients, &fit);
                let step = Step::new(&model, &gradients);
                let [moved, explained] = Parameters::default().take(&step, &gradients, &model);
                if is_futile {
                    futile += 1;
                    assert!(explained <= FUTILE, "{length}, {blocks}: {explained}");
                    let size = 0.5 * fit.waves.power();
                    assert!(
                        moved <= MAX_LAST_STEP * MAX_LAST_STEP * size,
                        "{length}, {blocks}: {moved}"
                    );
                } else {
                    others += 1;
                    assert!(explained > 0.01 * FUTILE, "{length}, {blocks}: {explained}");
                }
                // A smaller wave may be at another frequency, which shows only in whether its steps settle.
                fit.waves.value[0].re *= 0.99;
                assert!(!model.is_futile(&gradients, &fit));
            }
            assert!(futile > 200 && others > 200, "{length}: {futile}, {others}");
        }
    }
}
