//! Recordings of more channels than two, and WAV files that go on behind the end by their header.

use std::fs;
use std::path::Path;

use crate::common::{WAVE, fault, npy, raw, rows, run, wav};

/// A WAV file of `channels` channels in place of two, with these bytes of samples.
fn wav_of(channels: u8, bytes: &[u8]) -> Vec<u8> {
    let mut file = wav(&[]);
    file[22] = channels;
    // The bytes of a frame; those of a second are not looked at.
    file[32] = 2 * channels;
    file[40..44].copy_from_slice(&(bytes.len() as u32).to_le_bytes());
    file.extend(bytes);
    file
}

/// An NPY file of this shape and order.
fn npy_of(shape: &str, fortran: &str, bytes: &[u8]) -> Vec<u8> {
    let header = String::from_utf8_lossy(&npy(&[])[10..128]).into_owned();
    let header = header.replace("(0, 2)", shape).replace(
        "'fortran_order': False",
        &format!("'fortran_order': {fortran}"),
    );
    let mut file = npy(&[])[..10].to_vec();
    // Blanks pad the header, which ends in a line feed, to its length.
    let header = format!("{:<117}\n", header.trim_end());
    file.extend(header.bytes());
    file.extend(bytes);
    file
}

fn bytes(codes: impl Iterator<Item = i16>) -> Vec<u8> {
    codes.flat_map(i16::to_le_bytes).collect()
}

/// Frames with one channel before S_C and one between S_C and S_D.
fn frames(codes: &[[i16; 2]]) -> impl Iterator<Item = [i16; 4]> {
    codes.iter().zip(0i16..).map(|(&[c, d], k)| [k, c, 77, d])
}

/// The rows without the names of their files.
fn numbers(here: &Path, options: &str) -> Vec<Vec<String>> {
    let rows = rows(here, options);
    rows.iter().map(|row| row.unnamed().to_vec()).collect()
}

#[test]
fn two_of_many_channels_are_chosen_by_their_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let interleaved = bytes(frames(&codes).flatten());
    let planes = bytes((0..4).flat_map(|place| frames(&codes).map(move |frame| frame[place])));
    for (name, file) in [
        ("two.wav", wav(&codes)),
        ("two.npy", npy(&codes)),
        ("four.wav", wav_of(4, &interleaved)),
        ("rows.npy", npy_of("(20000, 4)", "False", &interleaved)),
        ("columns.npy", npy_of("(20000, 4)", "True", &planes)),
        ("planes.npy", npy_of("(4, 20000)", "False", &planes)),
        ("one.wav", wav_of(1, &interleaved)),
        ("one.npy", npy_of("(80000, 1)", "False", &interleaved)),
    ] {
        fs::write(here.join(name), file).unwrap();
    }
    let expected = rows(here, "two.wav");
    assert!(expected.len() > 90);
    let numbers = |options: &str| numbers(here, options);
    let of_two = numbers("two.wav");
    for options in [
        "four.wav --columns 2,4",
        "rows.npy --rate 100000 --columns 2,4",
        "columns.npy --rate 100000 --columns 2,4",
        "planes.npy --rate 100000 --columns 2,4",
        "two.npy --rate 100000 --columns 1,2",
    ] {
        assert_eq!(numbers(options), of_two, "{options}");
    }
    // With the channels swapped the pattern turns the other way.
    for row in rows(here, "two.wav --columns 2,1") {
        assert!((row.number("quadrature_amplitude") + WAVE.quadrature).abs() < 0.01);
    }
    for (options, told) in [
        (
            "four.wav",
            "found 4 channels, but two are needed; choose those of S_C and S_D, as in --columns 1,2",
        ),
        (
            "four.wav --columns 2,5",
            "--columns 2,5: give the channel numbers of S_C and S_D, two different ones from 1 to 4",
        ),
        ("four.wav --columns 1,2,4", "two different ones from 1 to 4"),
        ("four.wav --columns c,d", "two different ones from 1 to 4"),
        ("rows.npy --columns 3,3", "two different ones from 1 to 4"),
        (
            "one.wav --columns 1,2",
            "found 1 channel, but two are needed; put",
        ),
        (
            "one.npy --columns 1,2",
            "the shape is (80000, 1), but (N, 2) is needed",
        ),
        ("rows.npy", "the shape is (20000, 4)"),
    ] {
        let found = run(here, &format!("identify {options}"));
        assert_eq!((found.code, found.out.as_str()), (1, ""), "{options}");
        assert!(found.err.contains(told), "{options}: {}", found.err);
    }
}

#[test]
fn samples_behind_the_end_by_the_header_are_not_lost_silently() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let whole = wav(&codes);
    let mut half = whole.clone();
    half[40..44].copy_from_slice(&40_000u32.to_le_bytes());
    fs::write(here.join("half.wav"), &half).unwrap();
    let found = fault(
        here,
        "half.wav",
        Vec::new(),
        &[
            "half.wav",
            "promises 10000 sample pairs, but more follow",
            "sox --ignore-length \"half.wav\" whole.wav",
        ],
    );
    assert!(found.len() > 45);
    // Another chunk, padding, or a rest too short for a chunk may stand there.
    for (name, tail) in [
        ("list.wav", &b"LIST\x04\x00\x00\x00INFO"[..]),
        ("padded.wav", &[0; 500]),
        ("odd.wav", &[1, 2, 3]),
    ] {
        fs::write(here.join(name), [&whole, tail].concat()).unwrap();
        assert!(rows(here, name).len() > 90);
    }
    // Three channels of 24 bits, whose data are an odd number of bytes: one more stands before the next chunk.
    let three = codes[1..].iter().flat_map(|&[c, d]| [c, d, 0]);
    let three = three.flat_map(|code: i16| [[0].as_slice(), &code.to_le_bytes()].concat());
    let three: Vec<u8> = three.collect();
    let mut header = whole[..44].to_vec();
    for (at, word) in [(22, 3), (32, 9), (34, 24)] {
        header[at..at + 2].copy_from_slice(&u16::to_le_bytes(word));
    }
    header[40..].copy_from_slice(&(three.len() as u32).to_le_bytes());
    let tail = b"\0LIST\x04\0\0\0INFO";
    fs::write(
        here.join("three.wav"),
        [&header, &three, &tail[..]].concat(),
    )
    .unwrap();
    assert!(rows(here, "three.wav --columns 1,2").len() > 90);
}

#[test]
fn two_of_many_raw_channels_are_chosen_by_their_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(20_000);
    let four = bytes(frames(&codes).flatten());
    fs::write(here.join("four.raw"), &four).unwrap();
    fs::write(here.join("two.raw"), raw(&codes)).unwrap();
    fs::write(here.join("two.wav"), wav(&codes)).unwrap();
    let numbers = |options: &str| numbers(here, options);
    let raw = "--raw i16 --rate 100000";
    let expected = numbers("two.wav");
    assert!(expected.len() > 90);
    for options in [
        "two.raw",
        "two.raw --channels 2",
        "two.raw --columns 1,2",
        "four.raw --channels 4 --columns 2,4",
    ] {
        assert_eq!(numbers(&format!("{options} {raw}")), expected, "{options}");
    }
    let swapped = numbers("two.wav --columns 2,1");
    for options in [
        "two.raw --columns 2,1",
        "four.raw --channels 4 --columns 4,2",
    ] {
        assert_eq!(numbers(&format!("{options} {raw}")), swapped, "{options}");
    }
    // A frame cut off in a pipe: the rows before it, and an error that says where it was.
    let cut = four[..8 * 15_000 + 5].to_vec();
    let options = format!("- {raw} --channels 4 --columns 2,4");
    let told = "sample pair 15000 (from 0): the data end in the middle of it; check that they hold all 4 channels";
    let found = fault(here, &options, cut, &[told]);
    assert!(found.len() > 70);
    for (options, told) in [
        (
            "four.raw --channels 4",
            "there are 4 interleaved channels (--channels), but two are needed; choose those of S_C and S_D, as in --columns 1,2",
        ),
        (
            "four.raw --channels 4 --columns 2,5",
            "--columns 2,5: give the channel numbers of S_C and S_D, two different ones from 1 to 4",
        ),
        (
            "four.raw --channels 4 --columns 3,3",
            "two different ones from 1 to 4",
        ),
        (
            "four.raw --channels 4 --columns c,d",
            "two different ones from 1 to 4",
        ),
        (
            "two.raw --channels 2 --columns 1,3",
            "two different ones from 1 to 2",
        ),
        (
            "four.raw --columns 1,3",
            "--columns 1,3: raw samples have two channels unless --channels gives another number",
        ),
    ] {
        let found = run(here, &format!("identify {options} {raw}"));
        assert_eq!((found.code, found.out.as_str()), (1, ""), "{options}");
        assert!(found.err.contains(told), "{options}: {}", found.err);
    }
    for options in [
        "two.wav --channels 2",
        "four.raw --raw i16 --channels 1",
        "four.raw --raw i16 --channels 65",
    ] {
        let found = run(here, &format!("identify {options}"));
        assert_eq!((found.code, found.out.as_str()), (2, ""), "{options}");
    }
}
