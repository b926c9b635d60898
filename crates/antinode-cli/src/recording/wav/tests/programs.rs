//! WAV files as other programs write them.

use std::io::Cursor;
use std::process::Command;

use crate::recording::tests::{drain, read};
use crate::recording::{OpenOptions, Recording};

#[test]
fn what_hound_writes_is_read_alike() {
    for bits in [8, 16, 24, 32] {
        let spec = hound::WavSpec {
            channels: 2,
            sample_rate: 100_000,
            bits_per_sample: bits,
            sample_format: hound::SampleFormat::Int,
        };
        let mut bytes = Cursor::new(Vec::new());
        let mut writer = hound::WavWriter::new(&mut bytes, spec).unwrap();
        let top = 1i64 << (bits - 1);
        let codes: Vec<i32> = (0..2000)
            .map(|k| ((k * 7_919_371_337_i64) % (2 * top) - top) as i32)
            .collect();
        codes
            .iter()
            .for_each(|&code| writer.write_sample(code).unwrap());
        writer.finalize().unwrap();
        let expected: Vec<f32> = codes
            .iter()
            .map(|&code| (f64::from(code) / top as f64) as f32)
            .collect();
        assert_eq!(
            read("a.wav", bytes.get_ref()),
            (expected.as_chunks::<2>().0.to_vec(), None),
            "{bits}"
        );
    }
}

/// Runs a program that writes a file.
fn make(program: &str, arguments: &[&str]) {
    let status = Command::new(program).args(arguments).status().unwrap();
    assert!(status.success(), "{program} {arguments:?}");
}

#[test]
#[ignore = "needs sox, and python3 with numpy and scipy"]
fn what_sox_and_scipy_write_is_read() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.wav");
    let name = path.to_str().unwrap();
    let check = |tolerance: f32| {
        let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
        assert_eq!(
            (recording.opened.sample_rate, recording.opened.pairs),
            (Some(100_000.0), Some(1000))
        );
        let (pairs, fault) = drain(&mut recording);
        assert!(fault.is_none());
        for (k, pair) in pairs.iter().enumerate() {
            let sine = 0.5 * (std::f64::consts::TAU * 0.05 * k as f64).sin() as f32;
            assert!(
                (pair[0] - sine).abs() < tolerance && (pair[1] + sine).abs() < tolerance,
                "{k}: {pair:?} {sine}"
            );
        }
    };
    for (encoding, bits, tolerance) in [
        ("unsigned", "8", 1e-2),
        ("signed", "16", 1e-4),
        ("signed", "24", 1e-5),
        ("signed", "32", 1e-5),
    ]
    .into_iter()
    .chain([("float", "32", 1e-5), ("float", "64", 1e-5)])
    {
        let format = [
            "-D", "-r", "100000", "-n", "-e", encoding, "-b", bits, "-c", "2", name,
        ];
        let effects = [
            "synth", "0.01", "sine", "5000", "vol", "0.5", "remix", "1", "1i",
        ];
        make("sox", &[&format[..], &effects].concat());
        check(tolerance);
    }
    for dtype in ["h", "i", "f", "d"] {
        let script = "import sys, numpy as n, scipy.io.wavfile as w\n\
             s = .5 * n.sin(2 * n.pi * .05 * n.arange(1000))\n\
             a = n.stack([s, -s], axis=1)\n\
             a = (a * {'h': 2**15, 'i': 2**31}.get(sys.argv[2], 1)).astype(sys.argv[2])\n\
             w.write(sys.argv[1], 100000, a)";
        make("python3", &["-c", script, name, dtype]);
        check(1e-4);
    }
}
