//! WAV files made by hand.

mod faults;
mod programs;

use super::super::tests::{Dribble, drain, file, message, read};
use super::super::{OpenOptions, Recording};

/// A header made by hand, and its data.
#[derive(Clone)]
struct Wav {
    magic: &'static [u8; 4],
    riff: u32,
    before: Vec<u8>,
    format: Vec<u8>,
    size: u32,
    data: Vec<u8>,
    after: Vec<u8>,
}

fn format(tag: u16, channels: u16, bits: u16) -> Vec<u8> {
    let frame = channels * bits.div_ceil(8);
    let mut format = Vec::new();
    for word in [tag, channels, 0x86a0, 1, 0, 0, frame, bits] {
        format.extend_from_slice(&word.to_le_bytes());
    }
    format
}

/// The extensible form: `bits` of which `valid` are in use.
fn extensible(tag: u16, bits: u16, valid: u16) -> Vec<u8> {
    let mut format = format(0xfffe, 2, bits);
    for word in [22, valid, 3, 0, tag] {
        format.extend_from_slice(&u16::to_le_bytes(word));
    }
    format.extend_from_slice(&super::SUBTYPE_TAIL);
    format
}

fn wav(format: Vec<u8>, data: &[u8]) -> Wav {
    let (size, data) = (data.len() as u32, data.to_vec());
    Wav {
        magic: b"RIFF",
        riff: 1,
        before: Vec::new(),
        format,
        size,
        data,
        after: Vec::new(),
    }
}

impl Wav {
    fn bytes(&self) -> Vec<u8> {
        let words = [
            b"WAVE",
            &self.before[..],
            b"fmt ",
            &(self.format.len() as u32).to_le_bytes(),
            &self.format,
        ];
        let head = [
            &self.magic[..],
            &self.riff.to_le_bytes(),
            &words.concat(),
            b"data",
            &self.size.to_le_bytes(),
        ];
        [&head.concat(), &self.data[..], &self.after].concat()
    }

    fn read(&self) -> (Vec<[f32; 2]>, Option<String>) {
        read("a.wav", &self.bytes())
    }

    fn fault(&self) -> String {
        self.read().1.expect("a fault")
    }

    fn open(&self) -> Recording {
        let (_directory, path) = file("a.wav", &self.bytes());
        Recording::open(&path, &OpenOptions::default()).expect("a good recording")
    }
}

const PAIR_16: [u8; 4] = [0, 0x40, 0, 0x80];

#[test]
fn every_sample_format_is_read() {
    let half = 0.5f32.to_le_bytes();
    let half_64 = 0.5f64.to_le_bytes();
    for (format, data) in [
        (format(1, 2, 8), &[0xc0, 0x40][..]),
        (format(1, 2, 16), &[0, 0x40, 0, 0xc0]),
        (format(1, 2, 24), &[0, 0, 0x40, 0, 0, 0xc0]),
        (format(1, 2, 32), &[0, 0, 0, 0x40, 0, 0, 0, 0xc0]),
        (format(3, 2, 32), &[half, (-0.5f32).to_le_bytes()].concat()),
        (
            format(3, 2, 64),
            &[half_64, (-0.5f64).to_le_bytes()].concat(),
        ),
        (extensible(1, 16, 16), &[0, 0x40, 0, 0xc0]),
        (extensible(1, 16, 12), &[0, 0x40, 0, 0xc0]),
        (extensible(1, 32, 24), &[0, 0, 0, 0x40, 0, 0, 0, 0xc0]),
        (extensible(1, 32, 0), &[0, 0, 0, 0x40, 0, 0, 0, 0xc0]),
        (
            extensible(3, 32, 32),
            &[half, (-0.5f32).to_le_bytes()].concat(),
        ),
    ] {
        assert_eq!(
            wav(format.clone(), data).read(),
            (vec![[0.5, -0.5]], None),
            "{format:?}"
        );
    }
}

#[test]
fn the_header_tells_rate_size_and_rail() {
    let recording = wav(format(1, 2, 16), &[0; 40]).open();
    assert_eq!(
        (recording.opened.sample_rate, recording.opened.pairs),
        (Some(100_000.0), Some(10))
    );
    assert_eq!(
        (recording.bytes_total, recording.bytes_read()),
        // A file's first samples are looked at, which a pipe's are not.
        (Some(84), 84)
    );
    assert_eq!(recording.full_scale(), Some(32_767.0 / 32_768.0));
    assert_eq!(wav(format(3, 2, 32), &[0; 40]).open().full_scale(), None);
    assert_eq!(
        wav(extensible(1, 16, 12), &[0; 40]).open().full_scale(),
        Some(2047.0 / 2048.0)
    );
    let mut no_rate = wav(format(1, 2, 16), &[0; 40]);
    no_rate.format[4..8].fill(0);
    assert_eq!(no_rate.open().opened.sample_rate, None);
}

#[test]
fn other_chunks_are_passed_over() {
    let mut padded = wav(format(1, 2, 16), &PAIR_16);
    // Three bytes and one of padding.
    padded.before = b"LIST\x03\0\0\0abc\0".to_vec();
    padded.after = b"LIST\x03\0\0\0abc\0".to_vec();
    assert_eq!(padded.read(), (vec![[0.5, -1.0]], None));
    // The content of a chunk behind the samples does not matter, however often the end is read.
    padded.after = [&b"cue \x1c\0\0\0\x01\0\0\0\x01\0\0\0"[..], &[0x80; 20]].concat();
    let mut recording = padded.open();
    let mut pairs = Vec::new();
    for expected in [1, 0, 0] {
        assert_eq!(recording.read(&mut pairs).unwrap(), expected);
    }
}

#[test]
fn data_of_a_length_never_filled_in_go_on_to_the_end() {
    for size in [0, 0xffff_ffff, 0xffff_fffc, 0x7fff_f000, 0x8000_0000] {
        let mut streamed = wav(format(1, 2, 16), &[PAIR_16; 3].concat());
        streamed.size = size;
        assert_eq!(streamed.open().opened.pairs, Some(3));
        assert_eq!(streamed.read(), (vec![[0.5, -1.0]; 3], None), "{size:#x}");
    }
    let mut streamed = wav(format(1, 2, 24), &[0; 12]);
    streamed.size = 0x7fff_effc;
    assert_eq!(streamed.read(), (vec![[0.0, 0.0]; 2], None));
}

#[test]
fn a_finished_file_of_nothing_has_no_pairs() {
    let mut empty = wav(format(1, 2, 16), &[]);
    empty.after = b"LIST\x04\0\0\0abcd".to_vec();
    empty.riff = empty.bytes().len() as u32 - 8;
    assert!(
        empty
            .fault()
            .starts_with("a.wav: there are no sample pairs in it;")
    );
}

#[test]
fn data_longer_than_4_gib_have_their_size_in_a_chunk_of_its_own() {
    let mut long = wav(format(1, 2, 16), &[PAIR_16; 2].concat());
    (long.magic, long.riff, long.size) = (b"RF64", u32::MAX, u32::MAX);
    long.before = [
        &b"ds64\x1c\0\0\0"[..],
        &[0; 8],
        &4u64.to_le_bytes(),
        &[0; 12],
    ]
    .concat();
    assert_eq!(long.read(), (vec![[0.5, -1.0]], None));
    long.before[16..24].copy_from_slice(&(5u64 << 32).to_le_bytes());
    assert!(long.fault().starts_with(
        "a.wav: at its end: the header promises 5368709120 sample pairs, but there are 2; "
    ));
}

#[test]
fn a_pipe_needs_no_length() {
    let mut piped = wav(format(1, 2, 16), &[PAIR_16; 500].concat());
    piped.size = 0xffff_ffff;
    let open = |wav: &Wav| {
        let opened = super::open(
            Box::new(Dribble::new(wav.bytes(), 5)),
            None,
            &OpenOptions::default(),
        )
        .expect("a good header");
        Recording::new("pipe".to_owned(), opened, None)
    };
    assert_eq!(open(&piped).opened.pairs, None);
    assert_eq!(drain(&mut open(&piped)).0.len(), 500);
    // Samples that have come are not held back for those still to come.
    assert_eq!(
        open(&piped).read(&mut Vec::with_capacity(500)).ok(),
        Some(1)
    );
    piped.size = 4000;
    assert_eq!(open(&piped).opened.pairs, Some(1000));
    assert!(
        message(drain(&mut open(&piped)).1).starts_with(
            "pipe: at its end: the header promises 1000 sample pairs, but there are 500"
        )
    );
    // What follows the data is told as of a file, even if the samples look like the name of a chunk.
    piped.size = 400;
    let mut recording = open(&piped);
    let (pairs, fault) = drain(&mut recording);
    assert_eq!(pairs.len(), 100);
    assert!(message(fault).contains("promises 100 sample pairs, but more follow"));
}

#[test]
fn samples_that_look_like_the_name_of_a_chunk_are_told() {
    let mut unfinished = wav(format(1, 2, 16), b"9B.ugT3!2345678901234567");
    unfinished.size = 0;
    unfinished.riff = unfinished.bytes().len() as u32 - 8;
    assert!(
        unfinished
            .fault()
            .contains("promises 0 sample pairs, but more follow")
    );
}

#[test]
fn samples_whose_values_look_like_the_size_of_a_chunk_are_told() {
    // Four pairs more than promised, of which the second would be the size of the last two.
    let more = [-9000, -5000, 8, 0, 1, 2, 3, 4]
        .map(i16::to_le_bytes)
        .concat();
    let mut unfinished = wav(format(1, 2, 16), &[&PAIR_16.repeat(3)[..], &more].concat());
    unfinished.size = 12;
    unfinished.riff = unfinished.bytes().len() as u32 - 8;
    assert_eq!(unfinished.read().0.len(), 3);
    assert!(
        unfinished
            .fault()
            .contains("promises 3 sample pairs, but more follow")
    );
}
