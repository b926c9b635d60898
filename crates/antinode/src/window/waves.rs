//! The two travelling waves of a window: z₊ = z_C + j z_D and z₋ = z_C − j z_D, each of which runs as one exponential while the
//! pattern precesses and decays.

use num_complex::Complex32;

use super::course::exponential;
use super::model::Model;

/// The raw parameters of both pick-offs, as they stand in the normal equations.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Parameters {
    pub z: [Complex32; 2],
    pub slope: [Complex32; 2],
    pub offset: [f32; 2],
}

/// The travelling waves at the middle of a window, and their courses.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Waves {
    /// z₊ and z₋.
    pub value: [Complex32; 2],
    /// z₊′ and z₋′ for each half window.
    pub change: [Complex32; 2],
    /// What of the change is exponential: z′/z, or nothing where a wave is too small to have a course of its own.
    pub(super) slope: [Complex32; 2],
    /// What is left of the change: it runs linearly.
    pub(super) rest: [Complex32; 2],
}

impl Waves {
    /// The waves of ideal pick-offs from the raw parameters.
    pub(super) fn new(model: &Model, parameters: &Parameters) -> Self {
        let correction = &model.correction;
        let travelling = |raw: [Complex32; 2]| {
            let [c, d] = correction.correct(raw);
            let turned = Complex32::new(-d.im, d.re);
            [c + turned, c - turned]
        };
        // Channel D was sampled later: what it saw lies that much further along its course.
        let [c, d] = parameters.z;
        let d = d - parameters.slope[1] * (correction.delay / model.half());
        let value = travelling([c, d]);
        let change = travelling(parameters.slope);
        let slope = core::array::from_fn(|w| {
            let power = value[w].norm_sqr();
            let steady = change[w].norm_sqr() < 0.25 * power;
            if steady {
                change[w] * value[w].conj() / power
            } else {
                Complex32::ZERO
            }
        });
        let rest = core::array::from_fn(|w| {
            if slope[w] == Complex32::ZERO {
                change[w]
            } else {
                Complex32::ZERO
            }
        });
        Self {
            value,
            change,
            slope,
            rest,
        }
    }

    /// The raw parameters that these waves have `later` samples on, had they kept their course.
    pub(super) fn parameters(
        &self,
        model: &Model,
        later: f32,
        turn: Complex32,
    ) -> [[Complex32; 2]; 2] {
        let correction = &model.correction;
        let half = model.half();
        let windows = later / half;
        let grown = |w: usize| {
            let ahead = exponential(self.slope[w & 1] * windows);
            (self.value[w & 1] * ahead + self.rest[w & 1] * windows) * turn
        };
        let grown = [grown(0), grown(1)];
        let slope = |w: usize| {
            if self.slope[w & 1] == Complex32::ZERO {
                self.rest[w & 1] * turn
            } else {
                grown[w & 1] * self.slope[w & 1]
            }
        };
        let slope = [slope(0), slope(1)];
        let pick_offs = |[plus, minus]: [Complex32; 2]| {
            let apart = (plus - minus) * 0.5;
            correction.distort([(plus + minus) * 0.5, Complex32::new(apart.im, -apart.re)])
        };
        let (mut z, slope) = (pick_offs(grown), pick_offs(slope));
        z[1] += slope[1] * (correction.delay / half);
        [z, slope]
    }

    /// The greatest |z′/z|² of the waves, a half window.
    pub(super) fn reach(&self) -> f32 {
        let [plus, minus] = self.slope.map(|slope| slope.norm_sqr());
        if plus > minus { plus } else { minus }
    }

    /// |z₊|² + |z₋|².
    pub(crate) fn power(&self) -> f32 {
        self.value[0].norm_sqr() + self.value[1].norm_sqr()
    }

    /// The common phase advance beyond the carrier, rad a half window, weighted by the power of the waves.
    pub(super) fn drift(&self) -> f32 {
        let turned = |w: usize| (self.change[w] * self.value[w].conj()).im;
        let power = self.power();
        if power > 0.0 {
            (turned(0) + turned(1)) / power
        } else {
            0.0
        }
    }
}
