//! Functions of complex numbers by `libm`: those of [`Complex`] itself use the standard library, which differs between platforms.

use libm::{atan2, fabs, hypot, sincos, sqrt};

pub(crate) type Complex = nalgebra::Complex<f64>;

pub(crate) fn polar(size: f64, angle: f64) -> Complex {
    let (sin, cos) = sincos(angle);
    Complex::new(size * cos, size * sin)
}

pub(crate) fn size(z: Complex) -> f64 {
    hypot(z.re, z.im)
}

/// The argument, -pi to pi; 0 for z = 0.
pub(crate) fn angle(z: Complex) -> f64 {
    atan2(z.im, z.re)
}

/// The square root with a real part of 0 or more; for a negative number it is exactly 0.
pub(crate) fn root(z: Complex) -> Complex {
    // First the larger part, which is not a difference of nearly equal numbers.
    let large = sqrt(0.5 * (size(z) + fabs(z.re)));
    if large == 0.0 {
        return Complex::new(0.0, 0.0);
    }
    let small = 0.5 * z.im / large;
    if z.re >= 0.0 {
        Complex::new(large, small)
    } else {
        Complex::new(fabs(small), libm::copysign(large, z.im))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_of_roots_are_the_numbers() {
        for (re, im) in [
            (3.0, 4.0),
            (-3.0, 4.0),
            (-3.0, -4.0),
            (1.0, -1e-12),
            (-1.0, 1e-12),
            (0.0, 2.0),
            (0.0, 0.0),
        ] {
            let z = Complex::new(re, im);
            let root = root(z);
            assert!(size(root * root - z) <= 4e-16 * size(z), "{z}: {root}");
            assert!(root.re >= 0.0, "{z}: {root}");
        }
        assert_eq!(root(Complex::new(-4.0, 0.0)), Complex::new(0.0, 2.0));
    }
}
