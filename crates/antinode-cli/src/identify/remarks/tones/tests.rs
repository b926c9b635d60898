//! Which tones are named, and the remedy for them.

use std::f64::consts::TAU;

use super::super::row_scatter::tests::row;
use super::*;
use antinode_sim::Deviates;

const RATE: f64 = 1e5;

/// The cause told for a wave of 5332 Hz beside tones of these frequencies, Hz, and amplitudes; of its rows one in `every` is a misfit.
fn cause(tones: &[(f64, f64)], every: u64, settings: &Settings) -> Option<String> {
    cause_of_turning(0.0, tones, every, settings)
}

/// The same for a pattern that turns at this rate, rad/s.
fn cause_of_turning(
    angle_rate: f32,
    tones: &[(f64, f64)],
    every: u64,
    settings: &Settings,
) -> Option<String> {
    let mut seen = Tones::default();
    let mut deviates = Deviates::new(3);
    for index in 0..300u64 {
        let pairs = (200 * index..200 * (index + 1)).map(|k| {
            let of =
                |(hertz, amplitude): &(f64, f64)| amplitude * (TAU * hertz / RATE * k as f64).cos();
            let all = tones.iter().chain([&(5332.0, 0.6)]).map(of).sum::<f64>();
            [all as f32, (1e-3 * deviates.draw()) as f32]
        });
        seen.see(&pairs.collect::<Vec<_>>());
        let mut row = row(index, 1.0, &mut deviates);
        row.angle_rate = angle_rate;
        if index % every == 0 {
            row.flags = Flags::MISFIT;
        }
        seen.row(&row);
    }
    seen.cause(settings)
}

#[test]
fn only_many_misfits_are_explained_and_not_by_harmonics_alone() {
    let settings = Settings::new(RATE);
    let tone = (9000.0, 0.01);
    let told = cause(&[tone], 2, &settings).unwrap();
    let start = "beside the wave there is a tone of 9000.0 Hz (amplitude 0.01 in C, 0.0000";
    let end = " in D): remove its cause, or give --coloured";
    assert!(told.starts_with(start) && told.ends_with(end), "{told}");
    assert_eq!(cause(&[tone], 20, &settings), None);
    assert_eq!(cause(&[], 2, &settings), None);
    let harmonic = (2.0 * 5332.0, 0.02);
    assert_eq!(cause(&[harmonic], 2, &settings), None);
    let told = cause(&[harmonic, tone], 2, &settings).unwrap();
    assert!(
        told.contains("there are tones of 10664.0 Hz (2f, amplitude 0.02 in C, "),
        "{told}"
    );
    assert!(
        told.contains(" in D) and of 9000.0 Hz (amplitude 0.01 in C, "),
        "{told}"
    );
    // The eighteenth, folded to 4024 Hz, is too high to be told as one.
    let told = cause(&[(9.0 * 5332.0, 0.01), (4024.0, 0.004)], 2, &settings);
    let told = told.unwrap();
    assert!(
        told.contains("47988.0 Hz (9f, ") && told.contains("4024.0 Hz (amplitude"),
        "{told}"
    );
}

#[test]
fn the_lines_of_a_turning_pattern_are_its_own() {
    let settings = Settings::new(RATE);
    // 300 rad/s turn the amplitude that a pick-off sees twice as fast.
    let lines = [-1.0, 1.0].map(|sign| (5332.0 + sign * 300.0 * FRAC_1_PI, 0.3));
    assert_eq!(cause_of_turning(-300.0, &lines, 2, &settings), None);
    assert!(cause(&lines, 2, &settings).is_some());
}

#[test]
fn the_lines_of_a_wave_that_drifts_are_its_own() {
    let settings = Settings::new(RATE);
    // By 1 Hz a window of 200 pairs, as much as 48 lines in the time of a spectrum, and one row in 50 is far off.
    let told = |tones: &[(f64, f64)], drift: f64| {
        let mut seen = Tones::default();
        let mut deviates = Deviates::new(3);
        let mut turns = 0.0;
        for index in 0..500u64 {
            let frequency = 5332.0 + drift * index as f64;
            let pairs = (200 * index..200 * (index + 1)).map(|k| {
                turns += frequency / RATE;
                let of = |(hertz, amplitude): &(f64, f64)| {
                    amplitude * (TAU * hertz / RATE * k as f64).cos()
                };
                let wave = 0.6 * (TAU * turns).cos() + 0.02 * (2.0 * TAU * turns).cos();
                [
                    (wave + tones.iter().map(of).sum::<f64>()) as f32,
                    (1e-3 * deviates.draw()) as f32,
                ]
            });
            seen.see(&pairs.collect::<Vec<_>>());
            let far = if index % 50 == 49 { 3000.0 } else { 0.0 };
            seen.row(&Estimate {
                frequency: frequency + far,
                flags: Flags::MISFIT,
                ..row(index, 1.0, &mut deviates)
            });
        }
        seen.cause(&settings)
    };
    assert_eq!(told(&[], 1.0), None);
    assert_eq!(told(&[], -1.0), None);
    let told = told(&[(7000.0, 0.05)], 1.0).unwrap();
    assert!(told.contains("there is a tone of 7000.0 Hz"), "{told}");
}

#[test]
fn the_remedy_is_what_is_not_given_yet() {
    let near = (5332.0 + 320.0, 0.01);
    let given = |periods, hum, coloured| Settings {
        periods,
        hum,
        coloured,
        ..Settings::new(RATE)
    };
    for (tones, settings, remedy) in [
        (
            vec![near],
            given(10, true, false),
            "--coloured and --periods 54, ",
        ),
        (vec![near], given(53, false, true), "or give --periods 54, "),
        (vec![near], given(54, false, false), "or give --coloured"),
        (vec![near], given(54, false, true), "remove its cause"),
        (
            vec![near, (8000.0, 0.02)],
            given(54, false, true),
            "remove their causes",
        ),
        (
            vec![(50.0, 0.01), (150.0, 0.01)],
            given(10, false, false),
            "or give --hum",
        ),
        (
            vec![(50.0, 0.01)],
            given(10, true, false),
            "remove its cause",
        ),
        (
            vec![(50.0, 0.01)],
            given(10, false, true),
            "remove its cause",
        ),
        (
            vec![(50.0, 0.01), (900.0, 0.01)],
            given(10, true, false),
            "or give --coloured",
        ),
        (
            vec![(3.0 * 5332.0 - 120.0, 0.01)],
            given(10, false, false),
            "or give --periods 49, so that a window holds a beat with its third harmonic",
        ),
        (
            vec![(900.0, 0.01)],
            given(5, true, true),
            "or give --periods 10, ",
        ),
    ] {
        let told = cause(&tones, 1, &settings).unwrap();
        assert!(told.contains(remedy), "{tones:?}: {told}");
        let is_end = !remedy.ends_with(' ');
        assert_eq!(told.ends_with(remedy), is_end, "{tones:?}: {told}");
    }
}

#[test]
fn no_spectrum_spans_a_gap() {
    let half = [[0.25, 0.5]; LENGTH / 2];
    for (is_gap, count) in [(false, 1), (true, 0)] {
        let mut seen = Tones::default();
        seen.see(&half);
        if is_gap {
            seen.interrupt();
        }
        seen.see(&half);
        assert_eq!(seen.spectra(), count);
    }
}
