//! `antinode resonator`: splits of damping and frequency, and effects that look like one or do not.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use crate::common::ring_downs::{
    four_seconds, identified, is_one_way, numbers, of_run, record, resonator,
};
use crate::common::{WAVE, done, rms, wav};

#[test]
fn three_angles_determine_a_split_of_frequency() {
    let directory = tempfile::tempdir().unwrap();
    // Along an axis of the frequencies nothing changes; between the axes energy passes from a_A to a_B and back, as between two pendulums.
    let split = 0.03;
    let mut rows = String::from(
        "time_s,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,main_amplitude_std,quadrature_amplitude_std,angle_std_rad,flags,file\n",
    );
    let eighth = std::f64::consts::FRAC_PI_8;
    for (angle, exchange) in [(0.0, 0.0), (eighth, 1.0), (2.0 * eighth, 0.0)] {
        for index in 0..100 {
            let time = 0.05 * f64::from(index);
            let phase = exchange * std::f64::consts::PI * split * time;
            let (sine, cosine) = phase.sin_cos();
            let level = (-0.08 * time).exp();
            rows += &format!(
                "{time},{},{},{angle},5332,1e-5,1e-5,1e-5,,{angle}\n",
                level * cosine,
                level * sine
            );
        }
    }
    let found = resonator(directory.path(), &rows, "--output csv");
    // These rows have no noise, whatever deviations they state.
    assert!(
        found.err.starts_with(
            "warning: rows differ from the resonator's motion by only 0.00 times their noise"
        ) && found.err.lines().count() == 1,
        "{}",
        found.err
    );
    let numbers = numbers(&found);
    let of = |quantity: &str| numbers[&(String::new(), quantity.to_owned())].0;
    assert!(
        (of("frequency_split_hz") - split).abs() < 1e-7,
        "{}",
        found.out
    );
    assert!(of("highest_at_rad").abs() < 1e-5, "{}", found.out);
    assert!((of("decay_time_s") - 12.5).abs() < 1e-4, "{}", found.out);
    assert!(of("damping_split_s") < 1e-6, "{}", found.out);
    for run in ["1", "2", "3"] {
        let (rotation, _) = numbers[&(run.to_owned(), "rotation_rad_s".to_owned())];
        assert!(rotation.abs() < 1e-6, "{}", found.out);
    }
}

/// A resonator with splits, and its quantities that are to be found.
const SPLIT: &str = "--decay-rate 0.08 --damping-split 0.012 --damping-angle 0.5 --frequency-split 0.004 --frequency-angle -0.3";
const OF_SPLIT: [(&str, f64); 5] = [
    ("decay_time_s", 12.5),
    ("damping_split_s", 0.012),
    ("most_damped_at_rad", 0.5),
    ("frequency_split_hz", 0.004),
    ("highest_at_rad", -0.3),
];

/// Errors over their stated deviations, of all these quantities, and of the rotation of this many runs.
fn errors(here: &Path, rows: &str, runs: u8, rotation: f64) -> Vec<f64> {
    let found = resonator(here, rows, "--output csv");
    if rotation == 0.0 {
        assert_eq!(found.err, "");
    } else {
        is_one_way(&found.err);
    }
    let numbers = numbers(&found);
    let of_resonator = OF_SPLIT.map(|(quantity, truth)| (String::new(), quantity, truth));
    let of_runs = (1..=runs).map(|run| (run.to_string(), "rotation_rad_s", rotation));
    let errors = of_resonator
        .into_iter()
        .chain(of_runs)
        .map(|(run, quantity, truth)| {
            let (value, std) = numbers[&(run, quantity.to_owned())];
            let std = std.unwrap();
            // Each split is known to a hundredth.
            assert!(std < 0.01 * truth.abs().max(0.01), "{}", found.out);
            (value - truth) / std
        });
    errors.collect()
}

#[test]
fn the_splits_of_simulated_ring_downs_are_found_to_their_deviations() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    for seed in 1..=8 {
        for angle in [0, 22, 45] {
            let radians = f64::from(angle).to_radians();
            record(
                here,
                &format!("{angle}.wav"),
                &format!("{SPLIT} --angle {radians} --seed {seed}{angle}"),
            );
        }
        let at_rest = identified(here, "0.wav 22.wav 45.wav");
        all.extend(errors(here, &at_rest, 3, 0.0));
        let turning = four_seconds(here, &format!("{SPLIT} --angle-rate 0.4 --seed {seed}"));
        all.extend(errors(here, &turning, 1, 0.4));
    }
    let worst = all
        .iter()
        .fold(0.0f64, |worst, error| worst.max(error.abs()));
    let rms = rms(&all);
    assert!(worst < 4.0 && (0.7..1.3).contains(&rms), "{all:.1?}");
}

#[test]
fn windows_in_which_the_pattern_turns_far_give_the_same_result() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut all = Vec::new();
    for seed in 1..=4 {
        done(
            here,
            &format!(
                "simulate -o it.wav --sample f32 --seconds 20 --noise 2e-4 --seed {seed} --angle-rate 1.5 {SPLIT}"
            ),
        );
        // 8° in each: the average over a window shows 1 % less of the splits.
        let rows = done(here, "identify --periods 500 --output csv it.wav");
        all.extend(errors(here, &rows.out, 1, 1.5));
    }
    assert!(all.iter().all(|error| error.abs() < 4.0), "{all:.1?}");
}

#[test]
fn splits_that_flaws_of_pick_offs_look_like_are_named_if_the_pattern_turns_one_way() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (flaw, quantity, which) in [
        ("--gain-ratio 1.001", "damping_split_s", 0),
        ("--skew-ns 10", "frequency_split_hz", 1),
    ] {
        let wave = |rate: &str| format!("--decay-rate 0.08 --angle-rate {rate} {flaw}");
        let [one_way, other_way] = ["0.4", "-0.4"].map(|rate| four_seconds(here, &wave(rate)));
        let split = |rows: &str| {
            let found = resonator(here, rows, "--output csv");
            let (split, std) = numbers(&found)[&(String::new(), quantity.to_owned())];
            (split, std.unwrap(), found.err)
        };
        let (split_one_way, std, err) = split(&one_way);
        let told = is_one_way(&err)[which];
        assert!(
            (split_one_way - told).abs() < 0.05 * told + 4.0 * std,
            "{flaw}: {split_one_way} ± {std}: {err}"
        );
        // With two more at rest flaws do not look like splits.
        let still = ["0.1", "0.5"]
            .map(|angle| four_seconds(here, &format!("--decay-rate 0.08 --angle {angle} {flaw}")));
        let (_, _, err) = split(&(one_way.clone() + &still.concat()));
        assert!(!err.contains("one way"), "{err}");
        let (split_both_ways, std, err) = split(&(one_way + &other_way));
        assert!(
            split_both_ways < 4.0 * std,
            "{flaw}: {split_both_ways} ± {std}"
        );
        assert!(!err.contains("one way"), "{err}");
    }
}

#[test]
fn turning_by_amplitudes_is_reported_and_does_not_change_the_splits() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let gamma = 0.3;
    let mut all = String::new();
    for angle in [0.1, 0.5, 0.9] {
        let wave = format!(
            "--angle {angle} --decay-rate 0.08 --main-amplitude 0.5 --quadrature-amplitude 0.1"
        );
        for (index, line) in four_seconds(here, &wave).lines().enumerate() {
            if index > 0 {
                // Without splits θ turns by −γ a_A a_B, and the frequency rises by 3γ (a_A² + a_B²) rad/s.
                let mut fields: Vec<_> = line.split(',').map(str::to_owned).collect();
                let fallen = (-0.16 * fields[0].parse::<f64>().unwrap()).exp();
                let turned = -gamma * 0.05 * (1.0 - fallen) / 0.16;
                let risen = 3.0 * gamma * 0.26 * fallen / TAU;
                let run_on = -3.0 * gamma * 0.26 * (1.0 - fallen) / 0.16;
                for (field, more) in [(4, turned), (5, run_on), (6, risen)] {
                    let value = fields[field].parse::<f64>().unwrap() + more;
                    fields[field] = format!("{value:.12}");
                }
                all += &(fields.join(",") + "\n");
            } else if all.is_empty() {
                all = line.to_owned() + "\n";
            }
        }
    }
    let found = resonator(here, &all, "--output csv");
    let numbers = numbers(&found);
    for (quantity, truth) in [
        ("turning_by_amplitudes_rad_s", -gamma),
        ("frequency_by_energy_hz", 3.0 * gamma / TAU),
        ("decay_time_s", 12.5),
    ] {
        let (value, std) = numbers[&(String::new(), quantity.to_owned())];
        let std = std.unwrap();
        assert!(
            (value - truth).abs() < 4.0 * std && std < 0.1 * truth.abs(),
            "{quantity}: {value} {std}"
        );
    }
    for split in ["damping_split_s", "frequency_split_hz"] {
        let (value, std) = numbers[&(String::new(), split.to_owned())];
        assert!(value < 4.0 * std.unwrap(), "{}", found.out);
    }
}

#[test]
fn one_pattern_that_rocks_a_little_determines_its_decay() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // By ±1.1°: no steady rotation, and too little for the splits.
    let codes = WAVE.codes_as(300_000, |time| {
        (0.4 + 0.02 * (8.0 * time).sin(), WAVE.decay(time))
    });
    fs::write(here.join("rocks.wav"), wav(&codes)).unwrap();
    let found = resonator(here, &identified(here, "rocks.wav"), "--output csv");
    assert!(
        found.code == 0 && found.err.contains("no steady rotation explains the rows: "),
        "{}",
        found.err
    );
    let (time, std) = of_run(&found.out, "1", "decay_time_s");
    assert!(
        (time - 1.0 / WAVE.decay_rate).abs() < 4.0 * std && std < 1e-2,
        "{}",
        found.out
    );
}

#[test]
fn both_modes_have_their_own_quality_factors_and_frequencies() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = four_seconds(
        here,
        "--decay-rate 0.08 --angle-rate 0.4 --damping-split 0.012 --frequency-split 0.004",
    );
    let found = numbers(&resonator(here, &rows, "--output csv"));
    let q = |rate: f64| std::f64::consts::PI * 5332.0 / rate;
    for (quantity, truth) in [
        ("most_damped_decay_time_s", 1.0 / 0.086),
        ("least_damped_decay_time_s", 1.0 / 0.074),
        ("most_damped_quality_factor", q(0.086)),
        ("least_damped_quality_factor", q(0.074)),
        ("highest_frequency_hz", 5332.002),
        ("lowest_frequency_hz", 5331.998),
    ] {
        let (value, std) = found[&(String::new(), quantity.to_owned())];
        let std = std.unwrap();
        assert!((value - truth).abs() < 4.0 * std, "{quantity}: {value}");
        assert!(std < 1e-3 * truth, "{quantity}: {std}");
    }
}
