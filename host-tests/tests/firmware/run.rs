//! `firmware/run`, the script behind `cargo replay`: output of the line's bytes, and accepted recordings.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use antinode::Packed;
use antinode_telemetry::{Receiver, Report};

use crate::emulator::{folder, images};
use crate::recordings;
use crate::told::estimates;

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/run");

/// A file for this test only.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    fs::write(&path, bytes).expect("it can be written");
    path
}

/// Runs a recording with the output to `out`; gives the exit code and the messages.
fn replay(recording: &Path, out: File) -> (Option<i32>, String) {
    let output = Command::new(SCRIPT)
        .arg(images().join("replay"))
        .arg(recording)
        .stdin(Stdio::null())
        .stdout(out)
        .stderr(Stdio::piped())
        .output()
        .expect("bash is installed");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), told)
}

/// Reports of a run on this recording, which must be accepted.
fn reports(recording: &Path) -> Vec<Report> {
    let out = recording.with_extension("out");
    let (code, told) = replay(recording, File::create(&out).expect("it can be written"));
    assert_eq!(code, Some(0), "{told}");
    let mut receiver = Receiver::new();
    let bytes = fs::read(out).expect("it is there");
    let reports = bytes.iter().filter_map(|&byte| receiver.push(byte));
    reports
        .map(|report| report.expect("a sound frame"))
        .collect()
}

fn little_endian(codes: &[Packed]) -> Vec<u8> {
    codes.iter().flat_map(|pair| pair.0.to_le_bytes()).collect()
}

/// A WAV file whose header states this length.
fn wav(codes: &[Packed], promised: u32) -> Vec<u8> {
    let mut bytes = b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0\x01\0\x02\0".to_vec();
    bytes.extend(100_000u32.to_le_bytes());
    bytes.extend(400_000u32.to_le_bytes());
    bytes.extend(b"\x04\0\x10\0data");
    bytes.extend(promised.to_le_bytes());
    bytes.extend(little_endian(codes));
    bytes
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn bytes_are_appended_to_a_file_after_its_content() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 5000);
    let recording = file("appended.raw", &little_endian(&codes));
    let expected = reports(&recording);
    assert!(estimates(&expected).len() > 10);
    let out = file("appended.bin", b"kept");
    let open = File::options().append(true).open(&out);
    let (code, told) = replay(&recording, open.expect("it is there"));
    assert_eq!(code, Some(0), "{told}");
    let bytes = fs::read(&out).expect("it is there");
    assert!(bytes.starts_with(b"kept") && bytes.len() > 1000);
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn a_wav_file_without_a_length_in_its_header_is_read_to_its_end() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 5000);
    let whole = reports(&file("whole.wav", &wav(&codes, 4 * 5000)));
    assert!(estimates(&whole).len() > 10);
    for (name, promised) in [("streamed.wav", 0), ("unknown.wav", u32::MAX)] {
        let streamed = reports(&file(name, &wav(&codes, promised)));
        assert_eq!(estimates(&streamed), estimates(&whole), "{name}");
    }
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn files_that_are_no_recording_are_refused_with_the_remedy() {
    let codes = recordings::codes(recordings::WAVE, recordings::quiet(), 5000);
    let no_stereo = [&wav(&codes, 20_000)[..22], &[1], &wav(&codes, 20_000)[23..]].concat();
    let out = folder().join("refused.bin");
    for (recording, part) in [
        (file("codes.csv", b"time,C,D\n0,1,2\n"), "is no WAV file"),
        (file("codes.bin", &little_endian(&codes)), "is no WAV file"),
        (file("mono.wav", &no_stereo), "was refused"),
        (folder(), "is no file that can be read"),
        (folder().join("none.wav"), "is no file that can be read"),
    ] {
        let (code, told) = replay(&recording, File::create(&out).expect("it can be written"));
        let name = recording.display();
        assert!(code.is_some_and(|code| code > 0), "{name}: {told}");
        let told = told.lines().last().unwrap_or("");
        let start = format!("firmware/run: {name} {part}");
        assert!(told.starts_with(&start), "{told}");
        assert!(told.contains("two channels of 16 bits"), "{told}");
        assert!(fs::read(&out).expect("it is there").is_empty(), "{name}");
    }
}

#[cfg(unix)]
#[test]
fn a_board_may_have_another_chip() {
    use std::os::unix::fs::PermissionsExt;

    let tools = folder().join("tools");
    fs::create_dir_all(&tools).expect("it can be made");
    // In place of the probe's program, it tells what it was asked for.
    let probe = tools.join("probe-rs");
    fs::write(&probe, "#!/bin/sh\necho \"$@\"\n").expect("it can be written");
    fs::set_permissions(&probe, fs::Permissions::from_mode(0o755)).expect("it is ours");
    let path = format!(
        "{}:{}",
        tools.display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let run = |image: &str, chip: Option<&str>| {
        Command::new(SCRIPT)
            .arg(image)
            .env("PATH", &path)
            .env_remove("SERIAL")
            .env_remove("CHIP")
            .envs(chip.map(|chip| ("CHIP", chip)))
            .output()
            .expect("bash is installed")
    };
    for (image, chip, asked) in [
        ("stm32f405", None, "run --chip STM32F405RGTx stm32f405\n"),
        (
            "stm32f405",
            Some("STM32F407VGTx"),
            "run --chip STM32F407VGTx stm32f405\n",
        ),
        (
            "stm32g474",
            Some("STM32G474RETx"),
            "run --chip STM32G474RETx stm32g474\n",
        ),
    ] {
        let output = run(image, chip);
        assert_eq!(String::from_utf8_lossy(&output.stdout), asked);
    }
    // Neither is it flashed as another chip, nor run in the emulator.
    let refused = run("stm32g474", None);
    let told = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{told}");
    assert!(told.contains("set CHIP to the chip of stm32g474"), "{told}");
}
