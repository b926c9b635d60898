//! What a window's waves leave unexplained: the residual as a whole, by blocks, as a step, and about the third harmonic.

use num_complex::Complex32;

use super::fit::{Blocks, Prediction};
use super::model::Model;
use super::response::Response;
use super::waves::{Course, Gains, Here, Mixing, Waves};

/// The residual of a fit, in several views. Squares are in input units squared.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Remains {
    /// Sum of the squared whitened residuals: noise of variance σ² a sample leaves `freedom`·σ².
    pub residual: f32,
    pub freedom: f32,
    /// The largest share of one block in `residual`: 6 degrees of freedom.
    pub worst_block: f32,
    /// The most that one step of both phasors between two blocks would take off `residual`: 4 degrees of freedom.
    pub step: f32,
    /// Third harmonic of each pick-off: complex amplitude, input units.
    pub third: [Complex32; 2],
    /// Noise variance a sample seen about the third harmonic, and its degrees of freedom.
    pub third_noise: f32,
    pub third_freedom: f32,
}

impl Remains {
    /// Noise variance a sample, seen about the carrier.
    pub(crate) fn variance(&self) -> f32 {
        self.residual / self.freedom
    }
}

/// Passes once more over the blocks of a window, with its final waves and offsets.
#[inline(never)]
pub(super) fn examine(
    model: &Model,
    blocks: Blocks<'_>,
    waves: &Waves,
    offsets: [f32; 2],
) -> Remains {
    let response = &model.response;
    let mixing = Mixing::new(model, waves);
    let predictions = Prediction::new(model, &mixing, offsets);
    let thirds = Third::new(model, &mixing, offsets);
    let mut course = Course::new(model, waves);
    let mut steps = Steps::new(model.blocks, response);
    let (mut residual, mut worst_block, mut worst_step) = (0.0, 0.0, 0.0);
    let (mut third, mut third_power, mut watched) = ([Complex32::ZERO; 2], 0.0, 0u16);
    for block in blocks.iter() {
        let here = course.next();
        let back = here.unit.conj();
        let along = |channel: usize| {
            let rest = predictions[channel].rest(&block.whitened[channel], &here);
            let power = rest.mean * rest.mean + rest.even * rest.even + rest.odd * rest.odd;
            let along = Complex32::new(
                response.mean.level * rest.mean + response.even.level * rest.even,
                response.odd.level * rest.odd,
            );
            (power, along * back)
        };
        let (c, d) = (along(0), along(1));
        let power = c.0 + d.0;
        residual += power;
        if power > worst_block {
            worst_block = power;
        }
        let step = steps.add(here.u, [c.1, d.1]);
        if step > worst_step {
            worst_step = step;
        }
        if let Some(seen) = &block.watched {
            let back_third = back * back * back;
            let rest = |channel: usize| thirds[channel].rest(seen.third[channel], &here);
            let (c, d) = (rest(0), rest(1));
            third[0] += c * back_third;
            third[1] += d * back_third;
            third_power += c.norm_sqr() + d.norm_sqr();
            watched += 1;
        }
    }
    let length = f32::from(model.layout.length);
    let count = f32::from(watched.max(1));
    let coherent = (third[0].norm_sqr() + third[1].norm_sqr()) / count;
    let third_freedom = 4.0 * f32::from(watched.saturating_sub(1));
    let incoherent = if third_power > coherent {
        third_power - coherent
    } else {
        0.0
    };
    Remains {
        residual,
        freedom: model.freedom(),
        worst_block,
        step: worst_step,
        third: third.map(|sum| sum * (2.0 / (count * length))),
        third_noise: incoherent / (0.5 * length * third_freedom.max(1.0)),
        third_freedom,
    }
}

/// Predicts the third-harmonic sums of one pick-off: what the wave itself puts there in blocks that do not fit its period.
struct Third {
    cosine: Gains,
    sine: Gains,
    offset: f32,
}

impl Third {
    fn new(model: &Model, mixing: &Mixing, offsets: [f32; 2]) -> [Self; 2] {
        let response = &model.response;
        let [cosine_c, cosine_d] = mixing.even(&response.third_even);
        let [sine_c, sine_d] = mixing.odd(&response.third_odd);
        let [offset_c, offset_d] = offsets.map(|offset| response.third_offset * offset);
        [
            Self {
                cosine: cosine_c,
                sine: sine_c,
                offset: offset_c,
            },
            Self {
                cosine: cosine_d,
                sine: sine_d,
                offset: offset_d,
            },
        ]
    }
}

impl Third {
    /// The sums less what is predicted here: Σ S e^(−3jφ).
    #[inline(always)]
    fn rest(&self, seen: Complex32, here: &Here) -> Complex32 {
        Complex32::new(
            seen.re - self.offset - self.cosine.of(here),
            self.sine.of(here) - seen.im,
        )
    }
}

/// Looks for a step of the phasors between two blocks: the sum of the residuals so far, against what noise would make it.
struct Steps {
    /// Mean weight of z in a block, over all phases of the carrier.
    weight: f32,
    /// 1/Σu² over the window, u being the blocks' middles; and one over the blocks.
    per_spread: f32,
    per_block: f32,
    count: f32,
    time: f32,
    sum: [Complex32; 2],
}

impl Steps {
    fn new(blocks: u16, response: &Response) -> Self {
        let levels = [response.mean, response.even, response.odd].map(|answer| answer.level);
        let blocks = f32::from(blocks);
        Self {
            weight: 0.5 * levels.iter().map(|level| level * level).sum::<f32>(),
            per_spread: 3.0 / (blocks - 1.0 / blocks),
            per_block: 1.0 / blocks,
            count: 0.0,
            time: 0.0,
            sum: [Complex32::ZERO; 2],
        }
    }

    /// Takes the next block's residual along z; gives what a step after it would explain.
    fn add(&mut self, u: f32, along: [Complex32; 2]) -> f32 {
        self.count += 1.0;
        self.time += u;
        self.sum[0] += along[0];
        self.sum[1] += along[1];
        // A step is known by what of it is neither constant nor slope.
        let room = self.count
            - self.count * self.count * self.per_block
            - self.time * self.time * self.per_spread;
        let power = self.sum[0].norm_sqr() + self.sum[1].norm_sqr();
        if room > 0.2 {
            power / (self.weight * room)
        } else {
            0.0
        }
    }
}
