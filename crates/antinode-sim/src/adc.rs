//! The quantiser of the converter.

use crate::flaws::Flaws;

/// A mid-tread converter: rounds to the nearest code, and saturates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Adc {
    lsb: f64,
    lowest: f64,
    highest: f64,
}

impl Adc {
    pub fn new(flaws: &Flaws) -> Option<Adc> {
        let (bits, lsb) = (flaws.bits?, flaws.lsb()?);
        let half = libm::exp2(f64::from(bits) - 1.0);
        Some(Adc {
            lsb,
            lowest: -half,
            highest: half - 1.0,
        })
    }

    pub fn code(&self, value: f64) -> i32 {
        self.nearest(value) as i32
    }

    pub fn value(&self, value: f64) -> f64 {
        self.nearest(value) * self.lsb
    }

    fn nearest(&self, value: f64) -> f64 {
        (value / self.lsb)
            .round_ties_even()
            .max(self.lowest)
            .min(self.highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adc(bits: u32, full_scale: f64) -> Adc {
        Adc::new(&Flaws {
            bits: Some(bits),
            full_scale,
            ..Flaws::default()
        })
        .unwrap()
    }

    #[test]
    fn values_at_full_scale_and_beyond_give_the_last_codes() {
        for bits in 2..=32 {
            let adc = adc(bits, 2.5);
            let (low, high) = (-(1i64 << (bits - 1)), (1i64 << (bits - 1)) - 1);
            assert_eq!(i64::from(adc.code(2.5)), high, "{bits}");
            assert_eq!(i64::from(adc.code(-2.5)), low, "{bits}");
            assert_eq!(i64::from(adc.code(1e300)), high, "{bits}");
            assert_eq!(i64::from(adc.code(f64::NEG_INFINITY)), low, "{bits}");
            assert_eq!(adc.value(-9.0), -2.5);
            assert_eq!(adc.value(9.0), 2.5 - 2.5 / (1i64 << (bits - 1)) as f64);
        }
    }

    #[test]
    fn a_value_gives_its_nearest_code_and_that_codes_value() {
        let adc = adc(12, 2.048);
        for code in -2048..2048 {
            let value = f64::from(code) * 0.001;
            assert_eq!(adc.code(value + 0.000_49), code);
            assert_eq!(adc.code(value - 0.000_49), code);
            assert!((adc.value(value + 0.000_3) - value).abs() < 1e-15);
        }
    }
}
