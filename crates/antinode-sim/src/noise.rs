//! Random numbers that are the same on every platform: PCG64-DXSM, and normals by Box & Muller with `libm`.

use libm::{exp, expm1, log, sincos, sqrt};
use rand_pcg::Pcg64Dxsm;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// Step of the uniform numbers, 2^-53.
const STEP: f64 = 1.0 / (1u64 << 53) as f64;

/// Purpose of the numbers: different streams of one seed are independent.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Stream {
    Noise = 1,
    Jitter = 2,
    Wave = 3,
    Coloured = 4,
    Deviates = 5,
}

/// Uniform numbers.
#[derive(Debug, Clone)]
pub(crate) struct Uniform(Pcg64Dxsm);

impl Uniform {
    pub fn new(seed: u64, stream: Stream) -> Uniform {
        // The odd multiplier gives each stream its own seed; the seeding itself mixes the bits.
        let apart = (stream as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Uniform(Pcg64Dxsm::seed_from_u64(seed ^ apart))
    }

    /// 0 <= u < 1
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * STEP
    }

    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }
}

/// Pairs of independent standard normal numbers; pair `index` is a function of the seed and `index` alone.
#[derive(Debug, Clone)]
pub(crate) struct Normals {
    origin: Pcg64Dxsm,
    uniform: Uniform,
    next: u64,
}

impl Normals {
    pub fn new(seed: u64, stream: Stream) -> Normals {
        let uniform = Uniform::new(seed, stream);
        Normals {
            origin: uniform.0.clone(),
            uniform,
            next: 0,
        }
    }

    pub fn pair(&mut self, index: u64) -> (f64, f64) {
        if index != self.next {
            self.uniform = Uniform(self.origin.clone());
            self.uniform.0.advance(2 * u128::from(index)); // two draws a pair
        }
        self.next = index.wrapping_add(1);
        let radius = sqrt(-2.0 * log(1.0 - self.uniform.unit())); // 1 - u: never the logarithm of 0
        let (sin, cos) = sincos(TAU * self.uniform.unit());
        (radius * cos, radius * sin)
    }
}

/// Independent normal numbers of mean 0 and variance 1, the same for the same seed on every platform.
#[derive(Debug, Clone)]
pub struct Deviates {
    normals: Normals,
    pairs: u64,
    second: Option<f64>,
}

impl Deviates {
    /// The numbers of this seed.
    pub fn new(seed: u64) -> Deviates {
        Deviates {
            normals: Normals::new(seed, Stream::Deviates),
            pairs: 0,
            second: None,
        }
    }

    /// The next number.
    pub fn draw(&mut self) -> f64 {
        self.second.take().unwrap_or_else(|| {
            let (first, second) = self.normals.pair(self.pairs);
            self.pairs += 1;
            self.second = Some(second);
            first
        })
    }
}

/// Pairs of independent normal numbers behind a first-order low-pass, of unit variance. Each depends on those before it: a jump forwards is
/// computed step by step, and one backwards from the first pair on.
#[derive(Debug, Clone)]
pub(crate) struct Coloured {
    normals: Normals,
    /// Share of a number in the next one, and share of new noise in that.
    shares: (f64, f64),
    now: (f64, f64),
    next: u64,
}

impl Coloured {
    pub fn new(seed: u64, corner: f64, sample_rate: f64) -> Coloured {
        let decay = TAU * corner / sample_rate;
        Coloured {
            normals: Normals::new(seed, Stream::Coloured),
            shares: (exp(-decay), sqrt(-expm1(-2.0 * decay))),
            now: (0.0, 0.0),
            next: 0,
        }
    }

    pub fn pair(&mut self, index: u64) -> (f64, f64) {
        if index.saturating_add(1) < self.next {
            self.next = 0;
        }
        while self.next <= index {
            let new = self.normals.pair(self.next);
            // The first has the full variance at once.
            let (stays, adds) = if self.next == 0 {
                (0.0, 1.0)
            } else {
                self.shares
            };
            self.now.0 = stays * self.now.0 + adds * new.0;
            self.now.1 = stays * self.now.1 + adds * new.1;
            self.next += 1;
        }
        self.now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The moments of a million pairs, each against its own standard error.
    #[test]
    fn the_normals_are_standard_and_independent() {
        let n = 1_000_000;
        let mut normals = Normals::new(11, Stream::Noise);
        let mut last = 0.0;
        let mut sums = [0.0; 8];
        for k in 0..n {
            let (x, y) = normals.pair(k);
            let terms = [
                x,
                y,
                x * x - 1.0,
                y * y - 1.0,
                x * y,
                x * last,
                x.powi(4) - 3.0,
                (x * y).powi(2) - 1.0,
            ];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
            last = y;
        }
        // Variances of the eight terms for a standard normal.
        let variances: [f64; 8] = [1.0, 1.0, 2.0, 2.0, 1.0, 1.0, 96.0, 8.0];
        for (i, (sum, variance)) in sums.iter().zip(variances).enumerate() {
            let z = sum / (variance * n as f64).sqrt();
            assert!(z.abs() < 4.0, "term {i} is off by {z} standard errors");
        }
    }

    #[test]
    fn the_normals_have_their_tails() {
        // 2e6 numbers: 1.27e2 beyond 4, 1.1 beyond 5, none beyond 8.6 (the end of 53 bits).
        let mut normals = Normals::new(12, Stream::Noise);
        let far = (0..1_000_000)
            .map(|k| normals.pair(k))
            .flat_map(|(x, y)| [x, y])
            .filter(|x| x.abs() > 4.0)
            .count();
        assert!((80..180).contains(&far), "{far} beyond 4 sigma");
    }

    #[test]
    fn coloured_pairs_are_correlated_as_behind_a_low_pass() {
        let mut coloured = Coloured::new(7, 2000.0, 100_000.0);
        let n = 1_000_000u64;
        let pairs: Vec<_> = (0..n).map(|k| coloured.pair(k)).collect();
        let mean = |lag: usize, of: fn((f64, f64), (f64, f64)) -> f64| {
            let products = pairs.iter().zip(&pairs[lag..]);
            products.map(|(&now, &later)| of(now, later)).sum::<f64>() / (n as f64 - lag as f64)
        };
        for lag in [0, 1, 5, 10, 100] {
            let kept = (-TAU * 0.02 * lag as f64).exp();
            for (found, expected) in [
                (mean(lag, |now, later| now.0 * later.0), kept),
                (mean(lag, |now, later| now.1 * later.1), kept),
                (mean(lag, |now, later| now.0 * later.1), 0.0),
            ] {
                // Four to five standard errors of n / 8 independent pairs.
                assert!((found - expected).abs() < 0.015, "{lag}: {found}");
            }
        }
        let starts = (0..4000).map(|seed| Coloured::new(seed, 1.0, 1e5).pair(0).0);
        let variance = starts.map(|x| x * x).sum::<f64>() / 4000.0;
        assert!((variance - 1.0).abs() < 0.1, "{variance}");
        for k in [99, 3, 4, 50, 0, 0, 1] {
            assert_eq!(coloured.pair(k), pairs[k as usize]);
        }
    }

    #[test]
    fn pairs_depend_on_the_index_alone() {
        let mut straight = Normals::new(5, Stream::Noise);
        let pairs: Vec<_> = (0..100).map(|k| straight.pair(k)).collect();
        let mut jumping = Normals::new(5, Stream::Noise);
        for k in [99, 3, 4, 50, 0, 1] {
            assert_eq!(jumping.pair(k), pairs[k as usize]);
        }
        assert!((0..100).all(|k| Normals::new(5, Stream::Jitter).pair(k) != pairs[k as usize]));
        assert!((0..100).all(|k| Normals::new(6, Stream::Noise).pair(k) != pairs[k as usize]));
    }
}
