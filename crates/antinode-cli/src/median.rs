//! The median, which a few numbers far off all others do not move.

/// The median of numbers, the upper one of an even count; `None` without numbers. It changes their order.
pub fn median(numbers: &mut [f64]) -> Option<f64> {
    let middle = numbers.len() / 2;
    (!numbers.is_empty()).then(|| *numbers.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_upper_middle_of_the_sorted_numbers() {
        for (mut numbers, expected) in [
            (vec![], None),
            (vec![3.0], Some(3.0)),
            (vec![2.0, 1.0], Some(2.0)),
            (vec![9.0, -1.0, 4.0], Some(4.0)),
            (vec![f64::INFINITY, 1.0, 3.0, 2.0], Some(3.0)),
        ] {
            assert_eq!(median(&mut numbers), expected, "{numbers:?}");
        }
    }
}
