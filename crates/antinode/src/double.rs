//! f64 at the interface, with multiplication as its only arithmetic: sums are made of whole numbers before. On a core without f64
//! its addition and its conversions are 1.5 KB of code.

/// The bits of one.
const ONE: i64 = 0x3ff0_0000_0000_0000;
/// By how much the exponents of f64 and f32 differ, and their fractions.
const EXPONENT: u64 = (1023 - 127) << 23;
const FRACTION: u32 = 29;

/// So many units.
#[inline(never)]
pub(crate) fn units(count: i64, unit: f64) -> f64 {
    let unit = if count < 0 { -unit } else { unit };
    count.unsigned_abs() as f64 * unit
}

/// The nearest f32 of a number within 10⁻³⁰ to 10³⁰.
pub(crate) fn to_single(x: f64) -> f32 {
    let half = 1 << (FRACTION - 1);
    f32::from_bits((((x.to_bits() + half) >> FRACTION) - EXPONENT) as u32)
}

/// One over a number within 10⁻³⁰ to 10³⁰, to within two units of the last place.
pub(crate) fn reciprocal(x: f64) -> f64 {
    let rough = u64::from((1.0 / to_single(x)).to_bits()) + EXPONENT;
    let newton = |rough: f64| {
        // Two less the product, which is so near one that its bits count what it is beyond: in halves below one.
        let beyond = (x * rough).to_bits() as i64 - ONE;
        let less = if beyond > 0 { 2 * beyond } else { beyond >> 1 };
        rough * f64::from_bits((ONE - less) as u64)
    };
    newton(newton(f64::from_bits(rough << FRACTION)))
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
            let x = f64::from_bits(exponent << 52 | seed >> 12);
            assert_eq!(to_single(x).to_bits(), (x as f32).to_bits(), "{x}");
            let apart = (reciprocal(x) * x - 1.0).abs();
            assert!(apart < 5e-16, "{x}: {apart}");
            let count = seed as i64 >> (i % 64);
            assert_eq!(units(count, x).to_bits(), (count as f64 * x).to_bits());
        }
        assert_eq!(reciprocal(1e5), 1e-5);
        assert_eq!(units(0, 1.0), 0.0);
    }
}
