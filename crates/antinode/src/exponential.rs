//! The exponential function, and e^x − 1 to the last digit near zero, as the courses of waves need it.

use num_complex::Complex32;

use crate::scalar::{greater, lesser};

/// One over the factorials of 8 down to 2.
const FACTORIALS: [f32; 7] = [
    1.0 / 40_320.0,
    1.0 / 5040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    1.0 / 2.0,
];

/// e^x − 1: within 1.2·10⁻⁷ for |x| up to 0.5, 4·10⁻⁶ up to 1, and 7·10⁻⁵ up to 1.4, which no course exceeds.
#[inline(never)]
pub(crate) fn growth(x: Complex32) -> Complex32 {
    // Horner's scheme for real factors, without products of complex numbers.
    let (doubled, square) = (2.0 * x.re, x.norm_sqr());
    let next = |(a, b): (f32, f32), &factor: &f32| (factor + doubled * a - square * b, a);
    // Three terms leave 3·10⁻⁹ here.
    let (a, b) = if square < 0.05 * 0.05 {
        FACTORIALS[4..].iter().fold((0.0, 0.0), next)
    } else {
        FACTORIALS.iter().fold((0.0, 0.0), next)
    };
    Complex32::new(1.0 + x.re * a - square * b, x.im * a) * x
}

/// e^x for x from −20 to 20, and beyond the value at the nearer end, with a relative error below 10⁻⁵.
pub(crate) fn exponential(x: f32) -> f32 {
    let part = lesser(greater(x, -20.0), 20.0) * (1.0 / 64.0);
    // Terms up to the sixth power leave a relative error of 6·10⁻⁸ before the power of 64.
    let next = |sum: f32, factor: &f32| sum * part + factor;
    let mut power = FACTORIALS[2..].iter().fold(0.0, next);
    power = (power * part + 1.0) * part + 1.0;
    for _ in 0..6 {
        power *= power;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_as_exact_as_stated() {
        let apart = |size: f64, turn: f64| {
            let x = [size * turn.cos(), size * turn.sin()].map(|x| x as f32);
            let [re, im] = x.map(f64::from);
            let found = growth(Complex32::new(x[0], x[1]));
            let apart = [
                f64::from(found.re) - (re.exp() * im.cos() - 1.0),
                f64::from(found.im) - re.exp() * im.sin(),
            ];
            apart[0].hypot(apart[1])
        };
        for (most, stated) in [(0.5, 1.2e-7), (1.0, 4e-6), (1.4, 7e-5)] {
            let sizes = (0..=100).map(|i| most * f64::from(i) / 100.0);
            let all =
                sizes.flat_map(|size| (0..100).map(move |i| apart(size, 0.063 * f64::from(i))));
            let worst = all.fold(0.0, f64::max);
            assert!(worst < stated && worst > 0.5 * stated, "{most}: {worst}");
        }
    }

    #[test]
    fn the_exponential_is_that_of_the_library() {
        for i in -2000..=2000 {
            let x = 0.01 * i as f32;
            let apart = exponential(x) / libm::expf(x) - 1.0;
            assert!(apart.abs() < 1e-5, "{x}: {apart}");
        }
        assert_eq!(exponential(0.0), 1.0);
        assert_eq!(exponential(-1e9), exponential(-20.0));
        assert_eq!(exponential(f32::INFINITY), exponential(20.0));
    }
}
