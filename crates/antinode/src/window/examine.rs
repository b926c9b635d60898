//! What a window's waves leave unexplained: the residual as a whole, by blocks, as a step, and about the third harmonic.

use num_complex::Complex32;

use super::course::{CHUNK, Chunk, Course, Here};
use super::model::Model;
use super::prediction::{Mixing, Prediction};
use super::response::Response;
use super::seen::Seen;
use super::third::Thirds;
use super::waves::Waves;

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
    blocks: &[Seen],
    waves: &Waves,
    offsets: [f32; 2],
    here: &mut Chunk,
) -> Remains {
    let mixing = Mixing::new(model, waves);
    let predictions = Prediction::new(model, &mixing, offsets);
    let is_watched = blocks.first().is_some_and(|block| block.watched.is_some());
    let mut thirds = is_watched.then(|| Thirds::new(model, &mixing, offsets));
    let mut course = Course::new(model, waves);
    let mut steps = Steps::new(model.blocks, &model.response);
    let (mut residual, mut worst_block, mut worst_step) = (0.0, 0.0, 0.0);
    let mut sums = [Complex32::ZERO; 2];
    for chunk in blocks.chunks(CHUNK) {
        let here = here.get_mut(..chunk.len()).unwrap_or_default();
        course.next(here);
        let mut rests = [Rest::default(); CHUNK];
        for (channel, prediction) in predictions.iter().enumerate() {
            let sum = &mut sums[channel];
            rest(model, prediction, channel, chunk, here, sum, &mut rests);
        }
        for (rest, here) in rests.iter().zip(&*here) {
            residual += rest.power;
            if rest.power > worst_block {
                worst_block = rest.power;
            }
            let step = steps.explained(here.u, rest.run);
            if step > worst_step {
                worst_step = step;
            }
        }
        if let Some(thirds) = &mut thirds {
            thirds.add(chunk, here);
        }
    }
    let mut remains = Remains {
        residual,
        freedom: model.freedom(),
        worst_block,
        step: worst_step,
        ..Remains::default()
    };
    if let Some(thirds) = thirds {
        thirds.conclude(&mut remains, f32::from(model.layout.length));
    }
    remains
}

/// What a block leaves, of both pick-offs.
#[derive(Debug, Clone, Copy, Default)]
struct Rest {
    /// Sum of the squares.
    power: f32,
    /// The squared sums, from the first block to this one, of what is left along z.
    run: f32,
}

/// Adds what one pick-off leaves of a run of blocks: one at a time, so that its constants stay in registers.
#[inline(never)]
fn rest(
    model: &Model,
    prediction: &Prediction,
    channel: usize,
    blocks: &[Seen],
    here: &[Here],
    sum: &mut Complex32,
    rests: &mut [Rest],
) {
    let Response {
        mean, even, odd, ..
    } = model.response;
    let prediction = *prediction;
    let mut run = *sum;
    for ((block, here), out) in blocks.iter().zip(here).zip(rests) {
        let rest = prediction.rest(&block.whitened[channel & 1], here);
        out.power += rest.mean * rest.mean + rest.even * rest.even + rest.odd * rest.odd;
        let along = Complex32::new(
            mean.level * rest.mean + even.level * rest.even,
            odd.level * rest.odd,
        );
        run += along * here.unit.conj();
        out.run += run.norm_sqr();
    }
    *sum = run;
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
        }
    }

    /// Goes on to the next block, at time `u`; gives what a step after it would explain, from the squared run of the residuals.
    fn explained(&mut self, u: f32, run: f32) -> f32 {
        self.count += 1.0;
        self.time += u;
        // A step is known by what of it is neither constant nor slope.
        let room = self.count
            - self.count * self.count * self.per_block
            - self.time * self.time * self.per_spread;
        if room > 0.2 {
            run / (self.weight * room)
        } else {
            0.0
        }
    }
}
