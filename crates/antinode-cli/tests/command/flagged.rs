//! `antinode identify` reports, once a recording, how many of its rows are flagged, and by what.

use std::f64::consts::TAU;
use std::fs;
#[cfg(unix)]
use std::{
    io::{BufRead, BufReader, Read, Write},
    process::{Child, ChildStdin, ChildStdout, Command},
};

use crate::common::{RATE, Row, WAVE, beside_flagged, done, identified, run, run_with, wav};
#[cfg(unix)]
use crate::common::{piped, send};

/// A wave with a gap in it.
fn torn() -> Vec<u8> {
    let mut codes = WAVE.codes(60_000);
    codes[20_000..30_000].fill([0, 0]);
    wav(&codes)
}

#[test]
fn flagged_rows_are_reported_in_every_format() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("torn.wav"), torn()).unwrap();
    fs::write(here.join("good.wav"), wav(&WAVE.codes(20_000))).unwrap();
    let csv = done(here, "identify --output csv torn.wav good.wav");
    assert_eq!(beside_flagged(&Row::all(&csv.out), &csv.err), [""; 0]);
    assert!(csv.err.starts_with("warning: torn.wav: "), "{}", csv.err);
    for arguments in ["--output table", "--output jsonl", "--methods all"] {
        let told = run(here, &format!("identify torn.wav good.wav {arguments}"));
        assert_eq!((told.code, told.err.as_str()), (0, csv.err.as_str()));
    }
    // A fault after them is reported last, and its exit code stays.
    fs::write(here.join("torn.wav"), &torn()[..200_003]).unwrap();
    let cut = run(here, "identify --output csv torn.wav none.wav");
    assert_eq!(cut.code, 1);
    let others = beside_flagged(&Row::all(&cut.out), &cut.err);
    assert_eq!(others.len(), 2, "{}", cut.err);
    assert!(cut.err.starts_with("warning: torn.wav: "), "{}", cut.err);
    assert!(others[0].starts_with("error: torn.wav: at its end: "));
    assert!(others[1].starts_with("error: none.wav: "));
}

#[test]
fn misfits_of_a_known_cause_have_no_other_remedy() {
    let directory = tempfile::tempdir().unwrap();
    // A gain that the rectified mains modulate.
    let samples = (0..100_000).flat_map(|k| {
        let time = f64::from(k) / RATE;
        let gain = 1.0 + 0.2 * (TAU * 100.0 * time).cos();
        [0.5, 0.2].map(|share| share * gain * (TAU * 5321.7 * time).cos())
    });
    let bytes = samples.flat_map(|sample| (sample as f32).to_le_bytes());
    let arguments = "identify - --raw f32 --rate 100000";
    let told = run_with(directory.path(), arguments, bytes.collect()).err;
    let lines: Vec<&str> = told.lines().collect();
    let [flagged, cause] = lines[..] else {
        panic!("{told}")
    };
    let (_, misfits) = flagged.split_once(" flagged: misfit ").unwrap();
    assert!(misfits.parse::<u32>().unwrap() > 400, "{told}");
    assert!(
        cause.contains(" Hz: there is mains ripple on a gain"),
        "{told}"
    );
}

#[test]
fn longer_windows_show_a_pattern_that_noise_makes_a_circle() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let wave = "--main-amplitude 0.4 --quadrature-amplitude -0.37 --noise 0.1";
    done(here, &format!("simulate -o a.wav --seconds 2 {wave}"));
    let (told, rows, flagged) = identified(here, "--periods 20");
    assert!(10 * flagged > 9 * rows.len(), "{flagged}");
    assert!(told.err.contains("give a larger --periods"), "{}", told.err);
    // Nothing else interrupts the angle.
    let flags: Vec<&str> = rows.iter().map(|row| row.text("flags")).collect();
    let mut after = flags
        .windows(2)
        .filter(|pair| pair[1].contains("reacquired"));
    assert!(after.all(|pair| pair[0].contains("circular")), "{flags:?}");
    let (told, _, flagged) = identified(here, "--periods 400");
    assert_eq!((flagged, told.err.as_str()), (0, ""));
}

/// A command that identifies from a pipe, and has printed rows of the wave after the gap.
#[cfg(unix)]
struct Begun {
    child: Child,
    input: ChildStdin,
    rows: BufReader<ChildStdout>,
    /// Its output so far.
    text: String,
}

#[cfg(unix)]
impl Begun {
    /// The bytes that it has been given.
    const GIVEN: usize = 150_000;

    fn new(command: &mut Command) -> Self {
        let mut child = piped(command.args(["identify", "-", "--output", "csv"]));
        let mut input = child.stdin.take().unwrap();
        input.write_all(&torn()[..Self::GIVEN]).unwrap();
        let mut rows = BufReader::new(child.stdout.take().unwrap());
        let mut text = String::new();
        // The wave returns at 0.3 s.
        while !text.contains("\n0.3") {
            assert_ne!(rows.read_line(&mut text).unwrap(), 0);
        }
        Self {
            child,
            input,
            rows,
            text,
        }
    }
}

#[cfg(unix)]
#[test]
fn an_interruption_reports_them_too() {
    for (signal, goes_on) in [("-INT", false), ("-TERM", true)] {
        let mut begun = Begun::new(&mut Command::new(env!("CARGO_BIN_EXE_antinode")));
        send(signal, &begun.child);
        if goes_on {
            // Samples that arrive meanwhile are not identified.
            let _ = begun.input.write_all(&torn()[Begun::GIVEN..]);
        }
        let output = begun.child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{signal}");
        begun.rows.read_to_string(&mut begun.text).unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        let others = beside_flagged(&Row::all(&begun.text), &told);
        assert_eq!(
            others,
            ["error: interrupted; the rows printed so far are good"]
        );
        drop(begun.input);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_begun_by_nohup_outlives_its_terminal() {
    let mut begun = Begun::new(Command::new("nohup").arg(env!("CARGO_BIN_EXE_antinode")));
    send("-HUP", &begun.child);
    begun.input.write_all(&torn()[Begun::GIVEN..]).unwrap();
    drop(begun.input);
    begun.rows.read_to_string(&mut begun.text).unwrap();
    let last = Row::all(&begun.text).pop().unwrap();
    assert!(last.number("time_s") > 0.59, "{}", begun.text);
    assert_ne!(begun.child.wait().unwrap().code(), Some(130));
}
