//! Clean pick-off signals by complex rotation, without a sine or cosine per sample.
//!
//! The standing wave is the sum of two waves that travel in opposite directions: with u = S_C + j S_D, (1)-(3) read
//!
//! ```text
//! u = (a_A + a_B)/2 exp(j(2 theta + tau)) + (a_A - a_B)/2 exp(j(2 theta - tau))
//! ```
//!
//! As long as the frequency does not drift, each of them is multiplied by a complex constant per sample, whatever the precession and the
//! decay; if the resonator has splits, both are multiplied by a constant matrix.

use crate::complex::{Complex, polar};
use crate::time::Instant;
use crate::wave::Wave;
use libm::exp;
use std::f64::consts::TAU;

/// Samples of a block: both waves are computed by the formulas at its head, and carried through it by a table.
const BLOCK: u64 = 64;

/// A wave that can be carried through a block.
pub(crate) trait Carried {
    /// State of the travelling waves at the head of a block.
    type Waves: Copy;
    /// Factor that advances them by a time.
    type Step;

    /// The waves at an instant.
    fn waves(&self, instant: Instant) -> Self::Waves;

    /// The step from t = 0 to an instant, which is the same for any waves.
    fn step(&self, instant: Instant) -> Self::Step;

    /// [S_C, S_D] after these waves have advanced by `step`.
    fn pick_offs(waves: &Self::Waves, step: &Self::Step) -> [f64; 2];
}

/// The wave that travels forward (2 theta + tau) and the one that travels back (2 theta - tau).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Running {
    forward: Complex,
    back: Complex,
}

/// Without splits.
impl Carried for Wave {
    type Waves = Running;
    /// Both waves, from unit waves without angle and phase at t = 0.
    type Step = Running;

    fn waves(&self, instant: Instant) -> Running {
        let truth = self.steady_at(instant);
        let (a, b) = (truth.main_amplitude, truth.quadrature_amplitude);
        Running {
            forward: polar(0.5 * (a + b), 2.0 * truth.angle - truth.phase),
            back: polar(0.5 * (a - b), 2.0 * truth.angle + truth.phase),
        }
    }

    fn step(&self, instant: Instant) -> Running {
        let tau = TAU * instant.turns(self.frequency, 0.0);
        let turn = 2.0 * self.angle_rate * instant.seconds();
        let decay = exp(-self.decay_rate * instant.seconds());
        Running {
            forward: polar(decay, turn + tau),
            back: polar(decay, turn - tau),
        }
    }

    fn pick_offs(waves: &Running, step: &Running) -> [f64; 2] {
        let (forward, back) = (waves.forward * step.forward, waves.back * step.back);
        [forward.re + back.re, forward.im + back.im]
    }
}

/// The clean signals of a wave without frequency drift, sampled without jitter.
#[derive(Debug, Clone)]
pub(crate) struct Carrier<W: Carried> {
    wave: W,
    sample_rate: f64,
    skew: f64,
    steps: Vec<W::Step>,
    block: Option<u64>,
    on_time: W::Waves,
    skewed: W::Waves,
}

impl<W: Carried> Carrier<W> {
    /// `skew` in s, for the second of the two signal pairs.
    pub fn new(wave: W, sample_rate: f64, skew: f64) -> Carrier<W> {
        let steps = (0..BLOCK).map(|i| wave.step(Instant::of_sample(i, sample_rate)));
        let steps = steps.collect();
        let head = wave.waves(Instant::of(0.0));
        Carrier {
            wave,
            sample_rate,
            skew,
            steps,
            block: None,
            on_time: head,
            skewed: head,
        }
    }

    /// [S_C, S_D] at sample `index`, and again `skew` s later.
    pub fn at(&mut self, index: u64) -> ([f64; 2], [f64; 2]) {
        let block = index / BLOCK;
        if self.block != Some(block) {
            let instant = Instant::of_sample(block * BLOCK, self.sample_rate);
            self.on_time = self.wave.waves(instant);
            self.skewed = self.wave.waves(instant.later(self.skew));
            self.block = Some(block);
        }
        let step = &self.steps[(index % BLOCK) as usize];
        let on_time = W::pick_offs(&self.on_time, step);
        (
            on_time,
            if self.skew == 0.0 {
                on_time
            } else {
                W::pick_offs(&self.skewed, step)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split::SplitWave;

    fn wave() -> Wave {
        Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: -0.4,
            angle_rate: 3.0,
            decay_rate: 0.2,
            ..Wave::default()
        }
    }

    /// The largest difference between a carrier and the formulas.
    fn worst<W: Carried>(wave: &Wave, carried: W) -> f64 {
        let (rate, skew) = (100_000.0, 1.3e-6);
        let mut carrier = Carrier::new(carried, rate, skew);
        let mut worst = 0.0f64;
        for index in (0..3000)
            .chain(1_000_000..1_001_000)
            .chain([3_600_000_063, 17])
        {
            let instant = Instant::of_sample(index, rate);
            let ([c, d], [c_late, d_late]) = carrier.at(index);
            let [c0, d0] = wave.pick_offs_at(instant);
            let [c1, d1] = wave.pick_offs_at(instant.later(skew));
            for error in [c - c0, d - d0, c_late - c1, d_late - d1] {
                worst = worst.max(error.abs());
            }
        }
        worst
    }

    #[test]
    fn the_table_gives_the_formulas() {
        let found = worst(&wave(), wave());
        assert!(found < 1e-14, "{found}");
    }

    #[test]
    fn the_table_of_a_split_wave_gives_the_formulas() {
        let wave = Wave {
            damping_split: 0.1,
            damping_angle: 0.1,
            frequency_split: 0.7,
            frequency_angle: -0.6,
            ..wave()
        };
        let split = SplitWave::of(&wave).expect("it has splits");
        let found = worst(&wave, split);
        assert!(found < 1e-14, "{found}");
    }

    #[test]
    fn without_skew_both_pairs_are_equal() {
        let mut carrier = Carrier::new(Wave::default(), 100_000.0, 0.0);
        for index in [0, 1, 64, 130] {
            let (on_time, late) = carrier.at(index);
            assert_eq!(on_time, late);
        }
    }
}
