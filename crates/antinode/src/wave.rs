//! The travelling waves of a window become the numbers of the standing wave: the short form of formulas (24)–(25).
//!
//! z₊ = (a_A + a_B)·e^{j(2θ−α)} and z₋ = (a_A − a_B)·e^{−j(2θ+α)}. Hence a_A = (|z₊|+|z₋|)/2, a_B = (|z₊|−|z₋|)/2,
//! 4θ = arg z₊ − arg z₋, 2α = −arg z₊ − arg z₋, with no cancellation and the right quadrant.

use core::f32::consts::{FRAC_PI_2, PI, TAU};

use num_complex::Complex32;

use crate::arch::square_root;
use crate::order::{greater, lesser};
use crate::window::{Fit, Model};

/// The standing wave at the middle of a window, with its rates per half window, and variances for the fit's own noise.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Standing {
    pub main: f32,
    pub quadrature: f32,
    /// In (−π/2, π/2], modulo π/2.
    pub angle: f32,
    /// In (−π, π], paired with `angle`.
    pub phase: f32,
    /// Advance of the common phase beyond the carrier.
    pub drift: f32,
    pub turning: f32,
    pub main_change: f32,
    pub quadrature_change: f32,
    /// The smaller of |z₊|, |z₋|, with its variance.
    pub lesser: f32,
    pub lesser_variance: f32,
    /// Of a_A and of a_B.
    pub main_variance: f32,
    pub quadrature_variance: f32,
    pub angle_variance: f32,
    pub phase_variance: f32,
    pub drift_variance: f32,
    pub turning_variance: f32,
    /// Covariance of drift and turning: with quadrature, a turning pattern looks like another frequency.
    pub drift_turning: f32,
    pub main_change_variance: f32,
    pub quadrature_change_variance: f32,
}

/// Weights of one real quantity on (Re, Im) of the two pick-offs' phasors.
type Gradient = [[f32; 2]; 2];

/// The gradient of p·(component of z₊ along e₊) + m·(component of z₋ along e₋).
fn gradient(plus: Complex32, minus: Complex32) -> Gradient {
    // z₊ = z_C + j z_D and z₋ = z_C − j z_D.
    [
        [plus.re + minus.re, plus.im + minus.im],
        [plus.im - minus.im, minus.re - plus.re],
    ]
}

/// The variance or covariance of two quantities, under one 2×2 covariance for each pick-off.
fn covariance(a: &Gradient, b: &Gradient, block: [[f32; 2]; 2], gain_d: f32) -> f32 {
    let one = |x: [f32; 2], y: [f32; 2]| {
        x[0] * (block[0][0] * y[0] + block[0][1] * y[1])
            + x[1] * (block[1][0] * y[0] + block[1][1] * y[1])
    };
    one(a[0], b[0]) + gain_d * gain_d * one(a[1], b[1])
}

impl Standing {
    /// The standing wave of a fit whose noise variance a sample is `noise`.
    pub(crate) fn new(model: &Model, fit: &Fit, noise: f32) -> Self {
        let [plus, minus] = fit.waves.value;
        let [plus_change, minus_change] = fit.waves.change;
        let size = |z: Complex32| square_root(z.norm_sqr());
        let arg = |z: Complex32| libm::atan2f(z.im, z.re);
        let (plus_angle, minus_angle) = (arg(plus), arg(minus));
        let (p, m) = (size(plus), size(minus));
        let along = |z: Complex32, size: f32| {
            if size > 0.0 { z / size } else { Complex32::ONE }
        };
        let (e_plus, e_minus) = (along(plus, p), along(minus, m));
        // Where the phase of a wave moves: across it, and the more the smaller it is.
        let across = |e: Complex32, size: f32| {
            let size = greater(greater(size, 1e-12 * (p + m)), f32::MIN_POSITIVE);
            Complex32::new(-e.im, e.re) / size
        };
        // The component of a change along e or f: how the size and the phase of a wave move.
        let turned = |change: Complex32, f: Complex32| change.re * f.re + change.im * f.im;
        let (f_plus, f_minus) = (across(e_plus, p), across(e_minus, m));

        let (plus_turn, minus_turn) = (turned(plus_change, f_plus), turned(minus_change, f_minus));
        let (plus_growth, minus_growth) =
            (turned(plus_change, e_plus), turned(minus_change, e_minus));

        let c = &model.covariance;
        let levels = [[c[0][0], c[0][1]], [c[1][0], c[1][1]]];
        let slopes = [[c[2][2], c[2][3]], [c[3][2], c[3][3]]];
        let gain_d = model.correction.noise_gain();
        let level = |g: &Gradient| noise * covariance(g, g, levels, gain_d);
        let slope = |g: &Gradient, h: &Gradient| noise * covariance(g, h, slopes, gain_d);

        let sum = gradient(e_plus * 0.5, e_minus * 0.5);
        let difference = gradient(e_plus * 0.5, e_minus * -0.5);
        let quarter = gradient(f_plus * 0.25, f_minus * -0.25);
        let half = gradient(f_plus * 0.5, f_minus * 0.5);
        let least = if p < m {
            gradient(e_plus, Complex32::ZERO)
        } else {
            gradient(Complex32::ZERO, e_minus)
        };
        Self {
            main: 0.5 * (p + m),
            quadrature: 0.5 * (p - m),
            angle: 0.25 * (plus_angle - minus_angle),
            phase: -0.5 * (plus_angle + minus_angle),
            drift: 0.5 * (plus_turn + minus_turn),
            turning: 0.25 * (plus_turn - minus_turn),
            main_change: 0.5 * (plus_growth + minus_growth),
            quadrature_change: 0.5 * (plus_growth - minus_growth),
            lesser: lesser(p, m),
            lesser_variance: level(&least),
            main_variance: level(&sum),
            quadrature_variance: level(&difference),
            angle_variance: level(&quarter),
            phase_variance: level(&half),
            drift_variance: slope(&half, &half),
            turning_variance: slope(&quarter, &quarter),
            drift_turning: slope(&half, &quarter),
            main_change_variance: slope(&sum, &sum),
            quadrature_change_variance: slope(&difference, &difference),
        }
    }
}

/// Takes whole turns off an angle in radians: (−π, π].
pub(crate) fn wrap(angle: f32) -> f32 {
    let turns = libm::roundf(angle / TAU);
    let rest = angle - turns * TAU;
    if rest <= -PI { rest + TAU } else { rest }
}

/// A pattern angle that runs on over the ambiguity of π/2: whole quarter turns apart from the rest, so that it never loses digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Angle {
    pub quarters: i32,
    /// In rad, about −π/4…π/4.
    pub rest: f32,
}

impl Angle {
    pub(crate) fn new(radians: f32) -> Self {
        let quarters = libm::roundf(radians / FRAC_PI_2);
        Self {
            quarters: quarters as i32,
            rest: radians - quarters * FRAC_PI_2,
        }
    }

    /// The value nearest to this one that equals `angle` modulo π/2, and by how many quarter turns it was moved.
    pub(crate) fn nearest(self, angle: f32) -> (Self, i32) {
        let quarters = libm::roundf((self.rest - angle) / FRAC_PI_2) as i32;
        let rest = angle + quarters as f32 * FRAC_PI_2;
        let moved = Angle::new(rest);
        (
            Self {
                quarters: self.quarters.wrapping_add(moved.quarters),
                rest: moved.rest,
            },
            self.quarters.wrapping_add(quarters),
        )
    }

    /// This angle less `other`, rad.
    pub(crate) fn less(self, other: Self) -> f32 {
        self.quarters.wrapping_sub(other.quarters) as f32 * FRAC_PI_2 + (self.rest - other.rest)
    }

    /// This angle moved by a small one, rad.
    pub(crate) fn plus(self, radians: f32) -> Self {
        let moved = Angle::new(self.rest + radians);
        Self {
            quarters: self.quarters.wrapping_add(moved.quarters),
            rest: moved.rest,
        }
    }

    /// In radians.
    pub(crate) fn radians(self) -> f64 {
        f64::from(self.quarters) * core::f64::consts::FRAC_PI_2 + f64::from(self.rest)
    }
}
