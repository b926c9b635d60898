//! Detection of waves whose periods are too long or too short to be searched, until there is a row; named if there is none.

use antinode::period::DifferenceDetector;

use super::super::{LONGEST_PERIOD, SHORTEST_PERIOD};
use super::longest;
use crate::digits::significant;

/// Pairs averaged into one to detect a slow wave: periods of 128 to 6400 samples, and of 32 times as many in the means of means.
const AVERAGED: u32 = 32;
/// Share of the samples' power that the means of a slow wave keep, at least.
const MIN_KEPT_POWER: f64 = 0.6;
/// Power of the differences of neighbours over that of the samples, at least, for a fast wave; at four samples a period it is 2.
const MIN_DIFFERENCE_POWER: f64 = 1.6;
/// Consecutive periods that must agree before one is accepted, and the relative difference allowed.
const MIN_AGREEING: u32 = 4;
const MAX_APART: f32 = 0.02;
/// Periods that finding one so often may take; in a shorter recording a slow wave need be found only once.
const MAX_AGREEING_PERIODS: f64 = 16.0;
/// Pairs searched, at most: a long recording of noise need not be searched three times to its end.
const MAX_PAIRS: u32 = 1_000_000;

/// A search whose period is accepted once it is found several times in a row.
#[derive(Debug, Default)]
struct PeriodSearch {
    detector: Box<DifferenceDetector<f32>>,
    period: f32,
    alike: u32,
}

impl PeriodSearch {
    fn push(&mut self, pair: [f32; 2]) {
        // An accepted period stays when the wave has decayed.
        if self.found().is_some() {
            return;
        }
        let Some(period) = self.detector.push(pair) else {
            return;
        };
        let is_like = (period / self.period - 1.0).abs() < MAX_APART;
        self.alike = if is_like { self.alike + 1 } else { 1 };
        self.period = period;
        self.detector.restart();
    }

    fn found(&self) -> Option<f64> {
        (self.alike >= MIN_AGREEING).then_some(f64::from(self.period))
    }
}

/// Sums of pairs and of their squares, for the power about the mean.
#[derive(Debug, Default)]
struct Power {
    count: f64,
    sums: [f64; 2],
    squares: f64,
}

impl Power {
    fn add(&mut self, pair: [f32; 2]) {
        self.count += 1.0;
        for (sum, value) in self.sums.iter_mut().zip(pair.map(f64::from)) {
            *sum += value;
            self.squares += value * value;
        }
    }

    fn value(&self) -> f64 {
        let [c, d] = self.sums.map(|sum| sum / self.count);
        self.squares / self.count - c * c - d * d
    }
}

/// The search for a slow wave in means.
#[derive(Debug, Default)]
struct InMeans {
    pairs: u32,
    sum: [f32; 2],
    power: Power,
    search: PeriodSearch,
}

impl InMeans {
    /// Takes a pair, and gives the mean that it completes.
    fn take(&mut self, pair: [f32; 2]) -> Option<[f32; 2]> {
        self.sum = [self.sum[0] + pair[0], self.sum[1] + pair[1]];
        self.pairs += 1;
        if self.pairs < AVERAGED {
            return None;
        }
        let mean = self.sum.map(|sum| sum / AVERAGED as f32);
        self.power.add(mean);
        self.search.push(mean);
        (self.pairs, self.sum) = (0, [0.0; 2]);
        Some(mean)
    }

    /// The wave's period, in the pairs taken, of which there were so many, if the means keep most of the samples' power.
    fn found(&self, power: f64, pairs: f64) -> Option<f64> {
        let averaged = f64::from(AVERAGED);
        let last = averaged * f64::from(self.search.period);
        let only = (last > 0.0 && pairs < MAX_AGREEING_PERIODS * last).then_some(last);
        let period = self.search.found().map(|period| averaged * period);
        let is_kept = self.power.value() > MIN_KEPT_POWER * power;
        period.or(only).filter(|_| is_kept)
    }
}

/// The search for waves of periods that the core does not search.
#[derive(Debug, Default)]
pub(super) struct UnsearchedWave {
    pairs: u32,
    last: [f32; 2],
    slow: InMeans,
    /// In the means of `slow`.
    slower: InMeans,
    fast: PeriodSearch,
    samples: Power,
    differences: Power,
}

impl UnsearchedWave {
    /// Takes pairs in which no period has been found yet.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        for &pair in pairs {
            if self.pairs < MAX_PAIRS && pair.iter().all(|value| value.is_finite()) {
                self.take(pair);
            }
        }
    }

    fn take(&mut self, pair: [f32; 2]) {
        self.samples.add(pair);
        if let Some(mean) = self.slow.take(pair) {
            self.slower.take(mean);
        }
        // Differences remove the offset; inverting every other one maps a frequency to half the sample rate less that.
        if self.pairs > 0 {
            let difference = [pair[0] - self.last[0], pair[1] - self.last[1]];
            self.differences.add(difference);
            let sign = if self.pairs.is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            self.fast.push(difference.map(|value| sign * value));
        }
        self.last = pair;
        self.pairs += 1;
    }

    /// A warning that names the wave seen in so many pairs of this rate, Hz, and what finds it in windows of these periods.
    pub fn warning(&self, rate: f64, pairs: u64, periods: u16) -> Option<String> {
        let pairs = pairs as f64;
        let power = self.samples.value();
        let is_fast = self.differences.value() > MIN_DIFFERENCE_POWER * power;
        let averaged = f64::from(AVERAGED);
        let slower = || Some(averaged * self.slower.found(power, pairs / averaged)?);
        let slow = self.slow.found(power, pairs).or_else(slower);
        let fast = self
            .fast
            .found()
            .map(|period| 1.0 / (0.5 - 1.0 / period))
            .filter(|_| is_fast);
        let period = slow.or(fast)?;
        // Three digits are the accuracy of a search.
        let [frequency, period] = [rate / period, period].map(|value| significant(value, 3));
        let seen = format!("a wave of about {frequency} Hz has {period} samples a period");
        Some(if period < SHORTEST_PERIOD {
            format!(
                "{seen}, fewer than the minimum of {SHORTEST_PERIOD}: check the sample rate, or sample at another rate"
            )
        } else if period > LONGEST_PERIOD as f64 {
            format!(
                "{seen}, more than the maximum of {LONGEST_PERIOD}: check the sample rate; if a lock-in amplifier demodulated the samples, \
                 give the pick-offs' own"
            )
        } else {
            let most = (pairs / longest(1, period)) as u16;
            let windows = match most {
                0 | 1 => "; record longer, as a window has at least 2 periods".to_owned(),
                _ if most < periods => format!(" --periods {most}"),
                _ => String::new(),
            };
            format!(
                "{seen}, outside the search range of 4 to 200: if that is the pick-offs' wave, give --frequency {frequency}{windows}"
            )
        })
    }
}

/// A note on the frequency, Hz, at which an undersampled wave shows; empty up to half the sample rate.
pub fn alias(frequency: f64, rate: f64) -> String {
    if frequency <= 0.5 * rate {
        return String::new();
    }
    let seen = (frequency - rate * (frequency / rate).round()).abs();
    format!("; if undersampled on purpose, this wave appears at {seen} Hz")
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use antinode_sim::Deviates;

    const RATE: f64 = 1e5;

    /// The warning for tones, each with a period in samples and an amplitude, about an offset in noise.
    fn told(tones: &[(f64, f64)], noise: f64) -> Option<String> {
        told_of_decaying(tones, noise, f64::INFINITY)
    }

    /// The same for tones with this decay time, in samples.
    fn told_of_decaying(tones: &[(f64, f64)], noise: f64, decay: f64) -> Option<String> {
        let mut deviates = Deviates::new(1);
        let mut unsearched = UnsearchedWave::default();
        let mut pairs: Vec<[f32; 2]> = (0..150_000)
            .map(|k| {
                let left = (-f64::from(k) / decay).exp();
                [0.8, -0.5].map(|share| {
                    let tone = |&(period, amplitude): &(f64, f64)| {
                        amplitude * (TAU * f64::from(k) / period).cos()
                    };
                    let wave: f64 = tones.iter().map(tone).sum();
                    (0.5 + share * left * wave + noise * deviates.draw()) as f32
                })
            })
            .collect();
        // A sample that is missing on one pick-off.
        pairs[999][1] = f32::NAN;
        unsearched.see(&pairs);
        unsearched.warning(RATE, 150_000, 10)
    }

    #[test]
    fn waves_beyond_the_search_are_named() {
        for (period, names) in [
            (
                2.08,
                "has 2.08 samples a period, fewer than the minimum of 2.5",
            ),
            (2.7, "--frequency 37000"),
            (3.3, "--frequency 30300"),
            (243.9, "--frequency 410"),
            (900.0, "--frequency 111"),
            (
                3300.0,
                "about 30.3 Hz has 3300 samples a period, more than the maximum of 1024",
            ),
            (
                9000.0,
                "about 11.1 Hz has 9000 samples a period, more than the maximum of 1024",
            ),
        ] {
            for noise in [1e-4, 0.01] {
                let told = told(&[(period, 1.0)], noise).expect("a wave");
                assert!(told.contains(names), "{period} {noise}: {told}");
            }
        }
    }

    #[test]
    fn a_wave_that_decays_into_noise_is_named() {
        for (period, names) in [(3.3, "--frequency 30300"), (244.0, "--frequency 410")] {
            let told = told_of_decaying(&[(period, 1.0)], 0.01, 15_000.0).expect("a wave");
            assert!(told.contains(names), "{told}");
        }
    }

    #[test]
    fn searched_waves_noise_and_pairs_of_tones_are_not_named() {
        for noise in [0.01, 1.0] {
            assert_eq!(told(&[], noise), None);
            for period in [4.5, 18.75, 60.0] {
                assert_eq!(told(&[(period, 1.0)], noise), None, "{period} {noise}");
            }
        }
        // Two tones that hide each other's period from the search.
        assert_eq!(told(&[(18.8, 0.5), (37.6, 0.28)], 1e-3), None);
        assert_eq!(told(&[(18.8, 0.45), (14.3, 0.45)], 1e-3), None);
        // A fast tone that is not most of the samples.
        assert_eq!(told(&[(18.8, 0.9), (3.3, 0.3)], 1e-3), None);
    }
}
