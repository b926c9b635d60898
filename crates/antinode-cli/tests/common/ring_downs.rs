//! Rows of simulated ring-downs, and what `antinode resonator` finds in them.

use std::fs;
use std::path::Path;

use super::run;

/// Rows of a simulated ring-down, in a file.
pub fn rows(here: &Path, simulated: &str, identified: &str) {
    let made = run(here, &format!("simulate -o it.wav {simulated}"));
    assert_eq!(made.code, 0, "{}", made.err);
    let rows = run(here, &format!("identify --output csv {identified} it.wav"));
    assert_eq!(rows.code, 0, "{}", rows.err);
    fs::write(here.join("rows.csv"), rows.out).unwrap();
}

/// A quantity of the resonator as CSV tells it, and its deviation.
pub fn of_resonator(out: &str, quantity: &str) -> (f64, f64) {
    let line = out
        .lines()
        .find_map(|line| line.strip_prefix(&format!(",{quantity},")));
    let (value, std) = line.and_then(|line| line.split_once(',')).expect(out);
    (value.parse().unwrap(), std.parse().unwrap())
}

/// Rows of several simulated ring-downs, one behind the other.
pub fn joined(
    here: &Path,
    simulated: impl IntoIterator<Item = String>,
    identified: &str,
) -> Vec<u8> {
    let mut all = Vec::new();
    for simulated in simulated {
        rows(here, &simulated, identified);
        all.extend(fs::read(here.join("rows.csv")).unwrap());
    }
    all
}
