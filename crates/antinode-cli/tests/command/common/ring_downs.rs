//! Rows of simulated ring-downs, and what `antinode resonator` finds in them.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use super::{Run, done, run, run_with};

/// Rows of a simulated ring-down, in a file.
pub fn rows(here: &Path, simulated: &str, identified: &str) {
    done(here, &format!("simulate -o it.wav {simulated}"));
    let rows = done(here, &format!("identify --output csv {identified} it.wav"));
    fs::write(here.join("rows.csv"), rows.out).unwrap();
}

/// A quantity of the resonator as CSV tells it, and its deviation.
pub fn of_resonator(out: &str, quantity: &str) -> (f64, f64) {
    of_run(out, "", quantity)
}

/// The same of a run, from 1.
pub fn of_run(out: &str, run: &str, quantity: &str) -> (f64, f64) {
    let line = out
        .lines()
        .find_map(|line| line.strip_prefix(&format!("{run},{quantity},")));
    let fields: Vec<_> = line.expect(out).split(',').collect();
    (fields[0].parse().unwrap(), fields[1].parse().unwrap())
}

/// Rows of several simulated ring-downs, one behind the other.
pub fn joined(
    here: &Path,
    simulated: impl IntoIterator<Item = String>,
    identified: &str,
) -> Vec<u8> {
    let mut all = Vec::new();
    for simulated in simulated {
        rows(here, &simulated, identified);
        all.extend(fs::read(here.join("rows.csv")).unwrap());
    }
    all
}

/// Rows of one recording, whose waves follow each other.
pub fn in_one(here: &Path, simulated: impl IntoIterator<Item = String>) -> Vec<u8> {
    let mut recording = Vec::new();
    for simulated in simulated {
        done(here, &format!("simulate -o it.wav {simulated}"));
        // Behind the header.
        recording.extend(fs::read(here.join("it.wav")).unwrap().split_off(44));
    }
    let identify = "identify - --raw i16 --rate 100000 --periods 50 --output csv";
    let rows = run_with(here, identify, recording);
    assert_eq!(rows.code, 0, "{}", rows.err);
    rows.out.into()
}

/// A recording of 4 s.
pub fn record(here: &Path, name: &str, wave: &str) {
    done(
        here,
        &format!("simulate -o {name} --seconds 4 --noise 0.002 {wave}"),
    );
}

/// Rows of recordings.
pub fn identified(here: &Path, names: &str) -> String {
    let rows = run(here, &format!("identify --periods 50 --output csv {names}"));
    assert_eq!((rows.code, rows.err.as_str()), (0, ""));
    rows.out
}

/// Rows of a recording of 4 s.
pub fn four_seconds(here: &Path, wave: &str) -> String {
    record(here, "it.wav", wave);
    identified(here, "it.wav")
}

/// What `antinode resonator` makes of rows.
pub fn resonator(here: &Path, rows: &str, options: &str) -> Run {
    run_with(
        here,
        &format!("resonator - {options}"),
        rows.as_bytes().into(),
    )
}

/// Values and deviations of CSV, by run and quantity.
pub fn numbers(run: &Run) -> HashMap<(String, String), (f64, Option<f64>)> {
    assert_eq!(run.code, 0, "{}", run.err);
    let mut lines = run.out.lines();
    assert_eq!(
        lines.next(),
        Some("run,quantity,value,std,file,from_s,to_s")
    );
    lines
        .map(|line| {
            let fields: Vec<_> = line.split(',').collect();
            let [run, quantity, value, std, file, from, to] = fields[..] else {
                panic!("{line}");
            };
            // Of all runs together there is no recording.
            assert_eq!([file, from, to].map(str::is_empty), [run.is_empty(); 3]);
            let key = (run.to_owned(), quantity.to_owned());
            (key, (value.parse().unwrap(), std.parse().ok()))
        })
        .collect()
}

/// Nothing is told but that the pattern turns one way; gives the splits that it names, in 1/s and Hz.
pub fn is_one_way(err: &str) -> [f64; 2] {
    assert!(
        err.starts_with("warning: the pattern turns only one way") && err.lines().count() == 1,
        "{err}"
    );
    [" 1/s of damping", " Hz; give"].map(|unit| {
        let (before, _) = err.split_once(unit).expect(err);
        let (_, number) = before.rsplit_once(' ').unwrap();
        number.parse().unwrap()
    })
}

/// Rows of ring-downs with amplitudes smaller by e^−p, where p is given for the time, s.
pub fn damped(rows: &str, p: impl Fn(f64) -> f64) -> String {
    let mut lines = rows.lines();
    let header = lines.next().unwrap();
    let place = |name| header.split(',').position(|column| column == name).unwrap();
    let time = place("time_s");
    let amplitudes = [place("main_amplitude"), place("quadrature_amplitude")];
    let damped = lines.map(|line| {
        let mut fields: Vec<_> = line.split(',').map(str::to_owned).collect();
        let by = (-p(fields[time].parse().unwrap())).exp();
        for place in amplitudes {
            fields[place] = (by * fields[place].parse::<f64>().unwrap()).to_string();
        }
        fields.join(",")
    });
    let lines: Vec<_> = std::iter::once(header.to_owned()).chain(damped).collect();
    lines.join("\n")
}
