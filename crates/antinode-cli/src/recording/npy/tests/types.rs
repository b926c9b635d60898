//! The types of numbers in an array.

use super::super::super::tests::{file, read};
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
