//! `antinode plot` if there is nothing to draw, or nowhere to write it.

use std::fs;
use std::path::Path;

use crate::common::svg::{HEADER, drawn};
use crate::common::{Run, names, run_with};

/// Runs `plot`, which must fail, with one message that contains all of these texts.
fn refused(here: &Path, arguments: &str, rows: &str, code: i32, told: &[&str]) {
    let Run { code: is, out, err } = run_with(here, arguments, rows.as_bytes().into());
    assert_eq!((is, out.as_str()), (code, ""), "{arguments}: {err}");
    assert!(err.starts_with("error: "), "{err}");
    for part in told {
        assert!(err.contains(part), "`{part}` is not in {err}");
    }
}

#[test]
fn faulty_rows_are_reported() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let good = "0,0.5,0.01,0,0,5332,0.1,,a\n1,0.5,0.01,0,0,5332,0.1,,a\n";
    let bad = HEADER.to_owned() + good + "2,0.5,x,0,0,5332,0.1,,a\n";
    fs::write(here.join("bad.csv"), bad).unwrap();
    refused(
        here,
        "plot bad.csv -o it.svg",
        "",
        1,
        &["bad.csv, line 4: main_amplitude_std is `x`, not a number; remove the line"],
    );
    let without = HEADER.replace("residual_rms", "rest") + good;
    refused(
        here,
        "plot - -o it.svg",
        &without,
        1,
        &[
            "standard input: no column residual_rms",
            "identify --output csv",
        ],
    );
    refused(
        here,
        "plot - -o it.png",
        "",
        1,
        &["standard input: there is nothing in it"],
    );
    refused(
        here,
        "plot - -o it.png",
        HEADER,
        1,
        &["standard input: there are no rows; "],
    );
    let lost = HEADER.to_owned() + "0,NaN,NaN,NaN,NaN,NaN,inf,lost,a\n";
    refused(
        here,
        "plot - -o it.svg",
        &lost,
        1,
        &["none of 1 rows has a wave; see their flags"],
    );
    let short = HEADER.to_owned() + "0,0.5\n";
    refused(
        here,
        "plot - -o it.svg",
        &short,
        1,
        &["line 2: found 2 fields", "remove the line"],
    );
    refused(
        here,
        "plot none.csv -o it.svg",
        "",
        1,
        &["none.csv: there is no such file; check the path"],
    );
    assert_eq!(names(here), ["bad.csv"]);
}

#[test]
fn a_figure_that_cannot_be_written_is_reported_and_harms_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = HEADER.to_owned() + "0,0.5,0.01,0,0,5332,0.1,,a\n";
    for name in ["it.pdf", "it", "it.csv"] {
        let told = format!(
            "{name}: the extension is not that of a known format; end the name in .svg or .png"
        );
        refused(here, &format!("plot - -o {name}"), &rows, 2, &[&told]);
    }
    refused(here, "plot -", &rows, 2, &["--out <FILE>"]);
    refused(
        here,
        "plot - -o it.svg --from 2 --to 1",
        &rows,
        2,
        &["--to: 1 s must be later than --from, 2 s"],
    );
    refused(
        here,
        "plot - -o it.svg --from 2",
        &rows,
        1,
        &[
            "standard input: no row lies between --from and --to: the rows' times go from 0 s to 0 s",
        ],
    );
    refused(here, "plot -o it.svg", &rows, 2, &["<ROWS>"]);
    refused(
        here,
        // Before any row is read.
        "plot none.csv -o none/it.svg",
        "",
        1,
        &["none/it.svg: there is no directory `none`; make it first"],
    );
    fs::create_dir(here.join("it.svg")).unwrap();
    refused(
        here,
        "plot - -o it.svg",
        &rows,
        1,
        &["it.svg: this exists and is not a file"],
    );
    fs::remove_dir(here.join("it.svg")).unwrap();
    assert!(names(here).is_empty());
    // The old file stays until the figure is complete.
    fs::write(here.join("it.svg"), "good").unwrap();
    refused(here, "plot - -o it.svg", HEADER, 1, &["there are no rows"]);
    assert_eq!(fs::read(here.join("it.svg")).unwrap(), b"good");
    drawn(here, &rows, "1 row of a; 0 flagged");
    assert_eq!(names(here), ["it.svg"]);
}

#[test]
fn numbers_too_large_for_an_axis_do_not_hang_the_command() {
    let directory = tempfile::tempdir().unwrap();
    for number in ["1e308", "-1.7e308", "1e-310"] {
        for place in 0..4 {
            let mut fields = ["1", "0.5", "0.01", "0.3"].map(str::to_owned);
            fields[place] = number.to_owned();
            let rows = format!(
                "{HEADER}0,0.5,0.01,0,0,5332,0.1,,a\n{},0,5332,0.1,,a\n",
                fields.join(",")
            );
            let drawn = run_with(directory.path(), "plot - -o it.svg", rows.into());
            assert_eq!(drawn.code, 0, "{number} {place}: {}", drawn.err);
        }
    }
}
