//! `antinode identify -o`: the file of rows, and what becomes of an earlier one of that name.

use std::fs;
use std::path::Path;

use crate::common::{Row, WAVE, done, run, wav};

/// Writes a recording `a.wav`, and one of silence, `none.wav`.
fn recordings(here: &Path) {
    fs::write(here.join("a.wav"), wav(&WAVE.codes(20_000))).unwrap();
    fs::write(here.join("none.wav"), wav(&[[0; 2]; 2000])).unwrap();
}

fn read(here: &Path, name: &str) -> String {
    fs::read_to_string(here.join(name)).unwrap()
}

#[test]
fn rows_of_earlier_recordings_are_kept() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    recordings(here);
    let mixed = run(here, "identify a.wav none.wav -o rows.csv");
    assert_eq!(mixed.code, 1);
    let rows = Row::all(&read(here, "rows.csv"));
    assert!(rows.len() > 90 && rows.iter().all(|row| row.text("file") == "a.wav"));
    let told = format!("rows.csv: {} rows\n", rows.len());
    assert!(mixed.err.contains(&told), "{}", mixed.err);
    // If there is no row at all, the earlier file stays, and a message says so.
    let none = run(here, "identify none.wav -o rows.csv");
    assert_eq!(none.code, 1);
    let told = "rows.csv: not written, as there are no rows\n";
    assert!(none.err.contains(told), "{}", none.err);
    assert_eq!(Row::all(&read(here, "rows.csv")).len(), rows.len());
}

#[test]
fn the_extension_of_the_name_sets_the_format() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    recordings(here);
    for (name, start) in [
        ("rows.CSV", "time_s,"),
        ("rows.JSONL", "{"),
        ("rows.json", "{"),
        ("rows.ndjson", "{"),
        ("rows.TXT", "   time, s"),
        ("rows", "   time, s"),
    ] {
        done(here, &format!("identify a.wav -o {name}"));
        assert!(read(here, name).starts_with(start), "{name}");
    }
    let unknown = run(here, "identify a.wav -o rows.tsv");
    assert_eq!(
        (unknown.code, unknown.err.as_str()),
        (
            2,
            "error: --out: .tsv is not a format of rows; end the name in .csv, .jsonl or .txt, or give --output\n"
        )
    );
    assert!(!here.join("rows.tsv").exists());
    done(here, "identify a.wav -o rows.tsv --output csv");
    assert!(read(here, "rows.tsv").starts_with("time_s,"));
}

#[test]
fn a_dash_is_standard_output() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    recordings(here);
    let plain = run(here, "identify a.wav --output csv");
    let dash = run(here, "identify a.wav --output csv -o -");
    assert_eq!((dash.code, dash.out, dash.err), (0, plain.out, plain.err));
    assert!(!here.join("-").exists());
}

#[cfg(windows)]
mod windows {
    use std::os::windows::fs::OpenOptionsExt;

    use super::*;

    #[test]
    fn a_file_that_another_program_has_open_is_refused_before_anything_is_read() {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path();
        recordings(here);
        fs::write(here.join("rows.csv"), "good").unwrap();
        // Shared for reading only, as spreadsheets do, and for reading and writing.
        for share in [1, 3] {
            let mut options = fs::File::options();
            let held = options.read(true).share_mode(share);
            let held = held.open(here.join("rows.csv")).unwrap();
            let refused = run(here, "identify a.wav -o rows.csv");
            assert_eq!(
                (refused.code, refused.err.as_str()),
                (
                    1,
                    "error: rows.csv: another program has this file open; close it there, or give another name\n"
                )
            );
            drop(held);
            assert_eq!(read(here, "rows.csv"), "good");
        }
        assert_eq!(fs::read_dir(here).unwrap().count(), 3);
        done(here, "identify a.wav -o rows.csv");
    }

    #[test]
    fn rows_may_go_nowhere() {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path();
        recordings(here);
        for name in ["NUL", "nul", r"\\.\NUL"] {
            let nowhere = run(here, &format!("identify a.wav -o {name}"));
            assert_eq!((nowhere.code, nowhere.out.as_str()), (0, ""), "{name}");
        }
        assert_eq!(fs::read_dir(here).unwrap().count(), 2);
    }
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::PermissionsExt;
    use std::process::Command;
    use std::time::{Duration, Instant};

    use super::*;
    use crate::common::{interrupted, piped, shell};

    #[test]
    fn an_interruption_leaves_the_rows_of_what_was_read() {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path();
        recordings(here);
        let all = run(here, "identify a.wav --output csv").out;
        let mut child = piped(
            Command::new(env!("CARGO_BIN_EXE_antinode"))
                .current_dir(here)
                .args(["identify", "a.wav", "-", "-o", "rows.csv"]),
        );
        // Standard input stays open until the command has ended.
        let input = child.stdin.take().unwrap();
        // Wait until the rows of the first recording are written; the command waits for the second.
        let begun = Instant::now();
        let written = || {
            let mut files = fs::read_dir(here).unwrap().map(|file| file.unwrap());
            files.any(|file| {
                let is_new = file.file_name().to_string_lossy().starts_with(".antinode");
                is_new && file.metadata().unwrap().len() == all.len() as u64
            })
        };
        while !written() {
            assert!(begun.elapsed() < Duration::from_secs(10));
        }
        let told = interrupted(child, input);
        assert!(
            told.ends_with("rows.csv: the rows up to this point are written\nerror: interrupted; the rows printed so far are good\n"),
            "{told}"
        );
        assert_eq!(read(here, "rows.csv"), all);
        assert_eq!(fs::read_dir(here).unwrap().count(), 3);
    }

    #[test]
    fn devices_and_pipes_are_written_to_as_they_are() {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path();
        recordings(here);
        let plain = run(here, "identify a.wav --output csv").out;
        for line in [
            "echo first > rows; \"$antinode\" identify a.wav --output csv -o /dev/stdout >> rows",
            "echo first > rows; \"$antinode\" identify a.wav --output csv -o /dev/fd/3 3>> rows",
            "mkfifo pipe; (echo first; cat pipe) > rows & \"$antinode\" identify a.wav --output csv -o pipe; wait",
        ] {
            let written = shell(here, line);
            assert!(written.status.success(), "{line}: {written:?}");
            assert_eq!(read(here, "rows"), format!("first\n{plain}"), "{line}");
        }
    }

    #[test]
    fn permissions_are_kept_and_read_only_files_too() {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path();
        recordings(here);
        let path = here.join("rows.csv");
        fs::write(&path, "good").unwrap();
        let allow = |mode| fs::set_permissions(&path, PermissionsExt::from_mode(mode)).unwrap();
        allow(0o444);
        let kept = run(here, "identify a.wav -o rows.csv");
        assert_eq!(kept.code, 1);
        let told = "rows.csv: this file is read-only, and stays as it is; give another name, or make it writable";
        assert!(kept.err.contains(told), "{}", kept.err);
        assert_eq!(read(here, "rows.csv"), "good");
        allow(0o600);
        done(here, "identify a.wav -o rows.csv");
        let mode = fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
    }
}
