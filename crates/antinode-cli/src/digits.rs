//! Numbers to the digits that mean something: for reading, those that their deviation leaves, in fixed notation unless they are small.

/// Decimals beyond these are below any deviation that single precision leaves.
const MOST_DECIMALS: f64 = 9.0;
/// The same of double precision.
const MOST_OF_DOUBLE: f64 = 17.0;
/// Digits of a number that double precision has.
const DIGITS_OF_DOUBLE: usize = 16;
/// Deviations below this have fewer than two digits in as many decimals.
const LEAST_STD: f64 = 1e-8;
/// Values from this on show digits enough in as many decimals, whatever their deviation.
const LEAST_VALUE: f64 = 1e-3;

/// A number rounded to so many digits, 1 or more, whatever its size.
pub fn significant(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

/// A number rounded to so many digits, or to as many more as show two digits of its deviation, if double precision has them.
pub fn significant_or_known(x: f64, digits: usize, std: f64) -> f64 {
    // A number of 0 asks for none.
    let known = exponent(x) - exponent(std) + 2.0;
    let known = if std > 0.0 { known as usize } else { digits };
    significant(x, known.clamp(digits, DIGITS_OF_DOUBLE))
}

/// The place of a number's first digit: 0 of 1 to 9.
fn exponent(x: f64) -> f64 {
    x.abs().log10().floor()
}

/// The decimals that show two digits of a standard deviation.
pub fn decimals(std: f64) -> usize {
    decimals_up_to(MOST_DECIMALS, std)
}

fn decimals_up_to(most: f64, std: f64) -> usize {
    if std > 0.0 && std.is_finite() {
        (1.0 - std.log10()).ceil().clamp(0.0, most) as usize
    } else {
        6
    }
}

/// A number to so many decimals, without a sign where that leaves nothing but zeros.
pub fn fixed(decimals: usize, x: f64) -> String {
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(zeros) if zeros.bytes().all(|byte| b"0.".contains(&byte)) => zeros.to_owned(),
        _ => text,
    }
}

/// A value with its standard deviation, the value to the right and the deviation to the left of one place.
pub fn with_std(value: f64, std: f64) -> String {
    with_std_up_to(MOST_DECIMALS, value, std)
}

/// The same of a value that is known beyond single precision.
pub fn with_small_std(value: f64, std: f64) -> String {
    with_std_up_to(MOST_OF_DOUBLE, value, std)
}

fn with_std_up_to(most: f64, value: f64, std: f64) -> String {
    if is_small(value, std) {
        format!(
            "{:>9} ±{:<7}",
            exponential(value, std),
            format!("{std:.1e}")
        )
    } else {
        with_std_to(decimals_up_to(most, std), value, std)
    }
}

/// Whether fixed notation would leave a value with this deviation as little but zeros.
fn is_small(value: f64, std: f64) -> bool {
    std > 0.0 && std < LEAST_STD && value.abs() < LEAST_VALUE
}

/// A value with an exponent, to two digits of its deviation.
fn exponential(value: f64, std: f64) -> String {
    // One digit at the least, of zero too.
    let decimals = (exponent(value) - exponent(std) + 1.0).max(0.0) as usize;
    format!("{value:.decimals$e}")
}

/// [`with_std`] to so many decimals.
pub fn with_std_to(decimals: usize, value: f64, std: f64) -> String {
    if std > 0.0 && std.is_finite() {
        format!(
            "{:>9} ±{:<7}",
            fixed(decimals, value),
            format!("{std:.decimals$}")
        )
    } else {
        without_std(decimals, value)
    }
}

/// A value to stand under [`with_std`], and by how many deviations it differs from the one there.
pub fn with_sigmas(value: f64, std: f64, sigmas: f64) -> String {
    let value = if is_small(value, std) {
        exponential(value, std)
    } else {
        fixed(decimals(std), value)
    };
    let digits = usize::from(sigmas.abs() < 99.95);
    // Beyond what the column holds only the size matters.
    let sigmas = if sigmas.abs() < 9999.5 {
        format!("{sigmas:+.digits$}σ")
    } else {
        format!("{sigmas:+.0e}σ")
    };
    format!("{value:>9} {sigmas:<8}")
}

/// A value alone, to stand under [`with_std_to`].
pub fn without_std(decimals: usize, value: f64) -> String {
    format!("{:>9}{:9}", fixed(decimals, value), "")
}

/// The heading of a column of [`with_std`].
pub fn heading(name: &str) -> String {
    format!("{name:>18}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_kept_whatever_the_size() {
        for (x, rounded) in [
            (0.012_345_678_901_26, 0.012_345_678_901_3),
            (-5.0e7 / 3.0, -16_666_666.7),
        ] {
            let digits = if x > 0.0 { 12 } else { 9 };
            assert_eq!(significant(x, digits), rounded);
        }
        assert!(significant(f64::NAN, 9).is_nan());
    }

    #[test]
    fn digits_are_kept_as_far_as_a_number_is_known() {
        let third = 23_102.0 / 3.0;
        for (std, rounded) in [
            (3.0e-9, 7_700.666_666_666_7),
            (9.9e-9, 7_700.666_666_666_7),
            (1.1e-8, 7_700.666_666_667),
            (3.0e-7, 7_700.666_666_67),
            (0.0, 7_700.666_666_67),
            (f64::NAN, 7_700.666_666_67),
            (1e-20, 7_700.666_666_666_667),
        ] {
            assert_eq!(significant_or_known(third, 12, std), rounded, "{std}");
        }
        assert_eq!(significant_or_known(0.0, 12, 1e-9), 0.0);
    }

    #[test]
    fn two_digits_of_the_deviation_are_shown() {
        assert_eq!(with_std(0.500_412, 4.53e-4), "  0.50041 ±0.00045");
        assert_eq!(with_std(-5331.6715, 0.2695), " -5331.67 ±0.27   ");
        assert_eq!(with_std(1.0, 0.0101), "    1.000 ±0.010  ");
        assert_eq!(with_std(20_000.4, 321.0), "    20000 ±321    ");
    }

    #[test]
    fn small_values_have_an_exponent_in_the_same_places() {
        assert_eq!(with_std(5.0012e-10, 2.04e-12), "5.001e-10 ±2.0e-12");
        assert_eq!(with_std(-5e-10, 2e-11), "-5.00e-10 ±2.0e-11");
        assert_eq!(with_std(3e-13, 2e-12), "    3e-13 ±2.0e-12");
        assert_eq!(with_std(3e-15, 2e-12), "    3e-15 ±2.0e-12");
        assert_eq!(with_std(0.0, 2e-12), "      0e0 ±2.0e-12");
        assert_eq!(with_sigmas(5e-10, 2e-12, 7.83), "5.000e-10 +7.8σ   ");
        // Digits enough, of the value or the deviation.
        assert_eq!(with_std(0.001, 2e-9), "0.001000000 ±0.000000002");
        assert_eq!(with_std(2e-5, 1e-8), "0.000020000 ±0.000000010");
    }

    #[test]
    fn as_many_decimals_as_a_small_deviation_needs_are_shown() {
        assert_eq!(
            with_small_std(2.000_000_012e-3, 3.04e-10),
            "0.00200000001 ±0.00000000030"
        );
        assert_eq!(
            with_small_std(5332.0, 2.5e-12),
            "5332.0000000000000 ±0.0000000000025"
        );
        assert_eq!(with_small_std(-5e-10, 2e-11), "-5.00e-10 ±2.0e-11");
        assert_eq!(with_small_std(0.5, 0.0), " 0.500000         ");
    }

    #[test]
    fn what_rounds_to_zero_has_no_sign() {
        assert_eq!(with_std(-4e-5, 0.0101), "    0.000 ±0.010  ");
        assert_eq!(with_std(-0.0006, 0.0101), "   -0.001 ±0.010  ");
        assert_eq!(without_std(1, -0.04), "      0.0         ");
        assert_eq!(fixed(0, -0.3), "0");
    }

    #[test]
    fn a_difference_in_deviations_stands_under_the_deviation() {
        assert_eq!(with_sigmas(0.503_96, 4.5e-4, 7.83), "  0.50396 +7.8σ   ");
        assert_eq!(with_sigmas(-0.025, 4.5e-4, -112.4), " -0.02500 -112σ   ");
        assert_eq!(with_sigmas(0.5, 4.5e-7, 71_234.0), "0.50000000 +7e4σ   ");
    }

    #[test]
    fn a_value_without_deviation_stands_alone() {
        assert_eq!(with_std(0.5, f64::NAN), " 0.500000         ");
        assert_eq!(with_std(0.5, 0.0), " 0.500000         ");
    }

    #[test]
    fn the_truth_stands_under_its_estimate() {
        assert_eq!(without_std(5, 0.499_96), "  0.49996         ");
    }
}
