//! Broken lines: each costs itself or its pair, and is reported.

use super::super::super::tests::{drain, file};
use super::super::super::{OpenOptions, Recording};
use super::check;

#[test]
fn a_line_without_a_known_time_is_left_out() {
    for (text, pairs, expected) in [
        (
            "0,1,2\nnan,2,3\n",
            1,
            "a.csv:2:1: the time is `nan`, not a finite number: the line is left out; rows",
        ),
        (
            "0,1,2\nx,2,3\n2,3,4\n3,3,4\n4,3,4\n",
            4,
            "a.csv:2:1: the time is `x`, not a finite number: the line is left out; rows",
        ),
        (
            "0,1,2\n1,1,2\n2,1,2\n,2,3\n3,3,4\n",
            4,
            "a.csv:4:1: the time is missing: the line is left out; rows",
        ),
        (
            "0,1,2\n1,1,2\n2,1,2\n3,1,2\nx,2,3\n6,3,4\n",
            5,
            "a.csv:5:1: the time is `x`, not a finite number: the line is left out, and before line 6 2 samples are lost; rows",
        ),
        (
            "0,1,2\n1,1,2\n2,1,2\n3,1,23,1,2\n4,2,3\ntime,c,d\n5\n5,2,3\n7,2,3\n8,2,3\n9,2,3\n",
            8,
            "a.csv:4: a line of 5 fields where the first has 3: the line is left out, the first of 3, and before line 9 1 sample is lost; rows",
        ),
        (
            "0 1 2\n1 1 2\n2\n3 1 2\n",
            3,
            "a.csv:3: a line of 1 field where the first has 3: the line is left out; rows",
        ),
        (
            "c,d,time\n1,2,0\n1,2,1\n1,2\n1,2,3\n",
            3,
            "a.csv:4: a line of 2 fields where the first has 3: the line is left out; rows",
        ),
        // A time at the end of a line may be cut off.
        (
            "c,time,d\n1,0,2\n1,10,2\n1,2\n1,30,2\n1,40,2\n",
            4,
            "a.csv:4: a line of 2 fields where the first has 3: the line is left out; rows",
        ),
        (
            "0,1,2\n1,1,2\n\0\0\0\0\n3,1,2\n",
            3,
            "a.csv:3: a line of 1 field where the first has 3: the line is left out; rows",
        ),
        (
            "0,1,2\n1,1,2\n2",
            2,
            "a.csv:3: a line of 1 field where the first has 3: the line is left out; rows",
        ),
        (
            "-,1,2\n0,1,2\n1,1,2\n",
            2,
            "a.csv:1:1: the time is `-`, not a finite number: the line is left out; rows",
        ),
    ] {
        check(text, pairs, expected);
    }
}

#[test]
fn a_broken_line_whose_place_is_known_is_a_pair_without_its_samples() {
    for (text, pairs, expected) in [
        (
            "1,2\n3\n5,6\n",
            vec!["1 2", "NaN NaN", "5 6"],
            "a.csv:2: sample pair 1 (from 0), a line of 1 field where the first has 2, so a sample is missing, the first of 2; rows",
        ),
        (
            "1 2\n3\n5 6\n",
            vec!["1 2", "NaN NaN", "5 6"],
            "a.csv:2: sample pair 1 (from 0), a line of 1 field where the first has 2, so a sample is missing, the first of 2; rows",
        ),
        (
            "1,2\n3,4,5\n5,6\n",
            vec!["1 2", "NaN NaN", "5 6"],
            "a.csv:2: sample pair 1 (from 0), a line of 3 fields where the first has 2, so a sample is missing, the first of 2; rows",
        ),
        (
            "1,2\n5,6\n7",
            vec!["1 2", "5 6", "NaN NaN"],
            "a.csv:3: sample pair 2 (from 0), a line of 1 field where the first has 2, so a sample is missing, the first of 2; rows",
        ),
        // The last field of a line cut off may be cut itself.
        (
            "0,1,2\n1,15\n2,5,6\n",
            vec!["1 2", "NaN NaN", "5 6"],
            "a.csv:2: sample pair 1 (from 0), a line of 2 fields where the first has 3, so a sample is missing, the first of 2; rows",
        ),
        (
            "time,c,heat,d\n0,1,20,2\n1,3,20\n2,5,20,6\n",
            vec!["1 2", "3 NaN", "5 6"],
            "a.csv:3: sample pair 1 (from 0), a line of 3 fields where the first has 4, so a sample is missing; rows",
        ),
    ] {
        let (_directory, path) = file("a.csv", text.as_bytes());
        let options = OpenOptions {
            columns: text.contains("heat").then(|| "time,c,d".parse().unwrap()),
            ..OpenOptions::default()
        };
        let mut recording = Recording::open(&path, &options).unwrap();
        let (found, fault) = drain(&mut recording);
        assert!(fault.is_none() && recording.lost().is_none(), "{text}");
        let found: Vec<String> = found.iter().map(|[c, d]| format!("{c} {d}")).collect();
        assert_eq!(found, pairs, "{text}");
        let told = recording.not_finite().unwrap().to_string();
        assert!(told.contains(expected), "{text}: {told}");
    }
}

#[test]
fn pairs_without_values_at_the_edges_are_no_faults() {
    let begins = "the first 2 sample pairs have no values: the recording begins behind them";
    let ends = "the last sample pair has no values: the recording ends before it";
    for (text, warnings, fault) in [
        (
            "time,c,d\n0,,\n1,nan,OVER\n2,1,2\n3,3,4\n4,,\n",
            vec![begins, ends],
            None,
        ),
        (
            "time,c,d\n0,,\n1,,\n2,1,2\n3,3,\n4,5,6\n",
            vec![begins],
            Some("a.csv:5:3: sample pair 3 (from 0), S_D (right): the value is missing; rows"),
        ),
        (
            "time,c,d\n0,,\n1,,\n2,1,2\n3,,\n4,5,6\n",
            vec![begins],
            Some(
                "a.csv:5:2: sample pair 3 (from 0), S_C (left): the value is missing, the first of 2; rows",
            ),
        ),
        (
            "time,c,d\n0,1,2\n1,3,4\n2,inf,inf\n",
            vec![],
            Some(
                "a.csv:4:2: sample pair 2 (from 0), S_C (left): the value is inf, not a finite number, the first of 2; rows",
            ),
        ),
        (
            "time,c,d\n0,,\n1,,\n2,,\n",
            vec![],
            Some(
                "a.csv:2:2: sample pair 0 (from 0), S_C (left): the value is missing, the first of 6; rows",
            ),
        ),
        // Among broken lines these may be broken, too.
        (
            "time,c,d\n0,,\n1,,\n2,1,2\n3,x,4\n4,5,6\n",
            vec![],
            Some(
                "a.csv:2:2: sample pair 0 (from 0), S_C (left): the value is missing, the first of 5; rows",
            ),
        ),
    ] {
        let (_directory, path) = file("a.csv", text.as_bytes());
        let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        assert!(
            drain(&mut recording).1.is_none() && recording.lost().is_none(),
            "{text}"
        );
        assert_eq!(
            recording.late_warnings().collect::<Vec<_>>(),
            warnings,
            "{text}"
        );
        let found = recording.not_finite().map(|found| found.to_string());
        assert_eq!(found.is_some(), fault.is_some(), "{text}: {found:?}");
        if let (Some(found), Some(fault)) = (found, fault) {
            assert!(found.contains(fault), "{text}: {found}");
        }
    }
}

#[test]
fn without_a_header_first_lines_without_values_are_pairs() {
    let rows = |separator: char, first: &dyn Fn(usize) -> String| {
        let row = move |k: usize| format!("{}{}{separator}{}\n", first(k), k * k % 7, k * k % 5);
        (3..40).map(row).collect::<String>()
    };
    let timed = rows(',', &|k| format!("{k},"));
    let plain = rows(';', &|_| String::new());
    let begins = "the first 3 sample pairs have no values: the recording begins behind them";
    for (text, missing) in [
        (format!("0,,\n1,,\n2,,\n{timed}"), 3),
        // Where the time is missing too, that of the samples tells when they begin.
        (format!(",,\n,,\n,,\n{timed}"), 0),
        (format!(";\n;\n;\n{plain}"), 3),
    ] {
        let (_directory, path) = file("a.csv", text.as_bytes());
        let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        let start = if missing == 0 { 3.0 } else { 0.0 };
        assert_eq!(recording.opened.start, start, "{text}");
        let (pairs, fault) = drain(&mut recording);
        assert!(
            fault.is_none() && recording.not_finite().is_none(),
            "{text}"
        );
        assert!(
            pairs[..missing]
                .iter()
                .flatten()
                .all(|value| value.is_nan())
        );
        assert_eq!(
            (pairs.len() - missing, pairs[missing]),
            (37, [2.0, 4.0]),
            "{text}"
        );
        let warnings: Vec<String> = recording.late_warnings().collect();
        assert_eq!(warnings.contains(&begins.to_owned()), missing > 0, "{text}");
    }
    // What is wrong with the columns is told of the first sample.
    let four: String = (2..40).map(|k| format!("{k},1,2,{k}\n")).collect();
    let (_directory, path) = file("a.csv", format!("0,,,\n1,,,\n{four}").as_bytes());
    let fault = Recording::open(&path, &OpenOptions::default()).err();
    let fault = fault.map(|fault| fault.to_string()).unwrap_or_default();
    assert!(fault.contains("a.csv:3: found 4 columns"), "{fault}");
}

#[test]
fn behind_a_line_that_is_cut_a_rising_signal_is_no_time() {
    let rows = (0..20).map(|k| format!("0.{},0.5\n", 100 + 10 * k + k * k / 10));
    let text = format!("5\n{}", rows.collect::<String>());
    let (_directory, path) = file("a.csv", text.as_bytes());
    let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
    let (pairs, fault) = drain(&mut recording);
    assert_eq!((pairs.len(), fault.is_none()), (20, true));
    assert_eq!(pairs[0], [0.1, 0.5]);
    let [warning] = &recording.opened.warnings[..] else {
        panic!("{:?}", recording.opened.warnings);
    };
    assert!(warning.starts_with("line 1 seems to lack its beginning"));
}

#[test]
fn text_that_is_mostly_broken_is_refused() {
    for (text, pairs, expected) in [
        (
            "time,c,d\n0,0,1,5,0,2\n0,1,1,5,0,2\n1,2,3\n",
            0,
            "a.csv:2: found 6 fields where the first line has 3; use another separator",
        ),
        (
            "time,c,d\n0,1,2\n0,1,1,5,0,2\n0,2,1,5,0,2\n",
            1,
            "a.csv:3: found 6 fields where the first line has 3; use another separator",
        ),
        ("1,2\n3\n4\n", 1, "a.csv:2:2: S_D is missing here; complete"),
        (
            "time,c,d\n0,1,2\n1\n2\n",
            1,
            "a.csv:3:2: S_C is missing here; complete",
        ),
    ] {
        check(text, pairs, expected);
        // The error is given only once.
        let (_directory, path) = file("a.csv", text.as_bytes());
        if let Ok(mut recording) = Recording::open(&path, &OpenOptions::default()) {
            assert!(drain(&mut recording).1.is_some() && recording.lost().is_none());
        }
    }
}

#[test]
fn only_lines_among_the_pairs_looked_at_are_reported() {
    let text: String = (0..100_000)
        .map(|k| match k {
            10 | 80_000 | 80_001 | 90_000 => "x\n".to_owned(),
            _ => format!("{k},{},1\n", k % 7),
        })
        .collect();
    let (_directory, path) = file("a.csv", text.as_bytes());
    for (start, end, told) in [
        (0, 99_996, Some((11, 4))),
        (11, 99_996, Some((80_001, 3))),
        (11, 80_000, Some((80_001, 2))),
        (11, 79_000, None),
    ] {
        let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        let (mut before, mut block) = (0, Vec::new());
        while recording.read(&mut block).unwrap() > 0 {
            let [from, to] = [start, end].map(|at: usize| at.clamp(before, before + block.len()));
            if from < to {
                recording.look(from as u64, &block[from - before..to - before]);
            }
            before += block.len();
        }
        let found = recording.lost().map(|lost| lost.to_string());
        let expected = told.map(|(line, count)| {
            let count = format!("the line is left out, the first of {count};");
            (format!("a.csv:{line}: a line of 1 field"), count)
        });
        assert_eq!(
            found.is_some(),
            expected.is_some(),
            "{start} {end}: {found:?}"
        );
        if let (Some(found), Some((place, count))) = (found, expected) {
            assert!(found.contains(&place) && found.contains(&count), "{found}");
        }
    }
}
