//! The f64 arithmetic of the interface, in integers: whole numbers times a unit, and what makes units. On a core without f64 the compiler's
//! own is 2.5 KB of code, and this a tenth of that.
//!
//! Units and numbers here are positive and within 10⁻³⁰ to 10³⁰, so there is no underflow, no infinity and no NaN.

/// The bits of one.
const ONE: i64 = 0x3ff0_0000_0000_0000;
/// Difference of the exponent biases of f64 and f32, in the place of an f32's exponent.
const EXPONENT_DIFFERENCE: u64 = (1023 - 127) << 23;
/// Bits of an f64's fraction beyond those of an f32's.
const EXTRA_FRACTION_BITS: u32 = 29;

/// `count` times `unit`, to within a unit in the last place.
#[inline(never)]
pub(crate) fn units(count: i64, unit: f64) -> f64 {
    let size = count.unsigned_abs();
    if size == 0 {
        return 0.0;
    }
    let bits = unit.to_bits();
    let shift = size.leading_zeros();
    let (a, b) = (size << shift, (bits << 11) | (1 << 63));
    // The upper half of the product; what is left out is less than three of its units.
    let halves = |x: u64| [x & 0xffff_ffff, x >> 32];
    let ([a_low, a_high], [b_low, b_high]) = (halves(a), halves(b));
    let product = a_high * b_high + ((a_high * b_low) >> 32) + ((a_low * b_high) >> 32);
    // Both factors begin with a one, so the product begins with one in its first or second bit.
    let (fraction, lead) = if product >> 63 == 1 {
        (product, 0)
    } else {
        (product << 1, 1)
    };
    // Rounding may carry into the exponent, as it should. The leading one adds one to it, which `exponent` allows for.
    let rounded = (fraction >> 11) + ((fraction >> 10) & 1);
    let exponent = (bits >> 52) + 63 - u64::from(shift + lead);
    let sign = count as u64 & (1 << 63);
    f64::from_bits(((exponent << 52) + rounded) | sign)
}

/// A number times 2 to the power of `exponent`.
pub(crate) fn scaled(x: f64, exponent: i64) -> f64 {
    f64::from_bits(x.to_bits().wrapping_add((exponent << 52) as u64))
}

/// The nearest f32.
pub(crate) const fn to_single(x: f64) -> f32 {
    let half = 1 << (EXTRA_FRACTION_BITS - 1);
    f32::from_bits((((x.to_bits() + half) >> EXTRA_FRACTION_BITS) - EXPONENT_DIFFERENCE) as u32)
}

/// One over a number, to within two units in the last place.
pub(crate) fn reciprocal(x: f64) -> f64 {
    let rough = u64::from((1.0 / to_single(x)).to_bits()) + EXPONENT_DIFFERENCE;
    let newton = |rough: f64| {
        // 2 less the product, which is so near 1 that its bits count the excess; below 1 their unit is half as large.
        let excess = product(x, rough).to_bits() as i64 - ONE;
        let decrease = if excess > 0 { 2 * excess } else { excess >> 1 };
        product(rough, f64::from_bits((ONE - decrease) as u64))
    };
    newton(newton(f64::from_bits(rough << EXTRA_FRACTION_BITS)))
}

/// The product of two numbers.
fn product(x: f64, y: f64) -> f64 {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)) | (1 << 52);
    scaled(units(fraction as i64, y), (bits >> 52) as i64 - 1075)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_those_of_f64_arithmetic() {
        let mut seed = 1u64;
        for i in 0..100_000 {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            // 10⁻³ to 10¹², all bits of the fraction.
            let exponent = 1023 - 10 + i % 50;
            let x = f64::from_bits((exponent << 52) | (seed >> 12));
            assert_eq!(to_single(x).to_bits(), (x as f32).to_bits(), "{x}");
            let apart = (reciprocal(x) * x - 1.0).abs();
            assert!(apart < 5e-16, "{x}: {apart}");
            let count = seed as i64 >> (i % 64);
            let (found, exact) = (units(count, x), count as f64 * x);
            let apart = found.to_bits().abs_diff(exact.to_bits());
            assert!(apart <= 1, "{count} of {x}: {found} {exact}");
            assert_eq!(scaled(x, -64), x / 18_446_744_073_709_551_616.0);
        }
        assert_eq!(reciprocal(1e5), 1e-5);
        assert_eq!((units(0, 1.0), units(-3, 2.0)), (0.0, -6.0));
        // A fraction that rounds up to the next power of two.
        assert_eq!(units(i64::MAX, 1.0), 9_223_372_036_854_775_808.0);
    }
}
