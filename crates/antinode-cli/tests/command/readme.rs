//! What the README shows is what its commands print and draw.

#[cfg(unix)]
use std::fs;
#[cfg(unix)]
use std::path::Path;
#[cfg(unix)]
use std::process::{Command, Output};

use crate::common::{README, run};

/// What the first block of such a language behind a heading holds.
fn block(heading: &str, language: &str) -> &'static str {
    let (_, behind) = README.split_once(heading).unwrap();
    let (_, block) = behind.split_once(&format!("```{language}\n")).unwrap();
    block.split_once("```").unwrap().0
}

/// Each line that it shows behind a heading is printed, in their order.
fn is_printed(heading: &str, printed: &str) {
    let mut printed = printed.lines();
    let shown = block(heading, "text").lines();
    for line in shown.filter(|&line| line != "…") {
        assert!(printed.any(|other| other == line), "{line}");
    }
}

/// Runs the commands behind a heading.
#[cfg(unix)]
fn run_commands(heading: &str, here: &Path) -> Output {
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
fn it_shows_the_demonstration_as_it_is() {
    let directory = tempfile::tempdir().unwrap();
    is_printed("# antinode", &run(directory.path(), "").out);
}

#[cfg(unix)]
#[test]
fn it_shows_the_resonator_as_it_is_printed() {
    let directory = tempfile::tempdir().unwrap();
    let printed = run_commands("### The resonator", directory.path());
    let told = [printed.stdout, printed.stderr].concat();
    is_printed("### The resonator", &String::from_utf8(told).unwrap());
}

#[cfg(unix)]
#[test]
fn it_shows_a_ring_down_as_it_is_drawn() {
    let directory = tempfile::tempdir().unwrap();
    run_commands("### Plots", directory.path());
    let drawn = fs::read_to_string(directory.path().join("ring.svg")).unwrap();
    let shown = include_str!("../../docs/ring.svg");
    assert!(drawn == shown, "copy the ring.svg drawn now");
}
