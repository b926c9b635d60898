//! Check for samples at their highest or lowest value far more often than one step beside it: cut off at an unknown rail, by too little
//! for a window to show it.

use antinode::Flags;

/// Ratio of samples at an end to those one step beside it, at least: the crest of a wave that is not cut off has 2.4, and noise makes that
/// less.
const MIN_RATIO: u64 = 6;
/// Samples at the end, and beside it, from which on the ratio is not due to chance.
const MIN_AT_END: u64 = 40;
const MIN_BESIDE: u64 = 5;
/// Noise, in steps, below which a wave that repeats may give the same few codes over and over.
const MIN_NOISE: f32 = 0.3;
/// Pairs examined together, however they arrive.
const STRETCH: usize = 1 << 12;
/// Stretches at the beginning that are all examined, and which share of the later ones: one in this many.
const FIRST_STRETCHES: u64 = 32;
const ONE_IN: u64 = 8;

/// One end of a pick-off's range: the maximum of its samples or of their negatives.
#[derive(Debug, Clone, Copy)]
struct End {
    value: f32,
    /// Samples at this value, and one step beside it.
    count: u64,
    beside: u64,
}

/// The ends of both pick-offs' ranges.
#[derive(Debug)]
pub(super) struct CutOff {
    /// The converter's step, if it is known.
    step: Option<f32>,
    /// Lowest and highest end, of S_C and of S_D.
    ends: [[End; 2]; 2],
    /// The current stretch, if it is to be examined, and how many of its pairs have passed.
    stretch: Vec<[f32; 2]>,
    taken: usize,
    stretches: u64,
    rows: u64,
    clipped: u64,
}

impl CutOff {
    /// No samples yet, of a converter with this step.
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
            if self.stretches < FIRST_STRETCHES || self.stretches.is_multiple_of(ONE_IN) {
                self.stretch.extend_from_slice(now);
            }
            if self.taken == STRETCH {
                self.examine();
                self.taken = 0;
                self.stretches += 1;
            }
        }
    }

    /// Examines what there is of the current stretch.
    fn examine(&mut self) {
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

    /// A warning if samples are cut off though most rows have no flag; `residual` is the smallest of any row.
    pub fn warning(&mut self, residual: f32) -> Option<String> {
        let step = self.step?;
        self.examine();
        if self.rows == 0 || 2 * self.clipped > self.rows || residual < MIN_NOISE * step {
            return None;
        }
        let ends = self.ends.iter().zip(["S_C", "S_D"]);
        let mut all = ends.flat_map(|(ends, who)| {
            let named = ends.iter().zip([("lowest", -1.0), ("highest", 1.0)]);
            named.map(move |(end, (which, sign))| (who, which, end, sign))
        });
        let (who, which, end, sign) = all.find(|(_, _, end, _)| end.is_cut())?;
        Some(format!(
            "{who} is at its {which} value, {}, {} times as often as one step from it: if that is the converter's rail, the wave is cut off \
             there in unflagged rows too; give both rails as --full-scale LOW,HIGH",
            sign * end.value,
            end.count / end.beside
        ))
    }
}

impl End {
    fn see(&mut self, pairs: &[[f32; 2]], channel: usize, sign: f32, step: f32) {
        let samples = || pairs.iter().map(|pair| sign * pair[channel]);
        let max = samples().fold(f32::NEG_INFINITY, f32::max);
        if max > self.value {
            // If the new end is one step higher, the old one is beside it.
            let is_next = (max - self.value - step).abs() < 0.5 * step;
            *self = Self {
                value: max,
                count: 0,
                beside: if is_next { self.count } else { 0 },
            };
        }
        if max < self.value - 1.5 * step {
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
        self.count >= MIN_AT_END
            && self.beside >= MIN_BESIDE
            && self.count >= MIN_RATIO * self.beside
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use antinode_sim::Deviates;

    /// The warning for a wave of this amplitude and noise, in steps, whose S_D is cut off at a level.
    fn warning(
        period: f64,
        main: f64,
        noise: f64,
        level: f64,
        decay: f64,
        seed: u64,
    ) -> Option<String> {
        let mut random = Deviates::new(seed);
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
            cut_off.warning(noise.hypot(0.29) as f32)
        };
        // However the pairs arrive.
        let warning = tell(700);
        assert_eq!(warning, tell(9000));
        warning
    }

    #[test]
    fn a_wave_that_is_slightly_cut_off_raises_a_warning_and_no_other_does() {
        for seed in 0..40 {
            let period = 4.3171 + 0.77 * seed as f64 + 0.013 * (seed * seed) as f64;
            for noise in [0.3, 0.6, 2.0] {
                for main in [60.0, 500.0, 2000.0] {
                    for decay in [0.0, 2e-5] {
                        let none = warning(period, main, noise, f64::INFINITY, decay, seed);
                        assert_eq!(none, None, "{period} {main} {noise} {decay}");
                    }
                }
                // By half a per cent.
                let cut = warning(period, 2000.0, noise, 2090.0, 0.0, seed).unwrap_or_default();
                assert!(
                    cut.starts_with("S_D is at its highest value, 2090, "),
                    "{period} {noise}: {cut}"
                );
            }
        }
        // Whole numbers of samples a period.
        for period in [4.0, 5.0, 8.0, 18.75, 20.0] {
            for phase in 0..40 {
                let main = 500.0 + 0.05 * f64::from(phase);
                assert_eq!(warning(period, main, 0.3, f64::INFINITY, 0.0, 1), None);
            }
        }
    }

    #[test]
    fn an_end_one_step_higher_has_the_old_one_beside_it() {
        let mut cut_off = CutOff::new(Some(1.0));
        for (value, count) in [(9.0, 100), (10.0, 50)] {
            let mut stretch = vec![[0.0; 2]; STRETCH];
            stretch[..count].fill([value; 2]);
            cut_off.see(&stretch);
        }
        let [[_, highest], _] = cut_off.ends;
        assert_eq!([highest.count, highest.beside], [50, 100]);
    }

    #[test]
    fn a_wave_that_reaches_a_rail_late_is_noticed_in_little_memory() {
        let saw = |top: usize| -> Vec<[f32; 2]> {
            let codes = (0..40 * STRETCH).map(|k| ((k % top) as f32).min(150.0));
            codes.map(|code| [code; 2]).collect()
        };
        let mut cut_off = CutOff::new(Some(1.0));
        for top in [100, 200] {
            cut_off.see(&saw(top));
        }
        assert!(cut_off.stretch.len() < STRETCH);
        cut_off.row(Flags::empty());
        let warning = cut_off.warning(1.0).unwrap();
        assert!(
            warning.starts_with("S_C is at its highest value, 150, 50 times"),
            "{warning}"
        );
    }

    #[test]
    fn no_warning_without_a_step_or_if_rows_have_the_flag() {
        let mut cut_off = CutOff::new(None);
        cut_off.see(&[[1.0; 2]; 100]);
        assert_eq!(cut_off.warning(1.0), None);
        let end = End {
            value: 1.0,
            count: 1000,
            beside: 10,
        };
        let mut cut_off = CutOff::new(Some(1.0));
        cut_off.ends = [[end; 2]; 2];
        assert_eq!(cut_off.warning(1.0), None);
        cut_off.rows = 10;
        assert!(
            cut_off
                .warning(1.0)
                .unwrap()
                .contains("S_C is at its lowest value, -1, 100 times")
        );
        assert_eq!(cut_off.warning(0.29), None);
        cut_off.clipped = 5;
        assert!(cut_off.warning(1.0).is_some());
        cut_off.clipped = 6;
        assert_eq!(cut_off.warning(1.0), None);
    }
}
