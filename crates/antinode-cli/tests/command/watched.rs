//! `antinode identify` on a terminal: it states on standard error what it reads.
#![cfg(unix)]

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::common::{WAVE, text, wav};
use serialport::{SerialPort, TTYPort};

#[test]
fn a_recording_is_not_read_from_a_terminal() {
    let (_terminal, end) = TTYPort::pair().unwrap();
    let input = File::options().read(true).open(end.name().unwrap());
    let run = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["identify", "-"])
        .stdin(Stdio::from(input.unwrap()))
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(1));
    let told = "error: standard input: this is a terminal; pipe a recording into the command, or name a file\n";
    assert_eq!(String::from_utf8(run.stderr).unwrap(), told);
}

/// Standard error as a terminal shows it.
fn shown(directory: &Path, arguments: &[&str]) -> String {
    let (mut terminal, end) = TTYPort::pair().unwrap();
    terminal.set_timeout(Duration::from_millis(200)).unwrap();
    let error = File::options().write(true).open(end.name().unwrap());
    let run = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["identify", "--output", "csv"])
        .args(arguments)
        .current_dir(directory)
        .stderr(Stdio::from(error.unwrap()))
        .output()
        .unwrap();
    assert!(run.status.success());
    assert!(run.stdout.starts_with(b"time_s,"));
    let mut text = Vec::new();
    let mut buffer = [0; 1024];
    while let Ok(length @ 1..) = terminal.read(&mut buffer) {
        text.extend_from_slice(&buffer[..length]);
    }
    String::from_utf8(text).unwrap().replace('\r', "")
}

#[test]
fn a_recording_is_named_with_its_format_length_and_rate() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.wav"), wav(&WAVE.codes(5000))).unwrap();
    fs::write(here.join("a.csv"), text(&WAVE.codes(5000))).unwrap();
    fs::write(here.join("a.bin"), crate::common::raw(&WAVE.codes(5000))).unwrap();
    let sound = "a.wav: WAV of 16-bit integers, 5000 sample pairs at 100000 Hz\n";
    assert_eq!(shown(here, &["a.wav"]), sound);
    // A rate that contradicts the header is warned of first.
    let told = shown(here, &["a.wav", "--rate", "5e4"]);
    let (warning, told) = told.split_once('\n').unwrap();
    assert!(warning.starts_with("warning: a.wav: the sample rate is 100000 Hz by its header and "));
    assert_eq!(told, sound.replace("100000", "50000"));
    // The length of a text is known at its end.
    let lines = "a.csv: CSV at 100000 Hz\na.csv: 5000 sample pairs\n";
    assert_eq!(shown(here, &["a.csv"]), lines);
    assert_eq!(shown(here, &["a.wav", "a.csv"]), format!("{sound}{lines}"));
    let raw = "a.bin: raw 16-bit integers, 5000 sample pairs at 50000 Hz\n";
    assert_eq!(
        shown(here, &["a.bin", "--raw", "i16", "--rate", "5e4"]),
        raw
    );
}
