//! How far the methods may differ from their expected results without a fault.

use super::comparison::{DELAY, DISAGREEMENT, NO_QUADRATURE};
use super::reference::Reference;
use super::wave::Shape;

/// Error of a window's sums from a turn of `turn` rad, a loss of the share `decay`, and f32 rounding, relative to the sums.
pub(super) fn slow(turn: f64, decay: f64, changing: f64) -> f64 {
    let (turn, decay) = (2.0 * turn, decay);
    // Their change over the window leaks at first order.
    (turn * turn + decay * decay) / 12.0 + changing * (turn.abs() + decay.abs()) + 1e-6
}

/// Leakage of a steady change: that of a constant, or |⟨t e^{2jωt}⟩| with t in windows from the middle if that is more, as it does not
/// vanish if the window fits the period.
pub(super) fn changing(leakage: f64, omega: f64, count: u32) -> f64 {
    let x = omega * f64::from(count);
    let (sine, cosine) = libm::sincos(x);
    leakage.max(0.5 * (cosine - sine / x).abs() / x)
}

/// How far a noise variance may exceed the one found, relative to it and in parts of [`DISAGREEMENT`]: by the chi-square quantile of 1 in
/// 300 000 windows, from the Wilson–Hilferty approximation, for an `uncertainty` of up to 0.3.
fn above(uncertainty: f64) -> f64 {
    let third = uncertainty / 3.0;
    let least = (1.0 - third * (third + 4.5)).max(0.1);
    (1.0 / (least * least * least) - 1.0) / DISAGREEMENT
}

/// Error of the root of `square` for an error of `deviation` in `square`, in parts of [`DISAGREEMENT`].
fn of_root(square: f64, deviation: f64) -> f64 {
    let error = DISAGREEMENT * deviation;
    let root = libm::sqrt(square);
    let below = root - libm::sqrt((square - error).max(0.0));
    below.max(libm::sqrt(square + error) - root) / DISAGREEMENT
}

/// Deviations by which the methods of one window may differ without a fault.
pub(super) struct Scatter<'a> {
    pub reference: &'a Reference,
    /// Sample pairs.
    pub count: u32,
    /// Leakage of a steady change, by [`changing`].
    pub changing: f64,
    /// Deviation of q of (16) at the quarter, input units squared.
    pub q_deviation: f64,
}

impl Scatter<'_> {
    /// Deviations of a_A, a_B and θ of the method of index `place` from `explained`: those of the exact solution, the uncertainty of the
    /// noise variance and of its mean square over the window, and the errors from turning, decay and f32 rounding.
    ///
    /// `seen` is the a_A² − a_B² from which the method computes its angle.
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
        // Leakage of the exact solution's deviations.
        let leaks = 4.0 * changing * size * a;
        let of_angle = if place == NO_QUADRATURE {
            // (12) takes the angle from roots of mean squares: on a pick-off's axis one of them is all noise.
            let (sine, cosine) = libm::sincos(2.0 * explained.angle);
            let whole = core::f64::consts::FRAC_1_SQRT_2 * explained.main_amplitude;
            let root = |share: f64| of_root((share * whole) * (share * whole), noise);
            let roots = libm::hypot(cosine * root(sine), sine * root(cosine));
            sum(angle, 0.5 * roots / whole, rest)
        } else {
            let own = angle * difference(&reference.wave.shape);
            let deviation = libm::hypot(own, rest * size * size + leaks);
            // With a smaller a_A² − a_B² the angle has no meaning: its deviation is infinite.
            deviation / (seen - DISAGREEMENT * deviation).max(0.0)
        };
        // (16) takes a_A − |a_B| from the root of a difference, which is small near a circle.
        let of_amplitudes = if place == DELAY {
            let root = explained.main_amplitude - explained.quadrature_amplitude.abs();
            let exact = size - reference.wave.shape.quadrature_amplitude.abs();
            let of_exact = 2.0 * exact * (a + b) + leaks;
            let deviation = sum(4.0 * noise, 4.0 * self.q_deviation, of_exact);
            0.5 * of_root(root * root, deviation)
        } else {
            0.0
        };
        // (22) adds the noise's square to that of a_B: with a small quadrature, a slight excess of noise makes a large difference.
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

/// a_A² − a_B², which scales the angle's accuracy.
pub(super) fn difference(shape: &Shape) -> f64 {
    let (a, b) = (shape.main_amplitude, shape.quadrature_amplitude);
    a * a - b * b
}
