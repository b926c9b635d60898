//! The first pairs that are identified: gathered until they are enough to tell something by, as a pipe may begin with one alone, and what
//! they tell: samples that are no pick-off's, or whose rows would mean nothing, though they might look well.

use std::ops::RangeInclusive;

use antinode::period::DifferenceDetector;

/// Some periods; no more, lest the rows of a pipe come before what is wrong with them.
const ENOUGH: usize = 512;

/// No wave goes straight for so many samples, a quarter of the longest period; the first of a pipe may be no more.
const STRAIGHT: usize = 256;
/// How far from straight rounding may take a time, in its whole rise.
const ROUNDING: f64 = 1e-4;

/// Amplitudes that the core identifies.
const AMPLITUDES: RangeInclusive<f64> = 1e-15..=1e17;

/// An offset this many times the rms about it leaves single precision too few digits for a wave.
const LARGE_OFFSET: f64 = 300.0;

/// A known frequency may be 5 % off, and so may one that was found.
const APART: f64 = 0.1;

/// Pairs gathered before they are identified.
#[derive(Debug, Default)]
pub(super) struct FirstPairs {
    pairs: Vec<[f32; 2]>,
    /// Pairs gathered, and not yet identified.
    ahead: usize,
    is_given: bool,
}

impl FirstPairs {
    /// Sees the next pairs that are to be identified, some of them not for the first time; gives all, once they are enough.
    pub fn see(&mut self, pairs: &[[f32; 2]]) -> Option<Vec<[f32; 2]>> {
        if !self.is_given && pairs.len() > self.ahead {
            self.pairs.extend(&pairs[self.ahead..]);
            self.ahead = pairs.len();
        }
        if self.pairs.len() < ENOUGH {
            return None;
        }
        self.rest()
    }

    /// So many pairs have been identified.
    pub fn pass(&mut self, pairs: usize) {
        self.ahead = self.ahead.saturating_sub(pairs);
    }

    /// All there are, where they were not enough.
    pub fn rest(&mut self) -> Option<Vec<[f32; 2]>> {
        self.is_given = true;
        let pairs = std::mem::take(&mut self.pairs);
        (!pairs.is_empty()).then_some(pairs)
    }
}

/// The pick-off whose samples go up in equal steps, as a time or a counter does.
pub(super) fn straight(pairs: &[[f32; 2]]) -> Option<&'static str> {
    if pairs.len() < STRAIGHT {
        return None;
    }
    let is_straight = |channel: usize| {
        let value = |k: usize| f64::from(pairs[k][channel]);
        let last = pairs.len() - 1;
        let rise = value(last) - value(0);
        let line = |k: usize| value(0) + rise * k as f64 / last as f64;
        rise > 0.0 && (0..last).all(|k| (value(k) - line(k)).abs() <= ROUNDING * rise)
    };
    let mut channels = ["S_C", "S_D"].into_iter().enumerate();
    channels.find_map(|(channel, name)| is_straight(channel).then_some(name))
}

/// How far samples swing, where that is no amplitude that can be identified.
pub(super) fn amplitude_beyond(pairs: &[[f32; 2]]) -> Option<f64> {
    let swing = |channel: usize| {
        let samples = pairs.iter().map(|pair| f64::from(pair[channel]));
        let finite = samples.filter(|sample| sample.is_finite());
        let [least, most] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |ends, sample| {
            [ends[0].min(sample), ends[1].max(sample)]
        });
        0.5 * (most - least)
    };
    let swing = swing(0).max(swing(1));
    (swing > 0.0 && !AMPLITUDES.contains(&swing)).then_some(swing)
}

/// What to tell where the first pairs hold a wave elsewhere than where one is said to be: its rows may look well.
pub(super) fn elsewhere(pairs: &[[f32; 2]], rate: f64, frequency: f32) -> Option<String> {
    let mut detector = Box::new(DifferenceDetector::<f32>::new());
    let period = pairs.iter().find_map(|&pair| detector.push(pair))?;
    let found = rate / f64::from(period);
    let apart = found / f64::from(frequency) - 1.0;
    (apart.abs() > APART).then(|| {
        format!(
            "a search finds a wave of {found:.0} Hz, where --frequency says {frequency} Hz: unless both are there, rows mean nothing"
        )
    })
}

/// The mean of samples and their rms about it, both pick-offs together, where the mean is too large for a wave about it.
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
    // What stands still is no wave, and not for its offset.
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
            assert!(given[0].len() >= ENOUGH && all.starts_with(&given[0]));
            assert!(first.rest().is_none());
        }
    }

    #[test]
    fn too_few_are_given_at_the_end() {
        assert!(FirstPairs::default().rest().is_none());
        let mut first = FirstPairs::default();
        assert!(first.see(&[[1.0; 2]; 9]).is_none());
        assert_eq!(first.rest().map(|pairs| pairs.len()), Some(9));
    }

    /// As many pairs of a time or a wave beside a wave.
    fn pairs(count: usize, first: impl Fn(f64) -> f64) -> Vec<[f32; 2]> {
        let pair = |k: usize| [first(k as f64) as f32, (0.3 * k as f64).cos() as f32];
        (0..count).map(pair).collect()
    }

    #[test]
    fn a_time_is_no_signal() {
        for (start, step) in [(0.0, 1e-5), (-100.0, 1e-5), (3.0, 10.0), (0.0, 1.0)] {
            let time = |k: f64| start + step * k;
            assert_eq!(
                straight(&pairs(16_384, time)),
                Some("S_C"),
                "{start} {step}"
            );
            assert_eq!(straight(&pairs(255, time)), None);
        }
        let swapped: Vec<[f32; 2]> = pairs(256, |k| k).iter().map(|&[t, d]| [d, t]).collect();
        assert_eq!(straight(&swapped), Some("S_D"));
    }

    #[test]
    fn a_wave_is_no_time() {
        // The longest period, where it goes up straightest; a dead pick-off; one that saw a knock.
        let slow = |k: f64| (TAU * (k - 128.0) / 1024.0).sin();
        assert_eq!(straight(&pairs(256, slow)), None);
        assert_eq!(straight(&pairs(16_384, |_| 1.0)), None);
        assert_eq!(straight(&pairs(16_384, |k| f64::from(k > 9.0))), None);
        assert_eq!(straight(&pairs(16_384, |_| f64::NAN)), None);
        assert_eq!(straight(&[]), None);
    }

    #[test]
    fn the_range_of_amplitudes_is_told() {
        for (scale, is_within) in [(1e-16, false), (1e-14, true), (1e16, true), (1e18, false)] {
            let mut pairs = pairs(100, |k| (0.3 * k).sin());
            for pair in &mut pairs {
                *pair = pair.map(|sample| scale * sample);
            }
            pairs[7][0] = f32::NAN;
            let told = amplitude_beyond(&pairs);
            assert_eq!(told.is_none(), is_within, "{scale}");
            assert!(told.is_none_or(|told| (told / f64::from(scale) - 1.0).abs() < 0.1));
        }
        assert_eq!(amplitude_beyond(&[]), None);
        assert_eq!(amplitude_beyond(&[[0.0; 2]; 9]), None);
    }
}
