//! Runs of equal f32 samples at their extremes: they show a rail that is not known.

use super::ChannelWatch;

/// Runs of equal samples: the longest at the lowest and at the highest value that had one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Runs {
    /// The last sample; infinite before the first.
    last: f32,
    /// The latest run, which may still go on.
    now: Run,
    /// Lowest and highest value of the runs before, and the longest run at each.
    values: [f32; 2],
    lengths: [u16; 2],
}

/// Equal samples, from the first one's index to that after the last one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
struct Run {
    value: f32,
    from: u16,
    to: u16,
}

impl Default for Runs {
    fn default() -> Self {
        Self {
            last: f32::INFINITY,
            now: Run {
                value: 0.0,
                from: 0,
                to: 0,
            },
            values: [f32::INFINITY, f32::NEG_INFINITY],
            lengths: [1; 2],
        }
    }
}

impl Runs {
    /// The longest run at an extreme; `length` at `value` is the longest of those before the latest.
    #[inline(always)]
    fn longest_at(&self, extreme: f32, value: f32, length: u16) -> u16 {
        let ended = if value == extreme { length } else { 1 };
        let last = if self.now.value == extreme {
            self.now.to - self.now.from
        } else {
            1
        };
        ended.max(last)
    }

    /// Adds the latest run to those before.
    fn take_last(&mut self) {
        let (value, length) = (self.now.value, self.now.to - self.now.from);
        let beyond = [value < self.values[0], value > self.values[1]];
        for (end, is_beyond) in beyond.into_iter().enumerate() {
            if is_beyond || value == self.values[end] && length > self.lengths[end] {
                (self.values[end], self.lengths[end]) = (value, length);
            }
        }
    }
}

impl ChannelWatch<f32> {
    /// The longest runs of samples equal to the lowest, and to the highest: one each, unless the signal is clipped.
    #[inline(always)]
    pub fn longest(&self) -> [u16; 2] {
        if self.runs.now.to == 0 {
            return [1; 2];
        }
        let Runs {
            values: [low, high],
            lengths: [at_low, at_high],
            ..
        } = self.runs;
        [
            self.runs.longest_at(self.low, low, at_low),
            self.runs.longest_at(self.high, high, at_high),
        ]
    }

    /// Takes sample `index`. NaN is no extreme.
    #[doc(hidden)]
    #[inline(always)]
    pub fn see(&mut self, sample: f32, index: u16) {
        if sample == self.last() {
            self.see_again(sample, index);
        }
        self.reach(sample, sample);
        self.end(sample);
    }

    /// Takes sample `index`, which is equal to the one before. Few are, and going on with a run costs little.
    #[doc(hidden)]
    #[inline(always)]
    pub fn see_again(&mut self, sample: f32, index: u16) {
        if self.runs.now.to != index {
            self.begin_run(sample, index);
        }
        self.runs.now.to = index + 1;
    }

    #[inline(never)]
    fn begin_run(&mut self, value: f32, index: u16) {
        if self.runs.now.to > 0 {
            self.runs.take_last();
        }
        self.runs.now.value = value;
        self.runs.now.from = index - 1;
    }

    /// The last sample seen; infinite before the first.
    #[doc(hidden)]
    #[inline(always)]
    pub fn last(&self) -> f32 {
        self.runs.last
    }

    /// Notes the last of the samples taken.
    #[doc(hidden)]
    #[inline(always)]
    pub fn end(&mut self, sample: f32) {
        self.runs.last = sample;
    }

    /// Widens the range to `low` and `high`.
    #[doc(hidden)]
    #[inline(always)]
    pub fn reach(&mut self, low: f32, high: f32) {
        if low < self.low {
            self.low = low;
        }
        if high > self.high {
            self.high = high;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ChannelWatch;

    #[test]
    fn runs_are_those_at_the_extremes() {
        let mut seed = 1u32;
        // Values of either sign only, and of both.
        for least in [-4.0, -1.0, 1.0] {
            let mut long = 0;
            for _ in 0..2000 {
                // Three values give many runs, most of them not at an extreme of the samples so far.
                let samples: [f32; 20] = core::array::from_fn(|_| {
                    seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    ((seed >> 24) % 3) as f32 + least
                });
                let mut watch = ChannelWatch::<f32>::empty();
                for (&sample, index) in samples.iter().zip(0..) {
                    watch.see(sample, index);
                }
                let low = samples.iter().copied().fold(f32::INFINITY, f32::min);
                let high = samples.iter().copied().fold(f32::NEG_INFINITY, f32::max);
                let run = |end: f32| {
                    let runs = samples.split(|&sample| sample != end);
                    runs.map(|run| run.len() as u16).max().unwrap_or(0)
                };
                assert_eq!([watch.low, watch.high], [low, high]);
                assert_eq!(watch.longest(), [run(low), run(high)], "{samples:?}");
                long += usize::from(watch.longest()[1] > 2);
            }
            assert!(long > 100);
        }
    }

    #[test]
    fn nan_is_no_extreme() {
        let mut watch = ChannelWatch::<f32>::empty();
        for (sample, index) in [2.0, f32::NAN, f32::NAN, -1.0].into_iter().zip(0..) {
            watch.see(sample, index);
        }
        assert_eq!([watch.low, watch.high], [-1.0, 2.0]);
        assert_eq!(watch.longest(), [1, 1]);
    }
}
