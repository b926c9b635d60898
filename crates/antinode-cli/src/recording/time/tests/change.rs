//! A sample rate that changes for good.

use super::*;

#[test]
fn a_rate_that_changes_is_not_taken_for_rounding() {
    for decimals in [5, 6] {
        // Hundreds of steps of one length, then of the other.
        let text = |counts: [usize; 2], lengths: [f64; 2]| -> Vec<String> {
            let steps = (0..2).flat_map(|part| vec![lengths[part]; 100 * counts[part]]);
            let mut sum = 0.0;
            let times = steps.map(|length| {
                sum += length;
                format!("{:.decimals$}", 1e-5 * sum)
            });
            times.collect()
        };
        // Twice as long: every other sample is lost.
        let (found, gaps) = axis(&text([3, 2], [1.0, 2.0]), HEAD).unwrap();
        assert_eq!(found.rate(), 1e5, "{decimals}");
        let expected: Gaps = (300..500).map(|index| (index, 1)).collect();
        assert_eq!(gaps, expected);
        for (counts, lengths, at, told) in [
            ([1, 4], [1.0, 4.0], 1, "1.0000e-5 s here, but by 4.0000e-5"),
            (
                [4, 1],
                [4.0, 1.0],
                400,
                "1.0000e-5 s here, but by 4.0000e-5",
            ),
        ] {
            let (index, fault) = run(&text(counts, lengths), HEAD).unwrap_err();
            assert!(
                index == at && fault.starts_with(&format!("time steps by {told} s elsewhere")),
                "{lengths:?}: {index}, {fault}"
            );
        }
    }
}
