//! The phase that fits a shape best: (14), and (19) from (18); the half period that an arctangent leaves open, (5).

use core::f64::consts::PI;

use super::products::Products;
use super::wave::{Shape, Wave};

/// α by (19): ∂J/∂α = 0 of (18) or (23) under condition (8). For a_B = 0 it is (14).
///
/// The two sums go into an atan2, so that of α and α + π it is the one of smaller J.
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

/// Of α and α + π the one that makes the main wave a_A cos(ωt − α) with a_A > 0, (5): the one of smaller J.
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
