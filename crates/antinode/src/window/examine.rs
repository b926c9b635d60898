//! The residual that a window's waves leave: as a whole, by blocks, as a step, and about the third harmonic.

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
    /// Sum of the squared whitened residuals: noise of variance σ² a sample leaves `freedom`·σ². What only moves a block's own offset is
    /// not part of it.
    pub residual: f32,
    pub freedom: f32,
    /// Mean square of the blocks' own offsets about the window's, for each pick-off; 0 if they have none.
    pub wander: [f32; 2],
    /// The largest share of one block in `residual`: 6 degrees of freedom, or 4 if blocks have offsets of their own.
    pub worst_block: f32,
    /// The most that one step of both phasors between two blocks would take off `residual`: 4 degrees of freedom.
    pub step: f32,
    /// Squared amplitude of each pick-off's third harmonic, or its mean with that of an image next to it.
    pub third: [f32; 2],
    /// Noise variance a sample about the third harmonic, and its degrees of freedom.
    pub third_noise: f32,
    pub third_freedom: f32,
    /// The same without the block that has the most: free of a fault in one block, but not of the third harmonic itself.
    pub third_without_worst: f32,
    /// The same as `third_noise`, without an image of a harmonic.
    pub third_without_image: f32,
}

impl Remains {
    /// Noise variance a sample about the carrier.
    pub(crate) fn variance(&self) -> f32 {
        self.residual / self.freedom
    }
}

/// Passes over the blocks of a window with the waves and offsets found, for their residual and for the gradients along which they must
/// still move.
///
/// Its parts are not inlined, so that it keeps only what they need of each other: its stack is the deepest of a window's solution.
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
        // A slope without growth may also be that of a steady wave, to which this adds nothing.
        if waves.slope[0].re == 0.0 || waves.slope[1].re == 0.0 {
            bend(&mut course, model, waves, index, run.len());
        }
        let mut residuals = Residuals::default();
        let mut prediction = Prediction::of_c(model, waves, offsets);
        take_residuals(
            model,
            &mut prediction,
            (index, blocks),
            &course,
            &mut residuals,
            gradients,
            &mut hum,
        );
        views.take(model, index, &residuals, run.len());
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

/// The residuals of a run of blocks.
#[derive(Default)]
struct Residuals {
    /// Sum of the squared residuals of both pick-offs, for each block.
    power: [f32; CHUNK],
    /// Squared running sums, from the window's first block to each, of both pick-offs' residuals along z.
    run: [f32; CHUNK],
}

/// Takes the residuals of the run of blocks from block `index` on, of all `blocks`, for one pick-off after the other, whose constants stay
/// in registers.
///
/// The sums refer to the phase and time of the last block taken, in blocks; at the window's end they are moved to its middle.
#[inline(never)]
fn take_residuals(
    model: &Model,
    prediction: &mut Prediction,
    (index, blocks): (usize, &[Seen]),
    course: &Course,
    residuals: &mut Residuals,
    gradients: &mut [Gradient; 2],
    hum: &mut Hum<'_>,
) {
    let (shared, response) = (model.shared, model.response.in_blocks(model.blocks));
    let run = blocks.get(index..).unwrap_or(&[]);
    // The recursion turns only residuals, which have no digits to lose.
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
        let residuals = residuals
            .power
            .iter_mut()
            .zip(&mut residuals.run)
            .zip(&hum.within);
        for ((block, (&plus, &minus)), ((power, run), [slope, bend])) in
            run.iter().zip(waves).zip(residuals)
        {
            let mut residual = prediction.residual(&block.whitened[channel & 1], &[plus, minus]);
            residual.odd -= slope;
            residual.even -= bend;
            // If the block has an offset of its own, its mean says nothing but that.
            let known = shared * residual.mean;
            sums.slope = (sums.slope - sums.level) * turn + response.across(&residual, known);
            sums.level = sums.level * turn + response.along(&residual, known);
            sums.mean += residual.mean;
            *power +=
                known * residual.mean + residual.even * residual.even + residual.odd * residual.odd;
            *run += sums.level.norm_sqr();
        }
        if run.len() <= CHUNK {
            // The last block lies as far after the middle as the first lies before it.
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
    /// Squared sum of the residuals up to a block, and its expectation in noise but for a factor, at the block where their ratio is
    /// highest.
    run: f32,
    expected: f32,
    time: f32,
}

impl Views {
    fn new() -> Self {
        Self {
            expected: 1.0,
            ..Self::default()
        }
    }

    /// Σu² over the window, u being the blocks' middles.
    #[inline]
    fn spread(model: &Model) -> f32 {
        (1.0 / 3.0) * (f32::from(model.blocks) - 0.5 * model.advance)
    }

    /// Takes the residuals of `count` blocks from block `index` on.
    #[inline(never)]
    fn take(&mut self, model: &Model, index: usize, residuals: &Residuals, count: usize) {
        let mut views = Self { ..*self };
        let mut u = model.time(index as u16);
        let spread = Self::spread(model);
        let least = 0.2 * spread;
        for (&power, &run) in residuals.power.iter().zip(&residuals.run).take(count) {
            views.residual += power;
            views.worst_block = greater(power, views.worst_block);
            views.time += u;
            u += model.advance;
            // Only that part of a step counts which is neither a constant nor a slope. Of a step after n of N blocks, n − n²/N is not
            // constant: the sum of their times, but for the sign.
            let expected = -views.time * (spread + views.time);
            if expected > least && run * views.expected > views.run * expected {
                (views.run, views.expected) = (run, expected);
            }
        }
        *self = views;
    }

    #[inline(never)]
    fn conclude(&self, model: &Model, remains: &mut Remains) {
        let Response {
            mean, even, odd, ..
        } = &model.response;
        // Mean weight of z in a block over all phases of the carrier.
        let known = model.shared * mean.level;
        let weight = 0.5 * (known * mean.level + even.level * even.level + odd.level * odd.level);
        remains.residual = self.residual;
        remains.wander = remains.wander.map(|sum| sum * (0.5 * model.per_half));
        remains.freedom = model.freedom();
        remains.worst_block = self.worst_block;
        // No step takes off more than there is, though rounding errors of the gradients may make it seem so.
        let step = self.run * Self::spread(model) / (weight * self.expected);
        remains.step = lesser(step, self.residual);
    }
}
