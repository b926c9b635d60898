//! `antinode identify` where no window is a wave: it says what was found, and what to try.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use crate::common::{RATE, Row, WAVE, Wave, done, no_rows, rows, run, silence, wav};

/// A 16-bit WAV file of tones, each given by frequency and amplitude.
fn tones(path: &Path, tones: &[(f64, f64)]) {
    let value = |k: usize| -> f64 {
        let tone = |&(frequency, amplitude): &(f64, f64)| {
            amplitude * (TAU * frequency * k as f64 / RATE).cos()
        };
        tones.iter().map(tone).sum()
    };
    let code = |value: f64| (value * 32_767.0).round() as i16;
    let pairs: Vec<[i16; 2]> = (0..20_000)
        .map(|k| [code(0.8 * value(k)), code(0.6 * value(k))])
        .collect();
    fs::write(path, wav(&pairs)).unwrap();
}

/// Runs `identify`, which must exit 1 without a row, with one message that contains all of these texts.
fn fault(directory: &Path, arguments: &str, told: &[&str]) {
    no_rows(directory, arguments, Vec::new(), told);
}

#[test]
fn windows_without_a_wave_are_distinguished_from_too_few_samples() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let refused = "a period was found, but no window of 10 periods in 20000 sample pairs";
    tones(&here.join("two.wav"), &[(5321.7, 0.45), (7000.0, 0.45)]);
    fault(
        here,
        "two.wav",
        &[
            refused,
            "second tone; if hum is as large as the wave, give --hum; if",
            "fewer than 4 samples a period",
        ],
    );
    tones(&here.join("one.wav"), &[(5321.7, 1.0)]);
    let settings = "check --full-scale and --resolution";
    fault(here, "one.wav --resolution 1", &[refused, settings]);
    assert!(rows(here, "one.wav --full-scale 2").len() > 90);
    let mut tiny = String::new();
    for k in 0..20_000 {
        let value = 1e-20 * (TAU * 5321.7 * f64::from(k) / RATE).cos();
        tiny += &format!("{value:e},{:e}\n", 0.5 * value);
    }
    fs::write(here.join("tiny.csv"), tiny).unwrap();
    let scale =
        "one wave: the first samples have an amplitude of 1e-20, beyond the range of 1e-15 to 1e17";
    fault(here, "tiny.csv --rate 1e5", &[refused, scale]);
    let short = "hold no window of 1022 periods; record longer or give a smaller --periods";
    fs::write(here.join("short.wav"), wav(&WAVE.codes(5000))).unwrap();
    fault(here, "short.wav --periods 1022", &[short]);
}

#[test]
fn noise_alone_has_no_period() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("noise.wav"), wav(&silence(0.005).codes(50_000))).unwrap();
    let none = "noise.wav: no period found in 50000 sample pairs (0.5000 s)";
    fault(here, "noise.wav", &[none, "check the sample rate"]);
}

#[test]
fn too_few_samples_a_period_are_named() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for samples in [2.5, 2.6, 2.7] {
        tones(&here.join("a.wav"), &[(RATE / samples, 0.9)]);
        let told = format!("Hz has {samples} samples a period");
        fault(here, "a.wav", &["no period found", &told]);
    }
    let fast = "if undersampled on purpose, this wave appears at 18750 Hz";
    let refused = run(here, "identify a.wav --frequency 281250");
    assert!(
        refused.code == 2 && refused.err.contains(fast),
        "{}",
        refused.err
    );
}

#[test]
fn a_wave_of_too_many_samples_a_period_is_named_with_the_option_that_finds_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    tones(&here.join("a.wav"), &[(410.07, 0.9)]);
    let told = "a wave of about 410 Hz has 244 samples a period";
    fault(here, "a.wav", &["no period found", told, "--frequency 410"]);
    assert!(rows(here, "a.wav --frequency 410").len() > 4);
}

#[test]
fn an_offset_that_drowns_the_wave_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let write = |offset: f64| {
        let mut lines = String::new();
        for k in 0..20_000 {
            let (sine, cosine) = (TAU * 5321.7 * f64::from(k) / RATE).sin_cos();
            lines += &format!(
                "{:.6},{:.6}\n",
                offset + 0.5 * cosine,
                offset + 0.2 * cosine + 0.1 * sine
            );
        }
        fs::write(here.join("a.csv"), lines).unwrap();
    };
    write(1000.0);
    let told = "(0.2000 s): the samples vary by only 3.9e-1 rms about an offset of 1.4142e3";
    fault(
        here,
        "a.csv --rate 1e5",
        &["no period found", told, "subtract the offset"],
    );
    write(10.0);
    assert!(rows(here, "a.csv --rate 1e5").len() > 90);
}

#[test]
fn a_recording_too_short_for_a_search_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (wave, pairs) in [(WAVE, 30), (silence(0.005), 590)] {
        fs::write(here.join("a.wav"), wav(&wave.codes(pairs))).unwrap();
        let told = format!("no period found in only {pairs} sample pairs");
        fault(here, "a.wav", &[&told, "record longer"]);
    }
}

#[test]
fn a_known_frequency_is_suggested_if_a_window_then_fits() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // The search leaves fewer than three of five periods.
    let slow = Wave {
        frequency: 500.0,
        ..WAVE
    };
    fs::write(here.join("a.wav"), wav(&slow.codes(1000))).unwrap();
    let none = "a period was found, but 1000 sample pairs (0.0100 s) hold no window of";
    let remedy = "; or, as the wave has about 500 Hz, give --frequency 500, so that no search precedes the window";
    fault(here, "a.wav --periods 4", &[none, remedy]);
    assert_eq!(rows(here, "a.wav --periods 4 --frequency 500").len(), 1);
    let why = "give a smaller --periods; the wave has about 500 Hz";
    fault(here, "a.wav --periods 5", &[none, why]);
}

#[test]
fn a_slow_wave_of_few_periods_is_named_with_the_options_that_find_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (frequency, options) in [
        (200.0, "--frequency 200 --periods 4"),
        (126.6, "--frequency 127 --periods 2"),
    ] {
        let wave = Wave { frequency, ..WAVE };
        fs::write(here.join("a.wav"), wav(&wave.codes(2500))).unwrap();
        for detector in ["", " --detector mean-return"] {
            let told = ["no period found", &format!("give {options}")];
            fault(here, &format!("a.wav{detector}"), &told);
        }
        assert_eq!(rows(here, &format!("a.wav {options}")).len(), 1);
    }
}

#[test]
fn the_other_detector_is_suggested() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    tones(&here.join("a.wav"), &[(5321.7, 0.5), (2660.0, 0.28)]);
    let none = "no period found in 20000 sample pairs";
    fault(
        here,
        "a.wav",
        &[none, "try --detector mean-return", "second tone"],
    );
    let found = run(here, "identify --output csv a.wav --detector mean-return");
    // The tone makes every row a misfit, which is reported.
    let rows = Row::all(&found.out);
    let all = format!(
        "warning: a.wav: {0} of {0} rows are flagged: misfit {0}",
        rows.len()
    );
    assert!(
        found.code == 0 && found.err.starts_with(&all),
        "{}",
        found.err
    );
    assert!(rows.len() > 90);
    let short = "short.wav --detector mean-return";
    fs::write(here.join("short.wav"), wav(&silence(0.005).codes(20_000))).unwrap();
    fault(
        here,
        short,
        &[
            "no period found",
            "try --detector difference; if that finds none either, give --frequency if it is known",
        ],
    );
    let help = run(here, "identify --help").out;
    let words: Vec<&str> = help.split_whitespace().collect();
    let told = "a second tone may hide it, try the other";
    assert!(words.join(" ").contains(told), "{help}");
}

#[test]
fn a_known_frequency_is_not_searched() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Noise nearly as large as the wave: a search finds nothing.
    let loud = Wave {
        main: 0.2,
        noise: 0.18,
        ..WAVE
    };
    fs::write(here.join("loud.wav"), wav(&loud.codes(100_000))).unwrap();
    let options = "loud.wav --periods 100";
    fault(here, options, &["no period found", "give --frequency"]);
    let found = rows(here, &format!("{options} --frequency 5320"));
    assert!(found.len() > 45, "{}", found.len());
    for row in &found {
        assert_eq!(row.text("flags"), "");
        assert!((row.number("frequency_hz") - 5321.7).abs() < 5.0);
    }
    // The first window begins with the first sample: this is the middle of ten periods.
    fs::write(here.join("clear.wav"), wav(&WAVE.codes(5000))).unwrap();
    let first = &rows(here, "clear.wav --frequency 5200")[0];
    let middle = first.number("samples") / 2.0 / RATE;
    assert!((first.number("time_s") - middle).abs() < 1e-5, "{middle}");
}

#[test]
fn a_slow_wave_may_be_known() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    tones(&here.join("slow.wav"), &[(125.0, 0.9)]);
    let told =
        "a wave of about 125 Hz has 800 samples a period, outside the search range of 4 to 200";
    fault(here, "slow.wav", &[told, "give --frequency 125"]);
    let found = rows(here, "slow.wav --periods 4 --frequency 125");
    assert!(found.len() > 4 && found.iter().all(|row| row.text("flags").is_empty()));
}

#[test]
fn a_frequency_that_is_not_the_waves_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    tones(&here.join("a.wav"), &[(5321.7, 0.9)]);
    for (frequency, found) in [("6600", ""), ("3732", "wave of 53"), ("10600", "")] {
        let run = run(here, &format!("identify a.wav --frequency {frequency}"));
        let warning = format!(
            "but --frequency says {frequency} Hz: rows mean nothing unless both waves are present"
        );
        assert!(run.err.contains(&warning), "{}", run.err);
        assert!(run.err.contains(found), "{}", run.err);
    }
    let run = run(here, "identify a.wav --frequency 6600");
    let error = "no window of 10 periods in 20000 sample pairs (0.2000 s) is mostly one wave within 5 % of 6600 Hz: check --frequency";
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert!(run.err.contains(error), "{}", run.err);
    // Too short for a window, for which the frequency is not blamed.
    let short = "a.wav: 20000 sample pairs (0.2000 s) hold no window of 850 periods";
    tones(&here.join("a.wav"), &[(4000.0, 0.9)]);
    fault(here, "a.wav --frequency 4000 --periods 850", &[short]);
}

#[test]
fn an_impossible_frequency_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    tones(&here.join("a.wav"), &[(5321.7, 0.9)]);
    for frequency in ["40001", "97", "0", "-5", "x"] {
        let run = run(here, &format!("identify a.wav --frequency {frequency}"));
        assert_eq!((run.code, run.out.as_str()), (2, ""), "{}", run.err);
        assert!(run.err.contains("--frequency"), "{}", run.err);
    }
    let range = "a.wav: --frequency: 40001 Hz is out of range: at a sample rate of 100000 Hz it must be 97.65625 to 40000 Hz, 1024 to 2.5 samples a period";
    let told = run(here, "identify a.wav --frequency 40001").err;
    assert!(told.contains(range), "{told}");
    let both = run(
        here,
        "identify a.wav --frequency 5000 --detector difference",
    );
    assert_eq!(both.code, 2);
    assert!(both.err.contains("--detector"), "{}", both.err);
}

#[test]
fn constant_samples_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let both = "found in 5000 sample pairs (0.0500 s): S_C and S_D are constant at ";
    fs::write(here.join("flat.wav"), wav(&[[8192, -8192]; 5000])).unwrap();
    fs::write(here.join("zero.wav"), wav(&[[0, 0]; 5000])).unwrap();
    for (options, what, value) in [
        ("flat.wav", "period", "0.25 and -0.25"),
        ("zero.wav", "period", "0 and 0"),
        ("zero.wav --frequency 5000", "wave", "0 and 0"),
        ("zero.wav --hum --detector mean-return", "period", "0 and 0"),
    ] {
        let told = format!("no {what} {both}{value}: check the wiring");
        fault(here, options, &[&told]);
        let found = run(here, &format!("identify {options}"));
        assert!(!found.err.contains("--detector"), "{}", found.err);
    }
    // A wave on one pick-off, and the other dead.
    let codes: Vec<[i16; 2]> = (0..5000)
        .map(|k| [(9000.0 * (0.335 * f64::from(k)).sin()) as i16, 9])
        .collect();
    fs::write(here.join("one.wav"), wav(&codes)).unwrap();
    let found = done(here, "identify one.wav");
    let dead = "warning: one.wav: S_D is constant at 0.00027";
    assert!(found.err.contains(dead), "{}", found.err);
    // Noise on one pick-off, and the other dead.
    let codes: Vec<[i16; 2]> = silence(0.1)
        .codes(5000)
        .iter()
        .map(|&[c, _]| [c, 9])
        .collect();
    fs::write(here.join("dead.wav"), wav(&codes)).unwrap();
    let dead = "S_D is constant at 0.00027";
    fault(here, "dead.wav", &["no period found", dead]);
}
