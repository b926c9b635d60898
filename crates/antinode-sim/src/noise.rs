//! Random numbers that are the same everywhere: PCG64-DXSM, and Box & Muller's normals over `libm`.

use libm::{log, sincos, sqrt};
use rand_pcg::Pcg64Dxsm;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// 2^-53: the step of the uniform numbers.
const STEP: f64 = 1.0 / (1u64 << 53) as f64;

/// What the numbers are for: different streams of one seed are independent.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Stream {
    Noise = 1,
    Jitter = 2,
    Wave = 3,
}

/// Uniform numbers.
#[derive(Debug, Clone)]
pub(crate) struct Uniform(Pcg64Dxsm);

impl Uniform {
    pub fn new(seed: u64, stream: Stream) -> Uniform {
        // An odd multiplier keeps the streams apart; the seeding itself mixes.
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

/// Pairs of independent standard normal numbers, pair `index` being a function of the seed and `index` alone.
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
    fn the_tails_are_there() {
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
