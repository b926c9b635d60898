//! The driver.

use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{MODE_2, Mode, SpiDevice};

use crate::alert::{Alert, Thresholds};
use crate::config::Config;
use crate::frame::{pair_from_boosted_frame, pair_from_frame};
use crate::register::{HARD_RESET, ONE_WIRE, Register, SOFT_RESET};
use crate::timing::RESET_US;

/// The SPI mode: the clock idles high, and data are taken at its falling edge, highest bit first.
///
/// It is that of Analog Devices' AD738x-FMC user guide and of their no-OS example for it, which also runs on an STM32F4 and until 2026 had
/// mode 1, in which data are taken at the falling edge as well; the example of Linux's binding has mode 3. With a mode that does not work
/// [`Ad7380::new`] gives [`Error::ReadBack`].
pub const SPI_MODE: Mode = MODE_2;

/// A configured AD7380 in 1-wire mode.
///
/// `SPI` is the chip on its bus, with CS; a `&mut` to it also works, and leaves it with the caller if `new` fails.
#[derive(Debug)]
pub struct Ad7380<SPI> {
    spi: SPI,
    config: Config,
}

impl<SPI: SpiDevice> Ad7380<SPI> {
    /// Waits 11 ms for the supply and the internal reference, or 5 ms with an external one, resets the chip, configures it, reads every
    /// register back and clears the averages. Pending results are discarded, so that the first pair from [`Self::read_pair`] was sampled
    /// with these settings. An external reference must settle by then, too.
    ///
    /// # Errors
    ///
    /// [`Error::Spi`] from the bus; [`Error::ReadBack`] if a register does not hold what was written: no chip, no supply, a wrong SPI
    /// mode, or too fast a clock for the wiring.
    pub fn new<D: DelayNs>(
        spi: SPI,
        delay: &mut D,
        config: Config,
    ) -> Result<Self, Error<SPI::Error>> {
        let mut adc = Self { spi, config };
        delay.delay_ms(config.reference.power_up_ms());
        adc.write(Register::Configuration2, HARD_RESET)?;
        delay.delay_us(RESET_US);

        // The alert is enabled after its thresholds are set, and averages, which make frames slower, come last.
        let [low, high] = config.alert.unwrap_or(Thresholds::FULL).registers();
        for (register, wrote) in [
            (Register::Configuration2, ONE_WIRE),
            (Register::AlertLowThreshold, low),
            (Register::AlertHighThreshold, high),
            (Register::Configuration1, config.configuration1()),
        ] {
            adc.write(register, wrote)?;
            adc.wait(delay);
            let read = adc.read(register, delay)? & register.read_back_mask();
            if read != wrote {
                return Err(Error::ReadBack {
                    register,
                    wrote,
                    read,
                });
            }
        }
        adc.soft_reset(delay)?;
        Ok(adc)
    }

    /// Clears the averages and the register ALERT; the settings stay. Pending results are discarded, as in [`Self::new`].
    ///
    /// # Errors
    ///
    /// [`Error::Spi`] from the bus.
    pub fn soft_reset<D: DelayNs>(&mut self, delay: &mut D) -> Result<(), Error<SPI::Error>> {
        self.write(Register::Configuration2, ONE_WIRE | SOFT_RESET)?;
        delay.delay_us(RESET_US);
        for _ in 0..self.config.oversampling.stale_frames() {
            self.read_pair()?;
            self.wait(delay);
        }
        Ok(())
    }

    /// Reads the pair `[A, B]` that was sampled at the frame before, and starts a new conversion of both.
    ///
    /// Call it no sooner than [`Oversampling::conversion_ns`](crate::Oversampling::conversion_ns) after the previous call. With resolution
    /// boost the two lowest bits of a result are cut off.
    ///
    /// # Errors
    ///
    /// [`Error::Spi`] from the bus.
    #[inline]
    pub fn read_pair(&mut self) -> Result<[i16; 2], Error<SPI::Error>> {
        if self.config.oversampling.boost() {
            return Ok(self.read_boosted_pair()?.map(|code| (code >> 2) as i16));
        }
        Ok(pair_from_frame(self.frame([0; 4])?))
    }

    /// As [`Self::read_pair`], but in units of VREF / 131 072, −131 072 to 131 071.
    ///
    /// Without resolution boost the two lowest bits are 0.
    ///
    /// # Errors
    ///
    /// [`Error::Spi`] from the bus.
    #[inline]
    pub fn read_boosted_pair(&mut self) -> Result<[i32; 2], Error<SPI::Error>> {
        if !self.config.oversampling.boost() {
            return Ok(self.read_pair()?.map(|code| i32::from(code) << 2));
        }
        Ok(pair_from_boosted_frame(self.frame([0; 5])?))
    }

    /// Reads, and thereby clears, the register ALERT.
    ///
    /// It takes two frames, which start conversions like any other, and waits for both: the pending result is lost, and the next pair is
    /// sampled at the second of them. To keep a steady rate, call it between recordings only, or watch the pin ALERT.
    ///
    /// # Errors
    ///
    /// [`Error::Spi`] from the bus.
    pub fn alert<D: DelayNs>(&mut self, delay: &mut D) -> Result<Alert, Error<SPI::Error>> {
        Ok(Alert::from_register(self.read(Register::Alert, delay)?))
    }

    /// The settings.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Gives the SPI back. The chip stays configured.
    pub fn free(self) -> SPI {
        self.spi
    }

    fn write(&mut self, register: Register, value: u16) -> Result<(), Error<SPI::Error>> {
        self.spi
            .write(&register.write_frame(value))
            .map_err(Error::Spi)
    }

    fn read<D: DelayNs>(
        &mut self,
        register: Register,
        delay: &mut D,
    ) -> Result<u16, Error<SPI::Error>> {
        self.spi.write(&register.read_frame()).map_err(Error::Spi)?;
        self.wait(delay);
        let value = Register::value(self.frame([0; 2])?);
        self.wait(delay);
        Ok(value)
    }

    /// Waits for the conversion that every frame starts: the next frame must not begin before its end.
    fn wait<D: DelayNs>(&self, delay: &mut D) {
        delay.delay_ns(self.config.oversampling.conversion_ns());
    }

    /// Reads a frame while sending zeros, the chip's no-operation: a plain read may send anything, and ones would be a write.
    #[inline]
    fn frame<const N: usize>(&mut self, mut bytes: [u8; N]) -> Result<[u8; N], Error<SPI::Error>> {
        self.spi.transfer_in_place(&mut bytes).map_err(Error::Spi)?;
        Ok(bytes)
    }
}

/// Error of the driver. `E` is that of the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error<E> {
    /// The bus failed.
    Spi(E),
    /// A register does not hold what was written.
    ReadBack {
        /// The register.
        register: Register,
        /// Its data as written, 12 bits.
        wrote: u16,
        /// Its data as read, without the reserved bits.
        read: u16,
    },
}

impl<E: core::fmt::Debug> core::fmt::Display for Error<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Spi(error) => write!(f, "the SPI bus failed: {error:?}"),
            Self::ReadBack {
                register,
                wrote,
                read,
            } => write!(
                f,
                "{register:?} reads {read:#05x} after {wrote:#05x} was written: check supply, wiring, SPI mode and clock (10 MHz is safe)"
            ),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for Error<E> {}
