//! The step between a converter's codes, found in the samples.

use super::error::Fault;
use super::{BLOCK_PAIRS, Source, codes};

/// Samples needed for each distinct value of a channel, if these are few: a noise-free wave repeats a few values too.
const MIN_SAMPLES_A_VALUE: usize = 8;
/// Fewest distinct values that show a step.
const MIN_VALUES: usize = 8;
/// Distinct values that lie on a grid by chance less than once in 10³⁰ times.
const SURE_VALUES: usize = 64;
/// Largest deviation of a distance between two values from a whole number of steps, in steps.
const TOLERANCE: f64 = 0.125;
/// Smallest distance of two values, in units in the last place of the largest: smaller ones show the steps of single precision itself.
const MIN_UNITS: f32 = 4.0;

/// Blocks looked at, at most, if a file begins in silence.
const MAX_HEAD_BLOCKS: usize = 16;

/// The step between a converter's codes, found in the samples; the greater one if the channels differ.
///
/// None for a continuous signal, however it was rounded: the steps of single precision itself are not a converter's.
pub(super) fn resolution(pairs: &[[f32; 2]]) -> Option<f32> {
    let steps = [0, 1].map(|channel| step(pairs.iter().map(|pair| pair[channel])));
    // Below the normal numbers there is no wave to be identified.
    let step = steps.into_iter().flatten().reduce(f32::max);
    let step = step.filter(|step| step.is_normal());
    step.or_else(|| codes::of_whole(pairs))
}

/// The first pairs of a file, the step found in them, and the fault behind them, if any.
pub(super) fn of_head(source: &mut Source) -> (Vec<[f32; 2]>, Option<f32>, Option<Fault>) {
    let mut head = Vec::with_capacity(BLOCK_PAIRS);
    let mut end = 0;
    loop {
        let before = head.len();
        end += BLOCK_PAIRS;
        let fault = source.fill(&mut head, end).err();
        let step = resolution(&head[before..]);
        let is_last = fault.is_some() || head.len() < end || end >= MAX_HEAD_BLOCKS * BLOCK_PAIRS;
        if is_last || step.is_some() || !is_silent(&head[before..]) {
            return (head, step, fault);
        }
    }
}

/// Whether both channels have too few distinct values to show a step.
fn is_silent(pairs: &[[f32; 2]]) -> bool {
    (0..2).all(|channel| {
        let mut values = Vec::with_capacity(MIN_VALUES);
        let samples = pairs.iter().map(|pair| pair[channel]);
        for sample in samples.filter(|sample| sample.is_finite()) {
            if !values.contains(&sample) {
                values.push(sample);
            }
            // Usually reached within a few samples, so that nothing need be sorted.
            if values.len() == MIN_VALUES {
                return false;
            }
        }
        true
    })
}

/// The greatest step of which all distances between samples are whole multiples, within the rounding of the text.
fn step(samples: impl Iterator<Item = f32>) -> Option<f32> {
    let mut values: Vec<f32> = samples.filter(|sample| sample.is_finite()).collect();
    let count = values.len();
    values.sort_unstable_by(f32::total_cmp);
    // Zeros of both signs are one value.
    values.dedup_by(|a, b| a == b);
    if values.len() < MIN_VALUES {
        return None;
    }
    let largest = values[0].abs().max(values[values.len() - 1].abs());
    let mut distances: Vec<(f64, f64)> = values
        .windows(2)
        .map(|pair| {
            let [low, high] = [pair[0], pair[1]].map(f64::from);
            let rounding = f64::from(f32::EPSILON) * low.abs().max(high.abs());
            (high - low, rounding)
        })
        .collect();
    distances.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    if distances[0].0 <= f64::from(MIN_UNITS * f32::EPSILON * largest) {
        return None;
    }
    // The shortest distance gives a first estimate of the step, which each longer one refines.
    let (mut length, mut steps) = (0.0, 0.0);
    for &(distance, rounding) in &distances {
        let step = if steps > 0.0 {
            length / steps
        } else {
            distance
        };
        let whole = (distance / step).round();
        if (distance - whole * step).abs() > TOLERANCE * step + rounding {
            return None;
        }
        (length, steps) = (length + distance, steps + whole);
    }
    let is_filled =
        steps <= 2.0 * values.len() as f64 && count >= MIN_SAMPLES_A_VALUE * values.len();
    (values.len() >= SURE_VALUES || is_filled).then_some((length / steps) as f32)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use antinode_sim::{Flaws, Gyro, Wave};

    use super::*;

    /// A wave in noise, each sample as `print` gives it.
    fn printed(main_amplitude: f64, noise: f64, print: impl Fn(f64) -> f32) -> Vec<[f32; 2]> {
        let wave = Wave {
            main_amplitude,
            quadrature_amplitude: 0.01 * main_amplitude,
            ..Wave::default()
        };
        let gyro = Gyro::new(wave, Flaws::white(noise), 1e5, 1).expect("a valid gyro");
        gyro.take(1 << 14).map(|pair| pair.map(&print)).collect()
    }

    #[test]
    fn the_steps_of_a_converter_are_found() {
        let volts = 3.3 / 4096.0;
        for (amplitude, step, decimals) in [
            (0.9, 1.0 / 32_768.0, 17),
            (0.9, 1.0 / 32_768.0, 6),
            (0.9, 1.0 / 2_097_152.0, 17),
            (6e-4, 1.0 / 32_768.0, 17),
            (1.2, volts, 17),
            (1.2, volts, 4),
            (9000.0, 1.0, 0),
            (12.0, 1.0, 0),
        ] {
            for (noise, offset) in [(0.0, 0.0), (0.3, 0.0), (3.0, 100.0)] {
                let print = |value: f64| {
                    let code = step * (value / step + offset).round();
                    format!("{code:.decimals$}").parse().expect("a number")
                };
                let found = resolution(&printed(amplitude, noise * step, print));
                let found = f64::from(found.unwrap_or(f32::NAN)) / step;
                assert!(
                    (found - 1.0).abs() < 1e-2,
                    "{amplitude} {step} {decimals} {noise}: {found}"
                );
            }
        }
    }

    #[test]
    fn the_greater_step_counts_if_the_pick_offs_differ() {
        let wave = printed(0.9, 0.01, |value| value as f32);
        let stepped = |steps: [f32; 2]| -> Vec<[f32; 2]> {
            let code = |value: f32, step: f32| (value / step).round() * step;
            let pair = |&[c, d]: &[f32; 2]| [code(c, steps[0]), code(d, steps[1])];
            wave.iter().map(pair).collect()
        };
        for steps in [[0.01, 0.03], [0.03, 0.01]] {
            let found = resolution(&stepped(steps)).unwrap();
            assert!((found / 0.03 - 1.0).abs() < 1e-2, "{steps:?}: {found}");
        }
    }

    #[test]
    fn a_continuous_signal_has_no_step() {
        for noise in [0.0, 1e-6, 1e-3] {
            assert_eq!(resolution(&printed(0.5, noise, |x| x as f32)), None);
            let digits = |x: f64| format!("{x:.8e}").parse().expect("a number");
            assert_eq!(resolution(&printed(0.5, noise, digits)), None);
            let decimals = |x: f64| format!("{x:.9}").parse().expect("a number");
            assert_eq!(resolution(&printed(0.5, noise, decimals)), None);
            // The rounding of the text has a step of its own, here too small to matter.
            let coarse = |x: f64| format!("{x:.6}").parse().expect("a number");
            let found = resolution(&printed(0.5, noise, coarse));
            assert!(found.is_none_or(|step| step < 1.01e-6), "{found:?}");
        }
        // The same few values over and over, as a wave without noise has them.
        for period in 4..200 {
            for phase in 0..20 {
                let sample =
                    |k: usize| (TAU * k as f64 / period as f64 + 0.1 * phase as f64).cos() as f32;
                let few: Vec<_> = (0..period).map(|k| [sample(k), 0.0]).collect();
                let pairs: Vec<[f32; 2]> = few.into_iter().cycle().take(1 << 14).collect();
                assert_eq!(resolution(&pairs), None, "{period} {phase}");
            }
        }
    }

    #[test]
    fn samples_that_are_not_finite_or_constant_do_not_matter() {
        assert_eq!(resolution(&[]), None);
        assert_eq!(resolution(&[[1.0, f32::NAN]; 1000]), None);
        let mut pairs = printed(0.5, 0.0, |x| (x * 64.0).round() as f32 / 64.0);
        for (k, pair) in pairs.iter_mut().enumerate() {
            pair[1] = 7.0;
            if k % 1000 == 0 {
                pair[0] = f32::INFINITY;
            }
        }
        assert_eq!(resolution(&pairs), Some(1.0 / 64.0));
    }
}
