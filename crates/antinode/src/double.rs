//! f64 at the interface: whole numbers times a unit, and what makes units. On a core without f64 its arithmetic is 2.5 KB of code, and
//! this a tenth of it.
//!
//! Units and numbers here are positive and within 10⁻³⁰ to 10³⁰, so there is no rounding to nothing, no infinity and nothing that is no number.

/// The bits of one.
const ONE: i64 = 0x3ff0_0000_0000_0000;
/// By how much the exponents of f64 and f32 differ, and their fractions.
const EXPONENT: u64 = (1023 - 127) << 23;
const FRACTION: u32 = 29;

/// So many units, to within a unit of the last place.
#[inline(never)]
pub(crate) fn units(count: i64, unit: f64) -> f64 {
    let size = count.unsigned_abs();
    if size == 0 {
        return 0.0;
    }
    let bits = unit.to_bits();
    let shift = size.leading_zeros();
    let (a, b) = (size << shift, (bits << 11) | (1 << 63));
    // The upper half of the product: of what is left out, less than three of its units.
    let halves = |x: u64| [x & 0xffff_ffff, x >> 32];
    let ([a_low, a_high], [b_low, b_high]) = (halves(a), halves(b));
    let product = a_high * b_high + ((a_high * b_low) >> 32) + ((a_low * b_high) >> 32);
    // Both begin with a one: their product does, or at its second bit.
    let (fraction, lead) = if product >> 63 == 1 {
        (product, 0)
    } else {
        (product << 1, 1)
    };
    // Rounding may carry into the exponent, as it should; the leading one is taken off it.
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
    let half = 1 << (FRACTION - 1);
    f32::from_bits((((x.to_bits() + half) >> FRACTION) - EXPONENT) as u32)
}

/// One over a number, to within two units of the last place.
pub(crate) fn reciprocal(x: f64) -> f64 {
    let rough = u64::from((1.0 / to_single(x)).to_bits()) + EXPONENT;
    let newton = |rough: f64| {
        // Two less the product, which is so near one that its bits count what it is beyond: in halves below one.
        let beyond = product(x, rough).to_bits() as i64 - ONE;
        let less = if beyond > 0 { 2 * beyond } else { beyond >> 1 };
        product(rough, f64::from_bits((ONE - less) as u64))
    };
    newton(newton(f64::from_bits(rough << FRACTION)))
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
    fn as_with_the_arithmetic_of_f64() {
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
