//! Figure 3: rms errors on one period against noise.

use antinode_sim::Wave;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use super::RATE;
use super::evaluate::{CURVES, errors};
use super::figure::{Curve, Figure, Name, Panel};
use super::samples::Samples;

/// Noise levels, % of a_A.
const LEVELS: std::ops::RangeInclusive<u32> = 0..=20;
/// Runs that one core takes at a time. Sums over them are joined in order: results do not depend on the cores.
const CHUNK: u32 = 250;

/// Mean square errors of every curve in windows of `periods` at a noise level in % of a_A.
fn mean_squares(
    wave: &Wave,
    periods: u32,
    level: u32,
    runs: std::ops::Range<u32>,
    seed: u64,
) -> [[f64; 4]; 8] {
    let mut sums = [[0.0; 4]; 8];
    let noise = 0.01 * f64::from(level) * wave.main_amplitude;
    for run in runs {
        // A run of a level has a seed of its own.
        let seed =
            seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (u64::from(level) << 32 | u64::from(run));
        let samples = Samples::simulate(wave, periods, RATE, noise, seed);
        for (sums, errors) in sums.iter_mut().zip(errors(&samples, wave)) {
            for (sum, error) in sums.iter_mut().zip(errors) {
                *sum += error * error;
            }
        }
    }
    sums
}

/// Rms errors of every curve, a_A, a_B in input units, θ in degrees, f in Hz, for each level; over all cores.
pub fn rms(wave: &Wave, periods: u32, levels: &[u32], runs: u32, seed: u64) -> Vec<[[f64; 4]; 8]> {
    let chunks: Vec<(usize, u32)> = (0..levels.len())
        .flat_map(|i| (0..runs.div_ceil(CHUNK)).map(move |chunk| (i, chunk * CHUNK)))
        .collect();
    let style = ProgressStyle::with_template("figure 3: {wide_bar} {percent} % {eta}");
    let bar = ProgressBar::new(chunks.len() as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let parts: Vec<_> = chunks
        .par_iter()
        .map(|&(i, start)| {
            let part = mean_squares(
                wave,
                periods,
                levels[i],
                start..(start + CHUNK).min(runs),
                seed,
            );
            bar.inc(1);
            part
        })
        .collect();
    bar.finish_and_clear();
    let mut totals = vec![[[0.0; 4]; 8]; levels.len()];
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

/// Figure 3: one period, noise of 0 to 20 % of a_A.
pub fn against_noise(wave: &Wave, runs: u32, seed: u64) -> Figure {
    let levels: Vec<u32> = LEVELS.collect();
    let rms = rms(wave, 1, &levels, runs, seed);
    let percent = 100.0 / wave.main_amplitude;
    let [bound, centred] = Samples::simulate(wave, 1, RATE, 0.0, seed).bounds(wave);
    let bounds = [(Name::Bound, bound), (Name::CentredBound, centred)];
    let kinds = [
        ('a', "main amplitude", "rms error, % of a_A", percent),
        ('b', "quadrature amplitude", "rms error, % of a_A", percent),
        ('c', "angle of the standing wave", "rms error, degrees", 1.0),
        ('d', "frequency", "rms error, Hz", 1.0),
    ];
    let panels = kinds
        .into_iter()
        .enumerate()
        .map(|(i, (letter, title, axis, scale))| {
            let mut curves: Vec<Curve> = CURVES
                .into_iter()
                .enumerate()
                .map(|(c, name)| Curve {
                    name,
                    y: rms.iter().map(|level| level[c][i] * scale).collect(),
                })
                .filter(|curve| curve.y.iter().any(|y| y.is_finite()))
                .collect();
            let noise = |level: &u32| 0.01 * f64::from(*level) * wave.main_amplitude;
            for (name, bound) in bounds {
                curves.push(Curve {
                    name,
                    y: levels
                        .iter()
                        .map(|level| bound[i] * noise(level) * scale)
                        .collect(),
                });
            }
            Panel {
                letter,
                title: format!("{title}, one period"),
                axis,
                logarithmic: false,
                curves,
            }
        });
    Figure {
        number: 3,
        axis: "noise, % of a_A, rms a sample",
        x: levels.iter().map(|&level| f64::from(level)).collect(),
        panels: panels.collect(),
    }
}
