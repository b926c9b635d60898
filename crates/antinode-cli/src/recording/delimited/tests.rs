//! Text recordings: the forms that are understood, and the errors of others.

mod broken;
mod time;

use std::fmt::Write;

use super::super::tests::{file, read, read_with};
use super::super::{OpenOptions, Recording};

const PAIRS: [[f32; 2]; 3] = [[0.1, 0.2], [-0.5, 1e-3], [1.5, -2.0]];

fn good(text: &str) -> Vec<[f32; 2]> {
    let (pairs, fault) = read("a.csv", text.as_bytes());
    assert_eq!(fault, None, "{text}");
    pairs
}

/// The number of good pairs, and the error that follows them.
fn bad(text: &str) -> (usize, String) {
    let (pairs, fault) = read("a.csv", text.as_bytes());
    (pairs.len(), fault.unwrap_or_default())
}

/// Checks how many pairs are good and how the error that follows begins; gives the whole error.
fn check(text: &str, pairs: usize, expected: &str) -> String {
    let (count, fault) = bad(text);
    assert!(
        fault.starts_with(expected) && count == pairs,
        "{text}: {count}, {fault}"
    );
    fault
}

#[test]
fn every_separator_is_understood() {
    for text in [
        "0.1,0.2\n-0.5,1e-3\n1.5,-2\n",
        "0.1, 0.2\r\n-0.5, 1e-3\r\n1.5, -2",
        "0.1;0.2\n-0.5;1e-3\n1.5;-2\n",
        "0,1;0,2\n-0,5;1e-3\n1,5;-2\n",
        "0.1\t0.2\n-0.5\t1e-3\n1.5\t-2\n",
        "0,1\t0,2\n-0,5\t0,001\n1,5\t-2\n",
        "  0.1   0.2\n -0.5   1e-3 \n1.5 -2\n",
        "\"0.1\",\"0.2\"\n\"-0.5\",\"1e-3\"\n1.5,-2\n",
        "0.1,0.2,\n-0.5,1e-3,\n1.5,-2,\n",
        "\u{feff}c,d\n0.1,0.2\n-0.5,1e-3\n1.5,-2\n",
        "\u{feff}# one\n\n  # two\nc,d\n0.1,0.2\n\n \t\r\n# three, or four\n-0.5,1e-3\n1.5,-2\n#",
        "d,c\n0.2,0.1\n1e-3,-0.5\n-2,1.5\n",
        "time,c,d\n0,0.1,0.2\n1e-5,-0.5,1e-3\n2e-5,1.5,-2\n",
        "% one\nc,d\n// two\n0.1,0.2\n-0.5,1e-3\n %three\n1.5,-2\n",
        "c,d\r0.1,0.2\r\r-0.5,1e-3\r# one\r1.5,-2\r",
        "c,d\nV,\n0.1,0.2\n-0.5,1e-3\n1.5,-2\n",
        "Time\tA\tB\n(ms)\t(mV)\t(mV)\n\n0\t0.1\t0.2\n1\t-0.5\t1e-3\n2\t1.5\t-2\n",
        "0 0.1 0.2\n1 -0.5 1e-3\n2 1.5 -2\n",
    ] {
        assert_eq!(good(text), PAIRS, "{text}");
    }
}

#[test]
fn columns_can_be_chosen() {
    let options = |columns: &str| OpenOptions {
        columns: Some(columns.parse().unwrap()),
        ..OpenOptions::default()
    };
    let text = b"n,heat,d,c\n1,20,0.2,0.1\n";
    assert_eq!(
        read_with("a.csv", text, &options("c,d")),
        (vec![[0.1, 0.2]], None)
    );
    assert_eq!(
        read_with("a.csv", text, &options("n,4,3")),
        (vec![[0.1, 0.2]], None)
    );
    let fault = read_with("a.csv", b"\n1,2\n", &options("c,d"))
        .1
        .expect("a fault");
    assert!(fault.starts_with(
        "a.csv:2: there is no column `c`; choose among the numbers 1 to 2 with --columns"
    ));
}

#[test]
fn faults_in_a_line_are_named_by_line_and_column() {
    for (text, pairs, expected) in [
        (
            "1,2\n3,x4\n",
            2,
            "a.csv:2:2: sample pair 1 (from 0), S_D (right): the value is `x4`, not a finite number; ",
        ),
        (
            "#\n\nc,d\r\n1,2\r\n\r\nnan,4\r\n5,6\n7,inf",
            4,
            "a.csv:6:1: sample pair 1 (from 0), S_C (left): the value is NaN, not a finite number, the first of 2; ",
        ),
        (
            "0,1,2\n1,2,-Inf\n",
            2,
            "a.csv:2:3: sample pair 1 (from 0), S_D (right): the value is -inf, not a finite number; ",
        ),
        (
            "0,1,2\n1,1e99,3\n",
            2,
            "a.csv:2:2: sample pair 1 (from 0), S_C (left): the value is inf, not a finite number; ",
        ),
        (
            "1,2\n,3\n",
            2,
            "a.csv:2:1: sample pair 1 (from 0), S_C (left): the value is missing; rows whose window contains one ",
        ),
        (
            "1,2\n3,\n",
            2,
            "a.csv:2:2: sample pair 1 (from 0), S_D (right): the value is missing; rows whose window contains one ",
        ),
        (
            "1,2\n,\n3,4\n",
            3,
            "a.csv:2:1: sample pair 1 (from 0), S_C (left): the value is missing, the first of 2; ",
        ),
        (
            "1,2\n\"3,4\n5,6\n",
            3,
            "a.csv:2:1: sample pair 1 (from 0), S_C (left): the value is `\"3`, not",
        ),
        (
            "1,2\nx,y\nz,-\n",
            1,
            "a.csv:2:1: S_C is `x`, not a number; correct or delete the line, or begin it with #",
        ),
        (
            "1x,2\n-,2\n1,2\n1,2\n1,2\n",
            0,
            "a.csv:1:1: S_C is `1x`, not a number; ",
        ),
        ("1,x\n", 0, "a.csv:1:2: S_D is `x`, not a number; "),
        // Every line has the form of the first, which holds no names.
        (
            "0x0CEC,0x07F1\n0x0CED,0x07F0\n",
            0,
            "a.csv:1:1: S_C is `0x0CEC`, not a number; write the codes in decimal digits; unsigned",
        ),
        (
            "[3300, 2033]\n[3301, 2032]\n",
            0,
            "a.csv:1:1: S_C is `[3300`, not a number; remove the brackets, `tr -d",
        ),
        (
            "C:512,D:498\nC:513,D:497\nC:514,D:-6\n",
            0,
            "a.csv:1:1: S_C is `C:512`, not a number; remove the labels, `sed",
        ),
        (
            "t=0.1,512,498\nt=0.2,513,497\n",
            0,
            "a.csv:1:1: the time is `t=0.1`, not a number; remove the labels, `sed",
        ),
        (
            "12:34:56.789 -> 512,498\n12:34:56.790 -> 513,497\n",
            0,
            "a.csv:1:1: S_C is `12:34:56.789 -> 512`, not a number; switch the terminal's time stamps off",
        ),
        (
            "a b\n\"1\" 0.5 0.4\n\"2\" 0.3 0.2\n",
            0,
            "a.csv:2: found 3 fields where the first line has 2; use another separator than the decimal mark, and the same one in \
             every line, and write no row names (in R `row.names = FALSE`)",
        ),
        (
            "ready\n1,2\n3,4\n",
            0,
            "a.csv:1: found 1 column, but two (S_C, S_D) or three (time in s, S_C, S_D) are needed; give one sample pair a line: of \
             two files `paste -d, c.csv d.csv`, of two variables in MATLAB or Octave `dlmwrite('both.csv', [c(:) d(:)], 'precision', 9)`; \
             if this line is a title, delete it or begin it with #",
        ),
        ("s,V,V\n0,1\n", 0, "a.csv:2:3: S_D is missing here; "),
        (
            "time,c,d\nx,V,V\n",
            0,
            "a.csv:2:1: the time is `x`, not a finite number; ",
        ),
        (
            "1\n2\n",
            0,
            "a.csv:1: found 1 column, but two (S_C, S_D) or three (time in s, S_C, S_D) are needed; ",
        ),
        ("1,2,3,4\n", 0, "a.csv:1: found 4 columns, but two "),
        (
            "# a\ntime_min,c,d\n",
            0,
            "a.csv:2: the time column `time_min` is not in s, ms, us or ns; convert it to seconds, \
             or ignore the time column with --columns 2,3 --rate HZ",
        ),
        (
            "time,c,d\nh,V,V\n",
            0,
            "a.csv:2: the time column `h` is not in s, ms, us or ns; ",
        ),
        (
            "time,c,d\n,1,2\n",
            0,
            "a.csv:2:1: the time is missing here; ",
        ),
        (
            "c,d\nNA,NA\n",
            1,
            "a.csv:2:1: sample pair 0 (from 0), S_C (left): the value is `NA`, not a finite number, the first of 2; ",
        ),
        (
            "c,d\n1,2\nV,V\n",
            2,
            "a.csv:3:1: sample pair 1 (from 0), S_C (left): the value is `V`, not",
        ),
        (
            "# nothing\n\n",
            0,
            "a.csv: there are no sample pairs in it; ",
        ),
        ("c,d\n", 0, "a.csv: there are no sample pairs in it; "),
        (
            "1,2\n3,\x1b[31m4\n",
            2,
            "a.csv:2:2: sample pair 1 (from 0), S_D (right): the value is `\\u{1b}[31m4`, not",
        ),
    ] {
        check(text, pairs, expected);
    }
}

#[test]
fn long_text_is_cut_short() {
    let fault = bad(&format!("1,2\n3,{}\n", "é".repeat(1000))).1;
    assert!(
        fault.contains(&format!(
            "S_D (right): the value is `{}`, not",
            "é".repeat(40)
        )),
        "{fault}"
    );
}

#[test]
fn a_line_without_end_does_not_fill_the_memory() {
    let endless = "1".repeat(300_000);
    let expected =
        "more than 65536 bytes without an end of line; give text with one sample pair a line";
    assert_eq!(bad(&endless), (0, format!("a.csv:1: {expected}")));
    assert_eq!(
        bad(&format!("1,2\n3,4\n{endless}")),
        (2, format!("a.csv:3: {expected}"))
    );
}

#[test]
fn progress_reaches_the_size_of_the_file() {
    let mut text = "\u{feff}# comment\n".to_owned();
    (0..1000).for_each(|k| write!(text, "\r\n{},{k}", k % 7).unwrap());
    let (_directory, path) = file("a.csv", text.as_bytes());
    let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
    assert_eq!(
        (recording.opened.pairs, recording.full_scale()),
        (None, None)
    );
    let mut block = Vec::new();
    while recording.read(&mut block).unwrap() > 0 {}
    assert_eq!(Some(recording.bytes_read()), recording.bytes_total);
}
