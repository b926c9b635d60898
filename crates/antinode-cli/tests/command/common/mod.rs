//! What the tests of the command share: runs of it and its rows; and, in modules of their own, what they are run on.

#[cfg(unix)]
pub mod device;
pub mod ring_downs;
pub mod svg;
mod wave;

use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};
#[cfg(unix)]
use std::process::{ChildStdin, Output};
use std::{fs, thread};

pub use wave::{RATE, WAVE, Wave, npy, printed, raw, silence, text, wav};

/// What the project tells first.
pub const README: &str = include_str!("../../../../../README.md");

/// What a run of the command left behind.
pub struct Run {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// Runs the command in a directory.
pub fn run(directory: &Path, arguments: &str) -> Run {
    run_with(directory, arguments, Vec::new())
}

/// Runs the command, which must succeed.
pub fn done(directory: &Path, arguments: &str) -> Run {
    let run = run(directory, arguments);
    assert_eq!(run.code, 0, "{arguments}: {}", run.err);
    run
}

/// Runs a line of shell in a directory, where `$antinode` is the command.
#[cfg(unix)]
pub fn shell(directory: &Path, line: &str) -> Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", line]).current_dir(directory);
    let shell = shell.env("antinode", env!("CARGO_BIN_EXE_antinode"));
    shell.output().unwrap()
}

/// Sends a signal, such as `-INT`, which is Ctrl-C, to a command that runs.
#[cfg(unix)]
pub fn send(signal: &str, child: &Child) {
    // The shell's own: a minimal system has no program of that name.
    let sent = Command::new("sh")
        .args(["-c", "kill \"$0\" \"$1\"", signal, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
}

/// Starts a command, with pipes to and from it.
pub fn piped(command: &mut Command) -> Child {
    let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
    command.stderr(Stdio::piped()).spawn().unwrap()
}

/// Interrupts a command whose input is open; gives what it told.
#[cfg(unix)]
pub fn interrupted(child: Child, input: ChildStdin) -> String {
    send("-INT", &child);
    let output = child.wait_with_output().unwrap();
    drop(input);
    assert_eq!(output.status.code(), Some(130));
    String::from_utf8(output.stderr).unwrap()
}

/// Files in a directory.
pub fn names(here: &Path) -> Vec<String> {
    let entries = fs::read_dir(here).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// The root of the mean square.
pub fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}

/// Runs the command in a directory, with bytes on standard input.
pub fn run_with(directory: &Path, arguments: &str, input: Vec<u8>) -> Run {
    let mut command = Command::new(env!("CARGO_BIN_EXE_antinode"));
    let command = command.current_dir(directory);
    let mut child = piped(command.args(arguments.split_whitespace()));
    let mut pipe = child.stdin.take().unwrap();
    // A command that fails at once reads nothing.
    let writer = thread::spawn(move || drop(pipe.write_all(&input)));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    Run {
        code: output.status.code().expect("no signal ends the command"),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Runs `identify --output csv`, which must succeed and say how many rows are flagged by what, and nothing else.
pub fn rows(directory: &Path, arguments: &str) -> Vec<Row> {
    let run = run(directory, &format!("identify --output csv {arguments}"));
    let rows = Row::all(&run.out);
    assert_eq!(
        (run.code, beside_flagged(&rows, &run.err)),
        (0, Vec::new()),
        "{arguments}"
    );
    rows
}

/// What a run on `a.wav` told, its rows, and how many of them are flagged.
pub fn identified(directory: &Path, arguments: &str) -> (Run, Vec<Row>, usize) {
    let run = run(
        directory,
        &format!("identify --output csv {arguments} a.wav"),
    );
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = Row::all(&run.out);
    let flagged = rows.iter().filter(|row| !row.text("flags").is_empty());
    let count = flagged.count();
    (run, rows, count)
}

/// What is told beside the flags of these rows, which must be told in one line a recording.
pub fn beside_flagged<'a>(rows: &[Row], err: &'a str) -> Vec<&'a str> {
    let mut lines: Vec<&str> = err.lines().collect();
    let mut files: Vec<&str> = rows.iter().map(|row| row.text("file")).collect();
    files.dedup();
    for file in files {
        let flags = rows.iter().filter(|row| row.text("file") == file);
        let flags: Vec<&str> = flags.map(|row| row.text("flags")).collect();
        let flagged = flags.iter().filter(|flags| !flags.is_empty()).count();
        let start = format!("warning: {file}: {flagged} of {} rows ", flags.len());
        let (told, others): (Vec<&str>, Vec<&str>) =
            lines.iter().partition(|line| line.starts_with(&start));
        assert_eq!(told.len(), usize::from(flagged > 0), "{start}: {err}");
        for line in told {
            let (_, counts) = line.split_once(" flagged: ").unwrap();
            let counts = counts.split(';').next().unwrap();
            let mut sum = 0;
            for one in counts.split(", ") {
                let (flag, count) = one.split_once(' ').unwrap();
                let has = |flags: &&&str| flags.split('+').any(|one| one == flag);
                assert_eq!(
                    flags.iter().filter(has).count().to_string(),
                    count,
                    "{line}"
                );
                sum += count.parse::<usize>().unwrap();
            }
            let all = flags.iter().filter(|flags| !flags.is_empty());
            assert_eq!(
                all.map(|flags| flags.split('+').count()).sum::<usize>(),
                sum
            );
        }
        lines = others;
    }
    lines
}

/// The rows of a text, which must be read without a word.
pub fn rows_of(directory: &Path, text: &str, arguments: &str) -> Vec<Row> {
    fs::write(directory.join("a.csv"), text).unwrap();
    rows(directory, &format!("a.csv {arguments}"))
}

/// Asserts that these are the rows expected, of windows that are later by so much.
pub fn same_later(found: &[Row], expected: &[Row], later: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let time = found.number("time_s") - expected.number("time_s");
        assert!((time - later).abs() < 1e-6, "{time}");
        assert_eq!(found.unnamed()[1..], expected.unnamed()[1..]);
    }
}

/// Runs `identify`, which must exit 1 with one message that holds all of these, beside that of flags; gives its rows.
pub fn fault(directory: &Path, arguments: &str, input: Vec<u8>, told: &[&str]) -> Vec<Row> {
    let run = run_with(
        directory,
        &format!("identify --output csv {arguments}"),
        input,
    );
    assert_eq!(run.code, 1, "{arguments}: {}", run.err);
    let rows = Row::all(&run.out);
    let others = beside_flagged(&rows, &run.err);
    assert_eq!(others.len(), 1, "{}", run.err);
    assert!(others[0].starts_with("error: "), "{}", run.err);
    for part in told {
        assert!(
            others[0].contains(part),
            "{arguments}: `{part}` is not in {}",
            run.err
        );
    }
    rows
}

/// The same without a row.
pub fn no_rows(directory: &Path, arguments: &str, input: Vec<u8>, told: &[&str]) {
    assert_eq!(fault(directory, arguments, input, told), [], "{arguments}");
}

/// One row of CSV.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    header: Vec<String>,
    fields: Vec<String>,
}

impl Row {
    /// Every row of a CSV output.
    pub fn all(text: &str) -> Vec<Self> {
        let mut lines = text
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect());
        let Some(header) = lines.next() else {
            return Vec::new();
        };
        lines
            .map(|fields: Vec<String>| {
                let header: Vec<String> = Clone::clone(&header);
                assert_eq!(fields.len(), header.len());
                Self { header, fields }
            })
            .collect()
    }

    /// A field as it is printed.
    pub fn text(&self, name: &str) -> &str {
        let place = self.header.iter().position(|column| column == name);
        &self.fields[place.unwrap_or_else(|| panic!("no column {name}"))]
    }

    /// A field as a number.
    pub fn number(&self, name: &str) -> f64 {
        self.text(name).parse().unwrap()
    }

    /// The row without the name of the file.
    pub fn unnamed(&self) -> &[String] {
        assert_eq!(self.header.last().unwrap(), "file");
        &self.fields[..self.fields.len() - 1]
    }
}
