//! TIM2 counts the sampling timer's triggers.

use stm32f4xx_hal::pac::{RCC, TIM2};

use crate::hardware::clock;
use crate::sampler::PairClock;

/// Timer that triggers the sampling, by its number as TIM2's internal trigger input (RM0090, 18.4.3).
#[derive(Debug, Clone, Copy)]
pub enum Trigger {
    /// ITR0.
    Tim1 = 0,
    /// ITR2.
    Tim3 = 2,
}

/// Wrapping 32-bit count of triggers.
pub struct Tim2(TIM2);

impl Tim2 {
    /// Starts counting.
    #[allow(unsafe_code, reason = "the fields take any bits")]
    pub fn new(timer: TIM2, rcc: &RCC, trigger: Trigger) -> Self {
        // APB1ENR.TIM2EN: clock on.
        rcc.apb1enr().modify(|_, w| w.tim2en().set_bit());
        clock::settle();
        // SAFETY: SMCR.TS is the trigger's number, and SMS 7 external clock mode 1: each trigger counts.
        timer
            .smcr()
            .write(|w| unsafe { w.ts().bits(trigger as u8).sms().bits(7) });
        // CR1.CEN: on. ARR is all ones after a reset.
        timer.cr1().write(|w| w.cen().set_bit());
        Self(timer)
    }
}

impl PairClock for Tim2 {
    #[inline]
    fn now(&self) -> u32 {
        self.0.cnt().read().bits()
    }
}
