//! Text recordings with a time column: the sample rate it gives, and the errors if it gives none.

use std::io::{self, Read};

use super::super::super::tests::file;
use super::super::super::{OpenOptions, Recording};
use super::{bad, check};

fn rate(text: &str) -> Option<f64> {
    let (_directory, path) = file("a.csv", text.as_bytes());
    Recording::open(&path, &OpenOptions::default())
        .expect("a good recording")
        .opened
        .sample_rate
}

#[test]
fn the_rate_comes_from_the_time() {
    assert_eq!(rate("1,2\n3,4\n"), None);
    assert_eq!(
        rate("t,c,d\n5,1,2\n5.00001,3,4\n5.00002,5,6\n"),
        Some(100_000.0)
    );
    assert_eq!(rate("0;1,5;2\n0,0001;3;4\n0,0002;3;4\n"), Some(10_000.0));
    assert_eq!(rate("0,1,2\n"), None);
}

#[test]
fn the_time_may_have_a_unit() {
    let lines = "0,1,2\n0.02,3,4\n0.04,5,6\n";
    for (header, expected) in [
        ("time,c,d\ns,V,V\n", 50.0),
        ("time,c,d\n(ms),(V),(V)\n\n", 50e3),
        ("time [s],c,d\nµs,,\n", 50e6),
        ("time,c,d\nns,LSB,LSB\n", 50e9),
        ("time_ms,c,d\n", 50e3),
        ("Time (us),A,B\n", 50e6),
        ("timens,c,d\n", 50e9),
        ("ms,V,V\n", 50e3),
    ] {
        assert_eq!(
            rate(&format!("{header}{lines}")),
            Some(expected),
            "{header}"
        );
    }
    // A µ of an older encoding.
    let (_directory, path) = file("a.csv", b"time,c,d\n(\xb5s),V,V\n0,1,2\n4.000,3,4\n");
    let recording = Recording::open(&path, &OpenOptions::default()).unwrap();
    assert_eq!(recording.opened.sample_rate, Some(250e3));
}

#[test]
fn gaps_as_regular_as_packets_are_reported_as_such() {
    // Packets of equal size, whose own times make each last longer than its pairs do.
    let told = |packets: &[usize]| {
        let mut text = String::new();
        let mut time = 0.0;
        for &pairs in packets {
            for _ in 0..pairs {
                text += &format!("{time:.6},1,2\n");
                time += 1e-5;
            }
            time += 3e-5;
        }
        check(
            &text,
            packets.iter().sum(),
            "a.csv:51: 3 samples are lost before this line",
        )
    };
    let regular = told(&[50; 7]);
    assert!(
        regular.contains(", one every 50 samples, as if packets had their own time stamps"),
        "{regular}"
    );
    for packets in [[50; 5].as_slice(), &[50, 50, 50, 50, 51, 50, 50]] {
        let seldom = told(packets);
        assert!(!seldom.contains("one every"), "{seldom}");
    }
}

#[test]
fn faults_in_time_are_named_by_line() {
    for (text, pairs, expected) in [
        (
            "0,1,2\n1,1,2\n2,1,2\n1.5,1,2\n",
            3,
            "a.csv:4: time goes from 2 s to 1.5 s, but must increase, and what follows is not read; sort",
        ),
        (
            "0,1,2\n1,1,2\n2,1,2\n5,1,2\n6,1,2\n",
            5,
            "a.csv:4: 2 samples are lost before this line (time goes from 2 s",
        ),
        (
            "0,1,2\n1,1,2\n2,1,2\n4,1,2\n5,1,2\n",
            5,
            "a.csv:4: 1 sample is lost before this line ",
        ),
        (
            "0,1,2\n1.0,1,2\n2.00,1,2\n3.05,1,2\n4.05,1,2\n5.05,1,2\n",
            3,
            "a.csv:4: time steps by 1.0500e0 s here, but by 1.0000e0 s elsewhere; sample at",
        ),
        (
            "2,1,2\n1,1,2\n",
            1,
            "a.csv:2: time goes from 2 s to 1 s, but must increase, and what follows is not read; ",
        ),
        (
            "2,1,2\n2,1,2\n2,1,2\n",
            1,
            "a.csv:2: time goes from 2 s to 2 s, but must increase, and what follows is not read; ",
        ),
        (
            "2,1,2\n2,1,2\n2,1,2\n3,1,2\n",
            1,
            "a.csv:2: times are given to 1e0 s only, too coarse for samples ",
        ),
    ] {
        let fault = check(text, pairs, expected);
        let remedy = ", or ignore the time column with --columns 2,3 --rate HZ";
        assert!(fault.ends_with(remedy), "{fault}");
    }
}

#[test]
fn a_line_whose_time_is_wrong_is_left_out_and_the_next_are_read() {
    let line = |k: usize| format!("{:.5},{},0.5", k as f64 * 1e-5, k % 7);
    let lines: Vec<String> = (0..100_000).map(line).collect();
    for at in [40, 90_000] {
        let time = &lines[at][..7];
        let wrong = |text: &str| vec![lines[at].replacen(time, text, 1)];
        let again = || lines[at - 19..at].to_vec();
        // What stands in place of some lines, how many are replaced, and the pairs and the line of the fault.
        for (new, old, pairs, line) in [
            (wrong("0.0"), 1, 99_999, at + 1),
            (wrong("-1"), 1, 99_999, at + 1),
            (wrong("9.9E37"), 1, 99_999, at + 1),
            (wrong("0.900031"), 1, 99_999, at + 1),
            (wrong("0.99999"), 1, 99_999, at + 1),
            (again(), 0, 100_000, at + 1),
            (
                vec![lines[at + 1].clone(), lines[at].clone()],
                2,
                99_999,
                at + 1,
            ),
            (
                vec![lines[at][..8].to_owned(), lines[at][8..].to_owned()],
                1,
                100_000,
                at + 2,
            ),
        ] {
            let mut all = lines.clone();
            all.splice(at..at + old, new.clone());
            let (count, fault) = bad(&(all.join("\n") + "\n"));
            assert_eq!(count, pairs, "{new:?}: {fault}");
            let is_told = fault.contains("the lines behind do: the line is left out");
            assert!(
                is_told && fault.starts_with(&format!("a.csv:{line}")),
                "{new:?}: {fault}"
            );
        }
    }
    // The first one too.
    for first in ["7,1,2\n", "-3.700004,1,2\n"] {
        let (pairs, fault) = bad(&(first.to_owned() + &lines[1..].join("\n")));
        assert_eq!(pairs, 99_999, "{first}");
        assert!(fault.starts_with("a.csv:1:1: the time `"), "{fault}");
    }
}

#[test]
fn a_column_that_counts_the_samples_shows_which_are_missing() {
    let text = |names: &str, count: &dyn Fn(u32) -> u32| -> String {
        let lines = (0..1000).map(|k| format!("{},1,2\n", count(k)));
        format!("{names}\n{}", lines.collect::<String>())
    };
    let gap = |k: u32| k + 300 * u32::from(k >= 500);
    for names in ["index,c,d", "n,x,y", ",c,d", "Sample,ADC1,ADC2"] {
        let (pairs, fault) = bad(&text(names, &gap));
        let expected = "a.csv:502: 300 samples are lost before this line (the count of samples goes from 499 to 800)";
        assert!(
            pairs == 1000 && fault.starts_with(expected),
            "{names}: {fault}"
        );
        // It gives no rate, and no time.
        let (_directory, path) = file("a.csv", text(names, &gap).as_bytes());
        let recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        assert_eq!(
            (recording.opened.sample_rate, recording.opened.start),
            (None, 0.0)
        );
    }
    // A gap before the count begins anew is still told as one of counts.
    let (pairs, fault) = bad(&text("n,c,d", &|k| gap(k) % 1200));
    assert!(
        pairs == 1000 && fault.contains("the count of samples goes from 499 to 800"),
        "{fault}"
    );
    // One that begins anew or counts something else does not.
    for count in [|k| k % 600, |k| k / 8, |k| 7 * k, |_| 0, |k| k * k] {
        let (pairs, fault) = bad(&text("n,c,d", &count));
        assert!(pairs == 1000 && fault.is_empty(), "{fault}");
    }
}

#[test]
fn a_jump_of_the_times_does_not_move_the_rate_before_it() {
    let time = |k: u32| f64::from(k) + if k < 300 { 0.0 } else { 0.46 };
    let text: String = (0..400)
        .map(|k| format!("{:.3}e-5,1,2\n", time(k)))
        .collect();
    assert_eq!(rate(&text), Some(1e5));
    assert_eq!(bad(&text).0, 300);
}

#[test]
fn samples_at_uneven_times_are_refused() {
    // One in four: each alone could be an accident.
    let time = |k: u32| f64::from(k) + [0.0, 0.0, 0.0, 0.03][k as usize % 4];
    let text: String = (0..10_000)
        .map(|k| format!("{:.3},1,2\n", time(k)))
        .collect();
    let (pairs, fault) = bad(&text);
    assert!(
        pairs < 40 && fault.contains("sample at a constant rate"),
        "{pairs}: {fault}"
    );
}

#[test]
fn a_gap_far_behind_the_first_lines_is_found() {
    let line = |k: u32| format!("{:.6},{},0.5\n", f64::from(k) / 96_000.0, k % 7);
    let mut text = "time,c,d\n".to_owned();
    (0..150_000)
        .filter(|&k| k != 140_000)
        .for_each(|k| text.push_str(&line(k)));
    let (pairs, fault) = bad(&text);
    assert_eq!(pairs, 149_999);
    assert!(
        fault.starts_with("a.csv:140002: 1 sample is lost before this line "),
        "{fault}"
    );
    assert_eq!(rate(&text), Some(96_000.0));
    // It is known where it belongs.
    let (_directory, path) = file("a.csv", text.as_bytes());
    let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
    while recording.next_gap().is_none() {
        recording.read(&mut Vec::new()).unwrap();
    }
    let gap = recording.next_gap().unwrap();
    assert_eq!((gap.before, gap.lost), (140_000, 1));
}

/// A live stream, of which no more must be asked for than has come.
struct Live(io::Cursor<String>);

impl Read for Live {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.0.read(bytes)?;
        assert!(read > 0, "held up");
        Ok(read)
    }
}

#[test]
fn pairs_that_were_read_ahead_are_not_held_up_by_the_next_line() {
    let options = OpenOptions {
        rate: Some(1e5),
        ..OpenOptions::default()
    };
    for lines in 1024..1030 {
        let text: String = (0..lines)
            .map(|k| format!("{:.5},{},1\n", f64::from(k) * 1e-5, k % 7))
            .collect();
        let stream = Box::new(Live(io::Cursor::new(text)));
        let mut opened =
            super::super::open(stream, &options, true).unwrap_or_else(|_| panic!("{lines}"));
        let mut pairs = Vec::new();
        while pairs.len() < lines as usize {
            assert!(opened.source.fill(&mut pairs, 1 << 14).is_ok());
        }
    }
}

#[test]
fn a_live_stream_of_times_that_show_no_rate_is_refused_at_once() {
    let options = OpenOptions {
        rate: Some(1e5),
        ..OpenOptions::default()
    };
    // Each time stands in two lines, and time runs backwards.
    for time in [|k: i32| k / 2, |k: i32| 5000 - k] {
        let lines = (0..1100).map(|k| format!("{}e-5,{},1\n", time(k), k % 7));
        let text = format!("time,c,d\n{}", lines.collect::<String>());
        let stream = Box::new(Live(io::Cursor::new(text)));
        let mut pairs = Vec::new();
        let read = super::super::open(stream, &options, true).and_then(|mut opened| {
            opened.source.fill(&mut pairs, 1 << 14)?;
            opened.source.fill(&mut pairs, 1 << 14)
        });
        assert!(read.is_err() && pairs.len() < 2, "{}", pairs.len());
    }
}
