//! The committed header is the one that the pinned cbindgen generates from the sources.

use std::path::Path;

#[test]
fn the_committed_header_is_that_of_the_sources() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut text = Vec::new();
    cbindgen::generate(here)
        .expect("the sources can be read")
        .write(&mut text);
    let text = in_c(String::from_utf8(text).expect("the header is text"));
    assert!(
        text.is_ascii(),
        "a comment has a letter that `in_c` does not know"
    );
    let path = here.join("include/antinode.h");
    if std::env::var_os("ANTINODE_BLESS").is_some() {
        std::fs::write(&path, &text).expect("the header can be written");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == text,
        "{} is not that of the sources: ANTINODE_BLESS=1 cargo test -p antinode-capi --test header",
        path.display()
    );
}

/// MISRA C, rule 3.1: no `/*` or `//` within a comment.
#[test]
fn no_comment_holds_the_mark_of_another() {
    let text = include_str!("../include/antinode.h");
    for line in text.lines() {
        let marks = ["/*", "//"].map(|mark| line.matches(mark).count());
        // `//` within such a comment is allowed.
        let is_comment = line.trim_start().starts_with("//") && marks[0] == 0;
        let is_one = marks[0] + marks[1] <= 1 && line.matches("*/").count() == marks[0];
        assert!(is_comment || is_one, "{line}");
    }
}

/// The header with the constants' names in C, and in ASCII.
fn in_c(text: String) -> String {
    let spellings = [
        ("ANTINODE_STATUS_T_", "ANTINODE_"),
        // In C the enum has no tag, because its typedef is a number: C++ does not allow one name for both.
        ("enum antinode_status_t\n#if", "enum\n#if"),
        ("\n  : int32_t\n", "\n    antinode_status_t : int32_t\n"),
        ("ANTINODE_FLAG_…", "ANTINODE_FLAG_*"),
        ("ANTINODE_DETECTION_…", "ANTINODE_DETECTION_*"),
        ("0…π/2", "0 to pi/2"),
        ("…", "*"),
        ("±", "+-"),
        ("×", "x"),
        ("·", "*"),
        ("−", "-"),
        ("°", " degrees"),
        ("π", "pi"),
        ("θ", "theta"),
        ("α", "alpha"),
    ];
    let spelled = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
    spellings.iter().fold(text, spelled)
}
