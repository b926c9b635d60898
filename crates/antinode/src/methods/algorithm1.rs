//! Algorithm 1: no quadrature, formulas (12) and (13).
//!
//! The roughest of the four: a quadrature wave makes a_A too large by a_B²/2a_A and turns θ by ½(a_B/a_A)² ctg 4θ. It gives starting
//! values for the others, and a baseline to compare them with.

use super::moments::Moments;
use super::ratio::Ratio;
use super::wave::Shape;

/// a_A and θ by (12); a_B = 0. The sign of θ is that of ⟨S_C S_D⟩, which needs no division by small samples.
pub fn shape(moments: &Moments) -> Shape {
    let (cc, dd, cd) = moments.means();
    let sine = libm::copysign(libm::sqrt(dd), cd);
    Shape {
        main_amplitude: libm::sqrt(2.0 * (cc + dd)),
        quadrature_amplitude: 0.0,
        angle: 0.5 * libm::atan2(sine, libm::sqrt(cc)),
    }
}

/// θ in rad by the rougher (13), −π/4…π/4, for which the window need not fit the period. NaN if every sample was left out.
///
/// Quadrature turns it by −½(a_B/a_A)² tg 2θ, whichever samples are left out; if none are, those with S_C near zero turn it by degrees.
pub fn rough_angle(ratio: &Ratio) -> f64 {
    0.5 * libm::atan(ratio.mean())
}
