//! Algorithm 1: no quadrature, formulas (12) and (13).
//!
//! Of the four it is the roughest: a quadrature wave makes a_A too large by a_B²/2a_A and turns θ by ½(a_B/a_A)² ctg 4θ. It gives
//! starting values for the others, and a base to compare them with.

use super::moments::Moments;
use super::ratio::Ratio;
use super::wave::Shape;

/// a_A and θ by (12); a_B = 0. The sign is that of ⟨S_C S_D⟩, which divides by no small sample.
pub fn shape(moments: &Moments) -> Shape {
    let (cc, dd, cd) = moments.means();
    let sine = libm::copysign(libm::sqrt(dd), cd);
    Shape {
        main_amplitude: libm::sqrt(2.0 * (cc + dd)),
        quadrature_amplitude: 0.0,
        angle: 0.5 * libm::atan2(sine, libm::sqrt(cc)),
    }
}

/// θ in rad by the rougher (13), −π/4…π/4: it needs no window that fits the period. NaN where every sample was left out.
///
/// Quadrature turns it by −½(a_B/a_A)² tg 2θ whatever is left out; where nothing is, samples of S_C near zero turn it by degrees.
pub fn rough_angle(ratio: &Ratio) -> f64 {
    0.5 * libm::atan(ratio.mean())
}
