//! The driver against the frames of the data sheet, byte by byte, and the limits in time.

mod bus;
mod results;
mod start;
mod timing;

use ad7380::{Ad7380, Config};
use embedded_hal_mock::eh1::delay::NoopDelay;
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
        write(0xA100), // CONFIGURATION2, SDO = 1
        read(2, 0x100),
        write(0xC000 | low),
        read(4, low),
        write(0xD000 | high),
        read(5, high),
        write(0x9000 | configuration1),
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
