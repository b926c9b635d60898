//! What is left, and what is said, if the disk is full.
#![cfg(unix)]

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::{WAVE, names, run, shell, wav};

/// Runs the command where no file may grow beyond 8 blocks of 512 bytes; it must fail with these messages.
fn full(here: &Path, arguments: &str, told: &str) {
    let line = format!("trap '' XFSZ; ulimit -f 8; \"$antinode\" {arguments}");
    let full = shell(here, &line);
    let err = String::from_utf8(full.stderr).unwrap();
    // The system's own words.
    let err = err.replace("File too large (os error 27)", "full");
    assert_eq!(
        (full.status.code(), err.as_str()),
        (Some(1), told),
        "{arguments}"
    );
    assert!(full.stdout.is_empty(), "{arguments}");
}

#[test]
fn rows_that_the_disk_holds_are_kept() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    let all = run(here, "identify a.wav --output csv").out;
    full(
        here,
        "identify a.wav a.wav -o rows.csv",
        "warning: a.wav is given twice\nrows.csv: the rows up to this point are written\n\
         error: the output cannot be written: rows.csv: full; check the disk or the pipe\n",
    );
    let rows = fs::read_to_string(here.join("rows.csv")).unwrap();
    assert!(rows.len() > 2000 && rows.ends_with('\n') && all.starts_with(&rows));
    assert_eq!(names(here), ["a.wav", "rows.csv"]);
}

#[test]
fn no_part_of_a_recording_or_a_figure_is_left() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    fs::write(
        here.join("rows.csv"),
        run(here, "identify a.wav --output csv").out,
    )
    .unwrap();
    let remedy = "check that its directory exists, is writable and has free space\n";
    for (arguments, name, fault) in [
        ("simulate -o", "new.wav", "full"),
        ("simulate -o", "new.csv", "full"),
        ("simulate -o", "new.npy", "full"),
        ("plot rows.csv -o", "new.svg", "full"),
        (
            "plot rows.csv -o",
            "new.png",
            "the image is not stored whole",
        ),
    ] {
        let told = format!("error: {name}: cannot be written: {fault}; {remedy}");
        full(here, &format!("{arguments} {name}"), &told);
        assert_eq!(names(here), ["a.wav", "rows.csv"]);
    }
    let told = format!("error: it/figure-1.csv: cannot be written: full; {remedy}");
    full(here, "study -o it --runs 1", &told);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    for arguments in [
        "",
        "identify a.wav",
        "completions bash",
        "simulate -o b.wav",
        "--help",
        "identify -h",
        "--version",
    ] {
        let full = shell(here, &format!("\"$antinode\" {arguments} > /dev/full"));
        assert_eq!(
            (
                full.status.code(),
                String::from_utf8(full.stderr).unwrap().as_str()
            ),
            (
                Some(1),
                "error: the output cannot be written: No space left on device (os error 28); check the disk or the pipe\n"
            ),
            "{arguments}"
        );
    }
}

#[test]
fn rows_are_written_though_nobody_reads_the_messages() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let recording = wav(&WAVE.codes(20_000));
    let mut child = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .current_dir(here)
        .args(["identify", "-", "-o", "rows.csv"])
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Closed before there can be a message: how many rows there are.
    drop(child.stderr.take());
    child.stdin.take().unwrap().write_all(&recording).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(names(here), ["rows.csv"]);
}
