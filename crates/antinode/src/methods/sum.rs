//! A running sum that keeps what rounding takes.

/// A compensated f32 sum (Kahan): four additions a term.
///
/// Its error is below 2⁻²³ of the mean |term| a term and does not grow with the count, where a plain f32 sum of n terms loses
/// n·2⁻²⁴ of itself. It overflows where a plain sum would: beyond 3·10³⁸.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sum {
    total: f32,
    /// What `total` has beyond the true sum.
    excess: f32,
}

impl Sum {
    #[inline(always)]
    pub(super) fn add(&mut self, term: f32) {
        let term = term - self.excess;
        let total = self.total + term;
        self.excess = (total - self.total) - term;
        self.total = total;
    }

    pub(super) fn value(self) -> f64 {
        f64::from(self.total) - f64::from(self.excess)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_sums_keep_their_digits() {
        let (mut sum, mut plain, mut truth) = (Sum::default(), 0f32, 0f64);
        for k in 0..1_000_000u32 {
            let term = 1.0 + (k % 97) as f32 * 0.013;
            sum.add(term);
            plain += term;
            truth += f64::from(term);
        }
        assert!((sum.value() / truth - 1.0).abs() < 1e-9);
        assert!((f64::from(plain) / truth - 1.0).abs() > 1e-5);
    }
}
