//! Block sums become a window's waves: the exact least-squares fit over any run of blocks.
//!
//! Each pick-off is Re(z(t)·e^{jωt}) + d with a slowly changing z. About a carrier near ω it has five linear parameters, z, z′ and
//! d at the middle of the window, and both pick-offs share one 5×5 matrix that does not depend on the data. What is not linear,
//! the exponential course of the two travelling waves, is predicted exactly and fitted by Gauss–Newton steps on the rest.

use num_complex::Complex32;

use super::course::{CHUNK, Here};
use super::examine::{Remains, examine};
use super::gradient::gradient;
use super::model::Model;
use super::seen::Seen;
use super::waves::{Parameters, Waves};
use crate::arch::square_root;
use crate::phase::PhaseStep;

/// Beyond this phase (rad) between a window's middle and its end the carrier is moved before the fit is believed.
pub(crate) const CARRIER_REACH: f32 = 0.05;
/// A fit that still moves by more than this share of the wave has found nothing.
const NEAR: f32 = 0.01;
/// Below this share of the wave the next step is rounding.
const SETTLED: f32 = 1e-8;
/// Below this share of the scatter's variance the next step does not matter.
const NEGLIGIBLE: f32 = 0.1;
/// Steps at most.
const STEPS: usize = 6;

/// What a fit found.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// What the waves' phases are counted from.
    pub carrier: PhaseStep,
    pub waves: Waves,
    pub offsets: [f32; 2],
    /// What the waves leave unexplained.
    pub remains: Remains,
    /// False when the steps did not settle.
    pub settled: bool,
}

impl Fit {
    /// What the next fit may begin with.
    pub(crate) fn last(&self) -> Last {
        Last {
            carrier: self.carrier,
            waves: self.waves,
            offsets: self.offsets,
        }
    }

    /// |z|² of each (ideal) pick-off.
    pub(crate) fn channel_power(&self) -> [f32; 2] {
        let [plus, minus] = self.waves.value;
        [
            0.25 * (plus + minus).norm_sqr(),
            0.25 * (plus - minus).norm_sqr(),
        ]
    }
}

/// What is kept of a fit to begin the next one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Last {
    carrier: PhaseStep,
    waves: Waves,
    offsets: [f32; 2],
}

/// Where a fit begins.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Start {
    parameters: Parameters,
    /// True when the parameters are those that the window before promises.
    is_promised: bool,
    /// Variance of the noise a sample, where it is known.
    noise: f32,
}

impl Start {
    /// Where the waves of `last` will be `half_samples` later; nothing promised where that is too far.
    pub(crate) fn after(model: &Model, last: &Last, half_samples: u64, noise: f32) -> Self {
        let later = 0.5 * half_samples.min(1 << 24) as u32 as f32;
        if later > 3.0 * model.half() || last.carrier != model.carrier {
            return Self::default();
        }
        let turn = model.carrier.after_half_samples(half_samples as i64).unit();
        let [z, slope] = last.waves.parameters(model, later, turn);
        Self {
            parameters: Parameters {
                z,
                slope,
                offset: last.offsets,
            },
            is_promised: true,
            noise,
        }
    }
}

impl Model {
    /// Fits `blocks`, which are as many as the model was built for.
    #[inline(never)]
    fn fit(&self, blocks: &[Seen], start: &Start) -> Fit {
        let mut parameters = start.parameters;
        let mut waves = if start.is_promised {
            Waves::new(self, &parameters)
        } else {
            Waves::default()
        };
        let mut settled = false;
        let mut here = [Here::default(); CHUNK];
        for step in 0..STEPS {
            let gradient = gradient(self, blocks, &waves, parameters.offset, &mut here);
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
            settled = (step > 0 || start.is_promised) && moved <= NEAR * NEAR * total;
            // What a step leaves is its product with what is not linear: the step itself and the course.
            let left = moved * (moved + waves.reach() * total);
            let scatter = NEGLIGIBLE * start.noise * self.covariance[0][0];
            if settled && left <= total * (SETTLED * SETTLED * total + scatter) {
                break;
            }
        }
        let remains = examine(self, blocks, &waves, parameters.offset, &mut here);
        Fit {
            carrier: self.carrier,
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
pub(crate) fn solve(
    model: &mut Model,
    blocks: &[Seen],
    mut carrier: PhaseStep,
    mut uncertainty: f32,
    start: Start,
) -> Fit {
    let count = blocks.len() as u16;
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
    let before = model.carrier;
    loop {
        model.retune(carrier, span);
        let skipped = usize::from((count - span) / 2);
        let part = blocks
            .get(skipped..skipped + usize::from(span))
            .unwrap_or(blocks);
        let is_first = moves == 0 && span == count && carrier == before;
        let start = if is_first { start } else { Start::default() };
        let fit = model.fit(part, &start);
        let drift = fit.waves.drift();
        if span == count && (drift.abs() <= CARRIER_REACH || moves >= 4) {
            return fit;
        }
        if drift.abs() > 1.5 || !drift.is_finite() {
            // The wave is nowhere near: the caller sees a fit that did not settle.
            model.retune(carrier, count);
            let fit = model.fit(blocks, &Start::default());
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
