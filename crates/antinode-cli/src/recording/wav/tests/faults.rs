//! The errors of WAV files that are not as they should be.

use super::{PAIR_16, Wav, extensible, format, wav};
use crate::recording::tests::read;

#[test]
fn truncated_data_are_delivered_before_the_error() {
    let mut cut = wav(format(1, 2, 16), &[PAIR_16; 3].concat());
    cut.size = 40;
    assert_eq!(cut.open().opened.pairs, Some(3));
    let (pairs, fault) = cut.read();
    assert_eq!(pairs, [[0.5, -1.0]; 3]);
    let expected =
        "a.wav: at its end: the header promises 10 sample pairs, but there are 3; copy or";
    assert!(fault.expect("a fault").starts_with(expected));
    cut.data.truncate(10);
    assert_eq!(cut.read().0.len(), 2);
    assert!(
        cut.fault()
            .starts_with("a.wav: at its end: the header promises 10 sample pairs, but there are 2")
    );
    cut.size = 10;
    assert_eq!(cut.read().0.len(), 2);
    assert!(
        cut.fault()
            .starts_with("a.wav: sample pair 2 (from 0): the data end in the middle of it; ")
    );
}

#[test]
fn other_than_two_channels_are_counted() {
    let fault = |channels| wav(format(1, channels, 16), &[0; 48]).fault();
    let one = "a.wav: WAV header: found 1 channel, but two are needed; put S_C on the left channel and S_D";
    assert!(fault(1).starts_with(one));
    assert!(fault(6).starts_with("a.wav: WAV header: found 6 channels, but two are needed; "));
    assert!(fault(0).starts_with("a.wav: WAV header: found 0 channels"));
}

#[test]
fn other_encodings_are_named() {
    for (format, expected) in [
        (
            format(2, 2, 4),
            "the samples are compressed (ADPCM); export",
        ),
        (
            format(6, 2, 8),
            "the samples are compressed (A-law); export",
        ),
        (
            format(7, 2, 8),
            "the samples are compressed (µ-law); export",
        ),
        (
            format(0x55, 2, 0),
            "the samples are compressed (MP3); export",
        ),
        (
            format(0x1234, 2, 16),
            "the samples are of an unknown encoding (tag 0x1234); export",
        ),
        (format(3, 2, 16), "the samples are 16-bit floats; export"),
        (format(1, 2, 64), "the samples are 64-bit integers; export"),
        (
            extensible(7, 8, 8),
            "the samples are compressed (µ-law); export",
        ),
    ] {
        let fault = wav(format, &[0; 48]).fault();
        assert!(
            fault.starts_with(&format!("a.wav: WAV header: {expected}")),
            "{fault}"
        );
    }
}

#[test]
fn a_damaged_header_is_named() {
    let good = wav(format(1, 2, 16), &PAIR_16);
    let change = |change: fn(&mut Wav)| {
        let mut wav = good.clone();
        change(&mut wav);
        wav.fault()
    };
    for (fault, expected) in [
        (
            change(|wav| wav.magic = b"RIFX"),
            "it is big-endian (RIFX); ",
        ),
        (
            change(|wav| wav.before = b"data\0\0\0\0".to_vec()),
            "the data come before their format; ",
        ),
        (
            change(|wav| wav.before = b"LIST\xff\xff\0\0".to_vec()),
            "the file ends before the data begin; ",
        ),
        (
            change(|wav| wav.format.truncate(14)),
            "a chunk is too short; ",
        ),
        (
            change(|wav| wav.format[12] = 8),
            "16 valid of 16 bits in 2 channels do not fit a frame of 8 bytes; ",
        ),
        (
            change(|wav| wav.format = extensible(1, 16, 24)),
            "24 valid of 16 bits in 2 channels do not fit a frame of 4 bytes; ",
        ),
        (
            change(|wav| wav.format = extensible(3, 32, 24)),
            "24 valid of 32 bits in 2 channels do not fit a frame of 8 bytes; ",
        ),
        (
            change(|wav| wav.format = format(0xfffe, 2, 16)),
            "its extensible format has an unknown subtype; ",
        ),
    ] {
        assert!(
            fault.starts_with(&format!("a.wav: WAV header: {expected}")),
            "{fault}"
        );
    }
    let whole = good.bytes();
    for end in 12..44 {
        let fault = read("a.wav", &whole[..end]).1.expect("a fault");
        assert!(
            fault.starts_with("a.wav: WAV header: the file ends before the data begin; "),
            "{end}: {fault}"
        );
    }
}

#[test]
fn not_finite_and_padding_are_named() {
    let values = [0.5f32, 0.5, 0.5, f32::NAN].map(f32::to_le_bytes);
    let (pairs, fault) = wav(format(3, 2, 32), values.as_flattened()).read();
    assert_eq!((pairs[0], pairs.len()), ([0.5, 0.5], 2));
    assert!(
        fault
            .expect("a fault")
            .starts_with("a.wav: sample pair 1 (from 0), S_D (right): the value is NaN, not")
    );
    let low = wav(extensible(1, 32, 24), &[0, 0, 0, 0, 7, 0, 0, 0]).fault();
    let expected = "a.wav: sample pair 0 (from 0), S_D (right): bits are set below the 24 valid ones of a 32-bit";
    assert!(low.starts_with(expected), "{low}");
}

#[test]
fn another_wav_behind_the_samples_is_reported() {
    for magic in [b"RIFF", b"RF64", b"BW64"] {
        let one = wav(format(1, 2, 16), &[PAIR_16; 3].concat());
        let mut both = one.clone();
        both.after = Wav { magic, ..one }.bytes();
        let (pairs, fault) = both.read();
        assert_eq!(pairs, [[0.5, -1.0]; 3]);
        let expected = "a.wav: after 3 sample pairs another WAV file begins, which is not read; ";
        assert!(fault.expect("a fault").starts_with(expected));
    }
}
