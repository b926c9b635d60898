//! Sampling instants and phases that stay exact for hours.

use libm::fma;

/// An instant in s, as an unevaluated sum: `lo` holds what `hi` cannot.
///
/// 10 h into a record half a unit in the last place of the time is 4e-12 s, 1e-7 rad at 5332 Hz: `lo` removes it, and
/// carries the small shifts (skew, jitter) without loss.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instant {
    pub hi: f64,
    pub lo: f64,
}

impl Instant {
    pub fn of(time: f64) -> Instant {
        Instant { hi: time, lo: 0.0 }
    }

    /// Sample `index` of a stream of `sample_rate` Hz: `hi + lo` is `index / sample_rate` to some 32 digits.
    pub fn of_sample(index: u64, sample_rate: f64) -> Instant {
        let hi = index as f64 / sample_rate;
        Instant {
            hi,
            lo: fma(-hi, sample_rate, index as f64) / sample_rate,
        }
    }

    /// `shift` s later, with `shift` small.
    pub fn later(self, shift: f64) -> Instant {
        Instant {
            hi: self.hi,
            lo: self.lo + shift,
        }
    }

    pub fn seconds(self) -> f64 {
        self.hi + self.lo
    }

    /// Turns of `frequency` t + `frequency_rate` t^2 / 2, less a whole number of turns: -0.5 to 0.5.
    ///
    /// Accurate to some 1e-16 turns, however many turns there were: the rounding error of each product is added back.
    pub fn turns(self, frequency: f64, frequency_rate: f64) -> f64 {
        let steady = frequency * self.hi;
        let steady_rest = fma(frequency, self.hi, -steady) + frequency * self.lo;
        let half = 0.5 * frequency_rate;
        let gained = half * self.hi; // of frequency, on average
        let drift = gained * self.hi;
        let drift_rest = fma(gained, self.hi, -drift)
            + fma(half, self.hi, -gained) * self.hi
            + frequency_rate * self.lo * (self.hi + 0.5 * self.lo);
        fraction(fraction(steady) + fraction(drift) + fraction(steady_rest + drift_rest))
    }
}

/// The distance to the nearest integer, exactly: -0.5 to 0.5.
fn fraction(x: f64) -> f64 {
    x - x.round_ties_even()
}

/// The first sample whose time `index / sample_rate` is `time` or later.
pub(crate) fn first_sample_from(time: f64, sample_rate: f64) -> u64 {
    let index = (time * sample_rate).ceil() as u64; // saturates at both ends
    // The product may have been rounded up across an integer, or down to it.
    if index > 0 && (index - 1) as f64 / sample_rate >= time {
        index - 1
    } else if (index as f64) / sample_rate < time {
        index.saturating_add(1)
    } else {
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_stay_exact_for_hours() {
        // 5332 Hz at 100 kS/s: sample k has turned 5332 k / 100000 times, here in whole numbers.
        for k in [1u64, 99_999, 123_456_789, 36_000 * 100_000 + 7] {
            let expected = (5332 * k % 100_000) as f64 / 100_000.0;
            let got = Instant::of_sample(k, 100_000.0).turns(5332.0, 0.0);
            assert!(
                fraction(got - expected).abs() < 1e-15,
                "sample {k}: {got} against {expected}"
            );
        }
    }

    #[test]
    fn a_shift_turns_as_far_late_in_a_record_as_early() {
        let f = 5332.0;
        let early = Instant::of_sample(10, 100_000.0);
        let late = Instant::of_sample(3_600_000_010, 100_000.0);
        let moved = |i: Instant| fraction(i.later(1e-6).turns(f, 0.0) - i.turns(f, 0.0));
        assert!((moved(early) - f * 1e-6).abs() < 1e-15);
        assert!((moved(late) - f * 1e-6).abs() < 1e-15);
    }

    #[test]
    fn drift_is_the_square_of_the_whole_time() {
        let got = Instant::of(1000.0).later(1e-3).turns(0.0, 2.0);
        // (1000.001)^2 = 1000002.000001
        assert!((got - 1e-6).abs() < 1e-15, "{got}");
        // 100000 S/s, 3/16 Hz/s: sample k has turned 3 k^2 / (32 * 10^10) times.
        for k in [99_999u64, 123_456_789, 36_000 * 100_000 + 7] {
            let rest = 3 * u128::from(k).pow(2) % 320_000_000_000;
            let expected = rest as f64 / 32e10;
            let got = Instant::of_sample(k, 100_000.0).turns(0.0, 0.1875);
            assert!(fraction(got - expected).abs() < 1e-15, "{k}: {got}");
        }
    }

    #[test]
    fn a_time_of_a_sample_gives_that_sample() {
        // 0.07 * 100000 is 7000.000000000001
        assert_eq!(first_sample_from(0.07, 100_000.0), 7000);
        for k in 0..20_000u64 {
            assert_eq!(first_sample_from(k as f64 / 99_999.7, 99_999.7), k);
            assert_eq!(
                first_sample_from((k as f64 / 99_999.7).next_up(), 99_999.7),
                k + 1
            );
        }
        assert_eq!(first_sample_from(-1.0, 1e5), 0);
        assert_eq!(first_sample_from(1e-9, 1e5), 1);
        assert_eq!(first_sample_from(f64::MAX, 1e5), u64::MAX);
    }
}
