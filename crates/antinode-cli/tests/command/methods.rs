//! `antinode identify --methods all` on simulated recordings: the paper's four methods beside the exact solution.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::common::{Row, rows, run};

/// Amplitudes and angle of every recording here; 20 samples a period, so that a window has whole periods.
const WAVE: &str = "--main-amplitude 0.5 --quadrature-amplitude -0.05 --angle 0.3 --frequency 5000";
const TRUTH: [f64; 3] = [0.5, -0.05, 0.3];
/// Columns of the exact solution, and, prefixed by `methodN_`, of a method.
const VALUES: [&str; 3] = ["main_amplitude", "quadrature_amplitude", "angle_rad"];
const DEVIATIONS: [&str; 3] = [
    "main_amplitude_std",
    "quadrature_amplitude_std",
    "angle_std_rad",
];
const OFF: [&str; 3] = [
    "main_amplitude_off_sigma",
    "quadrature_amplitude_off_sigma",
    "angle_off_sigma",
];

/// Simulates a.wav with these options, and returns the rows of all methods, identified with those.
fn simulated(directory: &Path, simulate: &str, identify: &str) -> Vec<Row> {
    let made = run(
        directory,
        &format!("simulate -o a.wav --sample f32 {simulate}"),
    );
    assert_eq!((made.code, made.err.as_str()), (0, ""), "{simulate}");
    let rows = rows(directory, &format!("a.wav --methods all {identify}"));
    assert!(rows.len() > 4, "{simulate}");
    rows
}

fn of(row: &Row, method: usize, name: &str) -> f64 {
    row.number(&format!("method{method}_{name}"))
}

/// Number of rows that warn.
fn warnings(rows: &[Row]) -> usize {
    let warn = |row: &&Row| match row.text("methods_flag") {
        "" => false,
        "disagree" => true,
        other => panic!("{other}"),
    };
    rows.iter().filter(warn).count()
}

#[test]
fn all_methods_find_a_clean_wave_and_none_warns() {
    let directory = tempfile::tempdir().unwrap();
    let rows = simulated(
        directory.path(),
        &format!("--seconds 0.5 --noise 0.005 {WAVE}"),
        "",
    );
    assert!(rows.len() > 200);
    assert_eq!(warnings(&rows), 0);
    let mut failed = [0; 4];
    for row in &rows {
        assert_eq!(row.text("flags"), "");
        for method in 1..=4 {
            for i in 0..3 {
                let (found, exact) = (of(row, method, VALUES[i]), row.number(VALUES[i]));
                let deviation = row.number(DEVIATIONS[i]);
                // The stated difference is the difference.
                let told = of(row, method, OFF[i]);
                let off = (found - exact) / deviation;
                assert!(
                    (told - off).abs() < 1e-3 * off.abs().max(1.0),
                    "{told} {off}"
                );
                // Method 1 neglects the quadrature: a_A is larger by a_B²/2a_A, and θ turned.
                let known = if method == 1 {
                    [0.0025, 0.05, 0.006][i]
                } else {
                    [0.0, 0.001, 0.0][i]
                };
                assert!(
                    (found - TRUTH[i]).abs() < known + 5.0 * deviation,
                    "method {method} {}: {found}",
                    VALUES[i]
                );
            }
            // In a window of whole periods, algorithm 4 is the exact solution but for the offsets.
            assert!(method < 4 || OFF.iter().all(|name| of(row, 4, name).abs() < 0.2));
            assert!(of(row, method, "frequency_off_sigma").abs() < 2.0);
            assert!((of(row, method, "frequency_hz") - 5000.0).abs() < 2.0);
            assert!(of(row, method, "unexplained_sigma") < 6.0);
            let fails = row.text(&format!("method{method}_failed_conditions"));
            if method == 1 {
                assert_eq!(fails, "(12)");
            }
            failed[method - 1] += usize::from(!fails.is_empty());
        }
        assert!(row.number("leakage") < 1e-3);
        assert!(row.number("delay_imbalance").abs() < 0.01);
        // tg Δφ_CD = −2 a_A a_B/((a_A² − a_B²) sin 4θ).
        let [a, b, angle] = TRUTH;
        let monitor = f64::atan2(-2.0 * a * b, (a * a - b * b) * (4.0 * angle).sin());
        assert!((row.number("phase_difference_rad") - monitor).abs() < 0.02);
    }
    // In white noise (17) and (20) hold, but for one window in some hundred.
    assert!(
        failed[1] * 50 < rows.len() && failed[2..] == [0, 0],
        "{failed:?}"
    );
}

#[test]
fn ranks_follow_the_conditions_and_then_j() {
    let directory = tempfile::tempdir().unwrap();
    // Windows of the default frequency are not whole periods; the delay does not allow for the nonlinearity's third harmonic.
    let mut rows = simulated(directory.path(), "--seconds 0.1 --noise 0.0002", "");
    let clean = rows.len();
    let cubic = "--seconds 0.1 --noise 0.0002 --cubic 0.3";
    rows.extend(simulated(directory.path(), cubic, ""));
    let mut behind = 0;
    for (i, row) in rows.iter().enumerate() {
        let class = |method: usize| {
            let fails = row.text(&format!("method{method}_failed_conditions"));
            let own = ["(12)", "(17)", "(20)"]
                .iter()
                .any(|own| fails.contains(own));
            (own, of(row, method, "j"))
        };
        behind += usize::from(i >= clean && class(2).0 && of(row, 2, "rank") > 2.0);
        let mut order: Vec<_> = (1..=4).map(|method| (class(method), method)).collect();
        order.sort_by(|a, b| a.partial_cmp(b).unwrap());
        let names: Vec<String> = order.iter().map(|(_, method)| method.to_string()).collect();
        assert_eq!(row.text("methods_by_rank"), names.join(">"));
        for (place, (_, method)) in order.iter().enumerate() {
            assert_eq!(of(row, *method, "rank"), place as f64 + 1.0);
        }
    }
    assert!(10 * behind > 9 * (rows.len() - clean), "{behind}");
}

#[test]
fn a_clipped_wave_makes_them_disagree() {
    let directory = tempfile::tempdir().unwrap();
    let clipped = format!("--seconds 0.1 --noise 0.001 --clip 0.3 {WAVE}");
    let rows = simulated(directory.path(), &clipped, "");
    assert_eq!(warnings(&rows), rows.len());
    let table = run(directory.path(), "identify a.wav --methods all");
    let said = table.out.matches("warning: the methods disagree").count();
    assert_eq!(said, rows.len(), "{}", table.out);
    assert!(table.out.contains("σ unexplained"));
    // The same as JSON.
    let json = run(
        directory.path(),
        "identify a.wav --methods all --output jsonl",
    );
    for (line, row) in json.out.lines().zip(&rows) {
        let object: serde_json::Value = serde_json::from_str(line).unwrap();
        assert_eq!(object["methods_flag"], "disagree");
        for name in ["method3_rank", "method2_unexplained_sigma"] {
            assert_eq!(object[name].as_f64(), Some(row.number(name)));
        }
    }
}

#[test]
fn a_table_shows_each_method_in_the_columns_of_its_row() {
    let directory = tempfile::tempdir().unwrap();
    let clean = format!("--seconds 0.05 --noise 0.005 {WAVE}");
    let rows = simulated(directory.path(), &clean, "");
    let table = run(directory.path(), "identify a.wav --methods all").out;
    assert!(!table.contains("warning"), "{table}");
    let heading = table.lines().position(|line| line.contains("time, s"));
    let lines: Vec<&str> = table.lines().skip(heading.unwrap() + 1).collect();
    assert_eq!(lines.len(), 5 * rows.len());
    for (window, row) in lines.chunks(5).zip(&rows) {
        // Decimal points are aligned.
        let points = |line: &str| {
            let places: Vec<usize> = line
                .chars()
                .enumerate()
                .filter(|(_, c)| *c == '.')
                .map(|(place, _)| place)
                .collect();
            places
        };
        let main = points(window[0])[1];
        for (i, line) in window[1..].iter().enumerate() {
            assert!(line.trim_start().starts_with(&format!("method {}", i + 1)));
            assert_eq!(points(line)[0], main, "{table}");
            assert!(line.contains("σ") && line.contains("rank"), "{line}");
            let fails = row.text(&format!("method{}_failed_conditions", i + 1));
            assert_eq!(line.contains(", fails "), !fails.is_empty(), "{line}");
            assert!(!line.contains("unexplained"), "{line}");
        }
    }
}

#[test]
fn several_recordings_have_one_header_and_one_legend() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let one = simulated(here, &format!("--seconds 0.05 --noise 0.005 {WAVE}"), "");
    std::fs::copy(here.join("a.wav"), here.join("b.wav")).unwrap();
    assert_eq!(rows(here, "a.wav b.wav --methods all").len(), 2 * one.len());
    let table = run(here, "identify a.wav b.wav --methods all").out;
    assert_eq!(table.matches("time, s").count(), 2, "{table}");
    assert_eq!(table.matches("Under each row").count(), 1, "{table}");
}

#[test]
fn a_known_skew_is_removed_from_all_methods() {
    let directory = tempfile::tempdir().unwrap();
    let clean = format!("--seconds 0.2 --noise 0.001 {WAVE}");
    let without = simulated(directory.path(), &clean, "");
    for skew in [1500.0, -6000.0] {
        let skewed = format!("{clean} --skew-ns {skew}");
        let calibrated = simulated(directory.path(), &skewed, &format!("--skew-ns {skew}"));
        let raw = simulated(directory.path(), &skewed, "");
        assert_eq!(
            (calibrated.len(), raw.len()),
            (without.len(), without.len())
        );
        assert_eq!(warnings(&calibrated), 0);
        // To first order a skew looks like quadrature, a_A·ωΔ/2·sin 4θ, which no method can distinguish, and none warns of.
        assert_eq!(warnings(&raw), 0);
        let false_quadrature =
            -0.5 * TRUTH[0] * TAU * 5000.0 * skew * 1e-9 * (4.0 * TRUTH[2]).sin();
        for ((calibrated, raw), without) in calibrated.iter().zip(&raw).zip(&without) {
            for method in 2..=4 {
                for i in 0..3 {
                    let name = VALUES[i];
                    let change = of(calibrated, method, name) - of(without, method, name);
                    // The same noise, but for that of D, which is interpolated from two samples.
                    assert!(
                        change.abs() < 3.0 * without.number(DEVIATIONS[i]),
                        "method {method} {name}: {change}"
                    );
                }
                let error = of(raw, method, VALUES[1]) - of(without, method, VALUES[1]);
                assert!(
                    (error / false_quadrature - 1.0).abs() < 0.1,
                    "method {method}: {error} for {false_quadrature}"
                );
            }
        }
    }
}

#[test]
fn noise_changed_by_a_calibration_is_no_disagreement() {
    let directory = tempfile::tempdir().unwrap();
    for flaw in [
        "--gain-ratio 1.5",
        "--gain-ratio 0.7",
        "--skew-ns 5000",
        "--pick-off-angle 0.15",
    ] {
        // The longer the window, the sooner a bias shows.
        let noisy = format!("--seconds 1 --noise 0.1 --angle {} {flaw}", PI / 16.0);
        let rows = simulated(directory.path(), &noisy, &format!("{flaw} --periods 1000"));
        assert_eq!(warnings(&rows), 0, "{flaw}");
        for row in &rows {
            assert_eq!(row.text("flags"), "", "{flaw}");
            let fails = row.text("method2_failed_conditions");
            assert_eq!(fails, "", "{flaw}");
        }
    }
}

#[test]
fn the_exact_solution_alone_has_no_columns_of_methods() {
    let directory = tempfile::tempdir().unwrap();
    simulated(directory.path(), "--seconds 0.1", "");
    let plain = run(directory.path(), "identify a.wav --output csv");
    assert!(!plain.out.contains("method"), "{}", plain.out);
    let wrong = run(directory.path(), "identify a.wav --methods 4");
    assert_eq!(wrong.code, 2);
    assert!(wrong.err.contains("exact, all"), "{}", wrong.err);
}

#[test]
fn long_periods_and_long_windows_have_methods_that_do_not_warn() {
    let directory = tempfile::tempdir().unwrap();
    // The frequency may be given 5 % too high, and a quarter of a period is then longer than it says.
    for (periods, windows, known) in [(10, 40, 1000), (300, 6, 1000), (10, 40, 1045)] {
        let seconds = 1e-3 * f64::from(periods * windows);
        let rows = simulated(
            directory.path(),
            &format!(
                "--frequency 1000 --rate 1000000 --seconds {seconds} --noise 0.005 --main-amplitude 0.5 --quadrature-amplitude -0.05 --angle 0.3"
            ),
            &format!("--frequency {known} --periods {periods}"),
        );
        // The first has no samples before it.
        assert!(rows[0].text("method4_rank").is_empty());
        let rows = &rows[1..];
        assert!(
            rows.iter()
                .all(|row| row.number("method4_main_amplitude") > 0.4)
        );
        assert_eq!(warnings(rows), 0, "{periods} periods");
        let failed = |row: &&Row| {
            let conditions = row.text("method2_failed_conditions");
            conditions.contains("(17)") || conditions.contains("(20)")
        };
        let failed = rows.iter().filter(failed).count();
        assert!(
            10 * failed <= rows.len(),
            "{periods} periods: {failed} fail"
        );
    }
}

#[test]
fn a_window_without_a_wave_has_no_methods() {
    let directory = tempfile::tempdir().unwrap();
    let gone = format!("--seconds 0.2 --noise 0.001 --dropout 0.05:0.1:zero {WAVE}");
    let rows = simulated(directory.path(), &gone, "");
    let lost = |row: &&Row| row.text("flags").contains("lost");
    let count = rows.iter().filter(lost).count();
    assert!(count > 0 && count < rows.len());
    for row in &rows {
        assert_eq!(row.text("method4_rank").is_empty(), lost(&row));
        assert_eq!(row.text("leakage").is_empty(), lost(&row));
    }
    let table = run(directory.path(), "identify a.wav --methods all").out;
    assert_eq!(
        table.matches("method 4").count(),
        rows.len() - count,
        "{table}"
    );
}
