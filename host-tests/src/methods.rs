//! Helpers of the tests of the methods.

use std::f64::consts::TAU;

use antinode::methods::Wave as Found;
use antinode_sim::Wave;

use crate::RATE;

/// Samples before a window's time zero, enough for a quarter period.
pub const LEAD: usize = 10;

/// A window of `periods` of a wave, after `LEAD` samples.
pub fn samples(wave: &Wave, periods: usize) -> Vec<[f32; 2]> {
    let n = (periods as f64 * RATE / wave.frequency).round() as usize;
    (0..n + LEAD)
        .map(|k| {
            let [c, d] = wave.pick_offs((k as f64 - LEAD as f64) / RATE);
            [c as f32, d as f32]
        })
        .collect()
}

/// a_A, a_B, θ and α of a wave that the core found.
pub fn numbers(wave: &Found) -> [f64; 4] {
    let s = wave.shape;
    [
        s.main_amplitude,
        s.quadrature_amplitude,
        s.angle,
        wave.phase,
    ]
}

/// ω of a wave, rad a sample.
pub fn omega(wave: &Wave) -> f64 {
    TAU * wave.frequency / RATE
}

/// Formats numbers for messages.
pub fn list(numbers: &[f64]) -> String {
    let texts: Vec<String> = numbers.iter().map(|x| format!("{x:.1e}")).collect();
    texts.join(", ")
}
