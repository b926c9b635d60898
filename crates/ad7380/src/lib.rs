//! Driver for Analog Devices' AD7380: two 16-bit SAR converters that sample at the same instant, up to 4 MSPS.
//!
//! It runs the chip in 1-wire mode: one data line (SDOA) carries both results, A first. [`Ad7380::new`] resets the chip,
//! configures it and reads every register back; [`Ad7380::read_pair`] then returns one pair per call.
//!
//! # Example
//!
//! ```
//! use ad7380::{Ad7380, Config, Thresholds};
//! # use embedded_hal_mock::eh1::{delay::NoopDelay, spi::{Mock, Transaction as T}};
//! # let write = |frame: u16| [T::transaction_start(), T::write_vec(frame.to_be_bytes().to_vec()), T::transaction_end()];
//! # let read = |tx: &[u8], rx: &[u8]| [T::transaction_start(), T::transfer_in_place(tx.to_vec(), rx.to_vec()), T::transaction_end()];
//! # let register = |address: u8, value: u16| [write(u16::from(address) << 12), read(&[0; 2], &value.to_be_bytes())].concat();
//! # let frames = [
//! #     write(0xA0FF).to_vec(), write(0xA100).to_vec(), register(2, 0x100), write(0xC801).to_vec(), register(4, 0x801),
//! #     write(0xD7FE).to_vec(), register(5, 0x7FE), write(0x9008).to_vec(), register(1, 0x008),
//! #     write(0xA13C).to_vec(), read(&[0; 4], &[0x55; 4]).to_vec(),
//! #     read(&[0; 4], &[0x7F, 0xFF, 0xFF, 0xFE]).to_vec(), register(3, 0x0002),
//! # ].concat();
//! # let (mut spi, mut delay) = (Mock::new(&frames), NoopDelay::new());
//! # let mut check = spi.clone();
//! // Any SpiDevice, in SPI mode `ad7380::SPI_MODE`, and any DelayNs of the board.
//! let config = Config { alert: Some(Thresholds::SATURATION), ..Config::default() };
//! let mut adc = Ad7380::new(&mut spi, &mut delay, config)?;
//!
//! let pair = adc.read_pair()?;
//! assert_eq!(pair, [32_767, -2]); // A stands at its rail.
//! assert_eq!(adc.alert(&mut delay)?.out_of_range(), [true, false]); // The chip has seen it too.
//! # check.done();
//! # Ok::<(), ad7380::Error<embedded_hal::spi::ErrorKind>>(())
//! ```
//!
//! # A pair is one frame late
//!
//! The falling edge of CS samples both inputs and starts the conversion; the bits that the same frame shifts out are those of the
//! *previous* conversion. So `read_pair` returns the inputs as they were at the previous call, and a steady rate of calls gives a steady
//! rate of samples. The first frame after the configuration shifts out a result that was sampled with other settings: `new` reads and
//! discards it, or, with a rolling average, as many frames as the average has conversions.
//!
//! # Codes
//!
//! Two's complement: −32 768 to 32 767 stands for −VREF to +VREF − 1 LSB between the input's two pins, one LSB is VREF / 32 768.
//!
//! # Which SPI clock
//!
//! A pair takes 32 clocks, and CS must be high for 10 ns: at the largest clock, 80 MHz, a frame is 410 ns and the largest rate
//! 2.43 million pairs a second (the 4 MSPS of the title page need both data lines). 100 000 pairs a second need 3.21 MHz and more;
//! [`timing`] computes it for any rate:
//!
//! ```
//! assert_eq!(ad7380::timing::min_sclk_hz(100_000, ad7380::Oversampling::Off), Some(3_203_204));
//! ```
//!
//! Register access is more reliable below the largest clock, according to Linux's driver, which uses 10 MHz: construct with that.
//!
//! # By timer and DMA
//!
//! At a high rate a timer should drive CS, and DMA the SPI, for sampling without jitter. Configure the chip with this driver, take the SPI
//! back with [`Ad7380::free`], send zeros (the chip's no-operation) and decode each frame with [`pair_from_frame`] or [`pair_from_word`].
//!
//! # Not supported
//!
//! 2-wire mode, power-down and the optional CRC of both directions, which stays off. The 14-bit AD7381 has the same registers but
//! frames of 28 clocks.
//!
//! # Sources
//!
//! - Analog Devices, data sheet AD7380/AD7381, and application note AN-2003 on its oversampling.
//! - Linux: `drivers/iio/adc/ad7380.c` (registers, thresholds, times), `Documentation/iio/ad7380.rst` (alert, resolution boost) and
//!   `Documentation/devicetree/bindings/iio/adc/adi,ad7380.yaml` (80 MHz).
//! - Analog Devices, no-OS: `drivers/adc/ad738x` (registers, frames); AD738x-FMC user guide (SPI mode).
#![no_std]
#![forbid(unsafe_code)]

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod alert;
mod config;
mod driver;
mod frame;
mod register;
pub mod timing;

pub use alert::{Alert, Thresholds, ThresholdsError};
pub use config::{Config, Oversampling, Ratio, Reference, RollingRatio};
pub use driver::{Ad7380, Error, SPI_MODE};
pub use frame::{at_rail, pair_from_boosted_frame, pair_from_frame, pair_from_word};
pub use register::Register;
