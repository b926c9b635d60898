//! Block sums become a window's waves: the exact least-squares fit over any run of blocks.
//!
//! Each pick-off is Re(z(t)·e^{jωt}) + d with a slowly changing z. About a carrier near ω it has five linear parameters, z, z′ and
//! d at the middle of the window, and both pick-offs share one 5×5 matrix that does not depend on the data. What is not linear,
//! the exponential course of the two travelling waves, is predicted exactly and fitted by Gauss–Newton steps on the rest.

use num_complex::Complex32;

use super::examine::{Remains, examine};
use super::model::Model;
use super::normal::Row;
use super::response::Whitened;
use super::seen::Seen;
use super::waves::{Course, Gains, Here, Mixing, Parameters, Waves};
use crate::arch::square_root;
use crate::phase::PhaseStep;

/// Beyond this phase (rad) between a window's middle and its end the carrier is moved before the fit is believed.
pub(crate) const CARRIER_REACH: f32 = 0.05;
/// A fit that still moves by more than this share of the wave has found nothing.
const NEAR: f32 = 0.01;
/// A step below this share of the wave leaves the next one below rounding: it is of second order.
const SETTLED: f32 = 1e-4;
/// Steps at most.
const STEPS: usize = 6;

/// What a fit found.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub waves: Waves,
    pub offsets: [f32; 2],
    /// What the waves leave unexplained.
    pub remains: Remains,
    /// False when the steps did not settle.
    pub settled: bool,
}

impl Fit {
    /// |z|² of each (ideal) pick-off.
    pub(crate) fn channel_power(&self) -> [f32; 2] {
        let [plus, minus] = self.waves.value;
        [
            0.25 * (plus + minus).norm_sqr(),
            0.25 * (plus - minus).norm_sqr(),
        ]
    }
}

/// Predicts the whitened sums of one pick-off.
pub(super) struct Prediction {
    mean: Gains,
    even: Gains,
    odd: Gains,
    offset: f32,
}

impl Prediction {
    pub(super) fn new(model: &Model, mixing: &Mixing, channel: usize, offset: f32) -> Self {
        let response = &model.response;
        Self {
            mean: mixing.even(channel, &response.mean),
            even: mixing.even(channel, &response.even),
            odd: mixing.odd(channel, &response.odd),
            offset: response.offset * offset,
        }
    }

    /// The sums less what is predicted here.
    #[inline(always)]
    pub(super) fn rest(&self, seen: &Whitened, here: &Here) -> Whitened {
        Whitened {
            mean: seen.mean - self.offset - self.mean.of(here),
            even: seen.even - self.even.of(here),
            odd: seen.odd - self.odd.of(here),
        }
    }
}

/// One pass over the blocks: the gradient of both pick-offs' parameters.
fn gradient<'a>(
    model: &Model,
    blocks: impl Iterator<Item = &'a Seen>,
    waves: &Waves,
    offset: [f32; 2],
) -> [Row; 2] {
    let response = &model.response;
    let mixing = Mixing::new(model, waves);
    let predictions: [Prediction; 2] =
        core::array::from_fn(|i| Prediction::new(model, &mixing, i, offset[i]));
    let mut course = Course::new(model, waves);
    let mut level = [Complex32::ZERO; 2];
    let mut slope = [Complex32::ZERO; 2];
    let mut mean = [0.0; 2];
    for block in blocks {
        let here = course.next();
        let back = here.unit.conj();
        for channel in 0..2 {
            let rest = predictions[channel].rest(&block.whitened[channel], &here);
            let along = Complex32::new(
                response.mean.level * rest.mean + response.even.level * rest.even,
                response.odd.level * rest.odd,
            ) * back;
            let across = Complex32::new(
                response.odd.slope * rest.odd,
                response.mean.slope * rest.mean + response.even.slope * rest.even,
            ) * back;
            level[channel] += along;
            // The block's own extent; scaled to half windows below.
            slope[channel] += along * (here.u * model.half()) + across;
            mean[channel] += rest.mean;
        }
    }
    let per_sample = 1.0 / model.half();
    core::array::from_fn(|i| {
        let slope = slope[i] * per_sample;
        [
            level[i].re,
            level[i].im,
            slope.re,
            slope.im,
            response.offset * mean[i],
        ]
    })
}

impl Model {
    /// Fits `blocks`, which are as many as the model was built for.
    fn fit<'a>(&self, blocks: impl Iterator<Item = &'a Seen> + Clone) -> Fit {
        let mut parameters = Parameters::default();
        let mut waves = Waves::default();
        let mut settled = false;
        for step in 0..STEPS {
            let gradient = gradient(self, blocks.clone(), &waves, parameters.offset);
            let mut moved = 0.0;
            let mut total = 0.0;
            for (channel, gradient) in gradient.into_iter().enumerate() {
                let change = self.normal.solve(gradient);
                let z = Complex32::new(change[0], change[1]);
                let slope = Complex32::new(change[2], change[3]);
                parameters.z[channel] += z;
                parameters.slope[channel] += slope;
                parameters.offset[channel] += change[4];
                moved += z.norm_sqr() + slope.norm_sqr();
                total += parameters.z[channel].norm_sqr();
            }
            waves = Waves::new(self, &parameters);
            settled = step > 0 && moved <= NEAR * NEAR * total;
            if settled && moved <= SETTLED * SETTLED * total {
                break;
            }
        }
        let remains = examine(self, blocks, &waves, parameters.offset);
        Fit {
            waves,
            offsets: parameters.offset,
            remains,
            settled,
        }
    }
}

/// Solves a run of blocks from a carrier known to `uncertainty` rad a sample.
///
/// A carrier too rough for the whole window is first refined in its middle: a single jump to a long window would slip a turn.
pub(crate) fn solve<'a>(
    model: &mut Model,
    blocks: impl Iterator<Item = &'a Seen> + Clone,
    count: u16,
    mut carrier: PhaseStep,
    mut uncertainty: f32,
) -> Fit {
    let length = f32::from(model.layout.length);
    let shortest = count
        .min((2.5 * carrier.period() / length) as u16 + 1)
        .max(count.min(4));
    let reach = |uncertainty: f32| {
        let blocks = 1.0 / (uncertainty * length + 1e-9);
        if blocks >= f32::from(count) {
            count
        } else {
            (blocks as u16).max(shortest)
        }
    };
    let mut span = reach(uncertainty);
    let mut moves = 0;
    loop {
        model.retune(carrier, span);
        let skipped = usize::from((count - span) / 2);
        let fit = model.fit(blocks.clone().skip(skipped).take(usize::from(span)));
        let drift = fit.waves.drift();
        if span == count && (drift.abs() <= CARRIER_REACH || moves >= 4) {
            return fit;
        }
        if drift.abs() > 1.5 || !drift.is_finite() {
            // The wave is nowhere near: the caller sees a fit that did not settle.
            model.retune(carrier, count);
            let fit = model.fit(blocks.clone().take(usize::from(count)));
            return Fit {
                settled: false,
                ..fit
            };
        }
        let half = model.half();
        carrier = carrier.shifted(drift / half);
        if span == count {
            moves += 1;
            continue;
        }
        // Four standard deviations of the frequency, from the bound.
        let noise = fit.remains.variance();
        let variance = 2.0 * noise * model.covariance[3][3] / fit.waves.power();
        uncertainty = 4.0 * square_root(variance) / half;
        span = reach(uncertainty).max(span + 1).min(count);
    }
}
