//! `antinode plot`: the figure shows what the rows contain.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use crate::common::svg::{FIRST, HEADER, SECOND, Svg, TITLES, drawn};
use crate::common::{Row, beside_flagged, done, names, run, run_with};

/// Rows of a ring-down that precesses and is interrupted twice.
fn ring_down(here: &Path) -> String {
    done(
        here,
        "simulate -o ring.wav --seconds 3 --noise 0.002 --decay-rate 0.5 --angle-rate 0.4 --dropout 0.5:0.6:zero --dropout 2:2.3:zero",
    );
    let rows = done(here, "identify --output csv --periods 50 ring.wav");
    assert_eq!(beside_flagged(&Row::all(&rows.out), &rows.err), [""; 0]);
    rows.out
}

#[test]
fn every_quantity_has_its_panel() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = ring_down(here);
    let rows = Row::all(&text);
    let flagged: Vec<f64> = rows
        .iter()
        .filter(|row| !row.text("flags").is_empty())
        .map(|row| row.number("time_s"))
        .collect();
    let told = format!("{} rows of ring.wav; {} flagged", rows.len(), flagged.len());
    let svg = drawn(here, &text, &told);

    let texts = svg.texts();
    let mut places = texts.iter();
    for title in TITLES {
        assert!(
            places.any(|text| text.starts_with(title)),
            "{title}: {texts:?}"
        );
    }
    for text in [
        "ring.wav",
        "± one standard deviation",
        "flagged rows",
        "time, s",
    ] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    let mut frequencies: Vec<f64> = rows
        .iter()
        .filter(|row| row.text("flags").is_empty())
        .map(|row| row.number("frequency_hz"))
        .collect();
    frequencies.sort_by(f64::total_cmp);
    let told = texts.iter().find_map(|text| text.strip_prefix(TITLES[3]));
    let median = told.unwrap().strip_suffix(" Hz, mHz").unwrap();
    let error = median.parse::<f64>().unwrap() - frequencies[frequencies.len() / 2];
    assert!(error.abs() < 5.1e-4, "{median}");

    let (first, last) = (
        rows[0].number("time_s"),
        rows[rows.len() - 1].number("time_s"),
    );
    let bands = svg.points("polygon", FIRST);
    for (index, panel) in svg.panels().iter().enumerate() {
        // The axis goes 1 % beyond the rows on either side.
        let time = |x: f64| {
            let share = (x - panel.across.start) / (panel.across.end - panel.across.start);
            first + (1.02 * share - 0.01) * (last - first)
        };
        let lines = svg.lines(panel, FIRST);
        assert_eq!(lines.len(), 3, "{}: two interruptions", TITLES[index]);
        for line in &lines {
            let (from, to) = (time(line[0].0), time(line[line.len() - 1].0));
            for hole in [0.5..0.6, 2.0..2.3] {
                assert!(
                    to < hole.start + 0.02 || from > hole.end - 0.02,
                    "{from} to {to}"
                );
            }
        }
        // All clean rows are drawn, and a few flagged ones, each at its time.
        let points: usize = lines.iter().map(Vec::len).sum();
        let clean = rows.len() - flagged.len();
        assert!(
            (clean..=rows.len()).contains(&points),
            "{points} of {clean}"
        );
        assert!((time(lines[0][0].0) - first).abs() < 1e-3);
        let (begin, end) = (lines[0][0].1, lines[2][lines[2].len() - 1].1);
        match index {
            0 | 1 => assert!(begin + 200.0 < end, "it decays"),
            2 => assert!(begin > end + 400.0, "it precesses"),
            _ => {}
        }
        let here = bands.iter().filter(|band| panel.down.contains(&band[0].1));
        assert_eq!(
            here.count(),
            if index < 4 { 3 } else { 0 },
            "{}",
            TITLES[index]
        );

        let marks = svg.marks(panel);
        assert!(!marks.is_empty());
        let is_marked = |at: f64| {
            let mut marks = marks.iter();
            marks.any(|mark| time(mark.start) - 2e-3 < at && at < time(mark.end) + 2e-3)
        };
        assert!(flagged.iter().all(|&at| is_marked(at)), "{marks:?}");
        let mut clean = rows.iter().filter(|row| row.text("flags").is_empty());
        assert!(
            clean.all(|row| !is_marked(row.number("time_s"))),
            "{marks:?}"
        );
    }
}

#[test]
fn values_are_drawn_in_their_places() {
    let directory = tempfile::tempdir().unwrap();
    // A margin of 8 % of the span is left above and below.
    let rows = HEADER.to_owned()
        + "0,1,0,-2,0,5332.001,0.1,,a\n1,3,0.25,2,0.1,5332.002,0.2,,a\n2,2,0,0,0.05,5332.003,0.3,,a\n";
    let svg = drawn(directory.path(), &rows, "3 rows of a; 0 flagged");
    for (index, panel) in svg.panels().iter().enumerate() {
        let of = |share: f64| panel.down.end - share * (panel.down.end - panel.down.start);
        let shares = match index {
            // The span includes the deviation.
            0 => [0.0, 2.0 / 2.25, 1.0 / 2.25],
            1 | 2 => [0.0, 1.0, 0.5],
            _ => [0.0, 0.5, 1.0],
        };
        let lines = svg.lines(panel, FIRST);
        assert_eq!((lines.len(), lines[0].len()), (1, 3));
        for (point, share) in lines[0].iter().zip(shares) {
            let wanted = of((share + 0.08) / 1.16);
            assert!(
                (point.1 - wanted).abs() < 2.0,
                "{index}: {point:?} {wanted}"
            );
        }
        assert!(svg.marks(panel).is_empty());
    }
    let texts = svg.texts();
    assert!(
        texts.contains(&"frequency less its median of 5332.00200 Hz, mHz"),
        "{texts:?}"
    );
    // 0.1 rad are 5.7°.
    let mut angles = texts.iter().skip_while(|text| **text != TITLES[2]);
    assert!(
        angles.by_ref().take(9).any(|text| *text == "4"),
        "{texts:?}"
    );
    assert!(!texts.contains(&"flagged rows"));
}

#[test]
fn recordings_have_colours_and_names() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let of = |file: &str| -> String {
        let rows = (0..20).map(|k| format!("{k},{},0.1,0.1,{k},5332,0.1,,{file}\n", 20 - k));
        rows.collect()
    };
    let svg = drawn(
        here,
        &(HEADER.to_owned() + &of("a") + &of("b<&>")),
        "40 rows of 2 recordings; 0 flagged",
    );
    let texts = svg.texts();
    assert!(
        texts.contains(&"a") && texts.contains(&"b&lt;&amp;&gt;"),
        "{texts:?}"
    );
    for panel in svg.panels() {
        for colour in [FIRST, SECOND] {
            assert_eq!(svg.lines(&panel, colour).len(), 1, "{colour}");
        }
    }
}

#[test]
fn many_recordings_are_named_and_distinguishable() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let of = |file: &str| -> String {
        let rows = (0..3).map(|k| format!("{k},{k},0.1,0.1,{k},5332,0.1,,{file}\n"));
        rows.collect()
    };
    // One recording in several files of rows.
    for file in ["one.csv", "two.csv"] {
        fs::write(here.join(file), HEADER.to_owned() + &of("same")).unwrap();
    }
    for (others, more) in [(18, None), (48, Some("26 more, in colours between these"))] {
        let rows: String = (0..others).map(|k| of(&format!("other{k}"))).collect();
        fs::write(here.join("others.csv"), HEADER.to_owned() + &rows).unwrap();
        let made = run(here, "plot one.csv two.csv others.csv -o it.svg");
        assert_eq!((made.code, made.err.as_str()), (0, ""));
        let svg = Svg::open(&here.join("it.svg"));
        let texts = svg.texts();
        let last = format!("other{}", others - 1);
        for text in ["one.csv: same", last.as_str()].into_iter().chain(more) {
            assert!(texts.contains(&text), "{text}: {texts:?}");
        }
        let named = texts.iter().filter(|text| text.starts_with("other"));
        let is_told = texts.iter().any(|text| text.contains(" more"));
        assert_eq!(
            (named.count(), is_told),
            (others.min(22) + usize::from(more.is_some()), more.is_some())
        );
        // Axes and grid have one each.
        let strokes = svg.0.lines().filter(|line| line.starts_with("<polyline "));
        let strokes = strokes.filter_map(|line| line.split("stroke=").nth(1)?.split(' ').next());
        let colours: HashSet<_> = strokes.collect();
        assert!(colours.len() >= others + 2, "{colours:?}");
    }
}

#[test]
fn values_that_are_no_numbers_are_skipped() {
    let directory = tempfile::tempdir().unwrap();
    let lines: String = (0..9)
        .map(|k| match k {
            3 => "3,NaN,inf,0.1,0.2,5332,0.1,,a\n".to_owned(),
            6 => "6,0.1,0.001,0.1,0.2,5332,inf,lost,a\n".to_owned(),
            _ => format!("{k},0.{k},0.001,0.1,0.2,5332,0.1,,a\n"),
        })
        .collect();
    let svg = drawn(
        directory.path(),
        &(HEADER.to_owned() + &lines),
        "9 rows of a; 1 flagged",
    );
    let lengths: Vec<Vec<_>> = svg
        .panels()
        .iter()
        .map(|panel| svg.lines(panel, FIRST).iter().map(Vec::len).collect())
        .collect();
    assert_eq!(
        lengths,
        [
            vec![3, 2, 2],
            vec![6, 2],
            vec![6, 2],
            vec![6, 2],
            vec![6, 2]
        ]
    );
}

#[test]
fn rows_may_be_utf_16_as_windows_writes_them() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = format!("\u{feff}{HEADER}0,0.5,0.001,0.1,0.2,5332,0.1,,Ö\r\n");
    let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(here.join("rows.csv"), &little).unwrap();
    for (rows, input) in [("rows.csv", Vec::new()), ("-", little)] {
        let made = run_with(here, &format!("plot {rows} -o it.svg"), input);
        let told = (made.code, made.out.as_str());
        assert_eq!(told, (0, "it.svg: 1 row of Ö; 0 flagged\n"), "{}", made.err);
    }
}

#[test]
fn a_png_is_as_wide_as_two_pixels_a_column() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("ring.csv"), ring_down(here)).unwrap();
    fs::write(here.join("Ring.PNG"), "good").unwrap();
    let made = run(here, "plot ring.csv -o Ring.PNG");
    assert_eq!((made.code, made.err.as_str()), (0, ""));
    let png = fs::read(here.join("Ring.PNG")).unwrap();
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    assert_eq!(png[16..20], 1980u32.to_be_bytes());
    // Half of the 340 KB with lines and bands; axes alone take 120 KB.
    assert!(png.len() > 170_000, "{}", png.len());
    assert_eq!(
        names(here),
        ["Ring.PNG", "ring.csv", "ring.wav", "ring.wav.json"]
    );
}

#[test]
fn a_million_rows_are_a_small_figure() {
    let directory = tempfile::tempdir().unwrap();
    let mut rows = HEADER.to_owned();
    let mut random = 1u32;
    for k in 0..1_000_000 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = 1e-7 * f64::from(random >> 12);
        let flags = if k % 97 == 0 { "misfit" } else { "" };
        rows += &format!(
            "{k},{noise},0.01,{noise},{noise},{},{noise},{flags},a\n",
            5332.0 + noise
        );
    }
    let svg = drawn(directory.path(), &rows, "1000000 rows of a; 10310 flagged");
    // 330 KB with a band in one panel.
    assert!(svg.0.len() < 500_000, "{}", svg.0.len());
    for panel in svg.panels() {
        let lines = svg.lines(&panel, FIRST);
        assert_eq!(lines.len(), 1);
        assert!(
            (880..=4 * 880).contains(&lines[0].len()),
            "{}",
            lines[0].len()
        );
    }
}

#[test]
fn a_part_of_the_rows_may_be_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let lines: String = (0..20)
        .map(|k| format!("{k},0.{k},0,0,0,5332,0.1,,a\n"))
        .collect();
    fs::write(here.join("rows.csv"), HEADER.to_owned() + &lines).unwrap();
    for (span, rows) in [
        ("--from 5 --to 8", 3),
        ("--from 5.5", 14),
        ("--to 4.5", 5),
        ("--from -3", 20),
    ] {
        let made = run(here, &format!("plot rows.csv -o it.svg {span}"));
        let told = format!("it.svg: {rows} rows of a; 0 flagged\n");
        assert_eq!((made.code, made.out), (0, told), "{span}: {}", made.err);
        let svg = Svg::open(&here.join("it.svg"));
        let panel = &svg.panels()[0];
        assert_eq!(svg.lines(panel, FIRST)[0].len(), rows);
    }
}
