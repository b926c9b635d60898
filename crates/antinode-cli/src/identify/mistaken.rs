//! First samples that are no pick-off's, or none that single precision can square: rows might look well all the same.

use std::ops::RangeInclusive;

/// No wave goes straight for so many samples, a quarter of the longest period; the first of a pipe may be no more.
const STRAIGHT: usize = 256;
/// How far from straight rounding may take a time, in its whole rise.
const ROUNDING: f64 = 1e-4;

/// Amplitudes that the core identifies.
const AMPLITUDES: RangeInclusive<f64> = 1e-15..=1e17;

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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

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
