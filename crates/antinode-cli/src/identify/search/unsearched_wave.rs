//! Waves whose periods are not searched, too long or too short: they are looked for until there is a row, to be named where there is none.

use antinode::period::DifferenceDetector;

use super::super::{LONGEST, SHORTEST};

/// Pairs that are summed into one to see a slow wave: periods of 128 to 6400 samples.
const SUMMED: u32 = 32;
/// Share of the samples' power that their means keep where they are a slow wave.
const KEPT: f64 = 0.6;
/// Power of the differences of neighbours over that of the samples where they are a fast wave; a wave of four samples a period has 2.
const DIFFERING: f64 = 1.6;
/// Periods found one after the other that agree before they are believed, and how far they may be apart.
const ALIKE: u32 = 4;
const APART: f32 = 0.02;
/// Pairs that are looked at: a recording of noise need not be searched thrice to its end.
const MOST: u32 = 1_000_000;

/// A search for a period that is believed if it is found again and again.
#[derive(Debug)]
struct Looking {
    detector: Box<DifferenceDetector<f32>>,
    period: f32,
    alike: u32,
}

impl Default for Looking {
    fn default() -> Self {
        Self {
            detector: Box::new(DifferenceDetector::new()),
            period: 0.0,
            alike: 0,
        }
    }
}

impl Looking {
    fn push(&mut self, pair: [f32; 2]) {
        // What was believed stays so when the wave has decayed.
        if self.found().is_some() {
            return;
        }
        let Some(period) = self.detector.push(pair) else {
            return;
        };
        let is_like = (period / self.period - 1.0).abs() < APART;
        self.alike = if is_like { self.alike + 1 } else { 1 };
        self.period = period;
        self.detector.restart();
    }

    fn found(&self) -> Option<f64> {
        (self.alike >= ALIKE).then_some(f64::from(self.period))
    }
}

/// Sums of pairs and of their squares, which tell the power about the mean.
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

/// The search for waves of periods that the core does not search.
#[derive(Debug, Default)]
pub(super) struct UnsearchedWave {
    pairs: u32,
    last: [f32; 2],
    sum: [f32; 2],
    slow: Looking,
    fast: Looking,
    samples: Power,
    means: Power,
    differences: Power,
}

impl UnsearchedWave {
    /// Takes pairs in which no period has been found yet.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        for &pair in pairs {
            if self.pairs < MOST && pair.iter().all(|value| value.is_finite()) {
                self.take(pair);
            }
        }
    }

    fn take(&mut self, pair: [f32; 2]) {
        self.samples.add(pair);
        self.sum = [self.sum[0] + pair[0], self.sum[1] + pair[1]];
        // A difference knows no offset; every other one turned round, half the sample rate less a frequency takes its place.
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
        if self.pairs.is_multiple_of(SUMMED) {
            let mean = self.sum.map(|sum| sum / SUMMED as f32);
            self.means.add(mean);
            self.slow.push(mean);
            self.sum = [0.0; 2];
        }
    }

    /// What to tell of a wave that was seen in samples of this rate, Hz.
    pub fn told(&self, rate: f64) -> Option<String> {
        let power = self.samples.value();
        let is_slow = self.means.value() > KEPT * power;
        let is_fast = self.differences.value() > DIFFERING * power;
        let slow = self
            .slow
            .found()
            .map(|period| f64::from(SUMMED) * period)
            .filter(|_| is_slow);
        let fast = self
            .fast
            .found()
            .map(|period| 1.0 / (0.5 - 1.0 / period))
            .filter(|_| is_fast);
        let period = slow.or(fast)?;
        let frequency = rate / period;
        let (frequency, period) = (rounded(frequency), rounded(period));
        let seen = format!("a wave of about {frequency} Hz has {period} samples a period");
        Some(if period < SHORTEST {
            format!(
                "{seen}, fewer than {SHORTEST}, the least that is identified: check the sample rate, or sample at another"
            )
        } else if period > LONGEST as f64 {
            format!(
                "{seen}, more than {LONGEST}, the most that is identified: check the sample rate; samples that a lock-in amplifier \
                 demodulated are not the pick-offs' own"
            )
        } else {
            format!(
                "{seen}, and 4 to 200 are searched: if that is the pick-offs' wave, give --frequency {frequency}"
            )
        })
    }
}

/// Where samples show a wave that is too fast for their rate, both in Hz; nothing of one that is not.
pub fn alias(frequency: f64, rate: f64) -> String {
    if frequency <= 0.5 * rate {
        return String::new();
    }
    let seen = (frequency - rate * (frequency / rate).round()).abs();
    format!("; undersampled on purpose, such a wave shows at {seen} Hz")
}

/// To three digits, as well as a search knows it.
fn rounded(value: f64) -> f64 {
    let unit = 10f64.powi(value.log10().floor() as i32 - 2);
    // Divided by a whole number, it prints short.
    if unit < 1.0 {
        (value / unit).round() / (1.0 / unit).round()
    } else {
        (value / unit).round() * unit
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::deviates::Deviates;

    const RATE: f64 = 1e5;

    /// What is told of tones, each so many samples a period and an amplitude, about an offset in noise.
    fn told(tones: &[(f64, f64)], noise: f64) -> Option<String> {
        told_of_decaying(tones, noise, f64::INFINITY)
    }

    /// The same of tones that decay in so many samples.
    fn told_of_decaying(tones: &[(f64, f64)], noise: f64, decay: f64) -> Option<String> {
        let mut deviates = Deviates(1);
        let mut unsearched = UnsearchedWave::default();
        let pairs: Vec<[f32; 2]> = (0..150_000)
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
        unsearched.see(&pairs);
        unsearched.told(RATE)
    }

    #[test]
    fn waves_beyond_the_search_are_named() {
        for (period, names) in [
            (2.08, "has 2.08 samples a period, fewer than 2.5"),
            (2.7, "--frequency 37000"),
            (3.3, "--frequency 30300"),
            (243.9, "--frequency 410"),
            (900.0, "--frequency 111"),
            (
                3300.0,
                "about 30.3 Hz has 3300 samples a period, more than 1024",
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
    fn others_are_not() {
        for noise in [0.01, 1.0] {
            assert_eq!(told(&[], noise), None);
            for period in [4.5, 18.75, 60.0] {
                assert_eq!(told(&[(period, 1.0)], noise), None, "{period} {noise}");
            }
        }
        // Two tones that hide each other's period from the search.
        assert_eq!(told(&[(18.8, 0.5), (37.6, 0.28)], 1e-3), None);
        assert_eq!(told(&[(18.8, 0.45), (14.3, 0.45)], 1e-3), None);
    }
}
