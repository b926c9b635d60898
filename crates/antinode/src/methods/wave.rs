//! Results of every method: a wave's shape and phase.

/// A standing wave without its phase: three of the five parameters of (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// a_A, input units, ≥ 0.
    pub main_amplitude: f64,
    /// a_B, input units, signed.
    pub quadrature_amplitude: f64,
    /// θ_A in rad; it is known modulo π/2, and lies within −π/4…π/4 unless [`Wave::near`] chose another value.
    pub angle: f64,
}

/// A standing wave with its phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Amplitudes and angle.
    pub shape: Shape,
    /// α in rad, (−π, π], at the window's first sample; it belongs to this angle: see [`Wave::near`].
    pub phase: f64,
}

impl Wave {
    /// The same motion with its angle nearest to `angle`, rad: θ changes by quarter turns, α by as many half turns.
    #[must_use = "it gives another, and changes none"]
    pub fn near(self, angle: f64) -> Self {
        use core::f64::consts::{FRAC_PI_2, PI, TAU};
        let quarters = libm::round((angle - self.shape.angle) / FRAC_PI_2);
        let phase = self.phase + quarters * PI;
        // Half a turn is positive.
        let phase = phase - libm::ceil(phase / TAU - 0.5) * TAU;
        Self {
            shape: Shape {
                angle: self.shape.angle + quarters * FRAC_PI_2,
                ..self.shape
            },
            phase,
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_angle_describes_the_same_motion() {
        let wave = Wave {
            shape: Shape {
                main_amplitude: 1.0,
                quadrature_amplitude: -0.2,
                angle: 0.3,
            },
            phase: 2.5,
        };
        for angle in [-7.0, -1.0, 0.4, 1.6, 12.0] {
            let near = wave.near(angle);
            assert!((near.shape.angle - angle).abs() <= core::f64::consts::FRAC_PI_4 + 1e-12);
            let (before, after) = (wave.quadratures(), near.quadratures());
            for i in 0..2 {
                assert!((before.0[i] - after.0[i]).abs() < 1e-12);
                assert!((before.1[i] - after.1[i]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn half_a_turn_of_phase_is_positive() {
        use core::f64::consts::{FRAC_PI_2, PI};
        for (phase, quarters, near) in [
            (PI, 0.0, PI),
            (0.0, 1.0, PI),
            (0.0, -1.0, PI),
            (PI, 1.0, 0.0),
            (-0.5 * PI, 2.0, -0.5 * PI),
        ] {
            let shape = Shape {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.1,
                angle: 0.0,
            };
            let wave = Wave { shape, phase }.near(quarters * FRAC_PI_2);
            assert_eq!(wave.phase, near, "{phase}, {quarters}");
        }
    }
}
