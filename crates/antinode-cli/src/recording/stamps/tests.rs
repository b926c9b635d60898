//! Which fields are clock times, and how they are read.

use super::*;

#[test]
fn clock_times_are_read_as_seconds_with_all_their_decimals() {
    for (field, expected) in [
        ("1970-01-01T00:00:00", Some(("0", true))),
        (
            "2026-11-28T13:45:01.123456",
            Some(("1795873501.123456", true)),
        ),
        ("2026-11-28 13:45:01,120", Some(("1795873501.120", true))),
        ("2026-11-28T13:45:01.5Z", Some(("1795873501.5", true))),
        ("2026-11-28T13:45:01.5+02:00", Some(("1795866301.5", true))),
        ("2026-11-28 13:45:01.5 -0030", Some(("1795875301.5", true))),
        (
            "2024-02-29T00:00:00.000000001",
            Some(("1709164800.000000001", true)),
        ),
        ("00:00:00.5", Some(("0.5", false))),
        (
            "23:59:59.12345678901234567890",
            Some(("86399.123456789012", false)),
        ),
        ("01:00:00.5+02:00", Some(("82800.5", false))),
        ("13:45:01Z", Some(("49501", false))),
        ("1:45:01.5", Some(("6301.5", false))),
        ("1:45:01.5 PM", Some(("49501.5", false))),
        ("12:00:01am", Some(("1", false))),
        ("12:00:01 Pm", Some(("43201", false))),
        ("28.11.2026 13:45:01", Some(("1795873501", true))),
        ("28.11.2026  1:45:01,50 PM", Some(("1795873501.50", true))),
        ("2026/11/28 13:45:01.5", Some(("1795873501.5", true))),
        ("2026.11.28T13:45:01", Some(("1795873501", true))),
        ("1.2.2026 0:00:00", Some(("1769904000", true))),
        // Of another form, or none of any day.
        ("13:45", None),
        ("13:45:01.5 PM", None),
        ("13:45:01 -> 755", None),
        ("[13:45:01.5]", None),
        ("24:00:00", None),
        ("13:60:00", None),
        ("2026-02-29T00:00:00", None),
        ("2026-11-28", None),
        ("11/28/2026 13:45:01", None),
        ("28-11-2026 13:45:01", None),
        ("28.11.26 13:45:01", None),
        ("11.28.2026 13:45:01", None),
        ("2026-11.28 13:45:01", None),
        ("0:45:01 PM", None),
        ("013:45:01", None),
        ("13:45:01 M", None),
        (":45:01", None),
        ("1969-12-31T23:59:59.5", None),
        ("é:45:01", None),
        ("12.5", None),
        ("", None),
    ] {
        let found = seconds(field.as_bytes());
        let expected = expected.map(|(text, has_date)| (text.to_owned(), has_date));
        assert_eq!(found, expected, "{field}");
    }
}

/// The text with its clock times in seconds.
fn converted(text: &str) -> String {
    let stamps = Stamps::of(text.as_bytes());
    let mut text = text.as_bytes().to_vec();
    // What is converted already stays as it is.
    for _ in 0..2 {
        stamps.convert(&mut text);
    }
    String::from_utf8(text).unwrap()
}

#[test]
fn only_columns_of_clock_times_are_converted() {
    for (text, expected) in [
        (
            "t,c,d\n00:00:01.5,1,2\r\n00:00:02.5,3,4",
            "t,c,d\n1.5,1,2\r\n2.5,3,4",
        ),
        (
            "  00:00:01   1 2\n\n# 00:00:02 1 2\n",
            "  1   1 2\n\n# 00:00:02 1 2\n",
        ),
        ("\"1970-01-01 00:00:01,5\";\"a;b\";2\n", "1.5;\"a;b\";2\n"),
        ("1\t2\t00:00:01\n3\t4\t00:00:02\n", "1\t2\t1\n3\t4\t2\n"),
        // A garbled one among them.
        (
            "00:00:01,1,2\n00:0x:01,1,2\n00:00:03,1,2\n",
            "1,1,2\n00:0x:01,1,2\n3,1,2\n",
        ),
    ] {
        assert_eq!(converted(text), expected);
    }
    for text in [
        "Time,13:45:01,13:45:01\n1,2,3\n4,5,6\n",
        "13:45:01\t755,3\n13:45:02\t756,3\n",
        "[13:45:01] 1 2\n",
        "1,2\n",
        "",
    ] {
        assert_eq!(converted(text), text);
    }
}

#[test]
fn columns_are_told_apart_by_their_dates() {
    let stamps = Stamps::of(b"1,00:00:01,1970-01-01T00:00:01,2\n");
    let has_date = [0, 1, 2, 3].map(|place| stamps.at(place).map(|column| column.has_date));
    assert_eq!(has_date, [None, Some(false), Some(true), None]);
    assert!(Stamps::of(b"1,2,3\n").is_empty());
}
