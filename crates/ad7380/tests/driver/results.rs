//! Pairs and alerts.

use ad7380::*;
use embedded_hal_mock::eh1::delay::NoopDelay;

use crate::{answer, configured, default_start, read, with};

#[test]
fn the_first_result_is_thrown_away_and_codes_have_their_sign() {
    let pairs = [
        answer(&[0x7F, 0xFF, 0x80, 0x00]),
        answer(&[0xFF, 0xFF, 0x00, 0x01]),
        answer(&[0x00, 0x00, 0x80, 0x01]),
    ];
    with(Config::default(), &default_start(), &pairs, |adc| {
        // Not the [0xDEAD, 0xBEEF] of the start.
        assert_eq!(adc.read_pair(), Ok([32_767, -32_768]));
        assert_eq!(adc.read_pair(), Ok([-1, 1]));
        // Without boost the two further bits are 0.
        assert_eq!(adc.read_boosted_pair(), Ok([0, -32_767 * 4]));
    });
}

#[test]
fn boosted_results_have_18_bits() {
    let oversampling = Oversampling::Normal {
        ratio: Ratio::X8,
        boost: true,
    };
    let start = [configured(0x800, 0x7FF, 0b00_1100_0100), answer(&[0; 5])];
    // A = 0b01…1 and B = 0b10…0 of 18 bits, then A = −1 and B = 1; the last four bits are nobody's.
    let highest = answer(&[
        0b0111_1111,
        0b1111_1111,
        0b1110_0000,
        0b0000_0000,
        0b0000_1111,
    ]);
    let ones = answer(&[
        0b1111_1111,
        0b1111_1111,
        0b1100_0000,
        0b0000_0000,
        0b0001_1010,
    ]);
    let pairs = [highest.clone(), highest, ones.clone(), ones];
    with(
        Config {
            oversampling,
            ..Config::default()
        },
        &start,
        &pairs,
        |adc| {
            assert_eq!(adc.read_boosted_pair(), Ok([131_071, -131_072]));
            assert_eq!(adc.read_pair(), Ok([32_767, -32_768]));
            assert_eq!(adc.read_boosted_pair(), Ok([-1, 1]));
            assert_eq!(adc.read_pair(), Ok([-1, 0]));
        },
    );
}

#[test]
fn saturation_raises_the_alert_of_its_channel() {
    // −32 752 = 0x8010, 32 751 = 0x7FEF.
    let start = [configured(0x801, 0x7FE, 0b1000), answer(&[0; 4])];
    // The upper bits of an answer are no data.
    let alerts = [
        read(3, 0xB002),
        read(3, 0x3010),
        read(3, 0x3021),
        read(3, 0x3300),
        read(3, 0),
    ];
    let config = Config {
        alert: Some(Thresholds::SATURATION),
        ..Config::default()
    };
    with(config, &start, &alerts, |adc| {
        let above = Alert {
            high: [true, false],
            ..Alert::default()
        };
        assert_eq!(adc.alert(&mut NoopDelay), Ok(above));
        let below = Alert {
            low: [false, true],
            ..Alert::default()
        };
        assert_eq!(adc.alert(&mut NoopDelay), Ok(below));
        let both = adc.alert(&mut NoopDelay).unwrap();
        assert_eq!((both.low, both.high), ([true, false], [false, true]));
        assert_eq!(both.out_of_range(), [true, true]);
        let failed = adc.alert(&mut NoopDelay).unwrap();
        assert!(failed.crc_failed && failed.setup_failed);
        assert_eq!(failed.out_of_range(), [false, false]);
        assert_eq!(adc.alert(&mut NoopDelay), Ok(Alert::default()));
    });
    assert_eq!(at_rail([32_767, -32_768]), [true, true]);
    assert_eq!(at_rail([32_766, -32_767]), [false, false]);
}

#[test]
fn thresholds_are_what_the_chip_holds() {
    let thresholds = Thresholds::new(-20_001, 20_001).unwrap();
    assert_eq!((thresholds.low(), thresholds.high()), (-20_016, 20_015));
    assert_eq!(Thresholds::new(-32_752, 32_751), Ok(Thresholds::SATURATION));
    assert_eq!(Thresholds::new(i16::MIN, i16::MAX), Ok(Thresholds::FULL));
    let error = Thresholds::new(1, 0).unwrap_err();
    assert_eq!(error, ThresholdsError { low: 1, high: 0 });
    assert_eq!(
        error.to_string(),
        "the low threshold, 1, must not be above the high one, 0"
    );
}
