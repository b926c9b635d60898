//! Algorithm 3: the axes of the wave, formulas (21) and (22).

use super::functional::root;
use super::moments::Moments;
use super::wave::Shape;

/// a_A, a_B and θ by (21), (5) and (22).
///
/// (22) gives |a_B| only: a_B takes the sign of `sign`, which is Q of (24), [`Products::q`](super::Products::q), or −q of (16). Noise of
/// σ a sample adds 2σ² to both squared amplitudes.
pub fn shape(moments: &Moments, sign: f64) -> Shape {
    let (cc, dd, cd) = moments.means();
    let angle = 0.25 * libm::atan2(2.0 * cd, cc - dd);
    let (main, quadrature) = rotated(moments, angle);
    Shape {
        main_amplitude: root(2.0 * main),
        quadrature_amplitude: libm::copysign(root(2.0 * quadrature), sign),
        angle,
    }
}

/// (⟨S_A²⟩, ⟨S_B²⟩) by (5): the second moments along the axes at `angle` rad, input units squared.
fn rotated(moments: &Moments, angle: f64) -> (f64, f64) {
    let (cc, dd, cd) = moments.means();
    let (s, c) = libm::sincos(2.0 * angle);
    let across = 2.0 * cd * s * c;
    (
        cc * c * c + dd * s * s + across,
        cc * s * s + dd * c * c - across,
    )
}
