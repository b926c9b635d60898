//! `antinode identify` on samples that are not what they are taken for: rows would look plausible.

use crate::common::{
    RATE, Row, WAVE, Wave, done, fault, npy, printed, raw, rows_of, run, run_with, text, wav,
};

#[test]
fn one_pick_off_stored_after_the_other_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let codes = WAVE.codes(20_000);
    let [c, d] = [0, 1].map(|channel| codes.iter().map(move |pair| pair[channel]));
    let behind: Vec<u8> = c.chain(d).flat_map(i16::to_le_bytes).collect();
    for (bytes, bits) in [(behind, "i16"), (raw(&codes), "i32")] {
        let arguments = format!("identify - --raw {bits} --rate 100000");
        let run = run_with(directory.path(), &arguments, bytes);
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(
            run.err
                .contains("warning: standard input: both pick-offs seem to be one signal"),
            "{bits}: {}",
            run.err
        );
    }
}

#[test]
fn one_signal_on_both_pick_offs_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let mut next = codes.clone();
    next[19_999][0] += 1;
    let same: Vec<[i16; 2]> = codes.iter().map(|&[c, _]| [c, c]).collect();
    let negative: Vec<[i16; 2]> = codes.iter().map(|&[c, _]| [c, -c]).collect();
    let nearly: Vec<[i16; 2]> = codes.iter().zip(&next).map(|(a, b)| [a[0], b[0]]).collect();
    for (codes, told) in [
        (same, Some("S_C and S_D are the same samples: ")),
        (negative, Some("are the same samples but for the sign: ")),
        // Equal but for one code in the last pair of all.
        (nearly, None),
        // A generator's signal on two inputs differs by noise, if only by that of their codes.
        (codes, None),
    ] {
        for (name, bytes) in [("a.wav", wav(&codes)), ("a.csv", text(&codes).into_bytes())] {
            std::fs::write(here.join(name), bytes).unwrap();
            let run = done(here, &format!("identify --output csv {name}"));
            let Some(told) = told else {
                assert_eq!(run.err, "");
                continue;
            };
            assert_eq!(run.err.lines().count(), 1, "{}", run.err);
            let is_told = run
                .err
                .starts_with(&format!("warning: {name}: S_C and S_D"));
            assert!(is_told && run.err.contains(told), "{}", run.err);
        }
    }
}

#[test]
fn a_recording_given_twice_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for name in ["a.wav", "b.wav"] {
        std::fs::write(here.join(name), wav(&WAVE.codes(2000))).unwrap();
    }
    let told = |files: &str| run(here, &format!("identify {files}")).err;
    assert_eq!(told("a.wav b.wav"), "");
    assert_eq!(
        told("a.wav b.wav ./a.wav"),
        "warning: ./a.wav is given twice\n"
    );
}

#[test]
fn a_pick_off_that_is_not_connected_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Noise of one code on S_D.
    let codes = WAVE.codes(20_000).into_iter().enumerate();
    let codes: Vec<[i16; 2]> = codes
        .map(|(k, [c, _])| [c, (k * 7919 % 13 / 5) as i16])
        .collect();
    std::fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    let run = run(here, "identify --output csv a.wav");
    let told = "warning: a.wav: S_D shows no wave in any row: unless the pattern stands on";
    assert!(run.err.contains(told), "{}", run.err);
}

#[test]
fn a_time_among_raw_samples_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let pair = |(k, pair): (usize, &[i16; 2])| [k as f64 / RATE, f64::from(pair[0])];
    let codes = WAVE.codes(20_000);
    let pairs: Vec<[f64; 2]> = codes.iter().enumerate().map(pair).collect();
    let bytes = |bits: &str| -> Vec<u8> {
        let samples = pairs.as_flattened().iter();
        match bits {
            "f32" => samples.flat_map(|&x| (x as f32).to_le_bytes()).collect(),
            _ => samples.flat_map(|x| x.to_le_bytes()).collect(),
        }
    };
    for bits in ["f32", "f64"] {
        let arguments = format!("- --raw {bits} --rate 100000");
        let told = ["standard input: S_C rises in equal steps"];
        let rows = fault(directory.path(), &arguments, bytes(bits), &told);
        assert!(rows.is_empty());
        // Fewer pairs are checked once all are read; other faults are reported too.
        let all = bytes(bits);
        let few = all.len() / codes.len() * 300;
        let cut = "the data end in the middle";
        for (more, parts) in [(0, &told[..]), (3, &[told[0], cut])] {
            let run = run_with(
                directory.path(),
                &format!("identify {arguments} --periods 20"),
                all[..few + more].to_vec(),
            );
            assert_eq!(run.code, 1);
            for part in parts {
                assert!(run.err.contains(part), "{bits}: {}", run.err);
            }
            assert_eq!(run.err.lines().count(), parts.len(), "{}", run.err);
        }
    }
}

#[test]
fn signals_with_times_that_differ_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(5000);
    let expected = rows_of(here, &text(&codes), "--to 0.045");
    // A count of lines is no time of its own.
    let counted = printed("", &codes, |k, [c, d]| {
        format!("{:.5},{c},{},{d}", k as f64 / RATE, k + 5)
    });
    assert_eq!(
        rows_of(here, &counted, "--columns 1,2,4 --to 0.045"),
        expected
    );
    // S_D begins so many samples later.
    for (late, told) in [
        (0, None),
        (
            3,
            Some(
                "differ by 3.00 samples, but both signals are read with those in column 1; give --skew-ns=30000,",
            ),
        ),
        (
            200,
            Some(
                "differ by 200.00 samples, but both signals are read with those in column 1; leave out",
            ),
        ),
    ] {
        let pairs = codes.iter().zip(&codes[late..]).enumerate();
        let pasted: String = pairs
            .map(|(k, ([c, _], [_, d]))| {
                let [time, own] = [k, k + late].map(|k| k as f64 / RATE);
                format!("{time:.5},{c},{own:.5},{d}\n")
            })
            .collect();
        std::fs::write(here.join("a.csv"), pasted).unwrap();
        let run = run(
            here,
            "identify --output csv a.csv --columns 1,2,4 --skew-ns=30000 --to 0.045",
        );
        let Some(told) = told else {
            assert_eq!(run.err, "");
            continue;
        };
        let told = format!(
            "warning: a.csv: the times of S_C in column 1 and those of S_D in column 3 {told}"
        );
        assert!(run.err.starts_with(&told), "{}", run.err);
        if late == 3 {
            // The remedy works.
            let amplitude = |rows: &[Row]| rows[0].number("main_amplitude");
            let found = amplitude(&Row::all(&run.out)) / 32_768.0;
            assert!((found / amplitude(&expected) - 1.0).abs() < 1e-3, "{found}");
        }
    }
}

#[test]
fn amplitudes_outside_the_range_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let codes = WAVE.codes(20_000);
    for (scale, is_beyond) in [
        (1e-43, true),
        (1e-21, true),
        (1e-18, false),
        (1e12, false),
        (1e14, true),
    ] {
        let samples = codes.as_flattened().iter();
        let bytes = samples.flat_map(|&code| (scale * f32::from(code)).to_le_bytes());
        // In a file, the converter's step is looked for.
        std::fs::write(directory.path().join("a.raw"), bytes.collect::<Vec<_>>()).unwrap();
        let run = run(directory.path(), "identify a.raw --raw f32 --rate 100000");
        let is_told = run.err.contains("beyond the range of 1e-15 to 1e17");
        assert_eq!(is_told, is_beyond, "{scale}: {}", run.err);
        assert!(is_beyond || run.code == 0, "{scale}: {}", run.err);
    }
}

#[test]
fn an_offset_that_single_precision_rounds_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let codes = Wave {
        noise: 1e-5,
        ..WAVE
    }
    .codes(20_000);
    for (offset, is_told) in [(80.0, true), (8.0, false), (0.0, false)] {
        let samples = codes.as_flattened().iter();
        let bytes = samples.flat_map(|&code| (f32::from(code) / 32_768.0 + offset).to_le_bytes());
        let run = run_with(
            directory.path(),
            "identify - --raw f32 --rate 100000",
            bytes.collect(),
        );
        assert_eq!(run.code, 0, "{}", run.err);
        let told = "warning: standard input: the offset is ";
        assert_eq!(run.err.contains(told), is_told, "{offset}: {}", run.err);
    }
}

#[test]
fn a_gain_that_ripples_with_the_mains_is_reported_in_place_of_remedies_for_misfits() {
    let directory = tempfile::tempdir().unwrap();
    let codes = WAVE.codes(100_000);
    for (ripple, is_told) in [(0.02, true), (0.0, false)] {
        let bytes = codes.iter().enumerate().flat_map(|(k, pair)| {
            let gain = 1.0 + ripple * (std::f64::consts::TAU * 100.0 * k as f64 / RATE).cos();
            pair.map(|code| ((gain * f64::from(code)) as i16).to_le_bytes())
        });
        let run = run_with(
            directory.path(),
            "identify - --raw i16 --rate 100000",
            bytes.flatten().collect(),
        );
        assert_eq!(run.code, 0, "{}", run.err);
        let told = run.err.contains("oscillates by")
            && run.err.contains("at 100 Hz")
            && run.err.contains("misfit");
        assert_eq!(told, is_told, "{ripple}: {}", run.err);
        assert!(!run.err.contains("give --hum"), "{}", run.err);
    }
}

#[test]
fn rows_given_as_a_recording_and_a_recording_given_as_rows_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let write = |name: &str, bytes: &[u8]| std::fs::write(here.join(name), bytes).unwrap();
    write("it.wav", &wav(&codes));
    write("it.npy", &npy(&codes));
    write("it.csv", text(&codes).as_bytes());
    let printed = |format: &str| {
        let run = run(here, &format!("identify it.wav --output {format}"));
        run.out
    };
    let (rows, lines) = (printed("csv"), printed("jsonl"));
    write("rows.csv", rows.as_bytes());
    write("rows.jsonl", lines.as_bytes());
    write("table.txt", printed("table").as_bytes());
    let both = run(here, "identify it.wav it.npy --rate 100000");
    write("both.txt", both.out.as_bytes());
    let mut broken: Vec<&str> = lines.lines().take(20).collect();
    broken[10] = "[0.1, 190]";
    write("broken.jsonl", broken.join("\n").as_bytes());
    let mut broken: Vec<&str> = rows.lines().take(20).collect();
    broken[10] = "0.1,190";
    write("broken.csv", broken.join("\n").as_bytes());
    for (arguments, told) in [
        ("identify rows.csv", "rows.csv:1: these are rows printed by"),
        (
            "identify table.txt",
            "table.txt:1: these are rows printed by",
        ),
        ("identify both.txt", "both.txt:2: these are rows printed by"),
        (
            "resonator table.txt",
            "table.txt: this is the table for reading",
        ),
        (
            "plot both.txt -o it.svg",
            "both.txt: this is the table for reading",
        ),
        (
            "resonator broken.jsonl",
            "broken.jsonl, line 11: this is not a JSON object: invalid type: sequence, expected a map; remove the line",
        ),
        (
            "identify rows.jsonl",
            "rows.jsonl:1: these are rows printed by",
        ),
        (
            "resonator it.wav",
            "it.wav: this is not text; give the rows that ",
        ),
        (
            "calibrate it.npy",
            "it.npy: this is not text; give the rows that ",
        ),
        (
            "plot it.csv -o it.svg",
            "it.csv: no column time_s in its first line; give the rows that ",
        ),
        ("resonator -", "standard input: there is nothing in it"),
        (
            "resonator broken.csv",
            "broken.csv, line 11: found 2 fields where the first line has 21; remove",
        ),
    ] {
        let run = run(here, arguments);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{arguments}");
        let is_told = run.err.starts_with("error: ") && run.err.contains(told);
        assert!(is_told, "{arguments}: {}", run.err);
    }
}
