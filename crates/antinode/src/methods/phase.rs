//! The phase that fits a shape best: (14), and (19) from (18).

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
