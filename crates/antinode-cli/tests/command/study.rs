//! `antinode study`: its files as they are seen, and what is told where they cannot be.

use std::fs;

use crate::common::run;

/// Width of a chart, and of a letter of a wide font, in its size.
const WIDTH: f64 = 740.0;
const LETTER: f64 = 0.55;

#[test]
fn captions_fit_and_what_cannot_be_written_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // The last one, behind all captions that are long.
    fs::create_dir_all(here.join("it/figure-3d.png")).unwrap();
    let made = run(here, "study --out it --runs 1");
    assert_eq!(
        (
            made.code,
            made.out.as_str(),
            made.err.replace('\\', "/").as_str()
        ),
        (
            1,
            "",
            "error: it/figure-3d.png: cannot be written: the image is not stored whole; check that its directory exists, may be \
             written and has room\n"
        )
    );
    for name in ["figure-1b.svg", "figure-2b.svg"] {
        let svg = fs::read_to_string(here.join("it").join(name)).unwrap();
        let (before, caption) = svg.split_once("\nFigure ").unwrap();
        let (caption, _) = caption.split_once('\n').unwrap();
        let (_, size) = before.rsplit_once("font-size=\"").unwrap();
        let size: f64 = size.split('"').next().unwrap().parse().unwrap();
        let letters = "Figure ".len() + caption.chars().count();
        assert!(size * LETTER * (letters as f64) < WIDTH, "{name}: {size}");
    }
}
