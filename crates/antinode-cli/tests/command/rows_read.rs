//! Rows as `resonator`, `calibrate` and `plot` read them, even if a spreadsheet, another program or an interruption changed them.

use std::fs;
use std::path::Path;

use crate::common::ring_downs::rows;
use crate::common::{done, run, run_with};

/// Standard output and standard error of `resonator`, which may leave out none of these rows.
fn resonator(here: &Path, rows: impl Into<Vec<u8>>) -> (String, String) {
    let found = run_with(here, "resonator - --output csv", rows.into());
    assert!(
        found.code == 0 && !found.err.contains("left out"),
        "{}",
        found.err
    );
    (found.out, found.err)
}

/// Writes rows of a ring-down to a file, and gives them as text.
fn ring_down(here: &Path) -> String {
    let simulated = "--seconds 2 --noise 0.002 --decay-rate 0.5 --angle 0.4";
    rows(here, simulated, "--periods 200");
    fs::read_to_string(here.join("rows.csv")).unwrap()
}

#[test]
fn rows_of_other_programs_are_the_same_rows() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let expected = resonator(here, text.as_str());
    let (header, lines) = text.split_once('\n').unwrap();
    let (first, others) = lines.split_once('\n').unwrap();
    let decimal_commas = text.replace(',', ";").replace('.', ",");
    let decimal_commas = decimal_commas.replace("it,wav", "it.wav");
    let commas = ",".repeat(header.matches(',').count());
    let tabs = text.replace(',', "\t");
    let utf_16 = ("\u{feff}".to_owned() + &tabs)
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let unmarked = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    for other in [
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        tabs.into_bytes(),
        utf_16,
        unmarked,
        format!("sep=;\n{decimal_commas}").into_bytes(),
        format!("sep=,\r\n{header}\r\n{commas}\r\n{lines}{commas}\n\n").into_bytes(),
        format!("# of today\n{header}\n# the first\n{first}\n{others}").into_bytes(),
    ] {
        assert_eq!(resonator(here, other), expected);
    }
}

#[test]
fn rows_joined_side_by_side_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let joined: Vec<String> = text.lines().map(|line| format!("{line},{line}")).collect();
    fs::write(here.join("joined.csv"), joined.join("\n")).unwrap();
    for arguments in ["resonator joined.csv", "plot joined.csv -o a.svg"] {
        let refused = run(here, arguments);
        let told = "joined.csv: two columns time_s in its first line, as in files that were joined side by side";
        assert!(
            refused.code == 1 && refused.err.contains(told),
            "{}",
            refused.err
        );
    }
}

#[test]
fn a_file_without_ends_of_line_is_not_read_whole() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let header = &text[..=text.find('\n').unwrap()];
    for begin in ["", header] {
        let endless = [begin.as_bytes(), &[b'7'; 17 << 20]].concat();
        let found = run_with(here, "resonator -", endless);
        assert_eq!(
            (found.code, found.err.as_str()),
            (
                1,
                "error: standard input: more than 16 MiB without an end of line; give the rows that `antinode identify --output csv \
                 RECORDING` prints\n"
            )
        );
    }
}

#[test]
fn a_field_that_cannot_be_used_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let columns: Vec<_> = text.lines().next().unwrap().split(',').collect();
    for (column, field, needed) in [
        ("angle_rad", "x", "a finite number in single precision"),
        (
            "frequency_hz",
            "1e300",
            "a finite number in single precision",
        ),
        (
            "main_amplitude",
            "1e39",
            "a number above 0 in single precision",
        ),
        (
            "main_amplitude",
            "1e-60",
            "a number above 0 in single precision",
        ),
        ("quadrature_amplitude", "2", "within ±main_amplitude"),
        ("quadrature_amplitude", "4e9", "within ±main_amplitude"),
        ("phase_std_rad", "0", "a number above 0"),
        ("frequency_std_hz", "1e-300", "a number above 0"),
    ] {
        let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
        let mut fields: Vec<_> = lines[7].split(',').collect();
        fields[columns.iter().position(|name| *name == column).unwrap()] = field;
        lines[7] = fields.join(",");
        lines.insert(2, "# a comment".to_owned());
        let told = format!(
            "error: standard input, line 9: {column} is `{field}`, not {needed}; remove the line\n"
        );
        for (command, end) in [("resonator", "\n"), ("calibrate", "\r\n")] {
            let found = run_with(here, &format!("{command} -"), lines.join(end).into_bytes());
            assert_eq!((found.code, &found.err), (1, &told), "{command}");
        }
    }
}

#[test]
fn flags_may_be_missing_as_programs_write_it_but_must_be_known() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let expected = resonator(here, &text[..]);
    let at = text
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|name| name == "flags");
    let with = |flags: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        for line in &mut lines[1..] {
            let mut fields: Vec<_> = line.split(',').collect();
            fields[at.unwrap()] = flags;
            *line = fields.join(",");
        }
        lines.join("\n") + "\n"
    };
    for flags in ["NaN", "null", " ", "None"] {
        assert_eq!(resonator(here, with(flags)), expected, "{flags}");
    }
    for command in ["resonator -", "calibrate -", "plot - -o a.svg"] {
        let found = run_with(here, command, with("misfit+odd").into());
        let told = "error: standard input, line 2: flags is `misfit+odd`, not names of flags, joined by `+`; remove the line\n";
        assert_eq!((found.code, &found.err[..]), (1, told), "{command}");
    }
}

#[test]
fn a_lost_wave_counts_however_its_time_is_missing() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let found = |flags: &str, time: &str| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let place = |name: &str| lines[0].split(',').position(|one| one == name).unwrap();
        let [time_at, flags_at] = [place("time_s"), place("flags")];
        let mut fields: Vec<_> = lines[20].split(',').collect();
        (fields[time_at], fields[flags_at]) = (time, flags);
        lines[20] = fields.join(",");
        let found = run_with(here, "resonator -", lines.join("\n").into());
        (found.code, found.out, found.err)
    };
    for flags in ["lost", "reacquired"] {
        let expected = found(flags, "");
        assert!(expected.1.contains("52 of 53 rows"), "{}", expected.1);
        for time in ["NaN", "null", "inf"] {
            assert_eq!(found(flags, time), expected, "{flags}, {time}");
        }
    }
}

#[test]
fn rows_of_another_form_that_follow_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let count = text.lines().count();
    let swapped: Vec<String> = text
        .lines()
        .map(|line| {
            let mut fields: Vec<_> = line.split(',').collect();
            fields.reverse();
            fields.join(",")
        })
        .collect();
    let fewer = text.replace(",flags", "");
    let json = done(here, "identify it.wav --periods 50 --output jsonl").out;
    for other in [swapped.join("\n"), fewer, json] {
        for command in ["resonator -", "plot - -o a.svg"] {
            let found = run_with(here, command, (text.clone() + &other).into());
            let told = format!(
                "error: standard input, line {}: rows with other columns, or in another form, begin here; ",
                count + 1
            );
            assert!(
                found.code == 1 && found.err.starts_with(&told),
                "{}",
                found.err
            );
        }
    }
}

#[test]
fn json_lines_are_read_as_csv_is() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (name, rate) in [("a", 1.2), ("b", -1.2)] {
        let made = format!(
            "simulate -o {name}.wav --seconds 3 --noise 0.002 --decay-rate 0.3 --angle-rate {rate} --dropout 1:1.1:noise"
        );
        done(here, &made);
    }
    for name in ["rows.csv", "rows.jsonl"] {
        done(
            here,
            &format!("identify a.wav b.wav --periods 50 -o {name}"),
        );
    }
    let lines = fs::read_to_string(here.join("rows.jsonl")).unwrap();
    assert!(lines.contains("lost"));
    for command in ["resonator", "calibrate", "plot -o it.svg"] {
        let [csv, json] = ["rows.csv", "rows.jsonl"].map(|rows| {
            let run = done(here, &format!("{command} {rows}"));
            let told = [run.out, run.err].map(|text| text.replace(rows, "ROWS"));
            (told, fs::read_to_string(here.join("it.svg")).ok())
        });
        assert_eq!(csv, json, "{command}");
    }
    let wrong = lines.replacen("\n{", "\n(", 1);
    let wrong = run_with(here, "resonator -", wrong.into());
    assert_eq!(wrong.code, 1);
    let told = "standard input, line 2: this is not a JSON object: ";
    assert!(wrong.err.contains(told), "{}", wrong.err);
}

#[test]
fn a_last_line_that_does_not_end_is_left_out() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let lines = run(here, "identify --output jsonl --periods 200 it.wav").out;
    for whole in [text, lines] {
        let count = whole.lines().count();
        let last = whole.trim_end().rfind('\n').unwrap() + 1;
        let cut = &whole[..last + 40];
        let found = run_with(here, "resonator - --output csv", cut.into());
        let told = format!(
            "warning: standard input, line {count}: it is incomplete, as after an interrupted write, and is left out\n"
        );
        let (out, err) = resonator(here, &whole[..last]);
        assert_eq!((found.code, found.err), (0, told + &err));
        assert_eq!(found.out, out);
        // A complete last line need not have an end.
        let whole = whole.trim_end();
        assert_eq!(
            resonator(here, whole),
            resonator(here, format!("{whole}\n"))
        );
    }
}

#[test]
fn a_table_is_distinguished_from_rows() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    ring_down(here);
    fs::copy(here.join("it.wav"), here.join("other.wav")).unwrap();
    for identified in [
        "it.wav",
        "it.wav other.wav",
        "--methods all it.wav other.wav",
    ] {
        let table = run(here, &format!("identify --periods 200 {identified}")).out;
        for command in ["resonator -", "calibrate -", "plot - -o it.svg"] {
            let found = run_with(here, command, table.clone().into());
            assert_eq!(
                (found.code, found.err.as_str()),
                (
                    1,
                    "error: standard input: this is the table for reading, which cannot be read back; add --output csv to the command that printed it\n"
                )
            );
        }
    }
    // Other CSV is not called a table.
    fs::write(here.join("log.csv"), "time,C,D\n0,0.1,0.2\n").unwrap();
    let found = run(here, "resonator log.csv");
    assert_eq!(
        (found.code, found.err.as_str()),
        (
            1,
            "error: log.csv: no column time_s in its first line; give the rows that `antinode identify --output csv RECORDING` prints\n"
        )
    );
}
