//! `antinode plot`: the values that its axes hold, and those that they leave out.

use std::fs;

use crate::common::run;
use crate::common::svg::{DARK, FIRST, HEADER, Svg, TITLES, drawn};

#[test]
fn a_flagged_value_far_from_the_others_ends_at_the_edge() {
    let directory = tempfile::tempdir().unwrap();
    let lines: String = (0..9)
        .map(|k| match k {
            4 => "4,900,0.001,900,900,9000,900,misfit,a\n".to_owned(),
            _ => format!("{k},0.{k},0.001,0.{k},0.{k},533{k},0.{k},,a\n"),
        })
        .collect();
    let svg = drawn(
        directory.path(),
        &(HEADER.to_owned() + &lines),
        "9 rows of a; 1 flagged",
    );
    for panel in svg.panels() {
        // Clean rows fill at least half of the panel.
        let line = &svg.lines(&panel, FIRST)[0];
        let height = panel.down.end - panel.down.start;
        assert!(line[0].1 - line[8].1 > 0.5 * height && line[4].1 < line[8].1);
    }
}

#[test]
fn constants_and_single_rows_have_axes() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let steady: String = (0..30)
        .map(|k| format!("{k},0.5,0,0,0,5332,0,,a\n"))
        .collect();
    let svg = drawn(
        here,
        &(HEADER.to_owned() + &steady),
        "30 rows of a; 0 flagged",
    );
    for panel in svg.panels() {
        let lines = svg.lines(&panel, FIRST);
        let middle = (panel.down.start + panel.down.end) / 2.0;
        assert!(lines[0].iter().all(|point| (point.1 - middle).abs() < 2.0));
        assert_eq!((lines.len(), lines[0].len()), (1, 30));
    }
    let svg = drawn(
        here,
        &(HEADER.to_owned() + "4.5,0.5,0.01,0,0,5332,0,,a\n"),
        "1 row of a; 0 flagged",
    );
    assert_eq!(svg.0.matches("<circle ").count(), TITLES.len());
    assert!(svg.texts().contains(&"time, s"));
    // Its deviation is a bar of nearly the panel's height.
    let panel = &svg.panels()[0];
    let bar = &svg.lines(panel, FIRST)[0];
    assert!(bar[0].1 - bar[1].1 > 0.8 * (panel.down.end - panel.down.start));
}

#[test]
fn zeros_show_their_deviation() {
    let directory = tempfile::tempdir().unwrap();
    let header = HEADER.replace("residual", "quadrature_amplitude_std,residual");
    let lines = (0..10).map(|k| format!("{k},0.5,0,0,0.1,5332,2e-5,0.01,,a\n"));
    let rows = header + &lines.collect::<String>();
    let svg = drawn(directory.path(), &rows, "10 rows of a; 0 flagged");
    let texts = svg.texts();
    // Two of them high, and a margin.
    for text in ["quadrature amplitude × 10⁶", "20", "−20"] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
}

#[test]
fn times_of_a_clock_that_began_long_ago_are_readable() {
    let directory = tempfile::tempdir().unwrap();
    let times = (0..10).map(|k| format!("170000000{k}.5,0.5,0,0,0,5332,0,,a\n"));
    let rows = HEADER.to_owned() + &times.collect::<String>();
    let svg = drawn(directory.path(), &rows, "10 rows of a; 0 flagged");
    let texts = svg.texts();
    for text in ["time − 1700000000 s, s", "9"] {
        assert!(texts.contains(&text), "{texts:?}");
    }
}

#[test]
fn a_long_ring_down_may_have_logarithmic_axes() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let lines = "0,1,0,-0.5,0,5332,0.1,,a\n1,0.1,0,0.05,0.1,5333,0.01,,a\n2,0.01,0,-0.005,0.2,5334,0.001,,a\n3,0.01,0,0,0.3,5335,0.001,,a\n";
    fs::write(here.join("rows.csv"), HEADER.to_owned() + lines).unwrap();
    let made = run(here, "plot rows.csv -o it.svg --log");
    assert_eq!((made.code, made.err.as_str()), (0, ""));
    let svg = Svg::open(&here.join("it.svg"));
    for (index, panel) in svg.panels().iter().enumerate() {
        let line = &svg.lines(panel, FIRST)[0];
        let share = |k: usize| (panel.down.end - line[k].1) / (panel.down.end - panel.down.start);
        let shares = match index {
            0 | 4 => [1.0, 0.5, 0.0, 0.0],
            // Its magnitude; 0 is drawn at the lower edge.
            1 => [1.0, 0.5, 0.0, 0.0],
            _ => [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|share| (share + 0.08) / 1.16),
        };
        for (k, wanted) in shares.into_iter().enumerate() {
            assert!(
                (share(k) - wanted).abs() < 0.01,
                "{index} {k}: {}",
                share(k)
            );
        }
    }
    let texts = svg.texts();
    for text in ["|quadrature amplitude|", "0.01", "0.1", "1", "0.001"] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
}

#[test]
fn rows_near_noise_do_not_influence_the_axes() {
    let directory = tempfile::tempdir().unwrap();
    let header = HEADER.replace("residual", "frequency_std_hz,angle_std_rad,residual");
    // The frequency drifts by 20 mHz. At the end its deviation is more than that, and the angle's is soon a small part of a turn.
    let lines: String = (0..100)
        .map(|k| {
            let (off, std) = match k {
                97.. => (f64::from(k - 98) * 30.0, 10.0),
                _ => (0.0, 1e-3),
            };
            let frequency = 5332.0 + 2e-4 * f64::from(k) + off;
            let of_angle = if k < 55 { 1e-4 } else { 0.02 };
            format!("{k},0.5,0,0,0.{k:02},{frequency},{std},{of_angle},0.1,,a\n")
        })
        .collect();
    let svg = drawn(
        directory.path(),
        &(header + &lines),
        "100 rows of a; 0 flagged",
    );
    let panel = &svg.panels()[3];
    let line = &svg.lines(panel, FIRST)[0];
    let height = panel.down.end - panel.down.start;
    assert!(line[0].1 - line[96].1 > 0.4 * height, "{line:?}");
    assert_eq!(line[97].1.round(), panel.down.end.round());
    assert_eq!(line[99].1.round(), panel.down.start.round());
    let angles = &svg.lines(&svg.panels()[2], FIRST)[0];
    assert!(
        angles.is_sorted_by(|one, next| one.1 > next.1),
        "{angles:?}"
    );
    assert!(svg.texts().contains(&"values beyond the axis"));
    // One in the legend, one below and one above.
    assert_eq!(svg.points("polygon", DARK).len(), 3);
}
