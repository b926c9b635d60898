//! The limits in time, against the same computed by hand.

use ad7380::timing::*;
use ad7380::{Oversampling, Ratio, RollingRatio};

#[test]
fn a_frame_takes_its_clocks_and_the_pulse_of_cs() {
    assert_eq!(min_frame_ns(80_000_000, Oversampling::Off), Some(400 + 10));
    assert_eq!(
        min_frame_ns(1_000_000, Oversampling::Off),
        Some(32_000 + 10)
    );
    // 32 / 3 MHz = 10 666.7 ns.
    assert_eq!(
        min_frame_ns(3_000_000, Oversampling::Off),
        Some(10_667 + 10)
    );
    let boosted = Oversampling::Rolling {
        ratio: RollingRatio::X8,
        boost: true,
    };
    assert_eq!(min_frame_ns(80_000_000, boosted), Some(500 + 10));
    // 32 / 7 Hz and 40 / 9 Hz are more than 4.29 s.
    for (oversampling, longest, shorter) in [(Oversampling::Off, 7, 8), (boosted, 9, 10)] {
        assert_eq!(min_frame_ns(1, oversampling), Some(u32::MAX));
        assert_eq!(min_frame_ns(longest, oversampling), Some(u32::MAX));
        assert_eq!(min_frame_ns(shorter, oversampling), Some(4_000_000_010));
    }
    assert_eq!(min_frame_ns(0, Oversampling::Off), None);
    assert_eq!(min_frame_ns(80_000_001, Oversampling::Off), None);
    assert_eq!(max_pair_rate_hz(0, Oversampling::Off), None);
}

#[test]
fn many_conversions_take_longer_than_the_frame() {
    let slow = Oversampling::Normal {
        ratio: Ratio::X32,
        boost: false,
    };
    assert_eq!(slow.conversion_ns(), 10 + 31 * 1_000);
    assert_eq!(min_frame_ns(80_000_000, slow), Some(31_010));
    assert_eq!(max_pair_rate_hz(80_000_000, slow), Some(32_247));
    let two = Oversampling::Normal {
        ratio: Ratio::X2,
        boost: false,
    };
    assert_eq!(two.conversion_ns(), 1_010);
    let rolling = Oversampling::Rolling {
        ratio: RollingRatio::X8,
        boost: false,
    };
    assert_eq!(rolling.conversion_ns(), Oversampling::Off.conversion_ns());
}

#[test]
fn the_smallest_clock_serves_its_rate_and_one_hertz_less_does_not() {
    let boosted = Oversampling::Rolling {
        ratio: RollingRatio::X2,
        boost: true,
    };
    for (oversampling, wanted) in [(Oversampling::Off, 32), (boosted, 40)] {
        for rate in [1, 48_000, 100_000, 999_999, 1_000_000, 1_960_784] {
            let sclk = min_sclk_hz(rate, oversampling).unwrap();
            // In units of 1e-9 clocks: what fits into the period less 10 ns.
            let clocks = |sclk: u32| {
                u64::from(sclk) * (1_000_000_000 - 10 * u64::from(rate)) / u64::from(rate)
            };
            assert!(clocks(sclk) >= wanted * 1_000_000_000, "{rate} Hz");
            assert!(clocks(sclk - 1) < wanted * 1_000_000_000, "{rate} Hz");
        }
    }
    let least = |rate| min_sclk_hz(rate, Oversampling::Off);
    assert!(least(2_439_024).is_some());
    assert_eq!([0, 2_439_025, u32::MAX].map(least), [None; 3]);
    assert_eq!(min_sclk_hz(1_960_785, boosted), None);
    // The conversions alone take 31.01 us.
    let slow = Oversampling::Normal {
        ratio: Ratio::X32,
        boost: false,
    };
    assert!(min_sclk_hz(32_247, slow).is_some());
    assert_eq!(min_sclk_hz(32_248, slow), None);
}

#[test]
fn the_smallest_clock_for_a_rate_allows_it_and_one_hertz_less_does_not() {
    let boosted = Oversampling::Rolling {
        ratio: RollingRatio::X2,
        boost: true,
    };
    for (oversampling, rates) in [(Oversampling::Off, 1..=2_439_024), (boosted, 1..=1_960_784)] {
        for rate in rates {
            let sclk = min_sclk_hz(rate, oversampling).unwrap();
            let allowed = |sclk| max_pair_rate_hz(sclk, oversampling).unwrap();
            assert!(allowed(sclk) >= rate, "{rate} Hz: {sclk} Hz");
            assert!(allowed(sclk - 1) < rate, "{rate} Hz: {sclk} Hz");
        }
    }
    assert_eq!(max_pair_rate_hz(31, Oversampling::Off), Some(0));
}
