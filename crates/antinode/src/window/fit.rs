//! Block sums become a window's waves: the exact least-squares fit over any run of blocks.
//!
//! Each pick-off is Re(z(t)·e^{jωt}) + d with a slowly changing z. About a carrier near ω it has five linear parameters, z, z′ and
//! d at the middle of the window, and both pick-offs share one 5×5 matrix that does not depend on the data. What is not linear,
//! the exponential course of the two travelling waves, is predicted exactly and fitted by Gauss–Newton steps on the rest: the
//! linear solution comes first, and a wave that holds still leaves one step to do, in the pass that looks at its residual anyway.

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
pub(crate) const CARRIER_REACH: f32 = 0.05;
/// Beyond this phase the wave is nowhere near the carrier.
const FARTHEST: f32 = 1.5;
/// The highest carrier: 0.45 turns a sample. A known frequency is at most 0.42, and near half a turn both quadratures are one.
const HIGHEST: u32 = 1_932_735_283;
/// The lowest carrier is that of the blocks over this: in a window of two periods an offset that wanders would be a wave of next to none.
const LOWEST: u32 = 2;
/// A fit that still moves by more than this share of the wave has found nothing.
const NEAR: f32 = 0.01;
/// Below this share of the wave the next step is rounding. One of 10⁻⁶ that is not looked at stands out of the noise of 10⁵ samples.
const SETTLED: f32 = 2.5e-7;
/// What a step may take off the residual, in variances of the noise and divided by the blocks, before the residual is looked at anew:
/// what is not taken off looks like a step between the first block and the others, as many times as large as there are blocks.
const NEGLIGIBLE: f32 = 0.5;
/// A step that explains less than this share of the variance of the noise moves nothing by a hundredth of its standard deviation.
const FUTILE: f32 = 1e-4;
/// Steps at most.
const STEPS: usize = 6;

/// What a fit found.
#[derive(Debug, Clone, Default)]
pub(crate) struct Fit {
    pub waves: Waves,
    pub offsets: [f32; 2],
    /// |z|² of each raw pick-off: of one that is dead nothing is left, whatever a calibration adds of the other.
    pub power: [f32; 2],
    /// The greatest amplitude of each raw pick-off's wave within the window, squared, or a little more.
    pub reach: [f32; 2],
    /// What the waves leave unexplained.
    pub remains: Remains,
    /// False when the steps did not settle.
    pub settled: bool,
}

impl Model {
    /// The carrier moved by `drift` rad a half window; none where that is too far, or no frequency that samples can tell.
    #[inline(never)]
    fn moved(&self, drift: f32) -> Option<PhaseStep> {
        let moved = (drift.abs() <= FARTHEST).then(|| self.carrier.shifted(drift * self.per_half));
        moved.filter(|carrier| (self.layout.step.0 / LOWEST..=HIGHEST).contains(&carrier.0))
    }

    /// How many blocks of `count` a carrier is good for that a fit of `span` of them found.
    #[inline(never)]
    fn next_span(&self, fit: &Fit, carrier: PhaseStep, span: u16, count: u16) -> u16 {
        // Four standard deviations of the frequency, from the bound.
        let noise = fit.remains.variance();
        let variance = 2.0 * noise * self.covariance.even[1][1] / fit.waves.power();
        let uncertainty = 4.0 * square_root(variance) * self.per_half;
        reach(self, count, carrier, uncertainty).max(span + 1)
    }

    /// Fits `blocks`, which are as many as the model was built for, into `fit`.
    #[inline(never)]
    fn fit(&self, blocks: &[Seen], fit: &mut Fit) {
        let mut gradients = gradient::of_sums(self, blocks);
        let mut parameters = Parameters::default();
        fit.offsets = [0.0; 2];
        self.step(&gradients, &mut parameters, fit);
        // With offsets of their own the linear solution does not know what the waves put into the blocks' means.
        let mut knows_offset = self.shared > 0.0;
        for _ in 0..STEPS {
            fit.waves.take_course();
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
        }
        let Parameters { z, slope, .. } = &parameters;
        fit.power = z.map(|z| z.norm_sqr());
        for (i, reach) in fit.reach.iter_mut().enumerate() {
            // (|z| + |z′|)² is not more than that: half a per cent of |z| more where nothing changes.
            *reach = 1.01 * fit.power[i] + 101.0 * slope[i].norm_sqr();
        }
    }

    /// True when a step from where these are the gradients would be lost in the noise, and that is far below the wave.
    #[inline(never)]
    fn is_futile(&self, gradients: &[Gradient; 2], fit: &Fit) -> bool {
        let Covariance { even, odd } = &self.covariance;
        let (of_level, of_slope) = (even[0][0] + odd[0][0], even[1][1] + odd[1][1]);
        let of_mean = even[2][2] * self.response.offset * self.response.offset;
        let explained = gradients.iter().map(|Gradient { level, slope, mean }| {
            of_level * level.norm_sqr() + of_slope * slope.norm_sqr() + of_mean * mean * mean
        });
        // Parameters that depend on each other explain up to as many times more as there are of them.
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
        fit.settled = moved <= NEAR * NEAR * size;
        // What is left has no part along the parameters: this much less than before the step.
        let explained = lesser(explained, fit.remains.residual);
        fit.remains.residual -= explained;
        let left = explained * fit.remains.freedom * f32::from(self.blocks);
        let negligible = left <= NEGLIGIBLE * fit.remains.residual;
        fit.settled && (negligible || moved <= SETTLED * SETTLED * size)
    }
}

/// Solves a run of blocks into `fit`, from a carrier known to `uncertainty` rad a sample.
///
/// A carrier too rough for the whole window is first refined in its middle: a single jump to a long window would slip a turn.
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
        let drift = fit.waves.drift();
        if span == count && (drift.abs() <= CARRIER_REACH || moves >= 4) {
            return;
        }
        let Some(moved) = model.moved(drift) else {
            // The wave is nowhere near: the caller sees a fit that did not settle.
            model.retune(carrier, count);
            model.fit(blocks, fit);
            fit.settled = false;
            return;
        };
        carrier = moved;
        if span == count {
            moves += 1;
        } else {
            span = model.next_span(fit, carrier, span, count);
        }
    }
}

/// How many blocks of `count` a carrier known to `uncertainty` rad a sample is good for.
#[inline(never)]
fn reach(model: &Model, count: u16, carrier: PhaseStep, uncertainty: f32) -> u16 {
    let length = f32::from(model.layout.length);
    let whole = uncertainty * length;
    // A carrier that noise has led to nothing has a period of any length.
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
    fn a_carrier_of_nothing_is_good_for_any_number_of_blocks() {
        let carrier = PhaseStep::from_period(2.79);
        let layout = Layout::unrounded(carrier, 1);
        let model = Model::new(layout, carrier, 11, Calibration::IDEAL, 1e5, false);
        for (step, blocks) in [(0, 11), (1, 11), (1 << 18, 11), (carrier.0, 7)] {
            assert_eq!(reach(&model, 11, PhaseStep(step), 0.3), blocks, "{step}");
        }
    }

    #[test]
    fn a_carrier_is_moved_to_no_frequency_that_samples_cannot_tell() {
        // A window of six samples: 1.4 rad a half of it are 0.074 turns a sample.
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
                // From 10⁻⁶ of the noise's deviation to that; of every other one the offset's part is next to nothing.
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
                    assert!(moved <= NEAR * NEAR * size, "{length}, {blocks}: {moved}");
                } else {
                    others += 1;
                    assert!(explained > 0.01 * FUTILE, "{length}, {blocks}: {explained}");
                }
                // A lesser wave may be at another frequency: whether its steps settle tells.
                fit.waves.value[0].re *= 0.99;
                assert!(!model.is_futile(&gradients, &fit));
            }
            assert!(futile > 200 && others > 200, "{length}: {futile}, {others}");
        }
    }
}
