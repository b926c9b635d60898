//! Numbers of an axis: limits of what can be drawn, factors, and how they are printed.

use crate::digits::fixed;

/// Magnitude from which on numbers cannot be drawn, and up to which they are drawn as 0.
const TOO_LARGE: f64 = 1e290;
const TOO_SMALL: f64 = 1e-280;

/// A number as an axis can hold it: `None` if it is too large, and 0 if it is too small, for steps along the axis.
pub fn drawable(number: f64) -> Option<f64> {
    let size = number.abs();
    (size < TOO_LARGE).then_some(if size > TOO_SMALL { number } else { 0.0 })
}

/// The decimals that steps of this size need.
pub fn decimals(step: f64) -> usize {
    // A step of 0.2 needs one, and so does one that is slightly less by rounding.
    (-(step * 1.000_001).log10().floor()).clamp(0.0, 15.0) as usize
}

/// A number with this many decimals, and a minus as wide as a digit.
pub fn printed(number: f64, decimals: usize) -> String {
    fixed(decimals, number).replace('-', "−")
}

/// The factor with which numbers of this magnitude need few digits, and its text for a title.
pub fn factor(size: f64) -> (f64, String) {
    if size == 0.0 || (1e-3..1e6).contains(&size) {
        return (1.0, String::new());
    }
    let power = -3 * (size.log10() / 3.0).floor() as i32;
    // The font has no raised minus.
    let sign = if power > 0 { '×' } else { '÷' };
    let raised: String = power
        .unsigned_abs()
        .to_string()
        .bytes()
        .map(|digit| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][usize::from(digit - b'0')])
        .collect();
    (10f64.powi(power), format!(" {sign} 10{raised}"))
}

/// The unit of frequency in which a difference of this size is 1 to 1000, and how many of it make 1 Hz.
pub fn frequency_unit(size: f64) -> (&'static str, f64) {
    match size {
        1.0.. => ("Hz", 1.0),
        1e-3.. => ("mHz", 1e3),
        1e-6.. => ("µHz", 1e6),
        _ => ("nHz", 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_distinguish_them() {
        assert_eq!([20.0, 1.0, 0.5, 0.2, 0.01].map(decimals), [0, 0, 1, 1, 2]);
        assert_eq!(decimals(0.3 - 0.2), 1);
        assert_eq!(factor(0.05), (1.0, String::new()));
        assert_eq!(factor(4.2e-6).1, " × 10⁶");
        let (by, text) = factor(4.2e7);
        assert_eq!(text, " ÷ 10⁶");
        assert!((1e6 * by - 1.0).abs() < 1e-12);
        for (size, unit) in [(20.0, "Hz"), (0.02, "mHz"), (2e-5, "µHz"), (2e-8, "nHz")] {
            let (name, by) = frequency_unit(size);
            assert!(
                name == unit && (size * by - 20.0).abs() < 1e-9,
                "{name} {by}"
            );
        }
    }
}
