//! The driver against the frames of the data sheet, byte by byte.

use ad7380::*;
use embedded_hal::spi::{self, ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::delay::{CheckedDelay, NoopDelay, Transaction as Delay};
use embedded_hal_mock::eh1::spi::{Mock, Transaction as Spi};

type Frames = Vec<Spi<u8>>;

/// One frame: CS falls, `sent` goes out, CS rises.
fn write(sent: u16) -> Frames {
    let bytes = sent.to_be_bytes().to_vec();
    vec![
        Spi::transaction_start(),
        Spi::write_vec(bytes),
        Spi::transaction_end(),
    ]
}

/// One frame of no-operation in which the chip answers.
fn answer(bytes: &[u8]) -> Frames {
    let zeros = vec![0; bytes.len()];
    vec![
        Spi::transaction_start(),
        Spi::transfer_in_place(zeros, bytes.to_vec()),
        Spi::transaction_end(),
    ]
}

/// A register read: bit 15 is 0, the answer comes one frame later.
fn read(address: u16, value: u16) -> Frames {
    [write(address << 12), answer(&value.to_be_bytes())].concat()
}

/// Reset, settings and read-back, when the registers hold `low`, `high`, `configuration1`.
fn configured(low: u16, high: u16, configuration1: u16) -> Frames {
    [
        write(0xA0FF), // CONFIGURATION2, RESET = 0xFF
        write(0xC000 | low),
        write(0xD000 | high),
        write(0xA100), // CONFIGURATION2, SDO = 1
        write(0x9000 | configuration1),
        read(4, low),
        read(5, high),
        read(2, 0x100),
        read(1, configuration1),
        write(0xA13C), // CONFIGURATION2, SDO = 1, RESET = 0x3C
    ]
    .concat()
}

/// Runs `test` with a chip that gives `then` after a start with `config`; every frame must have come.
fn with(
    config: Config,
    start: &[Frames],
    then: &[Frames],
    test: impl FnOnce(&mut Ad7380<Mock<u8>>),
) {
    let mock = Mock::new(&[start, then].concat().concat());
    let mut adc = Ad7380::new(mock, &mut NoopDelay, config).expect("frames that match");
    test(&mut adc);
    adc.free().done();
}

fn default_start() -> [Frames; 2] {
    [
        configured(0x800, 0x7FF, 0),
        answer(&[0xDE, 0xAD, 0xBE, 0xEF]),
    ]
}

#[test]
fn resets_configures_reads_back_and_waits() {
    let mut spi = Mock::new(&default_start().concat());
    let mut delay = CheckedDelay::new(&[
        Delay::delay_ms(5),
        Delay::delay_us(10),
        Delay::delay_us(10),
        Delay::delay_ns(190),
    ]);
    let adc = Ad7380::new(&mut spi, &mut delay, Config::default()).unwrap();
    assert_eq!(*adc.config(), Config::default());
    spi.done();
    delay.done();
}

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
fn every_setting_reaches_its_bits() {
    use Oversampling::{Normal, Rolling};
    let alert = Some(Thresholds::new(-100, 100).unwrap());
    let cases = [
        (Reference::External, Oversampling::Off, None, 0b00_0000_0010),
        (
            Reference::Internal,
            Oversampling::Off,
            alert,
            0b00_0000_1000,
        ),
        (
            Reference::Internal,
            Normal {
                ratio: Ratio::X2,
                boost: false,
            },
            None,
            0b00_0100_0000,
        ),
        (
            Reference::Internal,
            Normal {
                ratio: Ratio::X4,
                boost: true,
            },
            None,
            0b00_1000_0100,
        ),
        (
            Reference::External,
            Normal {
                ratio: Ratio::X8,
                boost: false,
            },
            None,
            0b00_1100_0010,
        ),
        (
            Reference::Internal,
            Normal {
                ratio: Ratio::X16,
                boost: false,
            },
            alert,
            0b01_0000_1000,
        ),
        (
            Reference::Internal,
            Normal {
                ratio: Ratio::X32,
                boost: true,
            },
            None,
            0b01_0100_0100,
        ),
        (
            Reference::Internal,
            Rolling {
                ratio: RollingRatio::X2,
                boost: false,
            },
            None,
            0b10_0100_0000,
        ),
        (
            Reference::Internal,
            Rolling {
                ratio: RollingRatio::X4,
                boost: false,
            },
            None,
            0b10_1000_0000,
        ),
        (
            Reference::Internal,
            Rolling {
                ratio: RollingRatio::X8,
                boost: true,
            },
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
        assert_eq!(adc.alert(), Ok(above));
        let below = Alert {
            low: [false, true],
            ..Alert::default()
        };
        assert_eq!(adc.alert(), Ok(below));
        let both = adc.alert().unwrap();
        assert_eq!((both.low, both.high), ([true, false], [false, true]));
        assert_eq!(both.out_of_range(), [true, true]);
        let failed = adc.alert().unwrap();
        assert!(failed.crc_failed && failed.setup_failed);
        assert_eq!(failed.out_of_range(), [false, false]);
        assert_eq!(adc.alert(), Ok(Alert::default()));
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

#[test]
fn a_register_that_reads_otherwise_stops_the_start() {
    let writes = [
        write(0xA0FF),
        write(0xC800),
        write(0xD7FF),
        write(0xA100),
        write(0x9002),
    ]
    .concat();
    let config = Config {
        reference: Reference::External,
        ..Config::default()
    };
    let good = [
        read(4, 0x800),
        read(5, 0x7FF),
        read(2, 0x100),
        read(1, 0x002),
    ];
    // No chip: the line stays low or high. A chip that lost the write: its own settings after a reset.
    for (broken, register, wrote, value, seen) in [
        (0, Register::AlertLowThreshold, 0x800, 0x000, 0x000),
        (0, Register::AlertLowThreshold, 0x800, 0xFFFF, 0xFFF),
        (1, Register::AlertHighThreshold, 0x7FF, 0x3FF, 0x3FF),
        (2, Register::Configuration2, 0x100, 0x000, 0x000),
        (3, Register::Configuration1, 0x002, 0x000, 0x000),
        (3, Register::Configuration1, 0x002, 0x022, 0x022),
    ] {
        let reads = [good[..broken].concat(), read(register as u16, value)].concat();
        let mut spi = Mock::new(&[writes.clone(), reads].concat());
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

/// A bus on which frame number `good` and all after it fail; before it the chip answers as after [`Config::default`].
struct FailingBus {
    good: usize,
    frame: usize,
}

impl ErrorType for FailingBus {
    type Error = ErrorKind;
}

impl SpiDevice for FailingBus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        // Five writes, then a request and an answer for each of four registers.
        let answers = [(6, 0x800_u16), (8, 0x7FF), (10, 0x100), (12, 0)];
        if self.frame == self.good {
            return Err(ErrorKind::Overrun);
        }
        if let [Operation::TransferInPlace(bytes)] = operations {
            let answer = answers.iter().find(|(frame, _)| *frame == self.frame);
            if let Some((_, value)) = answer {
                bytes.copy_from_slice(&value.to_be_bytes());
            }
        }
        self.frame += 1;
        Ok(())
    }
}

#[test]
fn an_error_of_the_bus_is_passed_on_from_every_frame() {
    // 13 frames to configure, the soft reset, the result thrown away.
    for good in 0..15 {
        let bus = FailingBus { good, frame: 0 };
        let error = Ad7380::new(bus, &mut NoopDelay, Config::default())
            .map(|_| ())
            .unwrap_err();
        assert_eq!(error, Error::Spi(ErrorKind::Overrun), "frame {good}");
        assert!(error.to_string().contains("SPI"));
    }
    let mut adc = Ad7380::new(
        FailingBus { good: 16, frame: 0 },
        &mut NoopDelay,
        Config::default(),
    )
    .unwrap();
    assert_eq!(adc.read_pair(), Ok([0, 0]));
    assert_eq!(adc.read_pair(), Err(Error::Spi(ErrorKind::Overrun)));
    assert_eq!(adc.alert(), Err(Error::Spi(ErrorKind::Overrun)));
    assert_eq!(
        adc.soft_reset(&mut NoopDelay),
        Err(Error::Spi(ErrorKind::Overrun))
    );
    assert_eq!(SPI_MODE, spi::MODE_2);
}
