//! Both pick-offs at an AD7380 on SPI1: S_C at its input A, S_D at B, 16 bits each, sampled at the falling edge of CS.
//!
//! | pin | function | connection |
//! |---|---|---|
//! | PA5 | SPI1_SCK | 10.5 MHz |
//! | PA6 | SPI1_MISO | the chip's SDOA |
//! | PA7 | SPI1_MOSI | the chip's SDI |
//! | PA8 | TIM1_CH1 | the chip's CS |
//!
//! The driver configures the chip over SPI by software. Then TIM1 drives CS without jitter, and at two of its compare events the DMA
//! writes a zero to SPI1: these 32 clocks fetch a pair from the chip, as two words that a third stream stores. A comes first and so lies in
//! the lower half of a word of memory, which thus is a [`Packed`] pair. Registers by their names in RM0090. A frame carries the pair that
//! was sampled one frame before, so times are one sample period late.

#![allow(
    unsafe_code,
    reason = "addresses for the DMA, and fields that take any bits"
)]

use ad7380::{Ad7380, Config};
use antinode::Packed;
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use stm32f4xx_hal::gpio::{Alternate, Output, PA5, PA6, PA7, PA8};
use stm32f4xx_hal::pac::{DMA2, RCC, SPI1, SYSCFG, TIM1, TIM2};

use crate::clocks::{APB2, APB2_TIMERS, CORE};
use crate::hardware::clock;
use crate::hardware::pair_clock::{Tim2, Trigger};
use crate::hardware::ring::{Memory, Origin, Stream};
use crate::sampler::{Converter, Sampler, wait_for};
use crate::sampling::{AD7380_RAILS, is_at_rail_16};
use crate::settings::SAMPLE_RATE;

/// Ticks of TIM1 from frame to frame.
const TICKS: u32 = APB2_TIMERS / SAMPLE_RATE;
/// SPI clock, Hz: about the highest at which the chip's registers are reliable.
const SCLK: u32 = APB2 / 8;
/// Times of the two writes of zeros, in ticks after CS falls: the second zero waits in the SPI's buffer until the first is sent.
const WRITES: [u32; 2] = [34, 134];
/// Time at which CS rises, in ticks: the clocks of a frame from the first write on, and 0.5 µs for the DMA.
const RISES: u32 =
    WRITES[0] + ad7380::timing::FRAME_CLOCKS * (APB2_TIMERS / SCLK) + APB2_TIMERS / 2_000_000;
/// Idle time between frames, in ticks.
const QUIET: [u32; 2] = [RISES + 84, TICKS.saturating_sub(168)];

/// Word that the DMA sends: a no-operation of the chip.
static ZERO: u16 = 0;

/// The SPI's data pins.
pub type Pins = (PA5<Alternate<5>>, PA6<Alternate<5>>, PA7<Alternate<5>>);

/// The SPI, the timer of its frames, and the chip.
pub struct SpiAdc {
    spi: SPI1,
    timer: TIM1,
}

impl SpiAdc {
    /// Configures the chip and starts sampling into `memory`; CS must be high.
    ///
    /// # Errors
    ///
    /// Those of [`Ad7380::new`].
    // `inline`, so that it is compiled only in images that call it.
    #[inline]
    pub fn start(
        spi: SPI1,
        (timer, counter): (TIM1, TIM2),
        (dma, memory): (DMA2, &'static mut Memory),
        _: Pins,
        mut cs: PA8<Output>,
        (rcc, system): (&RCC, &SYSCFG),
    ) -> Result<Sampler<Self, Stream, Tim2>, ad7380::Error<ErrorKind>> {
        // AHB1ENR, APB2ENR: clocks of the DMA, SPI, timer and SYSCFG.
        rcc.ahb1enr().modify(|_, w| w.dma2en().set_bit());
        rcc.apb2enr()
            .modify(|_, w| w.spi1en().set_bit().tim1en().set_bit().syscfgen().set_bit());
        clock::settle();
        // CMPCR.CMP_PD: on, so that fast pins make less noise on the supply (RM0090, 9.1).
        // SAFETY: it writes bit 0 of a register, a field that the crate's description of the chip lacks.
        unsafe { system.cmpcr().as_ptr().write_volatile(1) };
        // CR1: master, CPOL 1 and CPHA 0 (the chip's mode 2), BR 2: APB2 over 8. SSM, SSI: CS is driven separately. DFF 0: bytes.
        spi.cr1().write(|w| {
            w.mstr().set_bit();
            w.cpol().set_bit();
            unsafe { w.br().bits(0b010) };
            w.ssm().set_bit();
            w.ssi().set_bit();
            w.spe().set_bit()
        });
        let device = Device {
            spi: &spi,
            cs: &mut cs,
        };
        Ad7380::new(device, &mut Delay, Config::default())?;
        let adc = Self { spi, timer };
        adc.configure(&dma);
        let _: PA8<Alternate<1>> = cs.into_alternate();
        let clock = Tim2::new(counter, rcc, Trigger::Tim1);
        // CR1.CEN: the frames begin.
        adc.timer.cr1().write(|w| w.cen().set_bit());
        let origin = Origin {
            register: adc.spi.dr().as_ptr() as u32,
            channel: 3,
            by_halves: true,
        };
        Ok(Sampler::new(adc, Stream::new(dma, memory, origin), clock))
    }

    fn configure(&self, dma: &DMA2) {
        // CR1.DFF: words of 16 bits; it may change only while SPE is off.
        self.spi.cr1().modify(|_, w| w.spe().clear_bit());
        self.spi
            .cr1()
            .modify(|_, w| w.dff().set_bit().spe().set_bit());
        // Streams 2 and 6, channel 6: TIM1's compare events 2 and 3 (RM0090, 10.3.3).
        for stream in [dma.st(2), dma.st(6)] {
            // SAFETY: the streams copy one half-word, a static, to the SPI's data register, repeatedly.
            unsafe {
                stream
                    .par()
                    .write(|w| w.bits(self.spi.dr().as_ptr() as u32));
                stream.m0ar().write(|w| w.bits(&raw const ZERO as u32));
                stream.ndtr().write(|w| w.bits(1));
                // DIR 1: to the peripheral. MSIZE, PSIZE 1: 16 bits. PL 2: below the priority of received words.
                stream.cr().write(|w| {
                    w.chsel().bits(6);
                    w.pl().bits(0b10);
                    w.msize().bits(0b01);
                    w.psize().bits(0b01);
                    w.circ().set_bit();
                    w.dir().bits(0b01)
                });
            }
            stream.cr().modify(|_, w| w.en().set_bit());
        }
        let timer = &self.timer;
        // SAFETY: each value is one that RM0090 lists for its field.
        unsafe {
            // ARR: the period. CCR1: CS rises. CCR2, CCR3: the writes.
            timer.arr().write(|w| w.bits(TICKS - 1));
            timer.ccr1().write(|w| w.bits(RISES));
            timer.ccr2().write(|w| w.bits(WRITES[0]));
            timer.ccr3().write(|w| w.bits(WRITES[1]));
            // CCMR1.OC1M 7: PWM mode 2, low until CCR1, high after it. CCER.CC1E and BDTR.MOE: output to the pin.
            timer.ccmr1_output().write(|w| w.oc1m().bits(0b111));
            timer.ccer().write(|w| w.cc1e().set_bit());
            timer.bdtr().write(|w| w.moe().set_bit());
            // CCMR1.OC2M 6: PWM mode 1, high until CCR2. CR2.MMS 5: that is TIM1's TRGO, which rises where CS falls. The update would rise
            // there too, but perhaps for a single cycle of TIM1, half of one of TIM2.
            timer.ccmr1_output().modify(|_, w| w.oc2m().bits(0b110));
            timer.cr2().write(|w| w.mms().bits(0b101));
        }
    }

    /// Waits for the idle time between two frames.
    fn wait(&self) {
        wait_for(QUIET, TICKS, || self.timer.cnt().read().bits());
    }
}

impl Converter for SpiAdc {
    const RATE: () = {
        assert!(
            APB2_TIMERS.is_multiple_of(SAMPLE_RATE),
            "SAMPLE_RATE must divide 168_000_000, TIM1's clock: 80_000, 96_000, 100_000, 112_000, 120_000, 125_000, 150_000"
        );
        assert!(
            TICKS <= 1 << 16,
            "SAMPLE_RATE must be 2600 or more: TIM1 has 16 bits"
        );
        assert!(
            QUIET[0] + 84 < QUIET[1],
            "SAMPLE_RATE must be 168_000 or less: a frame takes 3.8 us"
        );
        match ad7380::timing::min_sclk_hz(SAMPLE_RATE, ad7380::Oversampling::Off) {
            Some(least) => assert!(SCLK > least, "SAMPLE_RATE is too high for SCLK"),
            None => panic!("SAMPLE_RATE is beyond the AD7380"),
        }
    };
    const RAILS: [i16; 2] = AD7380_RAILS;

    fn stop(&mut self) {
        // Between frames, so that the next one begins with A. DIER 0: no writes. CR2.RXDMAEN 0: no fetches.
        self.wait();
        self.timer
            .dier()
            .modify(|_, w| w.cc2de().clear_bit().cc3de().clear_bit());
        self.spi.cr2().modify(|_, w| w.rxdmaen().clear_bit());
    }

    fn arm(&mut self) {
        self.wait();
        // Reading DR and then SR empties the buffer and clears SR.OVR.
        for _ in 0..2 {
            let _ = self.spi.dr().read();
            let _ = self.spi.sr().read();
        }
        self.spi.cr2().modify(|_, w| w.rxdmaen().set_bit());
        // SR 0: clears compare events of past frames, which would otherwise request their writes now.
        self.timer.sr().reset();
        self.timer
            .dier()
            .modify(|_, w| w.cc2de().set_bit().cc3de().set_bit());
    }

    #[inline]
    fn has_overrun(&self) -> bool {
        self.spi.sr().read().ovr().bit_is_set()
    }

    #[inline]
    fn is_at_rail(pair: Packed) -> bool {
        is_at_rail_16(pair)
    }
}

/// The chip on its bus by software, for its configuration.
struct Device<'a> {
    spi: &'a SPI1,
    cs: &'a mut PA8<Output>,
}

impl Device<'_> {
    fn exchange(&mut self, byte: u8) -> Result<u8, ErrorKind> {
        // DR allows only accesses of its own width; with DFF 0 the upper half is ignored.
        self.spi.dr().write(|w| w.dr().set(u16::from(byte)));
        // SR.RXNE: a byte has come back. That takes 130 cycles; a dead bus must not hang the start.
        if (0..CORE / 1_000_000).any(|_| self.spi.sr().read().rxne().bit_is_set()) {
            Ok(self.spi.dr().read().dr().bits() as u8)
        } else {
            Err(ErrorKind::Other)
        }
    }
}

impl ErrorType for Device<'_> {
    type Error = ErrorKind;
}

impl SpiDevice for Device<'_> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        self.cs.set_low();
        let run = || {
            for operation in operations {
                match operation {
                    Operation::Read(bytes) => {
                        for byte in bytes.iter_mut() {
                            *byte = self.exchange(0)?;
                        }
                    }
                    Operation::Write(bytes) => {
                        for &byte in bytes.iter() {
                            self.exchange(byte)?;
                        }
                    }
                    Operation::TransferInPlace(bytes) => {
                        for byte in bytes.iter_mut() {
                            *byte = self.exchange(*byte)?;
                        }
                    }
                    Operation::Transfer(read, write) => {
                        for i in 0..read.len().max(write.len()) {
                            let got = self.exchange(write.get(i).copied().unwrap_or(0))?;
                            if let Some(byte) = read.get_mut(i) {
                                *byte = got;
                            }
                        }
                    }
                    Operation::DelayNs(ns) => Delay.delay_ns(*ns),
                }
            }
            Ok(())
        };
        let result = run();
        // SR.BSY: the last byte has arrived half a clock before the end of its frame.
        let _ = (0..CORE / 1_000_000).any(|_| self.spi.sr().read().bsy().bit_is_clear());
        self.cs.set_high();
        // CS must be high for at least 10 ns.
        cortex_m::asm::delay(8);
        result
    }
}

/// Waits by counting cycles.
struct Delay;

impl DelayNs for Delay {
    fn delay_ns(&mut self, ns: u32) {
        let cycles = u64::from(ns) * u64::from(CORE / 1_000_000) / 1000;
        cortex_m::asm::delay((cycles as u32).saturating_add(1));
    }
}
