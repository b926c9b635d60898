//! What hum does to a window whose blocks have offsets of their own: hum that moves these also runs within each block.

use num_complex::Complex32;

use super::course::{CHUNK, Course};
use super::model::Model;
use super::prediction::Prediction;
use super::seen::Seen;

/// The offsets of a window's blocks beyond its own.
pub(super) struct Hum<'a> {
    /// The sum of their squares, of each pick-off.
    wander: &'a mut [f32; 2],
    /// What their slopes add to the odd sums of the pick-off and the run of blocks looked at, and their bends to the even ones.
    pub within: [[f32; 2]; CHUNK],
}

impl<'a> Hum<'a> {
    /// None taken yet: the sum of the squares is to be in `wander`.
    pub fn new(wander: &'a mut [f32; 2]) -> Self {
        *wander = [0.0; 2];
        Self {
            wander,
            within: [[0.0; 2]; CHUNK],
        }
    }

    /// Takes the run of blocks of pick-off `channel` from block `index` on, of all `blocks`.
    ///
    /// The slope of a block is that between its neighbours' offsets, less what the wave puts there; of a window's first and last block it is
    /// that of the parabola of least squares through four: as noisy as a straight line through two, and exact to one order more.
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
        // From the block before the run to that after it.
        let mut rests = [0.0; CHUNK + 2];
        for (i, rest) in rests.iter_mut().enumerate() {
            if let Some(block) = blocks.get((index + i).wrapping_sub(1)) {
                let waves = course.each_ref().map(|wave| beside(wave, i));
                *rest = offset(prediction, block, channel, &waves);
            }
        }
        self.wander[channel] += rests[1..=CHUNK].iter().map(|rest| rest * rest).sum::<f32>();
        let [before, a, b, c, d, e, after] = &mut rests;
        if index == 0 {
            *before = *b - slope_at_first([*a, *b, *c, *d]);
        }
        let left = blocks.len() - index.min(blocks.len());
        if left == CHUNK {
            *after = *d - slope_at_first([*e, *d, *c, *b]);
        } else if let Some([before, now, after]) = rests
            .get_mut(left.saturating_sub(1)..)
            .and_then(<[f32]>::first_chunk_mut)
        {
            // In a window's last run, if it is short, on the straight line through two.
            *after = 2.0 * *now - *before;
        }
        for (within, neighbours) in self.within.iter_mut().zip(rests.windows(3)) {
            let (from, to) = (neighbours[1] - neighbours[0], neighbours[2] - neighbours[1]);
            *within = [
                model.basis.ramp * (to + from),
                model.basis.bow * (to - from),
            ];
        }
    }
}

/// A wave at place `i` of the run and the blocks beside it.
#[cold]
#[inline(never)]
fn beside(wave: &[Complex32; CHUNK], i: usize) -> Complex32 {
    let &[first, second, .., last_but_one, last] = wave;
    match wave.get(i.wrapping_sub(1)) {
        Some(&wave) => wave,
        None if i == 0 => beyond(second, first),
        None => beyond(last_but_one, last),
    }
}

/// A wave one block beyond the last of two.
#[cold]
#[inline(never)]
fn beyond(before: Complex32, last: Complex32) -> Complex32 {
    let square = before.norm_sqr();
    if square > 0.0 {
        // No power of three: that of a great wave is beyond f32.
        last * (last * before.conj() / square)
    } else {
        last
    }
}

/// The offset of a block, where the waves are these.
#[cold]
#[inline(never)]
fn offset(prediction: &Prediction, block: &Seen, channel: usize, waves: &[Complex32; 2]) -> f32 {
    prediction.mean_rest(&block.whitened[channel & 1], waves)
}

/// The slope over two blocks in the first of four of these offsets.
fn slope_at_first([a, b, c, d]: [f32; 4]) -> f32 {
    1.3 * b + 1.7 * c - 2.1 * a - 0.9 * d
}
