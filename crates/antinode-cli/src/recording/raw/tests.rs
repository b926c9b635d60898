//! Streams of samples made by hand.

use clap::ValueEnum;

use super::super::tests::{self, Dribble, drain, file, message};
use super::*;
use crate::recording::by_content::{RAW_FORMAT_NEEDED, UNKNOWN};
use crate::recording::{OpenOptions, Recording};

fn raw(bytes: Vec<u8>, kind: Kind) -> Recording {
    of_stream(Box::new(Dribble::new(bytes, 7)), kind)
}

fn of_stream(stream: Stream, kind: Kind) -> Recording {
    let name = "standard input";
    let opened = open(stream, kind, &OpenOptions::default(), None);
    Recording::new(name.to_owned(), opened.unwrap(), None)
}

#[test]
fn every_format_is_read_across_ragged_chunks() {
    let codes: Vec<i16> = (0..999).map(|k| k * 31 - 15_000).collect();
    let values: Vec<f32> = codes
        .iter()
        .map(|&code| f32::from(code) / 32_768.0)
        .collect();
    let whole = |bytes: Vec<u8>| bytes[..bytes.len() / 2 * 2].to_vec();
    let pairs = values[..998].as_chunks::<2>().0.to_vec();
    let i16s = codes[..998]
        .iter()
        .flat_map(|code| code.to_le_bytes())
        .collect();
    let u16s = codes[..998]
        .iter()
        .flat_map(|&code| (code.cast_unsigned() ^ 0x8000).to_le_bytes())
        .collect();
    let i24s = codes[..998]
        .iter()
        .flat_map(|code| [vec![0], code.to_le_bytes().to_vec()].concat())
        .collect();
    let i32s = codes[..998]
        .iter()
        .flat_map(|&code| (i32::from(code) << 16).to_le_bytes())
        .collect();
    let f32s = values[..998]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let f64s = values[..998]
        .iter()
        .flat_map(|&value| f64::from(value).to_le_bytes())
        .collect();
    for (bytes, format) in [
        (f64s, Kind::F64),
        (u16s, Kind::U16),
        (i24s, Kind::I24),
        (i16s, Kind::I16),
        (i32s, Kind::I32),
        (f32s, Kind::F32),
    ] {
        let (read, fault) = drain(&mut raw(whole(bytes), format));
        assert_eq!(read, pairs);
        assert!(fault.is_none());
    }
}

#[test]
fn bytes_are_integers_with_or_without_sign() {
    for (format, expected) in [
        (Kind::U8, [[-1.0, 0.0], [-0.5, 127.0 / 128.0]]),
        (Kind::I8, [[0.0, -1.0], [0.5, -1.0 / 128.0]]),
    ] {
        let mut recording = raw(vec![0, 0x80, 0x40, 0xff], format);
        assert_eq!(recording.full_scale(), Some(127.0 / 128.0));
        let (read, fault) = drain(&mut recording);
        assert_eq!(read, expected);
        assert!(fault.is_none());
    }
}

#[test]
fn messages_and_the_readme_name_every_format() {
    let names = Kind::value_variants().iter();
    let names = names.filter_map(|format| Some(format.to_possible_value()?.get_name().to_owned()));
    let names: Vec<String> = names.collect();
    let (last, others) = names.split_last().expect("there are formats");
    let expected = format!("--raw {} or {last}", others.join(", "));
    let needed = RAW_FORMAT_NEEDED.to_owned();
    let unknown = UNKNOWN.to_owned();
    let readme = include_str!("../../../../../README.md").replace('`', "");
    for text in [needed, unknown, readme] {
        assert!(text.contains(&expected), "{expected} is not in {text}");
    }
}

#[test]
fn half_a_pair_at_the_end_is_an_error_after_the_good_data() {
    let (pairs, fault) = drain(&mut raw(vec![0, 0x40, 0, 0xc0, 1, 0], Kind::I16));
    assert_eq!(pairs, [[0.5, -0.5]]);
    assert!(
        message(fault).starts_with(
            "standard input: sample pair 1 (from 0): the data end in the middle of it"
        )
    );
}

#[test]
fn not_finite_samples_pass_and_are_reported() {
    let mut values = [0.5f32; 40];
    values[30] = f32::NEG_INFINITY;
    values[33] = f32::NAN;
    let bytes = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let mut recording = raw(bytes, Kind::F32);
    let (pairs, fault) = drain(&mut recording);
    assert_eq!((pairs.len(), fault.is_none()), (20, true));
    assert_eq!(pairs[15], [f32::NEG_INFINITY, 0.5]);
    assert!(message(recording.not_finite()).starts_with(
        "standard input: sample pair 15 (from 0), S_C (left): the value is -inf, not a finite \
         number, the first of 2; "
    ));
}

#[test]
fn a_live_stream_is_delivered_as_it_comes() {
    let mut recording = raw(vec![0; 64], Kind::I16);
    assert_eq!(recording.read(&mut Vec::with_capacity(100)).ok(), Some(1));
}

#[test]
fn a_fault_of_the_pipe_comes_after_the_good_data() {
    struct Broken;
    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::other("cable pulled"))
        }
    }
    let stream = Box::new(io::Cursor::new(vec![0; 8]).chain(Broken));
    let (pairs, fault) = drain(&mut of_stream(stream, Kind::I16));
    assert_eq!(pairs.len(), 2);
    assert!(message(fault).starts_with("standard input: cannot be read: cable pulled; "));
}

#[test]
fn the_step_is_found_behind_a_silent_beginning() {
    let options = tests::raw(Kind::I16);
    // 12 bits in 16, behind silence with a code of noise.
    let code = |k: usize, silent: usize| match k {
        _ if k < silent => [16 * i16::from(k.is_multiple_of(5)), 0],
        _ => [0.1, 1.7].map(|phase| ((0.3 * k as f64 + phase).sin() * 1000.0).round() as i16 * 16),
    };
    let resolution = |silent: usize| {
        let codes = (0..silent + 50_000).flat_map(|k| code(k, silent));
        let bytes: Vec<u8> = codes.flat_map(i16::to_le_bytes).collect();
        let (_directory, path) = file("a.raw", &bytes);
        let mut recording = Recording::open(&path, &options).unwrap();
        let step = recording.resolution().map(|step| step * 32_768.0);
        // The samples read ahead are delivered too.
        assert_eq!(drain(&mut recording).0.len(), silent + 50_000);
        step
    };
    for silent in [0, 10_000, 100_000, 240_000] {
        assert_eq!(resolution(silent), Some(16.0), "{silent}");
    }
    // Behind a silence longer than what is read ahead, the step is that of all bits.
    assert_eq!(resolution(300_000), Some(1.0));
}
