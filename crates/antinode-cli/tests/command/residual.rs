//! `antinode identify --residual`: what the waves leave of the samples, as a recording.

use std::fs;
#[cfg(unix)]
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
#[cfg(unix)]
use std::process::Command;

use crate::common::{
    RATE, Row, Run, WAVE, Wave, done, raw, rms, run, run_with, silence, text, wav,
};
#[cfg(unix)]
use crate::common::{interrupted, piped, shell};

/// The lines of a residual in text: times and both signals.
fn lines(path: &Path) -> Vec<[f64; 3]> {
    let text = fs::read_to_string(path).unwrap();
    let (header, lines) = text.split_once('\n').unwrap();
    assert_eq!(header, "time,c,d");
    let line = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|part| part.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    lines.lines().map(line).collect()
}

/// The residual of a simulated gyro, and the rows.
fn simulated(simulate: &str, identify: &str) -> (Vec<[f64; 3]>, Vec<Row>) {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    done(here, &format!("simulate -o a.npy --sample f64 {simulate}"));
    let arguments =
        format!("identify a.npy --rate 1e5 --output csv --residual left.csv {identify}");
    let told = run(here, &arguments);
    assert_eq!(told.code, 0, "{}", told.err);
    (lines(&here.join("left.csv")), Row::all(&told.out))
}

/// Rms of both signals within these lines, about their mean.
fn scatter(lines: &[[f64; 3]]) -> f64 {
    let both: Vec<f64> = [1, 2]
        .into_iter()
        .flat_map(|signal| {
            let mean = lines.iter().map(|line| line[signal]).sum::<f64>() / lines.len() as f64;
            lines.iter().map(move |line| line[signal] - mean)
        })
        .collect();
    rms(&both)
}

#[test]
fn noise_is_left_of_a_wave_as_its_rows_say() {
    let flaws = "--gain-ratio 1.2 --skew-ns 3000 --pick-off-angle 0.1";
    let pair = [
        ("--angle-rate 3 --decay-rate 2", ""),
        ("--offset-c 0.4 --offset-d -0.3", "--periods 50"),
        // Near a circle the frequency of a window alone depends on how the pattern turns.
        ("--quadrature-amplitude 0.47 --angle-rate 8", ""),
        ("--quadrature-amplitude 0.5", ""),
        ("--quadrature-amplitude -0.3", "--frequency 5300"),
    ];
    for (simulate, identify) in pair {
        for flaws in ["", flaws] {
            let (lines, rows) = simulated(
                &format!("--seconds 0.5 --noise 0.001 {simulate} {flaws}"),
                &format!("{identify} {flaws}"),
            );
            assert_eq!(lines.len(), 50_000);
            let told: Vec<f64> = rows.iter().map(|row| row.number("residual_rms")).collect();
            let found = scatter(&lines);
            // Of a window's 380 samples of both signals, about ten are used up.
            assert!(
                (0.975..1.01).contains(&(found / 0.001)),
                "{simulate}: {found}"
            );
            let ratio = found / rms(&told);
            assert!((0.955..1.015).contains(&ratio), "{simulate}: {ratio}");
        }
    }
    // Nothing but rounding is left of a wave without noise.
    let (lines, _) = simulated("--seconds 0.2 --angle-rate 3 --decay-rate 2", "");
    assert!(scatter(&lines) < 1e-7);
}

#[test]
fn it_has_a_pair_for_each_pair_in_its_place() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let wave = Wave {
        noise: 0.0005,
        ..WAVE
    };
    let mut codes = wave.codes(30_000);
    // 0.02 and −0.03 of full scale.
    codes[12_345][0] += 655;
    codes[20_000][1] -= 983;
    let own = text(&codes);
    fs::write(here.join("a.csv"), &own).unwrap();
    let glitches = [(12_345, 1, 0.02), (20_000, 2, -0.03)];
    for (arguments, first) in [
        ("", 0),
        ("--from 0.1 --to 0.25", 10_000),
        ("--periods 200 --hop 40", 0),
    ] {
        let _ = fs::remove_file(here.join("left.csv"));
        done(
            here,
            &format!("identify a.csv --residual left.csv {arguments}"),
        );
        let lines = lines(&here.join("left.csv"));
        assert_eq!(lines.len(), if first == 0 { 30_000 } else { 15_000 });
        for (k, line) in lines.iter().enumerate() {
            let place = first + k;
            assert!((line[0] - place as f64 / RATE).abs() < 1e-9, "{line:?}");
            for signal in [1, 2] {
                let glitch = glitches.iter().find(|it| (it.0, it.1) == (place, signal));
                let truth = glitch.map_or(0.0, |it| it.2);
                // The wave takes up little of a single sample.
                assert!(
                    (line[signal] - truth).abs() < 0.004,
                    "{arguments}: {place} {line:?}"
                );
            }
        }
    }
    // 1000 pairs are lost: they are zeros, and so are the few that no window has, before the first and beside the loss.
    let lost = 15_000..16_000;
    let kept = own.lines().enumerate();
    let kept = kept.filter(|(line, _)| !lost.contains(&line.wrapping_sub(1)));
    let kept: Vec<&str> = kept.map(|(_, line)| line).collect();
    fs::write(here.join("b.csv"), kept.join("\n")).unwrap();
    let run = run(here, "identify b.csv --residual lost.csv");
    assert!(run.err.contains("1000 samples are lost"), "{}", run.err);
    let lines = lines(&here.join("lost.csv"));
    assert_eq!(lines.len(), 30_000);
    let is_zero = |place: &usize| lines[*place][1..] == [0.0; 2];
    assert!(lost.clone().all(|place| is_zero(&place)));
    // A window has 188 pairs.
    let others = (0..30_000).filter(|place| !lost.contains(place) && is_zero(place));
    let others: Vec<usize> = others.collect();
    assert!(others.len() < 3 * 188, "{others:?}");
    let is_beside = |place: &usize| {
        [0, 15_000, 30_000]
            .iter()
            .any(|end| place.abs_diff(*end) <= 188)
    };
    assert!(others.iter().all(is_beside), "{others:?}");
}

#[test]
fn hum_stays_in_it() {
    let (lines, _) = simulated("--seconds 0.4 --noise 0.0002 --hum 0.01", "");
    let found = scatter(&lines);
    assert!((found / (0.01 / 2f64.sqrt()) - 1.0).abs() < 0.02, "{found}");
}

#[test]
fn a_lost_wave_leaves_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut codes = WAVE.codes(20_000);
    codes.extend(silence(0.005).codes(20_000));
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    let run = run(here, "identify a.wav --output csv --residual left.csv");
    assert!(
        run.err.contains("left.csv: 40000 sample pairs, rms "),
        "{}",
        run.err
    );
    let lines = lines(&here.join("left.csv"));
    assert!(lines[100..19_000].iter().all(|line| line[1..] != [0.0; 2]));
    let is_zero = |line: &[f64; 3]| line[1..] == [0.0; 2];
    assert!(lines[25_000..].iter().all(is_zero));
    let rows = Row::all(&run.out);
    let lost = rows.iter().filter(|row| row.text("flags").contains("lost"));
    let samples = |row: &Row| {
        let (middle, samples) = (RATE * row.number("time_s"), row.number("samples"));
        let first = (middle - 0.5 * (samples - 1.0)).round() as usize;
        first..first + samples as usize
    };
    assert!(lost.clone().count() > 0);
    assert!(lost.flat_map(samples).all(|place| is_zero(&lines[place])));
    // Without any row there is no file.
    let run = run_with(
        here,
        "identify - --raw i16 --rate 1e5 --residual none.wav",
        raw(&silence(0.005).codes(5000)),
    );
    assert_eq!(run.code, 1);
    assert!(
        run.err
            .contains("none.wav: not written, as there are no rows\n"),
        "{}",
        run.err
    );
    assert_eq!(fs::read_dir(here).unwrap().count(), 2);
}

#[test]
fn a_window_with_a_sample_that_is_not_finite_leaves_zeros() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut samples: Vec<f32> = WAVE
        .codes(20_000)
        .concat()
        .into_iter()
        .map(f32::from)
        .collect();
    samples[2 * 9000 + 1] = f32::NAN;
    samples[2 * 15_000] = f32::INFINITY;
    let bytes: Vec<u8> = samples
        .iter()
        .flat_map(|sample| sample.to_le_bytes())
        .collect();
    for options in ["", "--hop 2", "--frequency 5300", "--hum"] {
        let arguments = format!("identify - --raw f32 --rate 1e5 --residual left.csv {options}");
        let run = run_with(here, &arguments, bytes.clone());
        assert!(
            run.err.contains("left.csv: 20000 sample pairs, rms "),
            "{}",
            run.err
        );
        let lines = lines(&here.join("left.csv"));
        let is_zero = |place: &usize| lines[*place][1..] == [0.0; 2];
        assert!([9000, 15_000].iter().all(is_zero), "{options}");
        assert!(
            ![8500, 9500, 14_500, 15_500].iter().any(is_zero),
            "{options}"
        );
        fs::remove_file(here.join("left.csv")).unwrap();
    }
}

#[test]
fn every_format_is_read_again() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    for ending in ["wav", "npy", "csv"] {
        let Run { err, .. } = done(here, &format!("identify a.wav --residual left.{ending}"));
        assert!(
            err.starts_with(&format!("left.{ending}: 20000 sample pairs, rms 0.00")),
            "{err}"
        );
        // It holds no wave.
        let again = run(here, &format!("identify left.{ending} --rate 1e5"));
        assert_eq!(again.code, 1);
        assert!(
            again.err.contains("no period found in 20000 sample pairs"),
            "{}",
            again.err
        );
    }
}

#[test]
fn what_cannot_be_written_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let recording = wav(&WAVE.codes(5000));
    for name in ["a.wav", "b.wav"] {
        fs::write(here.join(name), &recording).unwrap();
    }
    for (arguments, code, told) in [
        (
            "a.wav b.wav --residual left.wav",
            2,
            "--residual is for one recording; identify each by itself",
        ),
        (
            "a.wav -o left.csv --residual ./left.csv",
            2,
            "--residual and --out are the same file; give one of them another name",
        ),
        (
            "a.wav --residual left.flac",
            2,
            "left.flac: the extension is not that of a known format",
        ),
        (
            "a.wav --residual a.wav",
            1,
            "a.wav: this file exists, and is not replaced",
        ),
        (
            "a.wav --residual b.wav",
            1,
            "b.wav: this file exists, and is not replaced",
        ),
        (
            "a.wav --residual none/left.wav",
            1,
            "none/left.wav: there is no directory `none`",
        ),
        (
            "a.wav --rate 99999.5 --residual left.wav",
            2,
            "left.wav: this format cannot hold a sample rate of 99999.5 Hz",
        ),
    ] {
        let run = run(here, &format!("identify {arguments}"));
        assert_eq!(run.code, code, "{}", run.err);
        assert!(run.err.contains(told), "{}", run.err);
        assert_eq!(run.out, "");
    }
    assert_eq!(fs::read_dir(here).unwrap().count(), 2);
    assert_eq!(fs::read(here.join("b.wav")).unwrap(), recording);
}

#[test]
fn a_gap_that_zeros_would_fill_a_disk_with_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let shifted = |shift: f64| {
        let lines = text(&WAVE.codes(10_000));
        let lines = lines
            .lines()
            .enumerate()
            .map(|(at, line)| match (at, line.split_once(',')) {
                (5000.., Some((time, rest))) => {
                    format!("{:.5},{rest}\n", time.parse::<f64>().unwrap() + shift)
                }
                _ => format!("{line}\n"),
            });
        fs::write(here.join("a.csv"), lines.collect::<String>()).unwrap();
        run(here, "identify a.csv --residual left.wav -o rows.csv")
    };
    let found = shifted(1000.0);
    let told =
        " sample pairs in a row are lost, and the file would hold as many zeros; it is not written";
    assert!(found.code == 1 && found.err.contains(told), "{}", found.err);
    assert!(!here.join("left.wav").exists());
    assert!(
        fs::read_to_string(here.join("rows.csv"))
            .unwrap()
            .lines()
            .count()
            > 40
    );
    let found = shifted(1.0);
    assert!(
        found.err.contains("left.wav: 110000 sample pairs"),
        "{}",
        found.err
    );
}

#[cfg(unix)]
#[test]
fn it_is_not_written_without_a_reader_of_the_rows() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(500_000))).unwrap();
    let run = shell(
        here,
        "\"$antinode\" identify a.wav --residual left.wav | head -n 1",
    );
    let told = String::from_utf8(run.stderr).unwrap();
    assert!(
        told.starts_with("left.wav: not written, as the rows' reader has gone; "),
        "{told}"
    );
    assert_eq!(fs::read_dir(here).unwrap().count(), 1);
}

#[cfg(unix)]
#[test]
fn an_interruption_completes_it() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut child = piped(
        Command::new(env!("CARGO_BIN_EXE_antinode"))
            .args(["identify", "-", "--raw", "i16", "--rate", "1e5"])
            .args(["--residual", "left.csv", "--output", "csv"])
            .current_dir(here),
    );
    let mut input = child.stdin.take().unwrap();
    input.write_all(&raw(&WAVE.codes(20_000))).unwrap();
    let mut rows = BufReader::new(child.stdout.take().unwrap());
    let mut table = String::new();
    while !table.contains("\n0.15") {
        assert_ne!(rows.read_line(&mut table).unwrap(), 0);
    }
    let told = interrupted(child, input);
    assert!(
        told.contains("left.csv: ") && told.contains("error: interrupted"),
        "{told}"
    );
    let lines = lines(&here.join("left.csv"));
    assert!((15_000..=20_000).contains(&lines.len()), "{}", lines.len());
    assert_eq!(fs::read_dir(here).unwrap().count(), 1);
}
