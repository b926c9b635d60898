//! What the methods may differ by from what is expected of them, without a fault.

use super::comparison::{DELAY, DISAGREEMENT, NO_QUADRATURE};
use super::reference::Reference;
use super::wave::Shape;

/// What turning by `turn` rad, a loss of `decay`, and f32 rounding leave in a window's sums, as a share of them.
pub(super) fn slow(turn: f64, decay: f64, changing: f64) -> f64 {
    let (turn, decay) = (2.0 * turn, decay);
    // What leaks changes over the window at first order.
    (turn * turn + decay * decay) / 12.0 + changing * (turn.abs() + decay.abs()) + 1e-6
}

/// How much of a steady change leaks: as much as of what is constant, or |⟨t e^{2jωt}⟩| with t in windows from the middle, which does
/// not vanish where a window fits the period.
pub(super) fn changing(leakage: f64, omega: f64, count: u32) -> f64 {
    let x = omega * f64::from(count);
    let (sine, cosine) = libm::sincos(x);
    leakage.max(0.5 * (cosine - sine / x).abs() / x)
}

/// By how much of itself a noise variance may be above what was found, in parts of [`DISAGREEMENT`]: the quantile that a chi-square of
/// such an uncertainty, 0.3 and less, is below in 1 of 300 000 windows, by Wilson and Hilferty.
fn above(uncertainty: f64) -> f64 {
    let third = uncertainty / 3.0;
    let least = (1.0 - third * (third + 4.5)).max(0.1);
    (1.0 / (least * least * least) - 1.0) / DISAGREEMENT
}

/// What `square` may be off by in its root, by `deviation` of its own, in parts of [`DISAGREEMENT`].
fn of_root(square: f64, deviation: f64) -> f64 {
    let most = DISAGREEMENT * deviation;
    let root = libm::sqrt(square);
    let below = root - libm::sqrt((square - most).max(0.0));
    below.max(libm::sqrt(square + most) - root) / DISAGREEMENT
}

/// What may separate the methods of one window without a fault.
pub(super) struct Scatter<'a> {
    pub reference: &'a Reference,
    /// Sample pairs.
    pub count: u32,
    /// How much of a steady change leaks, by [`changing`].
    pub changing: f64,
    /// Deviation of q of (16) at the quarter, input units squared.
    pub q_deviation: f64,
}

impl Scatter<'_> {
    /// By how much the method of this place may differ from `explained`: the exact solution's own deviations, how little the noise and
    /// its mean square over the window are known, and what turning, decay and f32 rounding leave.
    ///
    /// `seen` is the a_A² − a_B² that the method has its angle from.
    pub fn of(&self, place: usize, explained: &Shape, seen: f64) -> [f64; 3] {
        let (reference, changing) = (self.reference, self.changing);
        let [of_c, of_d, _] = reference.noise.moments;
        let mean_square = libm::sqrt(2.0 / f64::from(self.count));
        let noise = of_c.max(of_d) * libm::hypot(above(reference.noise_uncertainty), mean_square);
        let size = reference.wave.shape.main_amplitude;
        let rest = slow(reference.turn, reference.decay, changing);
        let [a, b, angle] = reference.deviations;
        let quadrature = explained.quadrature_amplitude.abs().max(b);
        let sum = |x: f64, y: f64, z: f64| libm::sqrt(x * x + y * y + z * z);
        // What leaks of the exact solution's deviations.
        let leaks = 4.0 * changing * size * a;
        let of_angle = if place == NO_QUADRATURE {
            // (12) takes the angle from roots of mean squares, and one is all noise where a pick-off sees nothing else.
            let (sine, cosine) = libm::sincos(2.0 * explained.angle);
            let whole = core::f64::consts::FRAC_1_SQRT_2 * explained.main_amplitude;
            let root = |share: f64| of_root((share * whole) * (share * whole), noise);
            let roots = libm::hypot(cosine * root(sine), sine * root(cosine));
            sum(angle, 0.5 * roots / whole, rest)
        } else {
            let own = angle * difference(&reference.wave.shape);
            let deviation = libm::hypot(own, rest * size * size + leaks);
            // An angle that rests on less than that means nothing.
            deviation / (seen - DISAGREEMENT * deviation).max(0.0)
        };
        // (16) takes a_A − |a_B| from the root of a difference, which is small where the pattern is near a circle.
        let of_amplitudes = if place == DELAY {
            let root = explained.main_amplitude - explained.quadrature_amplitude.abs();
            let exact = size - reference.wave.shape.quadrature_amplitude.abs();
            let of_exact = 2.0 * exact * (a + b) + leaks;
            let deviation = sum(4.0 * noise, 4.0 * self.q_deviation, of_exact);
            0.5 * of_root(root * root, deviation)
        } else {
            0.0
        };
        // (22) adds the noise's square to a_B's: a small quadrature and a little excess make a large difference.
        [
            sum(libm::hypot(a, of_amplitudes), noise / size, rest * size),
            sum(
                libm::hypot(b, of_amplitudes),
                noise / quadrature,
                rest * size * (1.0 + rest * size / quadrature),
            ),
            of_angle,
        ]
    }
}

/// a_A² − a_B², which the angle rests on.
pub(super) fn difference(shape: &Shape) -> f64 {
    let (a, b) = (shape.main_amplitude, shape.quadrature_amplitude);
    a * a - b * b
}
