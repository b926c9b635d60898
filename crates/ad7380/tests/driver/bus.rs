//! A bus that fails.

use ad7380::{Ad7380, Config, Error};
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::delay::NoopDelay;

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
        // A reset, then a write, a request and an answer for each of four registers.
        let answers = [(3, 0x100_u16), (6, 0x800), (9, 0x7FF), (12, 0)];
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
    assert_eq!(
        adc.alert(&mut NoopDelay),
        Err(Error::Spi(ErrorKind::Overrun))
    );
    assert_eq!(
        adc.soft_reset(&mut NoopDelay),
        Err(Error::Spi(ErrorKind::Overrun))
    );
}
