//! What hum does to a window whose blocks have offsets of their own: hum that moves these also runs within each block.

use num_complex::Complex32;

use super::course::{CHUNK, Course, at, bend, course};
use super::model::Model;
use super::prediction::Prediction;
use super::seen::Seen;
use super::waves::Waves;

/// The offsets of a window's blocks beyond its own.
pub(super) struct Hum<'a> {
    waves: &'a Waves,
    /// The sum of their squares, of each pick-off.
    wander: &'a mut [f32; 2],
    /// What their slopes add to the odd sums of the pick-off and the run of blocks looked at.
    pub slopes: [f32; CHUNK],
}

impl<'a> Hum<'a> {
    /// None taken yet, of a window of these waves: the sum of the squares is to be in `wander`.
    pub fn new(waves: &'a Waves, wander: &'a mut [f32; 2]) -> Self {
        *wander = [0.0; 2];
        Self {
            waves,
            wander,
            slopes: [0.0; CHUNK],
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
        let mut rests = [0.0; CHUNK + 2];
        let mut count = 0;
        let places = rests.iter_mut().skip(1).take(CHUNK);
        for (place, block) in places.zip(blocks.iter().skip(index)) {
            *place = offset(prediction, block, channel, &at(course, count));
            self.wander[channel] += *place * *place;
            count += 1;
        }
        let beside = |index| beside(model, prediction, self.waves, channel, (index, blocks));
        let [before, a, b, c, d, e, after] = &mut rests;
        *before = beside(index.wrapping_sub(1)).unwrap_or(*b - slope_at_first([*a, *b, *c, *d]));
        let next = beside(index + CHUNK);
        if count == CHUNK {
            *after = next.unwrap_or(*d - slope_at_first([*e, *d, *c, *b]));
        } else if let [.., before, now] = rests.get(..=count).unwrap_or(&[])
            && let next = 2.0 * now - before
            && let Some(place) = rests.get_mut(count + 1)
        {
            // In a window's last run, if it is short, on the straight line through two.
            *place = next;
        }
        for (slope, neighbours) in self.slopes.iter_mut().zip(rests.windows(3)) {
            *slope = model.basis.ramp * (neighbours[2] - neighbours[0]);
        }
    }
}

/// The offset of a block beside the run looked at, where that one's course does not reach.
#[cold]
#[inline(never)]
fn beside(
    model: &Model,
    prediction: &Prediction,
    waves: &Waves,
    channel: usize,
    (index, blocks): (usize, &[Seen]),
) -> Option<f32> {
    let block = blocks.get(index)?;
    let mut course = course(model, waves, index);
    bend(&mut course, model, waves, index, 1);
    Some(offset(prediction, block, channel, &at(&course, 0)))
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
