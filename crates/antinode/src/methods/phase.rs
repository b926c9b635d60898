//! The phase with which a shape fits best, (14) and (19), and the choice between α and α + π, (5).

use core::f64::consts::PI;

use super::products::Products;
use super::wave::{Shape, Wave};

/// α by (19): ∂J/∂α = 0 of (18) or (23) under condition (8). For a_B = 0 it is (14).
///
/// By atan2 of both sums, it is the one of α and α + π that has the smaller J.
pub fn align(shape: &Shape, products: &Products) -> Wave {
    let (s2, c2) = libm::sincos(2.0 * shape.angle);
    let (a_cosine, a_sine) = products.along(c2, s2);
    let (b_cosine, b_sine) = products.along(-s2, c2);
    let ratio = shape.quadrature_amplitude / shape.main_amplitude;
    Wave {
        shape: *shape,
        phase: libm::atan2(a_sine - ratio * b_cosine, a_cosine + ratio * b_sine),
    }
}

/// Chooses between α and α + π, by (5): the one with which the main wave is a_A cos(ωt − α) with a_A > 0, and J smaller.
pub(super) fn resolve_half_period(wave: Wave, products: &Products) -> Wave {
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
