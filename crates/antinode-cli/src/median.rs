//! The median of numbers, which a few far off all others do not move, and their ends.

/// The median of numbers, the upper one of an even count; `None` without numbers. It changes their order.
pub fn median(numbers: &mut [f64]) -> Option<f64> {
    let middle = numbers.len() / 2;
    (!numbers.is_empty()).then(|| *numbers.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The smallest and the largest of numbers; infinity and minus infinity without numbers.
pub fn ends(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let numbers = numbers.into_iter();
    numbers.fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[least, most], number| [least.min(number), most.max(number)],
    )
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
