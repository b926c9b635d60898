//! Lines, their fields and numbers.

use super::*;

#[test]
fn the_separator_is_found_in_the_line() {
    assert_eq!(separator(b"1,5;2,5"), b';');
    assert_eq!(separator(b"1,5\t2,5"), b'\t');
    assert_eq!(separator(b"1.5, 2.5"), b',');
    assert_eq!(separator(b"1.5  2.5"), b' ');
}

#[test]
fn comments_are_distinguished_from_fields() {
    for line in ["# a", " %a", "//", "; Samplerate: 1 MHz", "; CSV by x"] {
        assert!(is_comment(line.as_bytes()), "{line}");
    }
    for line in [";1;2", "; 1; 2", "; C; D", ";c;d", "c; D", "/"] {
        assert!(!is_comment(line.as_bytes()), "{line}");
    }
}

#[test]
fn fields_lose_blanks_and_quotes() {
    let split = |line, mark| {
        fields(line, mark)
            .map(|field| str::from_utf8(field).unwrap())
            .collect::<Vec<_>>()
    };
    assert_eq!(split(b" 1.5, \"2.5\" ,\r\n", b','), ["1.5", "2.5"]);
    assert_eq!(split(b"  1.5   2.5 \n", b' '), ["1.5", "2.5"]);
    assert_eq!(split(b"1,,2", b','), ["1", "", "2"]);
    // A separator in quotes is part of the field, if they enclose all of it.
    assert_eq!(
        split(b"t, \"C, V\" ,\"a \"\"x, y\"\"\",d", b','),
        ["t", "C, V", "a \"\"x, y\"\"", "d"]
    );
    assert_eq!(split(b"5\" x,d,\"", b','), ["5\" x", "d", "\""]);
    assert_eq!(split(b"\"a\"b,\"c,d", b','), ["\"a\"b", "\"c", "d"]);
}

#[test]
fn lines_end_the_same_way() {
    for (text, expected) in [
        ("1,2\r3,4\r", "1,2\n3,4\n"),
        ("\r,\r3,4\r", "\n,\n3,4\n"),
        ("c,d\r\r1,2\r", "c,d\n\n1,2\n"),
        // A `\r` before the end of a line, or of a line of the left one of two files side by side, is a blank.
        ("1,2\r\n3,4", "1,2\r\n3,4"),
        ("1,2\n3,4\n", "1,2\n3,4\n"),
        ("1,2\r\r\n3,4", "1,2\r\r\n3,4"),
        ("1\r,2\r\n3\r,4", "1\r,2\r\n3\r,4"),
    ] {
        for most in [1, 2, 3, 100] {
            let bytes = text.as_bytes().to_vec();
            let stream = super::super::tests::Dribble::new(bytes, most);
            let mut found = String::new();
            with_line_ends(Box::new(stream))
                .unwrap()
                .read_to_string(&mut found)
                .unwrap();
            assert_eq!(found, expected);
        }
    }
    let split = |line| fields(line, b',').collect::<Vec<_>>();
    assert_eq!(split(b"1\r,2\r\r\n"), [b"1", b"2"]);
}
