//! The types of numbers in an array.

use half::f16;

use super::super::super::tests::{file, read, read_with};
use super::super::super::{OpenOptions, Recording};
use super::{PAIRS, npy};

/// The samples of [`PAIRS`], each as these bytes.
fn bytes<const N: usize>(each: impl Fn(f32) -> [u8; N]) -> Vec<u8> {
    PAIRS.as_flattened().iter().flat_map(|&v| each(v)).collect()
}

#[test]
fn every_type_is_read_in_both_byte_orders() {
    let i8 = |v| (v * 128.0) as i8;
    let i16 = |v| (v * 32_768.0) as i16;
    let i32 = |v| (v * 2_147_483_648.0) as i32;
    // Offset binary: mid-scale is 0.
    let u8 = |v| (v * 128.0 + 128.0) as u8;
    let u16 = |v| (v * 32_768.0 + 32_768.0) as u16;
    for (descr, data) in [
        ("'|u1'", bytes(|v| u8(v).to_le_bytes())),
        ("'|i1'", bytes(|v| i8(v).to_le_bytes())),
        ("'<u2'", bytes(|v| u16(v).to_le_bytes())),
        ("'>u2'", bytes(|v| u16(v).to_be_bytes())),
        ("'<i2'", bytes(|v| i16(v).to_le_bytes())),
        ("'>i2'", bytes(|v| i16(v).to_be_bytes())),
        ("'<i4'", bytes(|v| i32(v).to_le_bytes())),
        ("'>i4'", bytes(|v| i32(v).to_be_bytes())),
        ("'<f2'", bytes(|v| f16::from_f32(v).to_le_bytes())),
        ("'>f2'", bytes(|v| f16::from_f32(v).to_be_bytes())),
        ("'<f4'", bytes(f32::to_le_bytes)),
        ("'>f4'", bytes(f32::to_be_bytes)),
        ("'<f8'", bytes(|v| f64::from(v).to_le_bytes())),
        ("'>f8'", bytes(|v| f64::from(v).to_be_bytes())),
    ] {
        let found = read("a.npy", &npy(descr, false, "(3, 2)", &data));
        assert_eq!(found, (PAIRS.to_vec(), None), "{descr}");
        // The same numbers, one channel after the other.
        let size = data.len() / 6;
        let samples: Vec<&[u8]> = data.chunks(size).collect();
        let planes = [0, 2, 4, 1, 3, 5].map(|place| samples[place]).concat();
        let found = read("a.npy", &npy(descr, true, "(3, 2)", &planes));
        assert_eq!(found, (PAIRS.to_vec(), None), "{descr} in columns");
    }
}

#[test]
fn records_of_like_fields_are_read() {
    let record = |names: &[&str]| {
        let fields = names.iter().map(|name| format!("('{name}', '<f4')"));
        format!("[{}]", fields.collect::<Vec<_>>().join(", "))
    };
    let data = bytes(f32::to_le_bytes);
    let swapped: Vec<[f32; 2]> = PAIRS.map(|[c, d]| [d, c]).to_vec();
    for (names, expected) in [
        (["c", "d"], PAIRS.to_vec()),
        (["x", "y"], PAIRS.to_vec()),
        // Names in another order than usual do not swap the signals.
        (["d", "c"], swapped.clone()),
        (["S_D", "S_C"], swapped),
    ] {
        for order in [false, true] {
            let array = npy(&record(&names), order, "(3,)", &data);
            assert_eq!(read("a.npy", &array), (expected.clone(), None), "{names:?}");
        }
    }
    // Of more fields, and of such that are not alike.
    let chosen = |columns: &str, array: &[u8]| {
        let options = OpenOptions {
            columns: Some(columns.parse().unwrap()),
            ..OpenOptions::default()
        };
        read_with("a.npy", array, &options)
    };
    let array = npy(&record(&["t", "c", "d"]), false, "(2,)", &data);
    let [[a, b], [c, d], [e, f]] = PAIRS;
    assert_eq!(chosen("2,3", &array), (vec![[b, c], [e, f]], None));
    assert_eq!(chosen("1,3", &array).0, [[a, c], [d, f]]);
    let told = |array: &[u8]| read("a.npy", array).1.unwrap();
    let fault = told(&array);
    let expected = "a.npy: NPY header: the shape is (2,) of records of 3 fields, but (N,) of two";
    assert!(fault.starts_with(expected), "{fault}");
    let mixed = npy("[('t', '<f8'), ('c', '<f4')]", false, "(2,)", &data);
    let fault = told(&mixed);
    assert!(
        fault.contains("or records of one of them, is needed"),
        "{fault}"
    );
}

#[test]
fn unsigned_integers_have_the_rails_and_the_step_of_signed_ones() {
    for (descr, bits, words) in [
        ("'|u1'", 8, "NPY of 8-bit unsigned integers"),
        ("'|i1'", 8, "NPY of 8-bit integers"),
        ("'<u2'", 16, "NPY of 16-bit unsigned integers"),
        ("'<i2'", 16, "NPY of 16-bit integers"),
    ] {
        let (_directory, path) = file("a.npy", &npy(descr, false, "(1, 2)", &[0; 4]));
        let recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        let step = (1.0 - f32::from(bits as u8)).exp2();
        let found = (recording.full_scale(), recording.resolution());
        assert_eq!(found, (Some(1.0 - step), Some(step)), "{descr}");
        assert_eq!(recording.opened.format, words);
    }
}
