//! An independent batch fit of the seven parameters to raw samples in f64, by Gauss–Newton on the model (1)–(3) itself.

use nalgebra::{DMatrix, DVector};

/// The parameters at the middle of the samples.
#[derive(Debug, Clone, Copy)]
pub struct Oracle {
    /// a_A.
    pub main: f64,
    /// a_B.
    pub quadrature: f64,
    /// θ_A, rad.
    pub angle: f64,
    /// ω, rad a sample.
    pub omega: f64,
    /// α, rad.
    pub phase: f64,
    /// Offsets of S_C and S_D.
    pub offsets: [f64; 2],
}

/// Fits all seven parameters to `pairs`, from a start near the solution.
pub fn fit(pairs: &[[f64; 2]], start: Oracle) -> Oracle {
    let mut p = [
        start.main,
        start.quadrature,
        start.angle,
        start.omega,
        start.phase,
        start.offsets[0],
        start.offsets[1],
    ];
    for _ in 0..20 {
        let mut jacobian = DMatrix::zeros(2 * pairs.len(), 7);
        let mut rest = DVector::zeros(2 * pairs.len());
        for (k, pair) in pairs.iter().enumerate() {
            let t = k as f64 - 0.5 * (pairs.len() - 1) as f64;
            let (s, c) = (p[3] * t - p[4]).sin_cos();
            let (s2, c2) = (2.0 * p[2]).sin_cos();
            let (main, quadrature) = (p[0] * c, p[1] * s);
            rest[2 * k] = pair[0] - (main * c2 - quadrature * s2 + p[5]);
            rest[2 * k + 1] = pair[1] - (main * s2 + quadrature * c2 + p[6]);
            let along = [
                -p[0] * s * c2 - p[1] * c * s2,
                -p[0] * s * s2 + p[1] * c * c2,
            ];
            let columns = [
                [c * c2, c * s2],
                [-s * s2, s * c2],
                [
                    -2.0 * (main * s2 + quadrature * c2),
                    2.0 * (main * c2 - quadrature * s2),
                ],
                [t * along[0], t * along[1]],
                [-along[0], -along[1]],
                [1.0, 0.0],
                [0.0, 1.0],
            ];
            for (column, [c, d]) in columns.iter().enumerate() {
                jacobian[(2 * k, column)] = *c;
                jacobian[(2 * k + 1, column)] = *d;
            }
        }
        let step = jacobian
            .svd(true, true)
            .solve(&rest, 1e-13)
            .expect("both factors were asked for");
        for (p, step) in p.iter_mut().zip(step.iter()) {
            *p += step;
        }
        if step.norm() < 1e-13 {
            break;
        }
    }
    Oracle {
        main: p[0],
        quadrature: p[1],
        angle: p[2],
        omega: p[3],
        phase: p[4],
        offsets: [p[5], p[6]],
    }
}
