//! The two travelling waves of a window: z₊ = z_C + j z_D and z₋ = z_C − j z_D, each of which runs as one exponential while the
//! pattern precesses and decays.

use num_complex::Complex32;

use super::gradient::Gradient;
use super::model::Model;
use super::normal::{Covariance, Row};

/// The parameters of both raw pick-offs in the normal equations, except the offsets.
#[derive(Default)]
pub(super) struct Parameters {
    pub z: [Complex32; 2],
    pub slope: [Complex32; 2],
}

/// A change of the raw parameters.
pub(super) struct Step {
    z: [Complex32; 2],
    slope: [Complex32; 2],
    pub offset: [f32; 2],
}

impl Step {
    /// The step to where the gradients vanish, if the problem were linear.
    #[inline(always)]
    pub(super) fn new(model: &Model, gradients: &[Gradient; 2]) -> Self {
        let Covariance { even, odd } = &model.covariance;
        let per_mean = model.response.offset;
        let [(c, slope_c, offset_c), (d, slope_d, offset_d)] = gradients.each_ref().map(|side| {
            let Gradient { level, slope, mean } = side;
            let mean = per_mean * mean;
            let of_even = |row: &Row| row[0] * level.re + row[1] * slope.im + row[2] * mean;
            let of_odd = |row: &Row| row[0] * level.im + row[1] * slope.re;
            (
                Complex32::new(of_even(&even[0]), of_odd(&odd[0])),
                Complex32::new(of_odd(&odd[1]), of_even(&even[1])),
                of_even(&even[2]),
            )
        });
        Self {
            z: [c, d],
            slope: [slope_c, slope_d],
            offset: [offset_c, offset_d],
        }
    }
}

impl Parameters {
    /// Moves by a step, from the point at which the gradients were taken. Gives Σ|Δz|² + Σ|Δz′|², and by how much that lowers the
    /// residual's sum of squares.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        step: &Step,
        gradients: &[Gradient; 2],
        model: &Model,
    ) -> [f32; 2] {
        // Offsets of single blocks have no part in the residual.
        let per_mean = model.response.offset * model.shared;
        let dot = |a: Complex32, b: Complex32| a.re * b.re + a.im * b.im;
        let (mut moved, mut explained) = (0.0, 0.0);
        for (channel, gradient) in gradients.iter().enumerate() {
            let (z, slope) = (step.z[channel], step.slope[channel]);
            self.z[channel] += z;
            self.slope[channel] += slope;
            moved += z.norm_sqr() + slope.norm_sqr();
            explained += dot(gradient.level, z)
                + dot(gradient.slope, slope)
                + per_mean * gradient.mean * step.offset[channel];
        }
        [moved, explained]
    }
}

/// The travelling waves at the middle of a window, and their courses.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Waves {
    /// z₊ and z₋.
    pub value: [Complex32; 2],
    /// z₊′ and z₋′, per half window.
    pub change: [Complex32; 2],
    /// z′/z if the wave changes exponentially; zero if it changes linearly, being too small to have a course of its own. Set by
    /// [`Waves::choose_courses`].
    pub(super) slope: [Complex32; 2],
}

impl Waves {
    /// Sets value and change to those that ideal pick-offs would see, from the raw parameters.
    #[inline]
    pub(super) fn set(&mut self, model: &Model, parameters: &Parameters) {
        let correction = &model.correction;
        let travelling = |raw: [Complex32; 2]| {
            let [c, d] = raw;
            let d = correction.correct(c, d);
            let turned = Complex32::new(-d.im, d.re);
            [c + turned, c - turned]
        };
        // That D is sampled later, and so sees the wave further along its course, is part of what is predicted: the next step takes it out.
        self.value = travelling(parameters.z);
        self.change = travelling(parameters.slope);
    }

    /// Decides which changes are exponential: those up to a little more than the wave itself, as the carrier follows the larger wave and
    /// the smaller one turns by twice as much beside it; for waves as small as noise, of no more than the share `small` of both waves'
    /// power, up to half of the wave. Growth is allowed less, as a wave that breaks off does not decay exponentially.
    #[inline(never)]
    pub(super) fn choose_courses(&mut self, small: f32) {
        let small = small * self.power();
        let waves = self.value.iter().zip(&self.change);
        for ((value, change), slope) in waves.zip(&mut self.slope) {
            let power = value.norm_sqr();
            let max = if power > small { 1.95 } else { 0.25 };
            let found = change * value.conj() * (1.0 / power);
            // False for NaN: a wave whose power has no inverse changes linearly.
            *slope = if 1.5 * found.re * found.re + found.im * found.im < max {
                found
            } else {
                Complex32::ZERO
            };
        }
    }

    /// The changes that are not exponential.
    #[inline]
    pub(super) fn linear_changes(&self) -> [Complex32; 2] {
        let linear_change = |w: usize| {
            if self.slope[w] == Complex32::ZERO {
                self.change[w]
            } else {
                Complex32::ZERO
            }
        };
        [linear_change(0), linear_change(1)]
    }

    /// |z₊|² + |z₋|².
    #[inline]
    pub(crate) fn power(&self) -> f32 {
        self.value[0].norm_sqr() + self.value[1].norm_sqr()
    }

    /// The common phase advance beyond the carrier, rad a half window, weighted by the power of the waves.
    pub(crate) fn drift(&self) -> f32 {
        let turned = |w: usize| (self.change[w] * self.value[w].conj()).im;
        let power = self.power();
        if power > 0.0 {
            (turned(0) + turned(1)) / power
        } else {
            0.0
        }
    }
}
