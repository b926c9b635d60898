//! Numbers printed to their meaningful digits: for reading, to two digits of the standard deviation, in fixed notation unless they are
//! small.

/// Most decimals shown: further ones are below any standard deviation that single precision leaves.
const MAX_DECIMALS: f64 = 9.0;
/// The same for values known in double precision.
const MAX_DECIMALS_OF_DOUBLE: f64 = 17.0;
/// Significant decimal digits of double precision.
const DIGITS_OF_DOUBLE: usize = 16;
/// Standard deviations below this show fewer than two digits in [`MAX_DECIMALS`] decimals.
const MIN_FIXED_STD: f64 = 1e-8;
/// Values from this on show enough digits in [`MAX_DECIMALS`] decimals, whatever their standard deviation.
const MIN_FIXED_VALUE: f64 = 1e-3;

/// A count of what a noun names, such as 1 row or 2 rows.
pub fn counted(count: u64, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// A number rounded to `digits` significant digits, 1 or more.
pub fn significant(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

/// A number rounded to `digits` significant digits, or to more if it takes more to show two digits of its standard deviation, up to
/// those of double precision.
pub fn significant_or_known(x: f64, digits: usize, std: f64) -> f64 {
    // −∞ for a value of 0, which becomes 0 digits.
    let known = exponent(x) - exponent(std) + 2.0;
    let known = if std > 0.0 { known as usize } else { digits };
    significant(x, known.clamp(digits, DIGITS_OF_DOUBLE))
}

/// The decimal exponent of a number: 0 from 1 to below 10.
pub fn exponent(x: f64) -> f64 {
    x.abs().log10().floor()
}

/// The number of decimals that shows two digits of a standard deviation; 6 if it is unknown or 0.
pub fn decimals(std: f64) -> usize {
    decimals_up_to(MAX_DECIMALS, std)
}

fn decimals_up_to(max: f64, std: f64) -> usize {
    if std > 0.0 && std.is_finite() {
        (1.0 - std.log10()).ceil().clamp(0.0, max) as usize
    } else {
        6
    }
}

/// The number of decimals, 6 or more, that tells samples of this rate, Hz, apart by their times.
pub fn decimals_of_times(rate: f64) -> usize {
    rate.log10().ceil().clamp(6.0, 12.0) as usize
}

/// A time or a length in s, to 4 decimals, or to more if it takes more to show two digits of a `whole`.
pub fn seconds(time: f64, whole: f64) -> String {
    let decimals = (1.0 - exponent(whole)).clamp(4.0, 12.0) as usize;
    fixed(decimals, time)
}

/// A number in fixed notation, without a sign if it rounds to zero.
pub fn fixed(decimals: usize, x: f64) -> String {
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(zeros) if zeros.bytes().all(|byte| b"0.".contains(&byte)) => zeros.to_owned(),
        _ => text,
    }
}

/// A value and its standard deviation, aligned at the ± between them.
pub fn with_std(value: f64, std: f64) -> String {
    with_std_up_to(MAX_DECIMALS, value, std)
}

/// [`with_std`] for a value that is known beyond single precision.
pub fn with_small_std(value: f64, std: f64) -> String {
    with_std_up_to(MAX_DECIMALS_OF_DOUBLE, value, std)
}

fn with_std_up_to(max: f64, value: f64, std: f64) -> String {
    if is_small(value, std) {
        format!(
            "{:>9} ±{:<7}",
            exponential(value, std),
            format!("{std:.1e}")
        )
    } else {
        with_std_to(decimals_up_to(max, std), value, std)
    }
}

/// Whether fixed notation would show hardly more than zeros of a value with this standard deviation.
fn is_small(value: f64, std: f64) -> bool {
    std > 0.0 && std < MIN_FIXED_STD && value.abs() < MIN_FIXED_VALUE
}

/// A value in exponential notation, to two digits of its standard deviation.
fn exponential(value: f64, std: f64) -> String {
    // At least one digit, also for a value of zero.
    let decimals = (exponent(value) - exponent(std) + 1.0).max(0.0) as usize;
    format!("{value:.decimals$e}")
}

/// [`with_std`] with a given number of decimals.
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

/// A value to be printed below one of [`with_std`], and its difference from that one in standard deviations.
pub fn with_sigmas(value: f64, std: f64, sigmas: f64) -> String {
    let value = if is_small(value, std) {
        exponential(value, std)
    } else {
        fixed(decimals(std), value)
    };
    let digits = usize::from(sigmas.abs() < 99.95);
    // Of a difference too wide for the column only the order of magnitude is shown.
    let sigmas = if sigmas.abs() < 9999.5 {
        format!("{sigmas:+.digits$}σ")
    } else {
        format!("{sigmas:+.0e}σ")
    };
    format!("{value:>9} {sigmas:<8}")
}

/// A value without a standard deviation, aligned with those of [`with_std_to`].
pub fn without_std(decimals: usize, value: f64) -> String {
    format!("{:>9}{:9}", fixed(decimals, value), "")
}

/// The heading of a column of [`with_std`], right-aligned to its width.
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
        // Fixed notation shows enough digits of the value or of the deviation.
        assert_eq!(with_std(0.001, 2e-9), "0.001000000 ±0.000000002");
        assert_eq!(with_std(2e-5, 1e-8), "0.000020000 ±0.000000010");
        assert_eq!(with_std(-0.5, 2e-9), "-0.500000000 ±0.000000002");
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
    fn values_that_round_to_zero_have_no_sign() {
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
    fn times_have_the_digits_that_a_rate_or_a_length_needs() {
        for (rate, decimals) in [
            (1.0, 6),
            (1e5, 6),
            (1e6, 6),
            (2e6, 7),
            (2e9, 10),
            (1e12, 12),
        ] {
            assert_eq!(decimals_of_times(rate), decimals, "{rate}");
        }
        for (time, whole, text) in [
            (0.5, 0.5, "0.5000"),
            (0.5, 0.0, "0.500000000000"),
            (1e-3, 1e-3, "0.0010"),
            (4.2e-7, 4.2e-7, "0.00000042"),
            (1e-8, 4.2e-7, "0.00000001"),
            (1234.5, 1e4, "1234.5000"),
        ] {
            assert_eq!(seconds(time, whole), text);
        }
    }

    #[test]
    fn the_truth_stands_under_its_estimate() {
        assert_eq!(without_std(5, 0.499_96), "  0.49996         ");
    }
}
