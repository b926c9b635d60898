//! Memory does not grow with the recording.

#![cfg(target_os = "linux")]

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::common::{Wave, raw, wav};

/// Pairs of the recording, 60 MB.
const PAIRS: usize = 15_000_000;

#[test]
fn a_long_recording_takes_little_memory() {
    let directory = tempfile::tempdir().unwrap();
    // 75 pairs are four periods, so that the same bytes can be repeated.
    let steady = Wave {
        frequency: 16_000.0 / 3.0,
        angle_rate: 0.0,
        decay_rate: 0.0,
        ..crate::common::WAVE
    };
    let piece = steady.codes(75_000);
    let mut header = wav(&[]);
    let data = 4 * PAIRS as u32;
    header[4..8].copy_from_slice(&(36 + data).to_le_bytes());
    header[40..44].copy_from_slice(&data.to_le_bytes());
    let path = directory.path().join("long.wav");
    let mut file = BufWriter::new(File::create(&path).unwrap());
    file.write_all(&header).unwrap();
    for _ in 0..PAIRS / piece.len() {
        file.write_all(&raw(&piece)).unwrap();
    }
    file.into_inner().unwrap();
    let rows = directory.path().join("rows.csv");
    let mut child = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["identify", "--output", "csv"])
        .arg(&path)
        .stdout(Stdio::from(File::create(&rows).unwrap()))
        .spawn()
        .unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0u64;
    let mut looks = 0;
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(&status).unwrap_or_default();
        // A process that has just ended reports no memory.
        if let Some(line) = text.lines().find_map(|line| line.strip_prefix("VmHWM:")) {
            peak = peak.max(line.trim().trim_end_matches(" kB").parse().unwrap());
            looks += 1;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(child.wait().unwrap().success());
    assert!(looks > 20, "{looks} looks at a run that should take longer");
    let rows = fs::read_to_string(rows).unwrap().lines().count();
    // A window is 190 pairs.
    assert!(rows > PAIRS / 190 - 10, "{rows} rows");
    // The recording is 60 MB, the rows another 15.
    assert!(peak < 12_000, "{peak} kB");
}
