//! What a window's waves leave unexplained: the residual as a whole, by blocks, as a step, and about the third harmonic.

use super::course::{CHUNK, Course, bend, course};
use super::gradient::Gradient;
use super::hum::Hum;
use super::image;
use super::model::Model;
use super::prediction::Prediction;
use super::response::Response;
use super::seen::Seen;
use super::third::{Line, Thirds};
use super::waves::Waves;
use crate::scalar::{greater, lesser};

/// The residual of a fit, in several views. Squares are in input units squared.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Remains {
    /// Sum of the squared whitened residuals: noise of variance σ² a sample leaves `freedom`·σ². What only moves an offset that a block
    /// has to itself is not among them.
    pub residual: f32,
    pub freedom: f32,
    /// Mean square of what the blocks' own offsets are beyond that of the window, of each pick-off; 0 where they have none.
    pub wander: [f32; 2],
    /// The largest share of one block in `residual`: 6 degrees of freedom, or 4.
    pub worst_block: f32,
    /// The most that one step of both phasors between two blocks would take off `residual`: 4 degrees of freedom.
    pub step: f32,
    /// Squared amplitude of each pick-off's third harmonic, or the mean of that and of an image next to it.
    pub third: [f32; 2],
    /// Noise variance a sample seen about the third harmonic, and its degrees of freedom.
    pub third_noise: f32,
    pub third_freedom: f32,
    /// The same without the block that has the most of it: a fault in one block is not in it, but the third harmonic is.
    pub third_spared: f32,
    /// The same without an image of a harmonic.
    pub third_alone: f32,
}

impl Remains {
    /// Noise variance a sample, seen about the carrier.
    pub(crate) fn variance(&self) -> f32 {
        self.residual / self.freedom
    }
}

/// Passes over the blocks of a window with the waves and offsets found: what they leave, and which way they must still move.
///
/// What it calls is not inlined: it keeps only what one part needs of another, for its stack is the deepest of a window's solution.
#[inline(always)]
pub(super) fn examine(
    model: &Model,
    blocks: &[Seen],
    waves: &Waves,
    offsets: &[f32; 2],
    remains: &mut Remains,
    gradients: &mut [Gradient; 2],
) {
    let is_watched = blocks.first().is_some_and(Seen::is_watched);
    let mut thirds = Thirds::of(Line::Third);
    let mut image = if is_watched {
        image::of(model).map(Thirds::of)
    } else {
        None
    };
    let mut views = Views::new();
    let mut hum = Hum::new(&mut remains.wander);
    for (chunk, run) in blocks.chunks(CHUNK).enumerate() {
        let index = chunk * CHUNK;
        let mut course = course(model, waves, index);
        // A slope of no growth may be that of a steady wave: then it adds nothing.
        if waves.slope[0].re == 0.0 || waves.slope[1].re == 0.0 {
            bend(&mut course, model, waves, index, run.len());
        }
        let mut left = LeftOfBlocks::default();
        let mut prediction = Prediction::of_c(model, waves, offsets);
        take_rests(
            model,
            &mut prediction,
            (index, blocks),
            &course,
            &mut left,
            gradients,
            &mut hum,
        );
        views.take(model, index, &left, run.len());
        if is_watched {
            let factors = &prediction.factors;
            thirds.add(model, waves, offsets, factors, run, &course);
            if let Some(image) = &mut image {
                image.add(model, waves, offsets, factors, run, &course);
            }
        }
    }
    views.conclude(model, remains);
    if is_watched {
        thirds.conclude(model, remains);
        if let Some(image) = &image {
            image.take_out(&thirds, model, remains);
        }
    }
}

/// What is left of the sums of a run of blocks.
#[derive(Default)]
struct LeftOfBlocks {
    /// What both pick-offs leave beside the waves: the sum of the squares.
    power: [f32; CHUNK],
    /// The squared sums, from the first block to each, of what is left along z.
    run: [f32; CHUNK],
}

/// Takes what both pick-offs leave of the run of blocks from block `index` on, of all `blocks`, one after the other: the constants of one
/// stay in registers.
///
/// The sums are against the carrier in the middle of the last block taken, and that along z′ is in blocks before it: at the window's end
/// both become what they are about its middle.
#[inline(never)]
fn take_rests(
    model: &Model,
    prediction: &mut Prediction,
    (index, blocks): (usize, &[Seen]),
    course: &Course,
    left: &mut LeftOfBlocks,
    gradients: &mut [Gradient; 2],
    hum: &mut Hum<'_>,
) {
    let (shared, response) = (model.shared, model.response.in_blocks(model.blocks));
    let run = blocks.get(index..).unwrap_or(&[]);
    // Only residuals are turned by it: they have no digits to lose.
    let turn = model.turn;
    for (channel, gradient) in gradients.iter_mut().enumerate() {
        if channel > 0 {
            prediction.change_to_d();
        }
        if shared == 0.0 {
            hum.take(model, prediction, channel, (index, blocks), course);
        }
        let prediction = *prediction;
        let mut sums = if index == 0 {
            Gradient::default()
        } else {
            *gradient
        };
        let waves = course[0].iter().zip(&course[1]);
        let left = left.power.iter_mut().zip(&mut left.run).zip(&hum.within);
        for ((block, (&plus, &minus)), ((power, run), [slope, bend])) in
            run.iter().zip(waves).zip(left)
        {
            let mut rest = prediction.rest(&block.whitened[channel & 1], &[plus, minus]);
            rest.odd -= slope;
            rest.even -= bend;
            // Of an offset that the block has to itself the mean says nothing else.
            let known = shared * rest.mean;
            sums.slope = (sums.slope - sums.level) * turn + response.across(&rest, known);
            sums.level = sums.level * turn + response.along(&rest, known);
            sums.mean += rest.mean;
            *power += known * rest.mean + rest.even * rest.even + rest.odd * rest.odd;
            *run += sums.level.norm_sqr();
        }
        if run.len() <= CHUNK {
            // The last block lies as far behind the middle as the first before it.
            let last = 1.0 - 0.5 * model.advance;
            sums.slope = (sums.slope * model.advance + sums.level * last) * model.first;
            sums.level *= model.first;
        }
        *gradient = sums;
    }
}

/// The residual as a whole, by blocks, and as a step of the phasors between two blocks.
#[derive(Default)]
struct Views {
    residual: f32,
    worst_block: f32,
    /// The sum of the residuals up to a block, squared, and what noise would make it: where it is most beyond.
    run: f32,
    room: f32,
    time: f32,
}

impl Views {
    fn new() -> Self {
        Self {
            room: 1.0,
            ..Self::default()
        }
    }

    /// Σu² over the window, u being the blocks' middles.
    #[inline]
    fn spread(model: &Model) -> f32 {
        (1.0 / 3.0) * (f32::from(model.blocks) - 0.5 * model.advance)
    }

    /// Takes what `count` blocks from block `index` on leave.
    #[inline(never)]
    fn take(&mut self, model: &Model, index: usize, left: &LeftOfBlocks, count: usize) {
        let mut views = Self { ..*self };
        let mut u = model.time(index as u16);
        let spread = Self::spread(model);
        let least = 0.2 * spread;
        for (&power, &run) in left.power.iter().zip(&left.run).take(count) {
            views.residual += power;
            views.worst_block = greater(power, views.worst_block);
            views.time += u;
            u += model.advance;
            // A step is known by what of it is neither constant nor slope. After n blocks of N it is n − n²/N that is not constant: the
            // sum of their times, but for the sign.
            let room = -views.time * (spread + views.time);
            if room > least && run * views.room > views.run * room {
                (views.run, views.room) = (run, room);
            }
        }
        *self = views;
    }

    #[inline(never)]
    fn conclude(&self, model: &Model, remains: &mut Remains) {
        let Response {
            mean, even, odd, ..
        } = &model.response;
        // Mean weight of z in a block, over all phases of the carrier.
        let known = model.shared * mean.level;
        let weight = 0.5 * (known * mean.level + even.level * even.level + odd.level * odd.level);
        remains.residual = self.residual;
        remains.wander = remains.wander.map(|sum| sum * (0.5 * model.per_half));
        remains.freedom = model.freedom();
        remains.worst_block = self.worst_block;
        // No step takes off more than there is, but what rounding left of the gradients may seem to.
        let step = self.run * Self::spread(model) / (weight * self.room);
        remains.step = lesser(step, self.residual);
    }
}
