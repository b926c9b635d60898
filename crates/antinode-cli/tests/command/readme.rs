//! What the README shows is what its commands print and draw.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::common::README;

/// What the first block of such a language behind a heading holds.
fn block(heading: &str, language: &str) -> &'static str {
    let (_, behind) = README.split_once(heading).unwrap();
    let (_, block) = behind.split_once(&format!("```{language}\n")).unwrap();
    block.split_once("```").unwrap().0
}

/// Runs the commands behind a heading.
fn run(heading: &str, here: &Path) -> Output {
    let command = Path::new(env!("CARGO_BIN_EXE_antinode"));
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", command.parent().unwrap().display());
    let output = Command::new("sh")
        .args(["-ec", block(heading, "sh")])
        .env("PATH", path)
        .current_dir(here)
        .output();
    output.unwrap()
}

#[test]
fn it_shows_the_resonator_as_it_is_printed() {
    let directory = tempfile::tempdir().unwrap();
    let printed = run("### The resonator", directory.path());
    let told = [printed.stdout, printed.stderr].map(|told| String::from_utf8(told).unwrap());
    let mut told = told.iter().flat_map(|told| told.lines());
    let shown = block("### The resonator", "text").lines();
    for line in shown.filter(|&line| line != "…") {
        assert!(told.any(|other| other == line), "{line}");
    }
}

#[test]
fn it_shows_a_ring_down_as_it_is_drawn() {
    let directory = tempfile::tempdir().unwrap();
    run("### Plots", directory.path());
    let drawn = fs::read_to_string(directory.path().join("ring.svg")).unwrap();
    let shown = include_str!("../../docs/ring.svg");
    assert!(drawn == shown, "copy the ring.svg drawn now");
}
