//! Hum in a window whose blocks have offsets of their own: what moves these offsets also runs within each block.

use num_complex::Complex32;

use super::course::{CHUNK, Course};
use super::model::Model;
use super::prediction::Prediction;
use super::seen::Seen;

/// The offsets of a window's blocks about the window's own.
pub(super) struct Hum<'a> {
    /// Sum of their squares, for each pick-off.
    wander: &'a mut [f32; 2],
    /// What their slopes add to the odd sums, and their bends to the even ones, of the present pick-off and run of blocks.
    pub within: [[f32; 2]; CHUNK],
}

impl<'a> Hum<'a> {
    /// Before the first block; the sums of squares are gathered in `wander`.
    pub fn new(wander: &'a mut [f32; 2]) -> Self {
        *wander = [0.0; 2];
        Self {
            wander,
            within: [[0.0; 2]; CHUNK],
        }
    }

    /// Takes the run of blocks of pick-off `channel` from block `index` on, of all `blocks`.
    ///
    /// The slope within a block is that between its neighbours' offsets, less what the wave adds to them. For a window's first and last
    /// block it is that of the least-squares parabola through four: as noisy as a straight line through two, and exact to one order more.
    #[cold]
    #[inline(never)]
    pub fn take(
        &mut self,
        model: &Model,
        prediction: &Prediction,
        channel: usize,
        (index, blocks): (usize, &[Seen]),
        course: &Course,
    ) {
        let channel = channel & 1;
        // From the block before the run to the one after it.
        let mut residuals = [0.0; CHUNK + 2];
        for (i, residual) in residuals.iter_mut().enumerate() {
            if let Some(block) = blocks.get((index + i).wrapping_sub(1)) {
                let waves = course.each_ref().map(|wave| wave_at(wave, i));
                *residual = offset(prediction, block, channel, &waves);
            }
        }
        self.wander[channel] += residuals[1..=CHUNK]
            .iter()
            .map(|residual| residual * residual)
            .sum::<f32>();
        let [before, a, b, c, d, e, after] = &mut residuals;
        if index == 0 {
            *before = *b - slope_at_first([*a, *b, *c, *d]);
        }
        let left = blocks.len() - index.min(blocks.len());
        if left == CHUNK {
            *after = *d - slope_at_first([*e, *d, *c, *b]);
        } else if let Some([before, now, after]) = residuals
            .get_mut(left.saturating_sub(1)..)
            .and_then(<[f32]>::first_chunk_mut)
        {
            // At the end of a short last run: on the straight line through two.
            *after = 2.0 * *now - *before;
        }
        for (within, neighbours) in self.within.iter_mut().zip(residuals.windows(3)) {
            let (from, to) = (neighbours[1] - neighbours[0], neighbours[2] - neighbours[1]);
            *within = [
                model.basis.ramp * (to + from),
                model.basis.bow * (to - from),
            ];
        }
    }
}

/// A wave at place `i` of the run, counted from the block before it.
#[cold]
#[inline(never)]
fn wave_at(wave: &[Complex32; CHUNK], i: usize) -> Complex32 {
    let &[first, second, .., last_but_one, last] = wave;
    match wave.get(i.wrapping_sub(1)) {
        Some(&wave) => wave,
        None if i == 0 => continued(second, first),
        None => continued(last_but_one, last),
    }
}

/// A wave one block after `last`, from its course between the two.
#[cold]
#[inline(never)]
fn continued(before: Complex32, last: Complex32) -> Complex32 {
    let square = before.norm_sqr();
    if square > 0.0 {
        // Without a third power, which exceeds f32 for a large wave.
        last * (last * before.conj() / square)
    } else {
        last
    }
}

/// The offset of a block with these waves, as its whitened mean shows it.
#[cold]
#[inline(never)]
fn offset(prediction: &Prediction, block: &Seen, channel: usize, waves: &[Complex32; 2]) -> f32 {
    prediction.mean_residual(&block.whitened[channel & 1], waves)
}

/// The slope, over two blocks, at the first of four offsets.
fn slope_at_first([a, b, c, d]: [f32; 4]) -> f32 {
    1.3 * b + 1.7 * c - 2.1 * a - 0.9 * d
}
