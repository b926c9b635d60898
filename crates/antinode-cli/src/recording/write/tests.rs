//! Written files are read back, here and by `scipy` and `numpy`.

use std::fs;
use std::process::Command;

use super::super::tests::{drain, without};
use super::super::{OpenOptions, Recording};
use super::encode::MAX_WAV_DATA;

use clap::ValueEnum;

use super::*;

fn signal(count: usize) -> Vec<[f64; 2]> {
    (0..count)
        .map(|k| (0.3 * k as f64).sin_cos())
        .map(|(c, d)| [0.9 * c, 1e-3 * d])
        .collect()
}

fn write(path: &Path, rate: f64, sample: SampleFormat, pairs: &[[f64; 2]]) -> Result<(), Failure> {
    let mut writer = RecordingWriter::create(path, rate, sample)?;
    for &pair in pairs {
        writer.write(pair)?;
    }
    writer.finish()
}

fn fault(name: &str, rate: f64, sample: SampleFormat, pairs: &[[f64; 2]]) -> String {
    let directory = tempfile::tempdir().unwrap();
    let fault = write(&directory.path().join(name), rate, sample, pairs).unwrap_err();
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
    without(directory.path(), &fault)
}

#[test]
fn written_recordings_are_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let pairs = signal(1000);
    for name in ["a.wav", "a.CSV", "a.npy"] {
        let path = directory.path().join(name);
        for &sample in SampleFormat::value_variants() {
            if name == "a.wav" && sample == SampleFormat::F64 {
                continue;
            }
            write(&path, 100_000.0, sample, &pairs).unwrap();
            let mut recording = Recording::open(&path, &OpenOptions::default()).unwrap();
            let rate = if name == "a.npy" {
                None
            } else {
                Some(100_000.0)
            };
            assert_eq!(recording.opened.sample_rate, rate);
            let (read, fault) = drain(&mut recording);
            assert!(fault.is_none());
            assert_eq!(read.len(), pairs.len());
            let step = match sample {
                SampleFormat::I16 => 0.5 / 32_768.0,
                _ => 1e-7,
            };
            for (read, pair) in read.as_flattened().iter().zip(pairs.as_flattened()) {
                assert!(
                    (f64::from(*read) - pair).abs() <= step,
                    "{name} {sample:?}: {read} {pair}"
                );
            }
        }
    }
}

#[test]
fn integers_are_rounded_and_held_at_the_rails() {
    for (sample, top) in [
        (SampleFormat::I16, 32_767),
        (SampleFormat::I24, 8_388_607),
        (SampleFormat::I32, i32::MAX),
    ] {
        assert_eq!(sample.store(1.0), Some(f64::from(top)));
        assert_eq!(sample.store(7.0), Some(f64::from(top)));
        assert_eq!(sample.store(-1.0), Some(f64::from(-top - 1)));
        assert_eq!(sample.store(-7.0), Some(f64::from(-top - 1)));
        let code = 1.0 / (f64::from(top) + 1.0);
        assert_eq!(sample.store(2.4 * code), Some(2.0));
        assert_eq!(sample.store(-2.6 * code), Some(-3.0));
    }
}

#[test]
fn text_has_the_fewest_digits_that_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.csv");
    let text = |sample, pair| {
        write(&path, 100_000.0, sample, &[[0.0, -1.0], pair]).unwrap();
        fs::read_to_string(&path).unwrap()
    };
    assert_eq!(
        text(SampleFormat::F64, [0.1, 1e-7]),
        "time,c,d\n0.0,0.0,-1.0\n1e-5,0.1,1e-7\n"
    );
    assert_eq!(
        text(SampleFormat::F32, [1.0 / 3.0, 2.5]),
        "time,c,d\n0.0,0.0,-1.0\n1e-5,0.33333334,2.5\n"
    );
    assert_eq!(
        text(SampleFormat::I16, [0.5, 1.0]),
        "time,c,d\n0.0,0.0,-1.0\n1e-5,0.5,0.999969482421875\n"
    );
}

#[test]
fn recordings_that_cannot_be_written_are_named() {
    let pairs = signal(3);
    let f32s = SampleFormat::F32;
    assert!(
        fault("a.flac", 1e5, f32s, &pairs)
            .starts_with("a.flac: the extension is not that of a known format; end the name in")
    );
    let expected = "a.wav: this format cannot hold a sample rate of 100000.5 Hz; give a whole number of Hz below";
    assert!(fault("a.wav", 100_000.5, f32s, &pairs).starts_with(expected));
    assert!(
        fault("a.wav", 1e9, f32s, &pairs)
            .starts_with("a.wav: this format cannot hold a sample rate of 1000000000")
    );
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(fault("a.csv", rate, f32s, &pairs).contains("cannot hold a sample rate of "));
    }
    assert!(
        fault("a.wav", 1e5, SampleFormat::F64, &pairs)
            .starts_with("a.wav: WAV files of 64-bit floats are not")
    );
    for (pair, channel) in [
        ([f64::NAN, 0.0], "S_C (left): NaN"),
        ([0.0, -f64::INFINITY], "S_D (right): -inf"),
    ] {
        let expected = format!("a.npy: sample pair 1 (from 0), {channel} is not a finite number; ");
        assert!(fault("a.npy", 1e5, SampleFormat::I24, &[[0.0, 0.0], pair]).starts_with(&expected));
    }
    assert!(
        fault("a.csv", 1e5, f32s, &[[1e300, 0.0]])
            .starts_with("a.csv: sample pair 0 (from 0), S_C (left): 1")
    );
    assert!(
        fault("none/a.csv", 1e5, f32s, &pairs)
            .starts_with("none/a.csv: there is no directory `none`")
    );
    let directory = tempfile::tempdir().unwrap();
    fs::create_dir(directory.path().join("a.wav")).unwrap();
    let taken = write(&directory.path().join("a.wav"), 1e5, f32s, &pairs)
        .unwrap_err()
        .to_string();
    assert!(taken.ends_with("a.wav: this exists and is not a file; give the path of a file"));
}

#[test]
fn a_full_wav_file_can_still_be_finished() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.wav");
    let mut writer = RecordingWriter::create(&path, 1e5, SampleFormat::I16).unwrap();
    writer.write([0.5, 0.5]).unwrap();
    writer.pairs = MAX_WAV_DATA / 4;
    assert!(writer.check_room(writer.pairs).is_ok());
    let fault = writer.write([0.5, 0.5]).unwrap_err().to_string();
    assert!(
        fault.contains("a.wav: 1073741809 sample pairs: a WAV file holds no more than 4 GiB; "),
        "{fault}"
    );
    writer.finish().unwrap();
    assert_eq!(
        drain(&mut Recording::open(&path, &OpenOptions::default()).unwrap()).0,
        [[0.5, 0.5]]
    );
}

#[test]
fn the_old_file_stays_until_the_new_one_is_whole() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.csv");
    fs::write(&path, "good").unwrap();
    let mut writer = RecordingWriter::create(&path, 1.0, SampleFormat::F64).unwrap();
    writer.write([1.0, 2.0]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "good");
    drop(writer);
    assert_eq!(fs::read_to_string(&path).unwrap(), "good");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    write(&path, 1.0, SampleFormat::F64, &[[1.0, 2.0]]).unwrap();
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "time,c,d\n0.0,1.0,2.0\n"
    );
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn a_file_that_cannot_have_its_name_is_kept() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.csv");
    let mut writer = RecordingWriter::create(&path, 1.0, SampleFormat::F64).unwrap();
    writer.write([1.0, 2.0]).unwrap();
    fs::create_dir(&path).unwrap();
    fs::write(path.join("file"), "").unwrap();
    let told = writer.finish().unwrap_err().to_string();
    let (_, told) = told
        .split_once("a.csv: cannot be given this name: ")
        .unwrap();
    let (_, told) = told.split_once("are beside it in `").unwrap();
    let (kept, _) = told.split_once('`').unwrap();
    let kept = directory.path().join(kept);
    assert_eq!(fs::read_to_string(kept).unwrap(), "time,c,d\n0.0,1.0,2.0\n");
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 2);
}

#[cfg(windows)]
#[test]
fn a_path_may_be_longer_than_windows_takes_without_its_mark() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.csv");
    let (whole, _) = WholeFile::create(&path).unwrap();
    // Wine takes any length, so that the mark itself is looked for.
    let name = whole.temporary().to_string_lossy();
    assert!(name.starts_with(r"\\?\"), "{name}");
    whole.finish().unwrap();
    assert!(path.is_file());
}

#[cfg(unix)]
#[test]
fn a_link_keeps_leading_to_its_file() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let directory = tempfile::tempdir().unwrap();
    let (path, link) = (
        directory.path().join("a.csv"),
        directory.path().join("b.csv"),
    );
    fs::write(&path, "good").unwrap();
    symlink(&path, &link).unwrap();
    write(&link, 1.0, SampleFormat::F64, &[[1.0, 2.0]]).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "time,c,d\n0.0,1.0,2.0\n"
    );
    let plain = directory.path().join("plain");
    fs::File::create(&plain).unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&plain));
    // Also if that file is not there yet.
    for to in [Path::new("c.csv"), &directory.path().join("d.csv")] {
        fs::remove_file(&link).unwrap();
        symlink(to, &link).unwrap();
        write(&link, 1.0, SampleFormat::F64, &[[1.0, 2.0]]).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert!(directory.path().join(to).is_file());
    }
}

#[test]
#[ignore = "needs python3 with numpy and scipy"]
fn scipy_and_numpy_read_what_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let pairs = signal(500);
    let script = "import sys, numpy as n\n\
         import scipy.io.wavfile as w\n\
         f = sys.argv[1]\n\
         r, a = w.read(f) if f.endswith('wav') else (1e5, n.load(f) if f.endswith('npy') else None)\n\
         if a is None:\n\
         \x20 t = n.loadtxt(f, delimiter=',', skiprows=1); a = t[:, 1:]; assert n.allclose(t[:, 0], n.arange(500) / r)\n\
         k = n.arange(500) * .3; e = n.stack([.9 * n.sin(k), 1e-3 * n.cos(k)], 1)\n\
         s = float(n.iinfo(a.dtype).max) + 1 if a.dtype.kind == 'i' else 1\n\
         assert r == 1e5 and a.shape == (500, 2) and abs(a / s - e).max() < 2e-5, (r, a.shape, abs(a / s - e).max())";
    for name in ["a.wav", "a.csv", "a.npy"] {
        for sample in &SampleFormat::value_variants()[..4] {
            let path = directory.path().join(name);
            write(&path, 1e5, *sample, &pairs).unwrap();
            let read = Command::new("python3")
                .args(["-c", script])
                .arg(&path)
                .status();
            assert!(read.unwrap().success(), "{name} {sample:?}");
        }
    }
}
