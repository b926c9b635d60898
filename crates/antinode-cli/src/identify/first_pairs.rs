//! The first pairs of a recording, gathered until there are enough to check, as a pipe may begin with a single one; and the checks: for
//! samples that come from no pick-off, or whose rows would look plausible but mean nothing.

use std::ops::RangeInclusive;

use antinode::period::DifferenceDetector;

use crate::median::ends;

/// Pairs that are checked: some periods, but few enough for the rows of a pipe not to come before a warning.
const CHECKED_PAIRS: usize = 512;

/// Fewest pairs for a ramp: a quarter of the longest period, over which no wave is straight. A pipe may begin with that few.
const MIN_RAMP_PAIRS: usize = 256;
/// Deviation of a rounded time from a straight line, at most, as a share of its whole rise.
const RAMP_TOLERANCE: f64 = 1e-4;

/// Amplitudes that the core identifies.
const AMPLITUDES: RangeInclusive<f64> = 1e-15..=1e17;

/// Offset, in units of the rms about it, from which on single precision has too few digits for the wave.
const LARGE_OFFSET: f64 = 300.0;

/// Relative difference allowed between `--frequency` and the frequency found: each may be 5 % off.
const MAX_MISMATCH: f64 = 0.1;

/// Gathers the first pairs ahead of their identification.
#[derive(Debug, Default)]
pub(super) struct FirstPairs {
    pairs: Vec<[f32; 2]>,
    /// Pairs gathered but not yet identified.
    ahead: usize,
    is_given: bool,
}

impl FirstPairs {
    /// Takes the pairs to be identified next, some of which it may have seen before; returns all pairs, once, when there are enough.
    pub fn see(&mut self, pairs: &[[f32; 2]]) -> Option<Vec<[f32; 2]>> {
        if !self.is_given && pairs.len() > self.ahead {
            self.pairs.extend(&pairs[self.ahead..]);
            self.ahead = pairs.len();
        }
        if self.pairs.len() < CHECKED_PAIRS {
            return None;
        }
        self.rest()
    }

    /// Notes that this many pairs have been identified.
    pub fn pass(&mut self, pairs: usize) {
        self.ahead = self.ahead.saturating_sub(pairs);
    }

    /// The pairs gathered, if they were too few to be returned before.
    pub fn rest(&mut self) -> Option<Vec<[f32; 2]>> {
        self.is_given = true;
        let pairs = std::mem::take(&mut self.pairs);
        (!pairs.is_empty()).then_some(pairs)
    }
}

/// The pick-off whose samples rise in equal steps, as a time or a counter does.
pub(super) fn ramp(pairs: &[[f32; 2]]) -> Option<&'static str> {
    if pairs.len() < MIN_RAMP_PAIRS {
        return None;
    }
    let is_straight = |channel: usize| {
        let value = |k: usize| f64::from(pairs[k][channel]);
        let last = pairs.len() - 1;
        let rise = value(last) - value(0);
        let line = |k: usize| value(0) + rise * k as f64 / last as f64;
        rise > 0.0 && (0..last).all(|k| (value(k) - line(k)).abs() <= RAMP_TOLERANCE * rise)
    };
    let mut channels = ["S_C", "S_D"].into_iter().enumerate();
    channels.find_map(|(channel, name)| is_straight(channel).then_some(name))
}

/// The amplitude of the samples, half of peak to peak, if it lies outside the range that can be identified.
pub(super) fn amplitude_beyond(pairs: &[[f32; 2]]) -> Option<f64> {
    let swing = |channel: usize| {
        let samples = pairs.iter().map(|pair| f64::from(pair[channel]));
        let [min, max] = ends(samples.filter(|sample| sample.is_finite()));
        0.5 * (max - min)
    };
    let swing = swing(0).max(swing(1));
    (swing > 0.0 && !AMPLITUDES.contains(&swing)).then_some(swing)
}

/// A warning if the first pairs hold a wave of another frequency than `--frequency`: rows may look plausible all the same.
pub(super) fn other_frequency(pairs: &[[f32; 2]], rate: f64, frequency: f32) -> Option<String> {
    let mut detector = Box::new(DifferenceDetector::<f32>::new());
    let period = pairs.iter().find_map(|&pair| detector.push(pair))?;
    let found = rate / f64::from(period);
    let apart = found / f64::from(frequency) - 1.0;
    (apart.abs() > MAX_MISMATCH).then(|| {
        format!(
            "a search finds a wave of {found:.0} Hz, but --frequency says {frequency} Hz: rows mean nothing unless both waves are present"
        )
    })
}

/// The mean of the samples and their rms about it, both pick-offs together, if the mean is too large for single precision.
pub(super) fn large_offset(pairs: &[[f32; 2]]) -> Option<[f64; 2]> {
    let finite = || {
        let pairs = pairs.iter().map(|pair| pair.map(f64::from));
        pairs.filter(|pair| pair.iter().all(|value| value.is_finite()))
    };
    let count = finite().count() as f64;
    let mean = [0, 1].map(|channel| finite().map(|pair| pair[channel]).sum::<f64>() / count);
    let squares = finite().map(|pair| (pair[0] - mean[0]).powi(2) + (pair[1] - mean[1]).powi(2));
    let (mean, rms) = (
        mean[0].hypot(mean[1]),
        (squares.sum::<f64>() / count).sqrt(),
    );
    // Constant samples have no wave either, but not because of their offset.
    (rms > 0.0 && mean > LARGE_OFFSET * rms).then_some([mean, rms])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn pairs_are_given_once_in_their_order() {
        let all: Vec<[f32; 2]> = (0..5000).map(|k| [k as f32, 0.0]).collect();
        for (stretch, step) in [(1, 1), (7, 3), (1000, 8), (512, 8), (5000, 4999)] {
            let mut first = FirstPairs::default();
            let mut given = Vec::new();
            for mut pairs in all.chunks(stretch) {
                while !pairs.is_empty() {
                    given.extend(first.see(pairs));
                    let taken = step.min(pairs.len());
                    first.pass(taken);
                    pairs = &pairs[taken..];
                }
            }
            assert_eq!(given.len(), 1, "{stretch} {step}");
            assert!(given[0].len() >= CHECKED_PAIRS && all.starts_with(&given[0]));
            assert!(first.rest().is_none());
        }
    }

    #[test]
    fn too_few_pairs_are_given_at_the_end() {
        assert!(FirstPairs::default().rest().is_none());
        let mut first = FirstPairs::default();
        assert!(first.see(&[[1.0; 2]; 9]).is_none());
        assert_eq!(first.rest().map(|pairs| pairs.len()), Some(9));
    }

    /// Pairs with a time or a wave as S_C, and a wave as S_D.
    fn pairs(count: usize, first: impl Fn(f64) -> f64) -> Vec<[f32; 2]> {
        let pair = |k: usize| [first(k as f64) as f32, (0.3 * k as f64).cos() as f32];
        (0..count).map(pair).collect()
    }

    #[test]
    fn a_time_is_recognised_as_a_ramp() {
        for (start, step) in [(0.0, 1e-5), (-100.0, 1e-5), (3.0, 10.0), (0.0, 1.0)] {
            let time = |k: f64| start + step * k;
            assert_eq!(ramp(&pairs(16_384, time)), Some("S_C"), "{start} {step}");
            assert_eq!(ramp(&pairs(255, time)), None);
        }
        let swapped: Vec<[f32; 2]> = pairs(256, |k| k).iter().map(|&[t, d]| [d, t]).collect();
        assert_eq!(ramp(&swapped), Some("S_D"));
    }

    #[test]
    fn a_wave_is_no_ramp() {
        // The longest period, where it rises straightest; a dead pick-off; one with a single step.
        let slow = |k: f64| (TAU * (k - 128.0) / 1024.0).sin();
        assert_eq!(ramp(&pairs(256, slow)), None);
        assert_eq!(ramp(&pairs(16_384, |_| 1.0)), None);
        assert_eq!(ramp(&pairs(16_384, |k| f64::from(k > 9.0))), None);
        assert_eq!(ramp(&pairs(16_384, |_| f64::NAN)), None);
        assert_eq!(ramp(&[]), None);
    }

    #[test]
    fn amplitudes_outside_the_range_are_found() {
        for (scale, is_within) in [(1e-16, false), (1e-14, true), (1e16, true), (1e18, false)] {
            let mut pairs = pairs(100, |k| (0.3 * k).sin());
            for pair in &mut pairs {
                *pair = pair.map(|sample| scale * sample);
            }
            pairs[7][0] = f32::NAN;
            let found = amplitude_beyond(&pairs);
            assert_eq!(found.is_none(), is_within, "{scale}");
            assert!(found.is_none_or(|found| (found / f64::from(scale) - 1.0).abs() < 0.1));
        }
        // A wave on S_D alone.
        let other = pairs(100, |_| 0.0);
        let other: Vec<[f32; 2]> = other.iter().map(|pair| pair.map(|x| 1e18 * x)).collect();
        assert!(amplitude_beyond(&other).is_some());
        assert_eq!(amplitude_beyond(&[]), None);
        assert_eq!(amplitude_beyond(&[[0.0; 2]; 9]), None);
    }

    #[test]
    fn an_offset_far_larger_than_the_samples_vary_is_found() {
        for (offset, is_large) in [
            ([290.0, 0.0], false),
            ([310.0, 0.0], true),
            ([0.0, -310.0], true),
            ([220.0, 220.0], true),
        ] {
            // With an rms of 1 about the mean, both pick-offs together.
            let pair = |k: usize| {
                let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
                [offset[0] + side, offset[1]]
            };
            let pairs: Vec<[f32; 2]> = (0..512).map(pair).collect();
            assert_eq!(large_offset(&pairs).is_some(), is_large, "{offset:?}");
        }
        assert_eq!(large_offset(&[[1.0; 2]; 512]), None);
    }
}
