//! What the two pick-offs see, by complex rotation: no sine or cosine at sample rate.
//!
//! The standing wave is two waves that run against each other: with u = S_C + j S_D, (1)-(3) read
//!
//! ```text
//! u = (a_A + a_B)/2 exp(j(2 theta + tau)) + (a_A - a_B)/2 exp(j(2 theta - tau))
//! ```
//!
//! and, as long as the frequency does not drift, each of them is multiplied by one complex constant a sample, whatever the
//! precession and the decay.

use crate::time::Instant;
use crate::wave::Wave;
use libm::{exp, sincos};
use std::f64::consts::TAU;

/// Samples a block: the two waves are found anew at the head of each block, and carried through it by a table.
const BLOCK: u64 = 64;

#[derive(Debug, Clone, Copy)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn polar(size: f64, angle: f64) -> Complex {
        let (sin, cos) = sincos(angle);
        Complex {
            re: size * cos,
            im: size * sin,
        }
    }

    fn times(self, other: Complex) -> Complex {
        Complex {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

/// The wave that runs forward (2 theta + tau) and the one that runs back (2 theta - tau).
#[derive(Debug, Clone, Copy)]
struct Running {
    forward: Complex,
    back: Complex,
}

impl Running {
    /// The running waves of a wave without frequency drift.
    fn of(wave: &Wave, instant: Instant) -> Running {
        let truth = wave.at_instant(instant);
        let (a, b) = (truth.main_amplitude, truth.quadrature_amplitude);
        Running {
            forward: Complex::polar(0.5 * (a + b), 2.0 * truth.angle - truth.phase),
            back: Complex::polar(0.5 * (a - b), 2.0 * truth.angle + truth.phase),
        }
    }

    /// (S_C, S_D) when these waves have moved on by `step`.
    fn pick_offs(&self, step: &Running) -> (f64, f64) {
        let (forward, back) = (self.forward.times(step.forward), self.back.times(step.back));
        (forward.re + back.re, forward.im + back.im)
    }
}

/// The clean signals of a wave without frequency drift, sampled without jitter.
#[derive(Debug, Clone)]
pub(crate) struct Carrier {
    wave: Wave,
    sample_rate: f64,
    skew: f64,
    steps: Vec<Running>,
    block: Option<u64>,
    on_time: Running,
    skewed: Running,
}

impl Carrier {
    /// `skew` in s, for the second of the two signal pairs.
    pub fn new(wave: Wave, sample_rate: f64, skew: f64) -> Carrier {
        // The steps are those of a wave of unit running waves that starts with no angle and no phase.
        let steps = (0..BLOCK).map(|i| {
            let instant = Instant::of_sample(i, sample_rate);
            let tau = TAU * instant.turns(wave.frequency, 0.0);
            let turn = 2.0 * wave.angle_rate * instant.seconds();
            let decay = exp(-wave.decay_rate * instant.seconds());
            Running {
                forward: Complex::polar(decay, turn + tau),
                back: Complex::polar(decay, turn - tau),
            }
        });
        let head = Running::of(&wave, Instant::of(0.0));
        Carrier {
            wave,
            sample_rate,
            skew,
            steps: steps.collect(),
            block: None,
            on_time: head,
            skewed: head,
        }
    }

    /// (S_C, S_D) at sample `index`, and again `skew` s later.
    pub fn at(&mut self, index: u64) -> ((f64, f64), (f64, f64)) {
        let block = index / BLOCK;
        if self.block != Some(block) {
            let instant = Instant::of_sample(block * BLOCK, self.sample_rate);
            self.on_time = Running::of(&self.wave, instant);
            self.skewed = Running::of(&self.wave, instant.later(self.skew));
            self.block = Some(block);
        }
        let step = &self.steps[(index % BLOCK) as usize];
        let on_time = self.on_time.pick_offs(step);
        (
            on_time,
            if self.skew == 0.0 {
                on_time
            } else {
                self.skewed.pick_offs(step)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_gives_the_formulas() {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: -0.4,
            angle_rate: 3.0,
            decay_rate: 0.2,
            ..Wave::default()
        };
        let (rate, skew) = (100_000.0, 1.3e-6);
        let mut carrier = Carrier::new(wave, rate, skew);
        let mut worst = 0.0f64;
        for index in (0..3000)
            .chain(1_000_000..1_001_000)
            .chain([3_600_000_063, 17])
        {
            let instant = Instant::of_sample(index, rate);
            let ((c, d), (c_late, d_late)) = carrier.at(index);
            let (c0, d0) = wave.pick_offs_at(instant);
            let (c1, d1) = wave.pick_offs_at(instant.later(skew));
            for error in [c - c0, d - d0, c_late - c1, d_late - d1] {
                worst = worst.max(error.abs());
            }
        }
        assert!(worst < 1e-14, "{worst}");
    }

    #[test]
    fn without_skew_both_are_one() {
        let mut carrier = Carrier::new(Wave::default(), 100_000.0, 0.0);
        for index in [0, 1, 64, 130] {
            let (on_time, late) = carrier.at(index);
            assert_eq!(on_time, late);
        }
    }
}
