//! `antinode identify` on faultless recordings: its rows, in every format.

use std::f64::consts::TAU;
use std::fs;

use crate::common::{
    RATE, README, Row, WAVE, done, names, npy, raw, rows, run, run_with, text, wav,
};

/// The header that the rows must begin with.
const COLUMNS: &str = "time_s,samples,main_amplitude,quadrature_amplitude,angle_rad,phase_rad,\
    frequency_hz,angle_rate_rad_s,decay_rate_s,main_amplitude_std,quadrature_amplitude_std,\
    angle_std_rad,frequency_std_hz,residual_rms,flags,";

#[test]
fn a_wav_file_gives_its_wave_at_the_bound() {
    let directory = tempfile::tempdir().unwrap();
    let pairs = 200_000;
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(pairs))).unwrap();
    let rows = rows(directory.path(), "a.wav");
    // Windows of ten periods, without gap: all samples but those of the search and a rest at the end.
    let windows = pairs as f64 / RATE * WAVE.frequency / 10.0;
    assert!(
        (windows - 14.0..=windows).contains(&(rows.len() as f64)),
        "{}",
        rows.len()
    );
    let mut squares = [[0.0; 2]; 4];
    let mut of_stated = [0.0; 7];
    for row in &rows {
        let (time, samples) = (row.number("time_s"), row.number("samples"));
        assert_eq!(row.text("flags"), "", "{time}");
        let (main, quadrature) = (
            WAVE.main * WAVE.decay(time),
            WAVE.quadrature * WAVE.decay(time),
        );
        // The phase at the same instant, in turns from the nearest whole one.
        let phase = (row.number("phase_rad") - WAVE.phase + TAU * WAVE.frequency * time) / TAU;
        let angle = row.number("angle_rad") - WAVE.angle - WAVE.angle_rate * time;
        let errors = [
            (row.number("main_amplitude") - main, "main_amplitude_std"),
            (
                row.number("quadrature_amplitude") - quadrature,
                "quadrature_amplitude_std",
            ),
            (angle, "angle_std_rad"),
            (
                row.number("frequency_hz") - WAVE.frequency,
                "frequency_std_hz",
            ),
            ((phase - phase.round()) * TAU, "phase_std_rad"),
            (
                row.number("angle_rate_rad_s") - WAVE.angle_rate,
                "angle_rate_std_rad_s",
            ),
            (
                row.number("decay_rate_s") - WAVE.decay_rate,
                "decay_rate_std_s",
            ),
        ];
        for (sum, (error, std)) in of_stated.iter_mut().zip(errors) {
            *sum += (error / row.number(std)).powi(2) / rows.len() as f64;
            assert!(
                error.abs() < 5.0 * row.number(std),
                "{time}: {std}: {error} {}",
                row.number(std)
            );
        }
        // The closed-form Cramér–Rao bounds.
        let power = main * main + quadrature * quadrature;
        let amplitude = WAVE.noise * (2.0 / samples).sqrt();
        let angle =
            WAVE.noise * (power / (2.0 * samples)).sqrt() / (main * main - quadrature * quadrature);
        let frequency = WAVE.noise * (24.0 / (power * samples)).sqrt() * RATE / (TAU * samples);
        for (i, bound) in [amplitude, amplitude, angle, frequency]
            .into_iter()
            .enumerate()
        {
            squares[i][0] += errors[i].0.powi(2);
            squares[i][1] += bound.powi(2);
        }
    }
    for (i, [error, bound]) in squares.into_iter().enumerate() {
        let ratio = (error / bound).sqrt();
        assert!((0.8..1.2).contains(&ratio), "quantity {i}: {ratio}");
    }
    let ratios = of_stated.map(f64::sqrt);
    assert!(
        ratios.iter().all(|ratio| (0.8..1.2).contains(ratio)),
        "{ratios:?}"
    );
}

#[test]
fn the_columns_are_in_their_order() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(2000))).unwrap();
    let csv = run(directory.path(), "identify a.wav --output csv");
    assert!(csv.out.starts_with(COLUMNS), "{}", csv.out);
    let json = run(directory.path(), "identify a.wav --output jsonl");
    let rows = Row::all(&csv.out);
    assert_eq!(json.out.lines().count(), rows.len());
    let names: Vec<&str> = COLUMNS.split_terminator(',').collect();
    for (line, row) in json.out.lines().zip(rows) {
        let object: serde_json::Value = serde_json::from_str(line).unwrap();
        for name in &names {
            match &object[name] {
                serde_json::Value::String(text) => assert_eq!(text, row.text(name)),
                number => assert_eq!(number.as_f64(), Some(row.number(name)), "{name}"),
            }
        }
    }
}

#[test]
fn the_readme_names_every_column() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(2000))).unwrap();
    let csv = run(directory.path(), "identify a.wav --output csv").out;
    for column in csv.lines().next().unwrap().split(',') {
        let is_named = README.contains(&format!("`{column}`"));
        assert!(is_named, "{column} is not in the README");
    }
}

#[test]
fn every_format_gives_the_same_rows() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name| directory.path().join(name);
    let codes = WAVE.codes(20_000);
    fs::write(path("a.wav"), wav(&codes)).unwrap();
    fs::write(path("a.npy"), npy(&codes)).unwrap();
    fs::write(path("a.csv"), text(&codes)).unwrap();
    let expected = rows(directory.path(), "a.wav");
    assert!(expected.len() > 90);
    // Only integers show the converter's rail and steps.
    let converter = "--full-scale 0.999969482421875 --resolution 0.000030517578125";
    let wide = codes
        .as_flattened()
        .iter()
        .flat_map(|&code| (i32::from(code) << 16).to_le_bytes());
    let float = codes
        .as_flattened()
        .iter()
        .flat_map(|&code| (f32::from(code) / 32_768.0).to_le_bytes());
    let unsigned = codes
        .as_flattened()
        .iter()
        .flat_map(|&code| (i32::from(code) + 32_768).to_le_bytes()[..2].to_vec());
    let wide: Vec<u8> = wide.collect();
    let medium: Vec<u8> = wide
        .chunks(4)
        .flat_map(|code| &code[1..])
        .copied()
        .collect();
    let float: Vec<u8> = float.collect();
    let runs = [
        ("a.npy --rate 100000".to_owned(), Vec::new()),
        (format!("a.csv {converter}"), Vec::new()),
        (
            format!("a.csv --columns C,D --rate 1e5 {converter}"),
            Vec::new(),
        ),
        ("- --rate 100000 --raw i16".to_owned(), raw(&codes)),
        ("- --rate 100000 --raw u16".to_owned(), unsigned.collect()),
        (format!("- --rate 100000 --raw i24 {converter}"), medium),
        (format!("- --rate 100000 --raw i32 {converter}"), wide),
        (format!("- --rate 100000 --raw f32 {converter}"), float),
        ("-".to_owned(), wav(&codes)),
    ];
    for (arguments, input) in runs {
        let run = run_with(
            directory.path(),
            &format!("identify --output csv {arguments}"),
            input,
        );
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{arguments}");
        let found = Row::all(&run.out);
        assert_eq!(found.len(), expected.len(), "{arguments}");
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.unnamed(), expected.unnamed(), "{arguments}");
        }
    }
}

#[test]
fn a_given_rate_takes_precedence_over_the_recordings_own() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(2000))).unwrap();
    let own = rows(directory.path(), "a.wav");
    let given = run(directory.path(), "identify --output csv a.wav --rate 50000");
    assert_eq!(
        (given.code, given.err.as_str()),
        (
            0,
            "warning: a.wav: the sample rate is 100000 Hz by its header and 50000 Hz by --rate, which takes precedence; omit \
             --rate if the header is right\n"
        )
    );
    let given = Row::all(&given.out);
    let ratio = own[0].number("frequency_hz") / given[0].number("frequency_hz");
    assert!((ratio - 2.0).abs() < 1e-6, "{ratio}");
    // A difference as small as a clock's error, for which a header has no digits, is no conflict.
    rows(directory.path(), "a.wav --rate 100000.5");
}

#[test]
fn windows_hop_by_blocks() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(10_000))).unwrap();
    let contiguous = rows(directory.path(), "a.wav");
    for pair in contiguous.windows(2) {
        let step = (pair[1].number("time_s") - pair[0].number("time_s")) * RATE;
        assert!((step - pair[0].number("samples")).abs() < 1e-3, "{step}");
    }
    let running = rows(directory.path(), "a.wav --hop 1");
    assert!(running.len() > 9 * contiguous.len(), "{}", running.len());
    // A block is a tenth of a window.
    let block = running[0].number("samples") / 10.0;
    for pair in running.windows(2) {
        let step = (pair[1].number("time_s") - pair[0].number("time_s")) * RATE;
        assert!((step - block).abs() < 1e-3, "{step}");
    }
    // A window of the same blocks is the same, whatever the hop to the next.
    let ten = rows(directory.path(), "a.wav --hop 10");
    assert!(ten.len().abs_diff(contiguous.len()) <= 1, "{}", ten.len());
    for row in &ten {
        let time = row.text("time_s");
        let same = running
            .iter()
            .find(|other| other.text("time_s") == time)
            .unwrap();
        for (name, std) in [
            ("main_amplitude", "main_amplitude_std"),
            ("frequency_hz", "frequency_std_hz"),
        ] {
            let difference = same.number(name) - row.number(name);
            assert!(
                difference.abs() < 0.1 * row.number(std),
                "{time} {name}: {difference}"
            );
        }
    }
    let gaps = rows(directory.path(), "a.wav --hop 20");
    assert!(gaps.len() <= contiguous.len() / 2 + 1, "{}", gaps.len());
}

#[test]
fn windows_are_as_long_as_asked() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("a.wav"), wav(&WAVE.codes(60_000))).unwrap();
    for periods in [2, 10, 50, 1022] {
        let rows = rows(directory.path(), &format!("a.wav --periods {periods}"));
        let wanted = f64::from(periods) * RATE / WAVE.frequency;
        let samples = rows[0].number("samples");
        assert!(
            (samples / wanted - 1.0).abs() < 0.06,
            "{periods}: {samples}"
        );
    }
}

#[test]
fn a_low_frequency_has_all_its_digits() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let frequency = 0.0123456789012;
    let slow = format!(
        "simulate -o a.csv --rate 1 --seconds 400000 --frequency {frequency} --noise 1e-4 --sample f32"
    );
    done(here, &slow);
    let made = run(here, "identify a.csv --rate 1 --periods 1000 --output csv");
    let rows = Row::all(&made.out);
    assert!(rows.len() >= 4, "{}", made.err);
    for row in &rows {
        let off = row.number("frequency_hz") - frequency;
        assert!(off.abs() < 5.0 * row.number("frequency_std_hz"), "{off}");
    }
}

#[test]
fn hum_is_named_and_removed() {
    let directory = tempfile::tempdir().unwrap();
    let mut codes = WAVE.codes(100_000);
    for (k, pair) in codes.iter_mut().enumerate() {
        let phase = TAU * 50.0 * k as f64 / RATE;
        // One per cent of full scale, on both pick-offs.
        *pair = pair.map(|code| code + (327.0 * phase.sin()) as i16);
    }
    fs::write(directory.path().join("hum.wav"), wav(&codes)).unwrap();
    let plain = done(
        directory.path(),
        "identify --periods 50 --output csv hum.wav",
    );
    let told = plain.err;
    assert!(
        told.contains("hum.wav") && told.contains("misfit") && told.contains("--hum"),
        "{told}"
    );
    let clean = rows(directory.path(), "hum.wav --periods 50 --hum");
    assert!(clean.len() > 100 && clean.iter().all(|row| row.text("flags").is_empty()));
}

#[test]
fn rows_go_to_a_file_in_the_format_of_its_name() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    for (options, name, wanted) in [
        ("-o rows.csv", "rows.csv", "--output csv"),
        ("--out rows.jsonl", "rows.jsonl", "--output jsonl"),
        ("-o rows.txt", "rows.txt", ""),
        ("-o rows.csv --output table", "rows.csv", ""),
    ] {
        let written = run(here, &format!("identify a.wav {options}"));
        assert_eq!(
            (written.code, written.out.as_str()),
            (0, ""),
            "{}",
            written.err
        );
        let printed = run(here, &format!("identify a.wav {wanted}"));
        assert_eq!(
            fs::read_to_string(here.join(name)).unwrap(),
            printed.out,
            "{options}"
        );
        let file = fs::read_to_string(here.join(name)).unwrap();
        let of_rows = |line: &&str| !line.starts_with("time_s") && !line.contains("time, s");
        let count = file.lines().filter(of_rows).count();
        let told = format!("{}{name}: {count} rows\n", printed.err);
        assert_eq!(written.err, told);
        fs::remove_file(here.join(name)).unwrap();
    }
    // Rows before a fault are kept; without rows the old file is kept; and no recording is overwritten.
    fs::write(here.join("short.wav"), &wav(&WAVE.codes(20_000))[..70_000]).unwrap();
    let cut = run(here, "identify short.wav -o rows.csv");
    assert_eq!(cut.code, 1);
    let kept = || fs::read_to_string(here.join("rows.csv")).unwrap();
    assert!(kept().lines().count() > 50);
    assert_eq!(run(here, "identify none.wav -o rows.csv").code, 1);
    assert!(kept().lines().count() > 50);
    let over = run(here, "identify a.wav -o ./a.wav");
    assert!(
        over.code == 2 && over.err.contains("is a recording to be read"),
        "{}",
        over.err
    );
    done(here, "identify a.wav");
    assert_eq!(names(here), ["a.wav", "rows.csv", "short.wav"]);
}
