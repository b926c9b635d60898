//! `same_rows ours.csv theirs.csv`: checks whether two tables hold the same numbers, to the last bit of their precision.

use std::process::ExitCode;

/// Indices of the columns in double precision, time, angle and frequency, and the last decimal that is printed: a value halfway between two
/// is rounded either way.
const DOUBLE: [(usize, f64); 3] = [(0, 1e-12), (4, 1e-9), (6, 1e-9)];

fn same(column: usize, ours: &str, theirs: &str) -> bool {
    match (ours.parse::<f64>(), theirs.parse::<f64>()) {
        (Ok(a), Ok(b)) => {
            let last = DOUBLE.iter().find(|(double, _)| *double == column);
            let is_same = match last {
                Some((_, last)) => (a - b).abs() < 1.5 * last,
                None => a as f32 == b as f32,
            };
            is_same || a == b || a.is_nan() && b.is_nan()
        }
        _ => ours == theirs,
    }
}

fn main() -> ExitCode {
    let files: Vec<String> = std::env::args()
        .skip(1)
        .map(|path| std::fs::read_to_string(path).expect("the table can be read"))
        .collect();
    let (ours, theirs): (Vec<_>, Vec<_>) = (files[0].lines().collect(), files[1].lines().collect());
    let differs = |(a, b): &(&&str, &&str)| {
        let (a, b): (Vec<_>, Vec<_>) = (a.split(',').collect(), b.split(',').collect());
        a.len() != b.len() || (0..a.len()).any(|i| !same(i, a[i], b[i]))
    };
    if let Some((a, b)) = ours.iter().zip(&theirs).find(differs) {
        eprintln!("these rows differ:\n{a}\n{b}");
        return ExitCode::FAILURE;
    }
    if ours.len() != theirs.len() || ours.len() < 3 {
        eprintln!("{} lines and {} lines", ours.len(), theirs.len());
        return ExitCode::FAILURE;
    }
    println!("{} rows are the same", ours.len() - 1);
    ExitCode::SUCCESS
}
