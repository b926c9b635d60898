//! The mean spectrum of samples, and the lines that stand out of it.

use std::f64::consts::TAU;

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftDirection, Length};

use crate::median::median;

/// Coefficients of the four-term Blackman–Harris window, and the share of a tone's power that it leaves: beyond [`HALF_WIDTH`] lines from a
/// tone it leaves less than 3·10⁻⁵ of its amplitude (F. J. Harris, *On the use of windows for harmonic analysis with the discrete Fourier
/// transform*, 1978).
const WINDOW: [f64; 4] = [0.35875, -0.48829, 0.14128, -0.01168];
const LEFT: f64 = 0.257_964;
/// Lines of a tone on either side of its middle.
const HALF_WIDTH: usize = 4;
/// Lines on either side among which a tone is the highest, and those whose median it must exceed.
const ALONE: usize = 8;
const NEIGHBOURS: usize = 48;
/// Lowest lines, which belong to an offset and its drift.
const SKIPPED: usize = 6;
/// Power of a line of a single spectrum over the median of its neighbours, at least: noise has it in one of 2·10⁷ lines.
const OVER_MEDIAN: f64 = 12.0;

/// The mean of the spectra of S_C and S_D, all of one length.
pub(super) struct Spectrum {
    /// Not by a planner, which takes all lengths: its code would be a tenth of the command's.
    transform: Radix4<f64>,
    /// The window, per pair.
    weights: Vec<f64>,
    spectra: u32,
    /// Sums of the powers of S_C and of S_D, per line.
    powers: Vec<[f64; 2]>,
}

/// A line that stands out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Its frequency, in lines; between two lines it is no whole number.
    pub place: f64,
    /// Amplitudes of its tone in S_C and in S_D.
    pub amplitudes: [f64; 2],
}

impl Spectrum {
    /// No spectra yet, each of `length` pairs, a power of two.
    pub fn new(length: usize) -> Self {
        let weight = |k: usize| {
            let turns = (k as f64 + 0.5) / length as f64;
            let terms = WINDOW.iter().zip(0u8..);
            terms
                .map(|(by, order)| by * (TAU * turns * f64::from(order)).cos())
                .sum()
        };
        Self {
            transform: Radix4::new(length, FftDirection::Forward),
            weights: (0..length).map(weight).collect(),
            spectra: 0,
            powers: vec![[0.0; 2]; length / 2],
        }
    }

    /// How many spectra there are.
    pub fn count(&self) -> u32 {
        self.spectra
    }

    /// The pairs in a spectrum.
    pub fn length(&self) -> usize {
        self.transform.len()
    }

    /// Adds the spectrum of `length` pairs, unless any is not finite.
    pub fn add(&mut self, pairs: &[[f32; 2]]) {
        let length = self.length();
        let mut lines: Vec<_> = pairs
            .iter()
            .map(|&[c, d]| Complex64::new(c.into(), d.into()))
            .collect();
        let mean = lines.iter().sum::<Complex64>() / length as f64;
        if !mean.is_finite() {
            return;
        }
        for (line, weight) in lines.iter_mut().zip(&self.weights) {
            *line = (*line - mean) * weight;
        }
        self.transform.process(&mut lines);
        for (k, powers) in self.powers.iter_mut().enumerate().skip(1) {
            // The spectra of C and j D, from that of C + j D.
            let (one, other) = (lines[k], lines[length - k].conj());
            powers[0] += 0.25 * (one + other).norm_sqr();
            powers[1] += 0.25 * (one - other).norm_sqr();
        }
        self.spectra += 1;
    }

    /// The lines that stand out with at least this share of the power of all lines; those within `excluded` lines of `wave` are left out.
    pub fn stand_out(&self, wave: f64, excluded: f64, share: f64) -> Vec<Line> {
        if self.spectra == 0 {
            return Vec::new();
        }
        let powers: Vec<f64> = self.powers.iter().map(|[c, d]| c + d).collect();
        let is_asked = |k: &usize| (*k as f64 - wave).abs() > excluded;
        let total: f64 = (SKIPPED..powers.len())
            .filter(is_asked)
            .map(|k| powers[k])
            .sum();
        // The mean of more spectra scatters less.
        let over_median = 1.0 + (OVER_MEDIAN - 1.0) / f64::from(self.spectra).sqrt();
        let length = self.length() as f64;
        // A tone's lines at positive frequencies have a quarter of its amplitude's square.
        let scale = 4.0 / (LEFT * length * length * f64::from(self.spectra));
        let near =
            |k: usize, by: usize| k.saturating_sub(by).max(1)..(k + by + 1).min(powers.len());
        let mut found = Vec::new();
        for k in (SKIPPED..powers.len() - 1).filter(is_asked) {
            let own: f64 = powers[near(k, HALF_WIDTH)].iter().sum();
            let is_highest = powers[near(k, ALONE)]
                .iter()
                .all(|&other| other <= powers[k]);
            if own < share * total || !is_highest {
                continue;
            }
            let mut around: Vec<f64> = near(k, NEIGHBOURS)
                .filter(|other| other.abs_diff(k) > HALF_WIDTH)
                .map(|other| powers[other])
                .collect();
            if median(&mut around).is_none_or(|median| powers[k] <= over_median * median) {
                continue;
            }
            // The window's lines about a tone are nearly a parabola of logarithms.
            let [before, at, after] = [k - 1, k, k + 1].map(|k| powers[k].ln());
            let bend = before - 2.0 * at + after;
            let beside = if bend < 0.0 {
                0.5 * (before - after) / bend
            } else {
                0.0
            };
            let amplitude = |signal: usize| {
                let power = near(k, HALF_WIDTH).map(|k| self.powers[k][signal]);
                (scale * power.sum::<f64>()).sqrt()
            };
            let line = Line {
                place: k as f64 + beside,
                amplitudes: [amplitude(0), amplitude(1)],
            };
            found.push((own, line));
        }
        found.sort_by(|(one, _), (other, _)| other.total_cmp(one));
        found.into_iter().map(|(_, line)| line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use antinode_sim::Deviates;

    /// Pairs of noise of this rms, and tones: turns per pair, and amplitudes in both signals.
    fn pairs(count: usize, noise: f64, seed: u64, tones: &[(f64, [f64; 2])]) -> Vec<[f32; 2]> {
        let mut deviates = Deviates::new(seed);
        (0..count)
            .map(|k| {
                let wave = |signal: usize| {
                    let tones = tones.iter().map(|(turns, amplitudes)| {
                        amplitudes[signal] * (TAU * (turns * k as f64 + 0.3)).cos()
                    });
                    tones.sum::<f64>()
                };
                [0, 1].map(|signal| (wave(signal) + noise * deviates.draw()) as f32)
            })
            .collect()
    }

    fn of(length: usize, pairs: &[[f32; 2]]) -> Spectrum {
        let mut spectrum = Spectrum::new(length);
        pairs
            .chunks_exact(length)
            .for_each(|pairs| spectrum.add(pairs));
        spectrum
    }

    #[test]
    fn nothing_stands_out_of_noise() {
        for seed in 1..=20 {
            for spectra in [1, 4, 30] {
                let noise = pairs(spectra << 11, 0.01, seed, &[]);
                let found = of(1 << 11, &noise).stand_out(100.0, 10.0, 0.0);
                assert_eq!(found.len(), 0, "{seed}, {spectra}: {found:?}");
            }
        }
    }

    #[test]
    fn tones_are_found_with_their_frequencies_and_amplitudes() {
        let length = 1 << 12;
        let mut deviates = Deviates::new(7);
        for seed in 1..=30 {
            // Beside a wave of amplitude 1, 30 lines and more away.
            let place = 300.0 + 1000.0 * deviates.draw().abs().min(1.7);
            let other = place - 31.0 - 9.0 * deviates.draw().abs();
            let tones = [
                (place, [0.003, 0.001]),
                (250.4, [0.8, 0.6]),
                (other, [0.0, 0.002]),
            ];
            let turns = tones.map(|(place, amplitudes)| (place / length as f64, amplitudes));
            let spectrum = of(length, &pairs(8 * length, 0.001, seed, &turns));
            let found = spectrum.stand_out(250.4, 10.0, 0.02);
            let expected = [tones[0], tones[2]];
            let expected = expected
                .iter()
                .filter(|(place, _)| (place - 250.4).abs() > 10.0);
            let expected: Vec<_> = expected.collect();
            assert_eq!(found.len(), expected.len(), "{tones:?}: {found:?}");
            for (line, (place, amplitudes)) in found.iter().zip(expected) {
                assert!((line.place - place).abs() < 0.05, "{place}: {line:?}");
                for (found, truth) in line.amplitudes.iter().zip(amplitudes) {
                    // What noise adds to the nine lines of a tone is 4e-5.
                    assert!(
                        (found - truth).abs() < 0.03 * truth + 1.5e-4,
                        "{place}: {line:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut pairs = pairs(2048, 0.01, 1, &[(0.1, [0.5, 0.0])]);
        pairs[700][1] = f32::NAN;
        assert_eq!(of(2048, &pairs).stand_out(500.0, 10.0, 0.0).len(), 0);
        let mut spectrum = of(1024, &pairs);
        assert_eq!(spectrum.count(), 1);
        spectrum.add(&pairs[..1024]);
        assert_eq!(spectrum.stand_out(500.0, 10.0, 0.1).len(), 1);
    }
}
