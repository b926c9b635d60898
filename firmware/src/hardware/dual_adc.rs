//! Both pick-offs at the chip's own converters: S_C on PA1 at ADC1, S_D on PA2 at ADC2, sampled at the same instant.
//!
//! Registers by their names in RM0090, chapter 13. TIM3's update is the trigger: in dual regular simultaneous mode ADC1's trigger
//! starts ADC2 as well, and both results leave as one word of the common data register.
//!
//! # Skew
//!
//! Both sample-and-holds open at the same edge of the converters' clock. The remaining skew is the mismatch of two apertures on one chip,
//! well below a nanosecond, and the greater one of the two anti-alias filters: two RC filters of 100 kHz with time constants that differ by
//! 2 % delay a 5 kHz wave by 1.6 µs ± 16 ns each, and 32 ns are 1 mrad of its phase. [`Calibration::skew`](antinode::Calibration) corrects
//! it; it can be measured with a wave of known angle, or with the same signal at both inputs.

use antinode::Packed;
use stm32f4xx_hal::gpio::{Analog, PA1, PA2};
use stm32f4xx_hal::pac::{ADC_COMMON, ADC1, ADC2, DMA2, RCC, TIM2, TIM3};

use crate::clocks::{APB1_TIMERS, APB2};
use crate::hardware::clock;
use crate::hardware::pair_clock::{Tim2, Trigger};
use crate::hardware::ring::{Memory, Origin, Stream};
use crate::sampler::{Converter, Sampler, wait_for};
use crate::sampling::{DUAL_ADC_RAILS, is_at_rail_12};
use crate::settings::SAMPLE_RATE;

/// Ticks of TIM3 from trigger to trigger.
const TICKS: u32 = APB1_TIMERS / SAMPLE_RATE;
/// The converters' clock, Hz: at most 36 MHz.
const ADC_CLOCK: u32 = APB2 / 4;
/// Ticks of TIM3 in a cycle of the converters' clock. A trigger within a cycle takes effect at the next one.
const ADC_TICKS: u32 = APB1_TIMERS / ADC_CLOCK;
/// Ticks of a conversion: 84 cycles of sampling, ample for a source of 10 kΩ, for which the accuracy is specified, and 12 for the 12 bits.
const CONVERSION: u32 = (84 + 12) * ADC_TICKS;
/// Idle time in ticks after a trigger: the conversion has ended, and the next trigger is at least a microsecond away.
const QUIET: [u32; 2] = [CONVERSION + 40, TICKS.saturating_sub(84)];

/// The two converters and their trigger.
pub struct DualAdc {
    first: ADC1,
    second: ADC2,
    common: ADC_COMMON,
    timer: TIM3,
}

/// The pins, as inputs to the converters.
pub type Pins = (PA1<Analog>, PA2<Analog>);

impl DualAdc {
    /// Starts sampling into `memory`.
    // `inline`, so that it is compiled only in images that call it.
    #[inline]
    pub fn start(
        (first, second, common): (ADC1, ADC2, ADC_COMMON),
        (timer, counter): (TIM3, TIM2),
        (dma, memory): (DMA2, &'static mut Memory),
        _: Pins,
        rcc: &RCC,
    ) -> Sampler<Self, Stream, Tim2> {
        // AHB1ENR, APB1ENR, APB2ENR: clocks of the DMA, the timer and the converters.
        rcc.ahb1enr().modify(|_, w| w.dma2en().set_bit());
        rcc.apb1enr().modify(|_, w| w.tim3en().set_bit());
        rcc.apb2enr()
            .modify(|_, w| w.adc1en().set_bit().adc2en().set_bit());
        clock::settle();
        let register = common.cdr().as_ptr() as u32;
        let adc = Self {
            first,
            second,
            common,
            timer,
        };
        // ARR: the period. CR2.MMS 2: the update is TIM3's TRGO.
        #[allow(unsafe_code, reason = "the fields take any bits")]
        // SAFETY: each value is one that RM0090 lists for its field.
        unsafe {
            adc.timer.arr().write(|w| w.bits(TICKS - 1));
            adc.timer.cr2().write(|w| w.mms().bits(0b010));
        }
        let clock = Tim2::new(counter, rcc, Trigger::Tim3);
        // CR1.CEN: the triggers begin.
        adc.timer.cr1().write(|w| w.cen().set_bit());
        let origin = Origin {
            register,
            channel: 0,
            by_halves: false,
        };
        Sampler::new(adc, Stream::new(dma, memory, origin), clock)
    }

    /// Sets up both converters, which must be in the state after a reset.
    #[allow(unsafe_code, reason = "the fields take any bits")]
    fn configure(&self) {
        // SAFETY: each value is one that RM0090 lists for its field.
        unsafe {
            // CCR.ADCPRE 1: APB2 over 4. Between two triggers, as the clock must not change while triggers arrive (RM0090, 18.3.15).
            // MULTI 0: independent while they are set up.
            self.wait();
            self.common.ccr().write(|w| w.adcpre().bits(0b01));
            // CR2.ADON: on, and three microseconds to settle. EOCS: without it or CR2.DMA an overrun raises no flag; ST's example
            // ADC_DualModeInterleaved for the STM32F407 also sets it in both.
            for control in [self.first.cr2(), self.second.cr2()] {
                control.write(|w| w.adon().set_bit().eocs().set_bit());
            }
            cortex_m::asm::delay(3 * 168);
            // SMPR2.SMP 4: 84 cycles, the same for both as the mode demands. SQR3.SQ1: the one channel; SQR1.L 0: no other.
            self.first.smpr2().modify(|_, w| w.smp1().bits(0b100));
            self.second.smpr2().modify(|_, w| w.smp2().bits(0b100));
            self.first.sqr3().write(|w| w.sq1().bits(1));
            self.second.sqr3().write(|w| w.sq1().bits(2));
            // CR1.OVRIE: an interrupt if a result is not fetched before the next one.
            self.first.cr1().write(|w| w.ovrie().set_bit());
            self.second.cr1().write(|w| w.ovrie().set_bit());
        }
    }

    /// Waits for the idle time between two triggers.
    fn wait(&self) {
        wait_for(QUIET, TICKS, || self.timer.cnt().read().bits());
    }
}

impl Converter for DualAdc {
    const RATE: () = {
        assert!(
            ADC_CLOCK.is_multiple_of(SAMPLE_RATE),
            "SAMPLE_RATE must divide 21_000_000, the converters' clock, lest samples jitter: 75_000, 84_000, 100_000, 120_000, 125_000, 150_000"
        );
        assert!(
            TICKS <= 1 << 16,
            "SAMPLE_RATE must be 1300 or more: TIM3 has 16 bits"
        );
        assert!(
            QUIET[0] + 40 < QUIET[1],
            "SAMPLE_RATE must be 150_000 or less: a conversion takes 4.6 us"
        );
    };
    const RAILS: [i16; 2] = DUAL_ADC_RAILS;

    #[allow(unsafe_code, reason = "the reset belongs to all converters")]
    fn stop(&mut self) {
        // Between two triggers, as in `configure`.
        self.wait();
        // SAFETY: after the start nothing else uses this register.
        let reset = unsafe { RCC::steal() };
        // APB2RSTR.ADCRST: puts both converters and their common part into the initial state, whatever theirs is. After an overrun,
        // requests stay blocked and triggers ignored until DMA and converters are set up again (RM0090, 13.8.1 and 13.9).
        reset.apb2rstr().modify(|_, w| w.adcrst().set_bit());
        reset.apb2rstr().modify(|_, w| w.adcrst().clear_bit());
        clock::settle();
    }

    #[allow(unsafe_code, reason = "the fields take any bits")]
    fn arm(&mut self) {
        self.configure();
        self.wait();
        // SAFETY: each value is one that RM0090 lists for its field.
        unsafe {
            // CCR.MULTI 6: regular simultaneous mode. DMA 2: one word a pair, ADC2 in its upper half. DDS: requests continue after the
            // DMA's last transfer, as it is circular (RM0090, 13.13.16).
            self.common
                .ccr()
                .modify(|_, w| w.multi().bits(0b00110).dma().bits(0b10).dds().set_bit());
            // CR2.EXTSEL 8: TIM3's TRGO. EXTEN 1: its rising edge. ADC2 has no trigger of its own: ADC1 starts it (RM0090, 13.9).
            self.first
                .cr2()
                .modify(|_, w| w.extsel().bits(0b1000).exten().bits(0b01));
        }
    }

    #[inline]
    fn has_overrun(&self) -> bool {
        // CSR.OVR1, OVR2: the flags of both converters.
        let status = self.common.csr().read();
        status.ovr1().bit_is_set() || status.ovr2().bit_is_set()
    }

    #[inline]
    fn is_at_rail(pair: Packed) -> bool {
        is_at_rail_12(pair)
    }
}
