//! `antinode resonator`: damping that changes while the wave rings down is found, and told.

use crate::common::ring_downs::{
    damped, four_seconds, identified, numbers, of_resonator, of_run, record, resonator,
};

#[test]
fn a_drift_is_printed_and_does_not_move_the_decay_time() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // 1/τ rises by a tenth in 4 s, also of a pattern at rest.
    let drift = 0.008 / 4.0;
    for wave in ["--angle 0.3", "--angle-rate 0.4"] {
        let rows = four_seconds(here, &format!("--decay-rate 0.08 {wave}"));
        let steady = resonator(here, &rows, "--output csv");
        assert!(
            !steady.out.contains("decay_rate") && !steady.err.contains("damping changes"),
            "{}{}",
            steady.out,
            steady.err
        );
        let rows = damped(&rows, |time| 0.5 * drift * time * (time - 4.0));
        let found = resonator(here, &rows, "--output csv");
        assert!(
            found.err.contains("the damping changes with time") && !found.err.contains("noise:"),
            "{}",
            found.err
        );
        let (value, std) = of_run(&found.out, "1", "decay_time_s");
        assert!(
            (value - 12.5).abs() < 4.0 * std && std < 0.02,
            "{}",
            found.out
        );
        let (value, std) = of_run(&found.out, "1", "decay_rate_drift_s2");
        assert!(
            (value - drift).abs() < 4.0 * std && std < 0.1 * drift,
            "{}",
            found.out
        );
        let table = resonator(here, &rows, "").out;
        assert!(table.contains("decay rate drift, 1/s²"), "{table}");
    }
}

#[test]
fn a_dependence_on_the_amplitude_is_printed_with_the_decay_time_of_small_waves() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Over four decay times, from a_A = 0.5 and a_B = 0.025 on.
    let rows = four_seconds(here, "--decay-rate 1 --angle-rate 0.4");
    let by_energy = 0.2;
    let energy = 0.250_625;
    let p = |time: f64| 0.5 * (by_energy * energy * -(-2.0 * time).exp_m1()).ln_1p();
    let found = resonator(here, &damped(&rows, p), "--output csv");
    assert!(
        found.err.contains("the damping changes with the amplitude")
            && found.err.contains("those of small waves"),
        "{}",
        found.err
    );
    let (value, std) = of_resonator(&found.out, "decay_rate_by_energy_s");
    assert!(
        (value - by_energy).abs() < 4.0 * std && std < 0.1 * by_energy,
        "{}",
        found.out
    );
    let (value, std) = of_resonator(&found.out, "decay_time_s");
    assert!(
        (value - 1.0).abs() < 4.0 * std && std < 0.01,
        "{}",
        found.out
    );
}

#[test]
fn splits_that_only_one_pattern_shows_are_told_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let split = "--decay-rate 0.3 --frequency-split 0.3 --damping-split 0.1 --angle 0.2";
    for (rates, is_told) in [(vec!["0"], true), (vec!["0.4", "-0.4"], false)] {
        let names: Vec<_> = rates.iter().map(|rate| format!("it{rate}.wav")).collect();
        for (name, rate) in names.iter().zip(rates) {
            record(here, name, &format!("{split} --angle-rate {rate}"));
        }
        let rows = identified(here, &names.join(" "));
        let found = resonator(here, &rows, "--output csv");
        assert!(found.out.contains("damping_split_s"), "{}", found.out);
        let told = found.err.contains("only one pattern that is not turned");
        assert_eq!(told, is_told, "{}", found.err);
        if is_told {
            // It cannot look like one if it is allowed for.
            let rows = damped(&rows, |time| 0.02 * time * (time - 4.0));
            let found = resonator(here, &rows, "--output csv");
            assert!(found.out.contains("damping_split_s"), "{}", found.out);
            assert!(
                found.err.contains("the damping changes") && !found.err.contains("only one"),
                "{}",
                found.err
            );
        }
    }
}

#[test]
fn runs_with_decays_and_frequencies_of_their_own_are_told_apart() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let waves = |frequency: &str| {
        [("0.1", "0.4", "5332"), ("0.11", "-0.4", frequency)].map(|(decay, turn, frequency)| {
            format!("--decay-rate {decay} --angle-rate {turn} --frequency {frequency} --damping-split 0.012")
        })
    };
    // Of two temperatures; and of two resonators.
    for (frequency, is_other) in [("5331.5", false), ("5400", true)] {
        let rows: String = waves(frequency)
            .iter()
            .enumerate()
            .map(|(i, wave)| {
                let rows = four_seconds(here, wave);
                let without_header =
                    |rows: &str| rows.lines().skip(1).map(|row| format!("{row}\n")).collect();
                // The second is another recording.
                let rows = rows.replace("it.wav", &format!("{i}.wav"));
                if i == 0 { rows } else { without_header(&rows) }
            })
            .collect();
        let found = resonator(here, &rows, "--output csv");
        assert!(
            found.err.contains("the runs decay at different rates"),
            "{}",
            found.err
        );
        assert_eq!(
            found
                .err
                .contains("Hz apart: give the rows of one resonator"),
            is_other,
            "{}",
            found.err
        );
        assert!(!found.err.contains("times their noise"), "{}", found.err);
        let numbers = numbers(&found);
        let frequency: f64 = frequency.parse().unwrap();
        for (run, quantity, truth) in [
            ("1", "frequency_hz", 5332.0),
            ("2", "frequency_hz", frequency),
            ("", "damping_split_s", 0.012),
        ] {
            let (value, std) = numbers[&(run.to_owned(), quantity.to_owned())];
            assert!((value - truth).abs() < 4.0 * std.unwrap(), "{}", found.out);
        }
    }
}
