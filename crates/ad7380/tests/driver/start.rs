//! Resets, settings and read-back.

use ad7380::*;
use embedded_hal_mock::eh1::delay::{CheckedDelay, NoopDelay, Transaction as Delay};
use embedded_hal_mock::eh1::spi::Mock;

use crate::{answer, configured, default_start, read, with, write};

#[test]
fn resets_configures_reads_back_and_waits() {
    let mut spi = Mock::new(&default_start().concat());
    let waits = |power_up, conversion| {
        let mut waits = vec![Delay::delay_ms(power_up), Delay::delay_us(10)];
        // A write, and the two frames of a read, of each of four registers.
        waits.extend((0..12).map(|_| Delay::delay_ns(conversion)));
        waits.extend([Delay::delay_us(10), Delay::delay_ns(conversion)]);
        waits
    };
    let mut delay = CheckedDelay::new(&waits(11, 190));
    let adc = Ad7380::new(&mut spi, &mut delay, Config::default()).unwrap();
    assert_eq!(*adc.config(), Config::default());
    spi.done();
    delay.done();

    // Every frame starts as many conversions as are averaged.
    let slow = Config {
        reference: Reference::External,
        oversampling: Oversampling::Normal {
            ratio: Ratio::X32,
            boost: false,
        },
        ..Config::default()
    };
    let start = [configured(0x800, 0x7FF, 0b01_0100_0010), answer(&[0; 4])];
    let then = read(3, 0);
    let mut spi = Mock::new(&[start.concat(), then].concat());
    let mut waits = waits(5, 31_010);
    waits.extend([Delay::delay_ns(31_010), Delay::delay_ns(31_010)]);
    let mut delay = CheckedDelay::new(&waits);
    let mut adc = Ad7380::new(&mut spi, &mut delay, slow).unwrap();
    adc.alert(&mut delay).unwrap();
    spi.done();
    delay.done();
}

#[test]
fn every_setting_reaches_its_bits() {
    use Oversampling::{Normal, Rolling};
    let alert = Some(Thresholds::new(-100, 100).unwrap());
    let normal = |ratio, boost| Normal { ratio, boost };
    let rolling = |ratio, boost| Rolling { ratio, boost };
    let (internal, external) = (Reference::Internal, Reference::External);
    let cases = [
        (external, Oversampling::Off, None, 0b00_0000_0010),
        (internal, Oversampling::Off, alert, 0b00_0000_1000),
        (internal, normal(Ratio::X2, false), None, 0b00_0100_0000),
        (internal, normal(Ratio::X4, true), None, 0b00_1000_0100),
        (external, normal(Ratio::X8, false), None, 0b00_1100_0010),
        (internal, normal(Ratio::X16, false), alert, 0b01_0000_1000),
        (internal, normal(Ratio::X32, true), None, 0b01_0100_0100),
        (
            internal,
            rolling(RollingRatio::X2, false),
            None,
            0b10_0100_0000,
        ),
        (
            internal,
            rolling(RollingRatio::X4, false),
            None,
            0b10_1000_0000,
        ),
        (
            internal,
            rolling(RollingRatio::X8, true),
            None,
            0b10_1100_0100,
        ),
    ];
    for (reference, oversampling, alert, bits) in cases {
        // −100 = 0xFF9C and 100 = 0x0064 without their last four bits.
        let (low, high) = if alert.is_some() {
            (0xFF9, 0x006)
        } else {
            (0x800, 0x7FF)
        };
        let mut start = vec![configured(low, high, bits)];
        let stale = match oversampling {
            Rolling { ratio, .. } => 1 << ratio as u32,
            _ => 1,
        };
        let bytes = if oversampling.boost() { 5 } else { 4 };
        start.extend((0..stale).map(|_| answer(&vec![0x55; bytes])));
        with(
            Config {
                reference,
                oversampling,
                alert,
            },
            &start,
            &[],
            |_| (),
        );
    }
}

#[test]
fn a_register_that_reads_otherwise_stops_the_start() {
    let config = Config {
        reference: Reference::External,
        ..Config::default()
    };
    let good = [
        [write(0xA100), read(2, 0x100)].concat(),
        [write(0xC800), read(4, 0x800)].concat(),
        [write(0xD7FF), read(5, 0x7FF)].concat(),
    ];
    // No chip: the line stays low or high. A chip that lost the write: its own settings after a reset.
    for (broken, register, wrote, value, seen) in [
        (0, Register::Configuration2, 0x100, 0x000, 0x000),
        (1, Register::AlertLowThreshold, 0x800, 0x000, 0x000),
        (1, Register::AlertLowThreshold, 0x800, 0xFFFF, 0xFFF),
        (2, Register::AlertHighThreshold, 0x7FF, 0x3FF, 0x3FF),
        (3, Register::Configuration1, 0x002, 0x000, 0x000),
        (3, Register::Configuration1, 0x002, 0x022, 0x022),
    ] {
        let address = register as u16;
        let frames = [
            write(0xA0FF),
            good[..broken].concat(),
            write(0x8000 | address << 12 | wrote),
            read(address, value),
        ];
        let mut spi = Mock::new(&frames.concat());
        let error = Ad7380::new(&mut spi, &mut NoopDelay, config).unwrap_err();
        assert_eq!(
            error,
            Error::ReadBack {
                register,
                wrote,
                read: seen
            }
        );
        spi.done();
    }
}

#[test]
fn reserved_bits_and_the_address_are_not_compared() {
    let mut start = default_start().concat();
    // The answers to CONFIGURATION2 and CONFIGURATION1, with their address, the reset field and reserved bits set.
    for (value, noise) in [(0x0100_u16, 0x2EFF_u16), (0x0000, 0x1C00)] {
        let plain = answer(&value.to_be_bytes())[1].clone();
        let at = start.iter().rposition(|frame| *frame == plain).unwrap();
        start[at] = answer(&(value | noise).to_be_bytes())[1].clone();
    }
    with(Config::default(), &[start], &[], |_| ());
}

#[test]
fn a_soft_reset_keeps_one_wire_mode_and_throws_a_result_away() {
    let then = [
        write(0xA13C),
        answer(&[0xAA; 4]),
        answer(&[0, 5, 0xFF, 0xFA]),
    ];
    with(Config::default(), &default_start(), &then, |adc| {
        adc.soft_reset(&mut NoopDelay).unwrap();
        assert_eq!(adc.read_pair(), Ok([5, -6]));
    });
}
