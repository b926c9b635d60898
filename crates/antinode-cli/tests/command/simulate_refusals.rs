//! `antinode simulate` if it cannot do what is asked: no existing file is harmed.

use std::fs;

use crate::common::{done, names, run};

#[test]
fn options_that_make_no_sense_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let cases = [
        ("", "--out <FILE>"),
        (
            "-o a.ogg",
            "a.ogg: the extension is not that of a known format; end the name in .wav, .csv or .npy",
        ),
        ("-o a", "a: the extension is not that of a known format"),
        ("-o a.wav --sample f64", "--sample f32"),
        ("-o a.wav --rate 44100.5", "whole number of Hz"),
        ("-o a.wav --rate -1", "--rate: it must be"),
        ("-o a.wav --seconds 0", "--seconds: 0 s"),
        ("-o a.wav --seconds -1", "--seconds: -1 s"),
        ("-o a.wav --seconds nan", "--seconds: NaN s"),
        ("-o a.wav --seconds 1e9", "1e12 sample pairs"),
        (
            "-o a.wav --seconds 2e4",
            "a.wav: 2000000000 sample pairs: a WAV file holds no more than 4 GiB; write a .npy file",
        ),
        (
            "-o a.wav --main-amplitude 0",
            "--main-amplitude: it must be",
        ),
        (
            "-o a.wav --quadrature-amplitude -0.6",
            "for the same wave give --main-amplitude 0.6 --quadrature-amplitude -0.5, an angle 45° greater and a phase 90° less",
        ),
        (
            "-o a.wav --quadrature-amplitude 0.6",
            "for the same wave give --main-amplitude 0.6 --quadrature-amplitude 0.5, an angle 45° less and a phase 90° less",
        ),
        ("-o a.wav --frequency 0", "--frequency: it must be"),
        ("-o a.wav --frequency 50000", "half of --rate, 50000 Hz"),
        ("-o a.wav --frequency 20000 --rate 39000", "raise --rate"),
        (
            "-o a.wav --frequency 49999 --frequency-rate 2",
            "--frequency: 49999 Hz drifts to 50001 Hz",
        ),
        (
            "-o a.wav --frequency-rate -6000",
            "--frequency-rate: 5332 Hz drifts to -668 Hz, but must stay above 0; give a smaller rate",
        ),
        (
            "-o a.wav --damping-split inf",
            "--damping-split: it must be",
        ),
        (
            "-o a.wav --frequency-angle nan",
            "--frequency-angle: it must be",
        ),
        ("-o a.wav --noise -0.1", "--noise: it must be"),
        ("-o a.wav --skew-ns nan", "--skew-ns: it must be"),
        ("-o a.wav --jitter-ns -1", "--jitter-ns: it must be"),
        (
            "-o a.wav --pick-off-angle inf",
            "--pick-off-angle: it must be",
        ),
        ("-o a.wav --clip 0", "--clip: it must be"),
        ("-o a.wav --bits 1", "--bits: it must be"),
        ("-o a.wav --full-scale 2", "--bits"),
        (
            "-o a.wav --clip-span 0:1",
            "it must be FROM:TO:LEVEL, as in 0.2:0.3:0.4",
        ),
        (
            "-o a.wav --lost 10",
            "it must be INDEX:COUNT, as in 500000:3",
        ),
        (
            "-o a.wav --angle 30deg",
            "'--angle <RAD>': it must be a number, without its unit",
        ),
        (
            "-o a.wav --seed -1",
            "'--seed <SEED>': it must be a whole number from 0 on",
        ),
        (
            "-o a.wav --clip-span 0.5:0.2:1",
            "--clip-span: it goes from 0.5 s to 0.2 s",
        ),
        ("-o a.wav --lost 5", "INDEX:COUNT"),
        ("-o a.wav --lost 5:0", "COUNT is 0"),
        ("-o a.wav --lost 100000:5", "--lost: it begins at 1"),
        ("-o a.wav --dropout 0:1:some", "zero, hold or noise"),
        (
            "-o a.wav --dropout 0:1:zero:e",
            "is not a channel; give c or d",
        ),
        (
            "-o a.wav --dropout 0.1:0.3:zero --dropout 0.2:0.4:hold",
            "--dropout: two of them overlap",
        ),
        (
            "-o a.wav --dropout 5:6:zero",
            "--dropout: it begins at 5 s, but the recording ends at 1 s",
        ),
    ];
    for (arguments, told) in cases {
        let run = run(here, &format!("simulate {arguments}"));
        assert_eq!(
            (run.code, run.out.as_str()),
            (2, ""),
            "{arguments}: {}",
            run.err
        );
        assert!(
            run.err.starts_with("error: ") && run.err.contains(told),
            "{arguments}: {}",
            run.err
        );
    }
    assert_eq!(fs::read_dir(here).unwrap().count(), 0);
}

#[test]
fn files_are_replaced_only_when_whole() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.npy"), "good").unwrap();
    fs::write(here.join("a.npy.json"), "true").unwrap();
    // The noise leaves single precision after some samples.
    let overflow = run(
        here,
        "simulate -o a.npy --sample f32 --noise 1.5e38 --seconds 10",
    );
    assert_eq!(overflow.code, 1);
    assert!(
        overflow.err.starts_with("error: a.npy: sample pair "),
        "{}",
        overflow.err
    );
    assert_eq!(fs::read(here.join("a.npy")).unwrap(), b"good");
    assert_eq!(fs::read(here.join("a.npy.json")).unwrap(), b"true");
    assert_eq!(names(here), ["a.npy", "a.npy.json"]);
    // If the truth cannot be written, there is no recording either.
    fs::remove_file(here.join("a.npy.json")).unwrap();
    fs::create_dir(here.join("a.npy.json")).unwrap();
    let taken = run(here, "simulate -o a.npy --seconds 0.01");
    assert_eq!(taken.code, 1);
    assert!(
        taken.err.starts_with("error: a.npy.json: "),
        "{}",
        taken.err
    );
    assert_eq!(fs::read(here.join("a.npy")).unwrap(), b"good");
    assert_eq!(names(here), ["a.npy", "a.npy.json"]);
    // Complete files replace the old ones.
    fs::remove_dir(here.join("a.npy.json")).unwrap();
    fs::write(here.join("a.npy.json"), "true").unwrap();
    let whole = run(here, "simulate -o a.npy --seconds 0.01");
    assert_eq!((whole.code, whole.err.as_str()), (0, ""));
    assert_eq!(
        whole.out,
        "a.npy: 1000 sample pairs at 100000 Hz; the truth is in a.npy.json\n"
    );
    assert!(
        fs::read(here.join("a.npy"))
            .unwrap()
            .starts_with(b"\x93NUMPY")
    );
    assert!(fs::read(here.join("a.npy.json")).unwrap().starts_with(b"{"));
}

#[test]
fn a_missing_directory_is_reported() {
    let directory = tempfile::tempdir().unwrap();
    let run = run(directory.path(), "simulate -o none/a.wav");
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert_eq!(
        run.err,
        "error: none/a.wav: there is no directory `none`; make it first, or correct the path\n"
    );
}

#[cfg(unix)]
#[test]
fn an_interruption_leaves_nothing_behind() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    use crate::common::send;

    for signal in ["-INT", "-TERM"] {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path();
        fs::write(here.join("a.wav"), "good").unwrap();
        fs::write(here.join("a.wav.json"), "true").unwrap();
        let child = Command::new(env!("CARGO_BIN_EXE_antinode"))
            .current_dir(here)
            .args(["simulate", "-o", "a.wav", "--seconds", "10000"])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Both files are begun before the first sample.
        let begun = Instant::now();
        while fs::read_dir(here).unwrap().count() < 4 {
            assert!(begun.elapsed() < Duration::from_secs(10));
        }
        send(signal, &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{signal}");
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(
            told,
            "error: a.wav: interrupted, and not written; run it again\n"
        );
        assert_eq!(fs::read_dir(here).unwrap().count(), 2, "{signal}");
        assert_eq!(fs::read(here.join("a.wav")).unwrap(), b"good");
        assert_eq!(fs::read(here.join("a.wav.json")).unwrap(), b"true");
    }
}

#[test]
fn a_recording_that_was_not_simulated_is_not_overwritten() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), "recorded").unwrap();
    let refused = run(here, "simulate -o a.wav");
    assert_eq!(
        (refused.code, refused.err.as_str()),
        (
            1,
            "error: a.wav: this file exists, but no a.wav.json does, so it was not simulated and is not replaced; give another name, or delete it first\n"
        )
    );
    assert_eq!(fs::read(here.join("a.wav")).unwrap(), b"recorded");
    for _ in 0..2 {
        done(here, "simulate -o b.wav --seconds 0.1");
    }
}
