//! Recognition and remedies of formats that are not read.

use std::io::Cursor;

use super::super::columns::Columns;
use super::super::tests::{message, raw, read, read_with};
use super::super::{Kind, OpenOptions, by_content, source::Known};
use super::*;

/// The beginning of a file of this format.
fn beginning(known: &Foreign) -> Vec<u8> {
    let mut head = vec![0; known.at];
    head.extend(known.mark);
    head.extend([0, 1, 2, 3]);
    head
}

#[test]
fn each_is_known_by_its_mark_and_has_a_remedy() {
    for known in &KNOWN {
        let mut head = beginning(known);
        match known.at {
            11 => head[..11].copy_from_slice(b"#9000000346"),
            18 => head[..18].copy_from_slice(b"(1600000000.123456"),
            _ => {}
        }
        let (pairs, fault) = read("a.dat", &head);
        assert!(pairs.is_empty());
        let expected = format!(
            "a.dat: this is {}, which is not read; {}",
            known.kind,
            known.remedy.split("FILE").next().unwrap_or_default()
        );
        let fault = fault.expect("a fault");
        // The name in it has a directory before it, which is left out.
        assert!(fault.starts_with(&expected), "{fault}");
        assert!(!fault.contains("FILE"), "{fault}");
    }
}

#[test]
fn archives_are_told_apart_by_the_first_file_in_them() {
    let told = |name: &str| {
        let head = [ZIP, &[0; 26], name.as_bytes(), &[0x93; 40]].concat();
        Foreign::find(&head).map(|found| found.kind)
    };
    assert_eq!(told("c.npy"), Some("an NPZ archive of NumPy"));
    assert_eq!(told("[Content_Types].xml"), Some("a spreadsheet"));
    assert_eq!(told("_rels/.rels"), Some("a spreadsheet"));
    assert_eq!(told("ring.wav"), Some("a ZIP archive"));
}

#[test]
fn whatever_else_is_known_of_it() {
    let gzip = b"\x1f\x8b\x08\x00 and more";
    for name in ["a.gz", "a.wav", "a.npy", "a.csv"] {
        let (_, fault) = read(name, gzip);
        let expected = format!(
            "{name}: this is compressed by gzip, which is not read; unpack it, `gzip -dc \"{name}\" |"
        );
        assert!(
            fault
                .as_ref()
                .is_some_and(|fault| fault.starts_with(&expected)),
            "{fault:?}"
        );
    }
    let columns = OpenOptions {
        columns: Some("1,2".parse::<Columns>().unwrap()),
        ..OpenOptions::default()
    };
    let (_, fault) = read_with("a.gz", gzip, &columns);
    assert!(fault.is_some_and(|fault| fault.contains("compressed by gzip")));
    // Raw samples may begin with any bytes.
    let (pairs, _) = read_with("a.gz", &gzip[..4], &raw(Kind::I16));
    assert_eq!(pairs.len(), 1);
    // Recognised by the name.
    let (_, fault) = read("a.mat", &[0; 20]);
    assert!(fault.is_some_and(|fault| fault.starts_with("a.mat: this is a MATLAB file, ")));
}

#[test]
fn a_remedy_names_the_file_as_a_shell_wants_it() {
    for name in ["a.gz", "a b.gz", "a(1).gz"] {
        let (_, fault) = read(name, b"\x1f\x8b\x08\x00");
        let command = format!("`gzip -dc \"{name}\" | antinode identify -`");
        assert!(fault.is_some_and(|fault| fault.ends_with(&command)));
    }
    let (_, fault) = read("a b.mat", b"MATLAB 5.0 MAT-file");
    assert!(fault.is_some_and(|fault| fault.contains("`load('a b.mat'); ")));
    let stream = Box::new(Cursor::new(b"\x1f\x8b\x08\x00".to_vec()));
    let opened = by_content::open(stream, Known::default(), &OpenOptions::default());
    let told = message(opened.err().map(|fault| fault.of("standard input")));
    let expected = "standard input: this is compressed by gzip, which is not read; unpack it, `gzip -dc FILE | antinode identify -`";
    assert_eq!(told, expected);
}
