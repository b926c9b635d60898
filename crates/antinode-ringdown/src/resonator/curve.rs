//! Damping that changes while a wave rings down.
//!
//! If it changes for both modes alike, by g(t), it only makes the whole wave smaller, by e^−p with p = ∫g dt: the motion is linear, but for
//! γ, whose effect becomes smaller by a share of 2p, which is neglected. So rows are compared with the motion after they have been made
//! larger by e^p. A gain that both pick-offs share acts in the same way.

use crate::runs::{Row, Run};

/// The place of the curve of a damping in proportion to a_A² + a_B², ∫(a_A² + a_B²) dt in s: it is known from the rows themselves.
pub const BY_ENERGY: usize = 0;
/// The place of the first curve over time: the Legendre polynomials from that of the second degree on, over the time from the run's first
/// row to its last. They leave a straight line, the decay, as it is.
pub const IN_TIME: usize = 1;
/// Number of these.
pub const MAX_IN_TIME: usize = 6;
/// Number of all curves.
pub const CURVES: usize = IN_TIME + MAX_IN_TIME;

/// The curves at each row of a run: by how much each makes p larger, per unit.
pub fn curves(run: &Run) -> Vec<[f64; CURVES]> {
    let energy = |row: &Row| row.main * row.main + row.quadrature * row.quadrature;
    let (from, half) = (run.rows[0].time, 0.5 * run.seconds());
    let mut before = &run.rows[0];
    let mut integral = 0.0;
    let at = |row| {
        integral += 0.5 * (energy(before) + energy(row)) * (row.time - before.time);
        before = row;
        let x = (row.time - from) / half - 1.0;
        let mut curves = [integral; CURVES];
        let (mut last, mut next) = (1.0, x);
        for (degree, curve) in (1..).zip(&mut curves[IN_TIME..]) {
            let degree = f64::from(degree);
            let after = ((2.0 * degree + 1.0) * x * next - degree * last) / (degree + 1.0);
            (last, next) = (next, after);
            *curve = after;
        }
        curves
    };
    run.rows.iter().map(at).collect()
}

/// Change of the decay rate with time, 1/s², in a run of this length, s, per unit of its first curve over time: that of a parabola through
/// the logarithm of its amplitudes.
pub fn drift(seconds: f64) -> f64 {
    12.0 / (seconds * seconds)
}

/// A row whose wave is larger by e^p, where p is the sum of its curves, each by a factor.
pub fn undamped(row: &Row, curves: &[f64; CURVES], factors: &[f64; CURVES]) -> Row {
    let p: f64 = curves.iter().zip(factors).map(|(at, by)| at * by).sum();
    let by = p.exp();
    let [of_main, of_quadrature, of_angle] = row.deviations;
    Row {
        main: by * row.main,
        quadrature: by * row.quadrature,
        deviations: [by * of_main, by * of_quadrature, of_angle],
        ..*row
    }
}
