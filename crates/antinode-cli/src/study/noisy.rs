//! Figure 3: rms errors in windows of one length over noise.

use rayon::prelude::*;

use super::evaluate::{CURVES, errors};
use super::figure::{Curve, Figure, Name, Panel, Point};
use super::samples::Samples;
use super::simulated::{STEPS, Simulated};
use crate::progress;

/// Runs that one core takes at a time. Sums over them are added in order, so that results do not depend on the number of cores.
const CHUNK: u32 = 250;

/// The noise at a step, rms a sample, in input units.
fn noise(simulated: &Simulated, step: u32) -> f64 {
    0.01 * simulated.percent(step) * simulated.wave().main_amplitude
}

/// Summed square errors of every curve at a step of the noise.
fn squares(
    simulated: &Simulated,
    step: u32,
    runs: std::ops::Range<u32>,
    seed: u64,
) -> [[f64; 4]; 8] {
    let mut sums = [[0.0; 4]; 8];
    let wave = &simulated.wave();
    let noise = noise(simulated, step);
    for run in runs {
        // Each run of each step has a seed of its own.
        let seed =
            seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (u64::from(step) << 32 | u64::from(run));
        let samples = Samples::simulate(wave, simulated.periods, simulated.rate, noise, seed);
        for (sums, errors) in sums.iter_mut().zip(errors(&samples, wave)) {
            for (sum, error) in sums.iter_mut().zip(errors) {
                *sum += error * error;
            }
        }
    }
    sums
}

/// Rms errors of every curve, a_A, a_B in input units, θ in degrees, f in Hz, for each step of the noise; over all cores.
pub fn rms(simulated: &Simulated, steps: &[u32], runs: u32, seed: u64) -> Vec<[[f64; 4]; 8]> {
    let chunks: Vec<(usize, u32)> = (0..steps.len())
        .flat_map(|i| (0..runs.div_ceil(CHUNK)).map(move |chunk| (i, chunk * CHUNK)))
        .collect();
    let bar = progress::bar(
        chunks.len() as u64,
        "figure 3: {wide_bar} {percent} % {eta}",
    );
    let parts: Vec<_> = chunks
        .par_iter()
        .map(|&(i, start)| {
            let part = squares(simulated, steps[i], start..(start + CHUNK).min(runs), seed);
            bar.inc(1);
            part
        })
        .collect();
    bar.finish_and_clear();
    let mut totals = vec![[[0.0; 4]; 8]; steps.len()];
    for ((i, _), part) in chunks.iter().zip(parts) {
        for (total, part) in totals[*i].iter_mut().flatten().zip(part.iter().flatten()) {
            *total += part;
        }
    }
    for total in totals.iter_mut().flatten().flatten() {
        *total = (*total / f64::from(runs)).sqrt();
    }
    totals
}

/// Ratio of the largest to the smallest error at the largest noise, at most, for an axis to be linear, as the paper's are.
const MAX_LINEAR_RATIO: f64 = 20.0;

/// Figure 3: windows of one length over noise.
pub fn against_noise(simulated: &Simulated, runs: u32, seed: u64) -> Figure {
    let wave = &simulated.wave();
    let steps: Vec<u32> = (0..=STEPS).collect();
    let rms = rms(simulated, &steps, runs, seed);
    let percent = 100.0 / wave.main_amplitude;
    let [bound, centred] =
        Samples::simulate(wave, simulated.periods, simulated.rate, 0.0, seed).bounds(wave);
    let kinds = [
        ('a', "main amplitude", "rms error, % of a_A", percent),
        ('b', "quadrature amplitude", "rms error, % of a_A", percent),
        ('c', "angle of the standing wave", "rms error, degrees", 1.0),
        ('d', "frequency", "rms error, Hz", 1.0),
    ];
    let panels = kinds.into_iter().enumerate();
    let panels = panels.map(|(i, (letter, title, axis, scale))| {
        let curves = CURVES.into_iter().enumerate().map(|(c, name)| Curve {
            name,
            y: rms.iter().map(|step| step[c][i] * scale).collect(),
        });
        let known = curves.filter(|curve| curve.y.iter().any(|y| y.is_finite()));
        let bounds = [(Name::Bound, bound[i]), (Name::CentredBound, centred[i])];
        let bounds = bounds.map(|(name, bound)| Curve {
            name,
            y: steps
                .iter()
                .map(|&step| bound * noise(simulated, step) * scale)
                .collect(),
        });
        let curves: Vec<_> = known.chain(bounds).collect();
        Panel {
            letter,
            title: format!("{title}, {}", simulated.window()),
            axis,
            logarithmic: is_wide(&curves),
            curves,
        }
    });
    let point = Point {
        periods: simulated.periods,
        rate: simulated.rate,
    };
    Figure {
        number: 3,
        axis: "noise, % of a_A, rms a sample",
        x: steps.iter().map(|&step| simulated.percent(step)).collect(),
        points: vec![point; steps.len()],
        runs: Some((runs, seed)),
        panels: panels.collect(),
    }
}

/// True if errors at the largest noise are too far apart for a linear axis.
fn is_wide(curves: &[Curve]) -> bool {
    let last = curves.iter().filter_map(|curve| curve.y.last().copied());
    let errors: Vec<f64> = last.filter(|error| *error > 0.0).collect();
    let greatest = errors.iter().copied().fold(0.0, f64::max);
    errors
        .iter()
        .any(|error| greatest > MAX_LINEAR_RATIO * error)
}
