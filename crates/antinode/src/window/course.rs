//! The phasors of both waves and of the carrier, from block to block of a window.

use num_complex::Complex32;

use super::model::Model;
use super::waves::Waves;
use crate::exponential::growth;

/// Blocks from one exact exponential to the next; a recursion gives those between.
pub(super) const CHUNK: usize = 5;

/// Half of z₊ and z₋, turned by the carrier, at the middles of a chunk's blocks: the part of each that C sees.
pub(super) type Course = [[Complex32; CHUNK]; 2];

/// The course over the blocks from block `index` of a window on, perhaps beyond its last; [`bend`] adds the linear changes.
#[inline(never)]
pub(super) fn course(model: &Model, waves: &Waves, index: usize) -> Course {
    let (u, unit) = model.carrier(index + CHUNK / 2);
    let half = unit * 0.5;
    [
        outwards(model, waves.value[0] * half, waves.slope[0], u),
        outwards(model, waves.value[1] * half, waves.slope[1], u),
    ]
}

/// A wave over a chunk, from the chunk's middle outwards, which lies at time `u`; `middle` is the wave there without its growth since the
/// window's middle.
#[inline(never)]
fn outwards(model: &Model, mut middle: Complex32, slope: Complex32, u: f32) -> [Complex32; CHUNK] {
    if u != 0.0 {
        // In two halves, as the middle of a chunk may lie beyond the window's end.
        let grown = growth(slope * (0.5 * u));
        middle += middle * grown;
        middle += middle * grown;
    }
    // Growth and turn of the wave over one block.
    let on = model.turn + model.turn * growth(slope * model.advance);
    let back = on.conj() * (1.0 / on.norm_sqr());
    let (before, after) = (middle * back, middle * on);
    [before * back, before, middle, after, after * on]
}

/// Adds the changes of the waves that are linear.
#[cold]
#[inline(never)]
pub(super) fn bend(course: &mut Course, model: &Model, waves: &Waves, index: usize, count: usize) {
    let linear_changes = waves.linear_changes();
    for i in 0..count.min(CHUNK) {
        let (u, unit) = model.carrier(index + i);
        for (wave, change) in course.iter_mut().zip(linear_changes) {
            wave[i] += change * unit * (0.5 * u);
        }
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::block::Layout;
    use crate::calibration::Calibration;
    use crate::phase::PhaseStep;

    #[test]
    fn a_chunk_keeps_its_digits_whatever_a_block_turns() {
        let mut seed = 1u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        // Blocks of a fifth, a quarter, a half and all of a period; a third of one is furthest from a whole number of quarter periods.
        for (length, limit) in [
            (4u16, 1.5e-7),
            (5, 1.5e-7),
            (9, 1.5e-7),
            (19, 1.5e-7),
            (6, 2.4e-7),
        ] {
            let mut squares = 0.0;
            for _ in 0..1000 {
                let carrier = PhaseStep::from_period(18.75 + 0.5 * random());
                let layout = Layout::unrounded(carrier, length);
                let model = Model::new(
                    layout,
                    carrier,
                    CHUNK as u16,
                    Calibration::IDEAL,
                    1e5,
                    false,
                );
                let value = Complex32::new(random(), random());
                let slope = Complex32::new(1e-3 * random(), 0.05 * random());
                let waves = Waves {
                    value: [value; 2],
                    slope: [slope; 2],
                    ..Waves::default()
                };
                let course = course(&model, &waves, 0);
                // The last block is the worst.
                let u = 1.0 - 1.0 / CHUNK as f64;
                let samples = f64::from(length) * 0.5 * (CHUNK - 1) as f64;
                let turns = f64::from(carrier.0) / 4_294_967_296.0 * samples;
                let phase = core::f64::consts::TAU * turns + u * f64::from(slope.im);
                let (sine, cosine) = libm::sincos(phase);
                let long = |z: Complex32| Complex64::new(f64::from(z.re), f64::from(z.im));
                let grown = Complex64::new(cosine, sine) * libm::exp(u * f64::from(slope.re));
                let truth = long(value) * grown * 0.5;
                let error = long(course[0][CHUNK - 1]) - truth;
                squares += error.norm_sqr() / truth.norm_sqr();
            }
            let error = libm::sqrt(squares / 1000.0);
            assert!(error < limit, "blocks of {length}: {error:e}");
        }
    }

    #[test]
    fn a_chunk_of_one_block_grows_as_far_as_a_course_may() {
        let carrier = PhaseStep::from_period(18.75);
        let layout = Layout::unrounded(carrier, 19);
        let blocks = CHUNK as u16 + 1;
        let model = Model::new(layout, carrier, blocks, Calibration::IDEAL, 1e5, false);
        for slope in [(-0.7, 0.9), (0.0, 1.39), (-1.13, 0.1)] {
            let slope = Complex32::new(slope.0, slope.1);
            let waves = Waves {
                value: [Complex32::ONE; 2],
                slope: [slope; 2],
                ..Waves::default()
            };
            let found = course(&model, &waves, CHUNK)[1][0];
            let (u, unit) = model.carrier(CHUNK);
            let (sine, cosine) = libm::sincosf(u * slope.im);
            let truth = unit * Complex32::new(cosine, sine) * (0.5 * libm::expf(u * slope.re));
            let error = (found - truth).norm_sqr() / truth.norm_sqr();
            assert!(error < 2e-5 * 2e-5, "{slope}: {error:e}");
        }
    }
}
