//! Algorithm 4: digital demodulation, formulas (24) and (25).
//!
//! It is exact only if the window fits the period, condition (8). Otherwise leakage remains: up to 1.3 % of a_A for a window of 19
//! samples at 18.75 a period, 0.36 % of the paper's wave. The [`Tracker`](crate::Tracker)'s window solution is its exact counterpart.

use super::functional::root;
use super::phase;
use super::products::Products;
use super::wave::{Shape, Wave};

/// The wave by (25), with 2Φ = atan2(L, M), M = C_x² + C_y² − S_x² − S_y², so that the quadrant is right, and Φ or Φ + π by (5).
///
/// The reference is φ = ωt, that is φ₀ = 0: α = Φ.
pub fn wave(products: &Products) -> Wave {
    let [cx, cy] = products.cosine.map(|mean| 2.0 * mean);
    let [sx, sy] = products.sine.map(|mean| 2.0 * mean);
    let e = sx * sx + cx * cx + sy * sy + cy * cy;
    let q = 2.0 * (sy * cx - sx * cy);
    let r = sx * sx + cx * cx - sy * sy - cy * cy;
    let s = 2.0 * (sx * sy + cx * cy);
    let l = 2.0 * (sx * cx + sy * cy);
    let m = cx * cx + cy * cy - sx * sx - sy * sy;
    let sum = root(e + q);
    let difference = root(e - q);
    let shape = Shape {
        main_amplitude: 0.5 * (sum + difference),
        quadrature_amplitude: 0.5 * (sum - difference),
        angle: 0.25 * libm::atan2(s, r),
    };
    phase::resolve_half_period(
        Wave {
            shape,
            phase: 0.5 * libm::atan2(l, m),
        },
        products,
    )
}
