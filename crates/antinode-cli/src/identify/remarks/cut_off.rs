//! Samples that stand at their highest or lowest value far more often than a step beside it: cut off where no rail is known, too little
//! for a window to show it.

use antinode::Flags;

/// So many times as often as beside it: at its crest a wave is 2.4 times as often in the last step as in the one before, and noise makes that
/// less.
const OFTEN: u64 = 6;
/// Samples at the end, and beside it, from which on that is no chance.
const LEAST: u64 = 40;
const LEAST_BESIDE: u64 = 5;
/// Noise of less than this, in steps, leaves the samples of a wave that repeats on the same few codes.
const LEAST_NOISE: f32 = 0.3;
/// Pairs that are looked at together, however they come.
const STRETCH: usize = 1 << 12;
/// Stretches that are all looked at; of those behind them one in so many.
const ALL: u64 = 32;
const SHARE: u64 = 8;

/// One end of a pick-off's samples, as the greatest of what they are or of their negatives.
#[derive(Debug, Clone, Copy)]
struct End {
    value: f32,
    /// Samples there, and one step beside it.
    count: u64,
    beside: u64,
}

/// The ends of both pick-offs' samples.
#[derive(Debug)]
pub(super) struct CutOff {
    /// The converter's step, where it is known.
    step: Option<f32>,
    /// Lowest and highest, of S_C and S_D.
    ends: [[End; 2]; 2],
    /// The stretch that has begun, if it is looked at, and how many pairs of it there were.
    stretch: Vec<[f32; 2]>,
    taken: usize,
    stretches: u64,
    rows: u64,
    clipped: u64,
}

impl CutOff {
    /// Of a converter of this step.
    pub fn new(step: Option<f32>) -> Self {
        let none = End {
            value: f32::NEG_INFINITY,
            count: 0,
            beside: 0,
        };
        Self {
            step,
            ends: [[none; 2]; 2],
            stretch: Vec::new(),
            taken: 0,
            stretches: 0,
            rows: 0,
            clipped: 0,
        }
    }

    /// Takes the next pairs.
    pub fn see(&mut self, mut pairs: &[[f32; 2]]) {
        while self.step.is_some() && !pairs.is_empty() {
            let (now, rest) = pairs.split_at(pairs.len().min(STRETCH - self.taken));
            pairs = rest;
            self.taken += now.len();
            if self.stretches < ALL || self.stretches.is_multiple_of(SHARE) {
                self.stretch.extend_from_slice(now);
            }
            if self.taken == STRETCH {
                self.look();
                self.taken = 0;
                self.stretches += 1;
            }
        }
    }

    /// Looks at what there is of a stretch.
    fn look(&mut self) {
        let Some(step) = self.step else { return };
        for (channel, ends) in self.ends.iter_mut().enumerate() {
            for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
                end.see(&self.stretch, channel, sign, step);
            }
        }
        self.stretch.clear();
    }

    /// Takes a row's flags.
    pub fn row(&mut self, flags: Flags) {
        self.rows += 1;
        self.clipped += u64::from(flags.contains(Flags::CLIPPED));
    }

    /// What to tell, where most rows do not have the flag, and this is the least residual of a row.
    pub fn told(&mut self, residual: f32) -> Option<String> {
        let step = self.step?;
        self.look();
        if self.rows == 0 || 2 * self.clipped > self.rows || residual < LEAST_NOISE * step {
            return None;
        }
        let ends = self.ends.iter().zip(["S_C", "S_D"]);
        let mut all = ends.flat_map(|(ends, who)| {
            let named = ends.iter().zip([("lowest", -1.0), ("highest", 1.0)]);
            named.map(move |(end, (which, sign))| (who, which, end, sign))
        });
        let (who, which, end, sign) = all.find(|(_, _, end, _)| end.is_cut())?;
        Some(format!(
            "{who} stands at its {which} value, {}, {} times as often as a step beside it: if that is the converter's rail, waves are cut off there in \
             rows without a flag too; give it as --full-scale LOW,HIGH",
            sign * end.value,
            end.count / end.beside
        ))
    }
}

impl End {
    fn see(&mut self, pairs: &[[f32; 2]], channel: usize, sign: f32, step: f32) {
        let samples = || pairs.iter().map(|pair| sign * pair[channel]);
        let most = samples().fold(f32::NEG_INFINITY, f32::max);
        if most > self.value {
            // One step higher, what was the end is beside it.
            let is_next = (most - self.value - step).abs() < 0.5 * step;
            *self = Self {
                value: most,
                count: 0,
                beside: if is_next { self.count } else { 0 },
            };
        }
        if most < self.value - 1.5 * step {
            return;
        }
        let (value, near) = (self.value - 0.5 * step, self.value - 1.5 * step);
        let (mut count, mut above) = (0, 0);
        for sample in samples() {
            count += u32::from(sample > value);
            above += u32::from(sample > near);
        }
        self.count += u64::from(count);
        self.beside += u64::from(above - count);
    }

    fn is_cut(&self) -> bool {
        self.value.is_finite()
            && self.count >= LEAST
            && self.beside >= LEAST_BESIDE
            && self.count >= OFTEN * self.beside
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::deviates::Deviates;

    /// What is told of a wave of this amplitude and noise, in steps, whose S_D is cut off at a level.
    fn told(
        period: f64,
        main: f64,
        noise: f64,
        level: f64,
        decay: f64,
        seed: u64,
    ) -> Option<String> {
        let mut random = Deviates(seed);
        let pairs: Vec<[f32; 2]> = (0..50_000)
            .map(|k| {
                let (sine, cosine) = (TAU * f64::from(k) / period).sin_cos();
                let size = main * (-decay * f64::from(k)).exp();
                let mut code = |of: f64| (size * of + 100.0 + noise * random.draw()).round();
                [code(0.3 * sine), code(cosine).min(level)].map(|code| code as f32)
            })
            .collect();
        let tell = |size: usize| {
            let mut cut_off = CutOff::new(Some(1.0));
            pairs.chunks(size).for_each(|pairs| cut_off.see(pairs));
            cut_off.row(Flags::empty());
            cut_off.told(noise.hypot(0.29) as f32)
        };
        // However the pairs come.
        let told = tell(700);
        assert_eq!(told, tell(9000));
        told
    }

    #[test]
    fn a_wave_that_is_hardly_cut_off_is_told_and_no_other() {
        for seed in 0..40 {
            let period = 4.3171 + 0.77 * seed as f64 + 0.013 * (seed * seed) as f64;
            for noise in [0.3, 0.6, 2.0] {
                for main in [60.0, 500.0, 2000.0] {
                    for decay in [0.0, 2e-5] {
                        let none = told(period, main, noise, f64::INFINITY, decay, seed);
                        assert_eq!(none, None, "{period} {main} {noise} {decay}");
                    }
                }
                // By half a per cent.
                let cut = told(period, 2000.0, noise, 2090.0, 0.0, seed).unwrap_or_default();
                assert!(
                    cut.starts_with("S_D stands at its highest value, 2090, "),
                    "{period} {noise}: {cut}"
                );
            }
        }
        // Whole numbers of samples a period.
        for period in [4.0, 5.0, 8.0, 18.75, 20.0] {
            for phase in 0..40 {
                let main = 500.0 + 0.05 * f64::from(phase);
                assert_eq!(told(period, main, 0.3, f64::INFINITY, 0.0, 1), None);
            }
        }
    }

    #[test]
    fn nothing_is_told_without_a_step_or_where_rows_have_the_flag() {
        let mut cut_off = CutOff::new(None);
        cut_off.see(&[[1.0; 2]; 100]);
        assert_eq!(cut_off.told(1.0), None);
        let end = End {
            value: 1.0,
            count: 1000,
            beside: 10,
        };
        let mut cut_off = CutOff::new(Some(1.0));
        cut_off.ends = [[end; 2]; 2];
        assert_eq!(cut_off.told(1.0), None);
        cut_off.rows = 10;
        assert!(
            cut_off
                .told(1.0)
                .unwrap()
                .contains("S_C stands at its lowest value, -1, 100 times")
        );
        cut_off.clipped = 6;
        assert_eq!(cut_off.told(1.0), None);
    }
}
