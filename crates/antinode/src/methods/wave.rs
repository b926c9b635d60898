//! What every method gives.

/// The standing wave without its phase: three of the five numbers of (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// a_A, input units, ≥ 0.
    pub main_amplitude: f64,
    /// a_B, input units, signed.
    pub quadrature_amplitude: f64,
    /// θ_A in rad, within −π/4…π/4: it is known modulo π/2.
    pub angle: f64,
}

/// The standing wave with its phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Amplitudes and angle.
    pub shape: Shape,
    /// α in rad, (−π, π], about the window's first sample, paired with the angle.
    pub phase: f64,
}

impl Wave {
    /// The pick-offs of (3) as S = u cos ωt + v sin ωt: ([u_C, u_D], [v_C, v_D]), input units.
    pub fn quadratures(&self) -> ([f64; 2], [f64; 2]) {
        let Shape {
            main_amplitude: a,
            quadrature_amplitude: b,
            angle,
        } = self.shape;
        let (s2, c2) = libm::sincos(2.0 * angle);
        let (s, c) = libm::sincos(self.phase);
        (
            [a * c * c2 + b * s * s2, a * c * s2 - b * s * c2],
            [a * s * c2 - b * c * s2, a * s * s2 + b * c * c2],
        )
    }
}
