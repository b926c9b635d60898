//! `antinode identify` on a pipe that stays open: faults of its samples are reported all the same.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use crate::common::{WAVE, raw, run_with};

/// Far more than a machine under load needs for a second of samples.
const PATIENCE: Duration = Duration::from_secs(60);

fn start() -> Child {
    Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["identify", "-", "--raw", "i16", "--rate", "1e5"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The messages while the pipe is open after these samples, and once it is closed after as many more.
fn told(codes: &[[i16; 2]]) -> [String; 2] {
    let mut run = start();
    let mut input = run.stdin.take().unwrap();
    input.write_all(&raw(codes)).unwrap();
    let mut error = BufReader::new(run.stderr.take().unwrap());
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut line = String::new();
        error.read_line(&mut line).unwrap();
        sender.send(line).unwrap();
        let mut rest = String::new();
        error.read_to_string(&mut rest).unwrap();
        sender.send(rest).unwrap();
    });
    let first = receiver.recv_timeout(PATIENCE);
    input.write_all(&raw(codes)).unwrap();
    drop(input);
    run.wait().unwrap();
    let first = first.expect("something is told while the pipe is open");
    [first, receiver.recv().unwrap()]
}

#[test]
fn one_signal_on_both_pick_offs_is_reported_once() {
    let same: Vec<[i16; 2]> = WAVE.codes(120_000).iter().map(|&[c, _]| [c, c]).collect();
    let [first, rest] = told(&same);
    let expected = "warning: standard input: so far S_C and S_D are the same samples: ";
    assert!(first.starts_with(expected), "{first}");
    assert!(!rest.contains("the same samples"), "{rest}");
}

#[test]
fn constant_samples_are_reported() {
    let [first, rest] = told(&[[100, -100]; 120_000]);
    let expected = "warning: standard input: so far S_C and S_D are constant at ";
    assert!(first.starts_with(expected), "{first}");
    // There is no row, and the reason is reported.
    assert_eq!(rest.lines().count(), 1, "{rest}");
    assert!(
        rest.starts_with("error: standard input: no period found in 240000 "),
        "{rest}"
    );
}

#[test]
fn only_a_second_of_samples_without_a_row_shows_a_constant_pick_off() {
    let directory = tempfile::tempdir().unwrap();
    let mut late = vec![[100, -100]; 50_000];
    late.extend(WAVE.codes(100_000));
    // The flags of rows show a dead pick-off.
    let dead: Vec<[i16; 2]> = WAVE.codes(120_000).iter().map(|&[c, _]| [c, 9]).collect();
    for codes in [late, dead] {
        let arguments = "identify - --raw i16 --rate 1e5";
        let run = run_with(directory.path(), arguments, raw(&codes));
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(!run.err.contains("so far"), "{}", run.err);
    }
}
