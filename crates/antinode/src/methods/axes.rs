//! The wave's own axes and the half period of a phase, formula (5).

use core::f64::consts::PI;

use super::moments::Moments;
use super::products::Products;
use super::wave::Wave;

/// (⟨S_A²⟩, ⟨S_B²⟩) by (5): the second moments along the axes at `angle` rad, input units squared.
pub fn rotated(moments: &Moments, angle: f64) -> (f64, f64) {
    let (cc, dd, cd) = moments.means();
    let (s, c) = libm::sincos(2.0 * angle);
    let across = 2.0 * cd * s * c;
    (
        cc * c * c + dd * s * s + across,
        cc * s * s + dd * c * c - across,
    )
}

/// Of α and α + π the one that makes the main wave a_A cos(ωt − α) with a_A > 0, (5): the one of smaller J.
pub fn resolve_half_period(wave: Wave, products: &Products) -> Wave {
    let (s2, c2) = libm::sincos(2.0 * wave.shape.angle);
    let (cosine, sine) = products.along(c2, s2);
    let (s, c) = libm::sincos(wave.phase);
    if cosine * c + sine * s >= 0.0 {
        return wave;
    }
    let turn = if wave.phase > 0.0 { -PI } else { PI };
    Wave {
        phase: wave.phase + turn,
        ..wave
    }
}
