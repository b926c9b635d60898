//! A running sum that makes up for rounding, for products of samples and for the response of a block to a wave.

/// A compensated f32 sum (Kahan): four additions a term.
///
/// Its error is below 2⁻²³ of the mean |term| a term and does not grow with the count, where a plain f32 sum of n terms loses
/// n·2⁻²⁴ of itself. It overflows where a plain sum would: beyond 3·10³⁸.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sum {
    total: f32,
    /// By how much `total` exceeds the true sum.
    excess: f32,
}

impl Sum {
    #[inline(always)]
    pub(crate) fn add(&mut self, term: f32) {
        let term = term - self.excess;
        let total = self.total + term;
        self.excess = (total - self.total) - term;
        self.total = total;
    }

    /// The sum with more digits than an f32 has.
    pub(crate) fn value(self) -> f64 {
        f64::from(self.total) - f64::from(self.excess)
    }

    /// The sum in f32, right to its last digit or two.
    pub(crate) fn get(self) -> f32 {
        self.total - self.excess
    }
}

/// Adds C², D² and C·D of a pair to three sums.
#[inline(always)]
pub(crate) fn add_products(sums: &mut [Sum; 3], [c, d]: [f32; 2]) {
    sums[0].add(c * c);
    sums[1].add(d * d);
    sums[2].add(c * d);
}

/// Adds C·C′ + D·D′ and C·D′ of a pair and one before it to two sums.
#[inline(always)]
pub(crate) fn add_delayed(sums: &mut [Sum; 2], [c, d]: [f32; 2], before: [f32; 2]) {
    sums[0].add(c * before[0] + d * before[1]);
    sums[1].add(c * before[1]);
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

    #[test]
    fn the_sums_of_a_block_are_right_to_their_last_digit() {
        for length in [5u32, 19, 94, 200] {
            let (mut sum, mut truth, mut size) = (Sum::default(), 0f64, 0f64);
            for k in 0..length {
                // Like a reference times a wave and the square of time: terms of both signs that nearly cancel.
                let term = (k as f32 * 0.335).cos() * (k as f32 - 0.5 * length as f32).powi(2);
                sum.add(term);
                truth += f64::from(term);
                size += f64::from(term).abs();
            }
            let error = (f64::from(sum.get()) - truth).abs();
            let rounding = 2f64.powi(-23) * truth.abs();
            assert!(
                error < rounding + 2f64.powi(-30) * size,
                "{length}: {error:e} of {truth}"
            );
        }
    }
}
