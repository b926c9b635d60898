//! What the core costs on this machine, as ratios to the same four sums with the crate idsp in the same run:
//! `cargo bench -p antinode-cli`.

use std::hint::black_box;
use std::num::Wrapping;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::SystemTime;
use std::{env, fs};

use antinode::block::Demodulator;
use antinode::phase::PhaseStep;
use antinode::{Front, Identifier, Sample, SamplePair, Settings};
use antinode_sim::{Flaws, Gyro, Wave};
use criterion::{BenchmarkGroup, Criterion, Throughput, measurement::WallTime};
use idsp::{Accu, cossin};

const RATE: f64 = 100_000.0;
const FREQUENCY: f64 = 5_332.0;
/// Sample pairs that a kernel works through.
const PAIRS: usize = 1 << 16;
/// Seconds of the recording that the command reads: long beside what it takes to start.
const SECONDS: usize = 40;
/// Pairs of a half-buffer.
const HALF_BUFFER: usize = 128;
const GROUP: &str = "speed";
const PEER: &str = "idsp sums";
const COMMAND: &str = "identify, WAV to CSV";

type Group<'a> = BenchmarkGroup<'a, WallTime>;
type Code = [i16; 2];

/// Codes of a 12-bit converter.
fn codes() -> Vec<Code> {
    let wave = Wave {
        main_amplitude: 1600.0,
        quadrature_amplitude: 80.0,
        angle: 0.5,
        frequency: FREQUENCY,
        ..Wave::default()
    };
    let flaws = Flaws {
        noise: 2.0,
        offset_c: 20.0,
        offset_d: -15.0,
        bits: Some(12),
        full_scale: 2048.0,
        ..Flaws::default()
    };
    let gyro = Gyro::new(wave, flaws, RATE, 1).expect("the gyro is valid");
    gyro.take(PAIRS)
        .map(|pair| pair.map(|x| x as i16))
        .collect()
}

/// The sums with idsp: a phase accumulator, `cossin`, and products added in 64 bits.
fn idsp_sums(group: &mut Group, codes: &[Code]) {
    let step = (FREQUENCY / RATE * 32f64.exp2()) as i32;
    group.bench_function(PEER, |bencher| {
        bencher.iter(|| {
            let mut phase = Accu::new(Wrapping(0), Wrapping(step));
            let mut sums = [0i64; 4];
            for (&[c, d], angle) in black_box(codes).iter().zip(&mut phase) {
                let (cosine, sine) = cossin(angle.0);
                for (sum, (sample, weight)) in
                    sums.iter_mut()
                        .zip([(c, cosine), (c, sine), (d, cosine), (d, sine)])
                {
                    *sum += i64::from(sample) * i64::from(weight);
                }
            }
            sums
        });
    });
}

fn demodulator<S: Sample>(watch: bool) -> Demodulator<S, 200> {
    let step = PhaseStep::from_period((RATE / FREQUENCY) as f32);
    Demodulator::new(step, 19, 0, watch)
}

/// The stages of the core in one arithmetic.
fn stages<S: Sample>(group: &mut Group, arithmetic: &str, codes: &[Code])
where
    Code: SamplePair<S>,
{
    for (name, watch) in [("block", false), ("watch", true)] {
        group.bench_function(format!("{name} {arithmetic}"), |bencher| {
            let mut demodulator = demodulator::<S>(watch);
            bencher.iter(|| {
                for half in black_box(codes).chunks(HALF_BUFFER) {
                    let mut pairs = half;
                    while !pairs.is_empty() {
                        let (taken, block) = demodulator.push_slice(pairs);
                        black_box(block);
                        pairs = &pairs[taken..];
                    }
                }
            });
        });
    }
    group.bench_function(format!("push {arithmetic}"), |bencher| {
        let mut demodulator = demodulator::<S>(false);
        bencher.iter(|| {
            for &pair in black_box(codes) {
                black_box(demodulator.push(pair));
            }
        });
    });
    group.bench_function(format!("acquire {arithmetic}"), |bencher| {
        let mut front = Front::<S, 200>::new(Settings::new(RATE)).expect("valid");
        bencher.iter(|| {
            for &pair in black_box(codes) {
                black_box(front.push(pair));
                if !front.is_searching() {
                    front.search();
                }
            }
        });
    });
    group.bench_function(format!("pipeline {arithmetic}"), |bencher| {
        let mut identifier = Identifier::<S, 200, 16>::new(Settings::new(RATE)).expect("valid");
        bencher.iter(|| {
            for half in black_box(codes).chunks(HALF_BUFFER) {
                identifier.extend(half, |estimate| {
                    black_box(&estimate);
                });
            }
        });
    });
}

/// The command as it is installed: a 16-bit WAV file in, rows of CSV out.
fn command(group: &mut Group, folder: &Path) {
    let recording = folder.join("recording.wav");
    let antinode = || Command::new(env!("CARGO_BIN_EXE_antinode"));
    let made = antinode()
        .args(["simulate", "--noise", "0.002", "--seconds"])
        .arg(SECONDS.to_string())
        .arg("-o")
        .arg(&recording)
        .stdout(Stdio::null())
        .status();
    assert!(made.expect("it runs").success(), "no recording");
    group.throughput(Throughput::Elements((SECONDS * RATE as usize) as u64));
    group.sample_size(10).bench_function(COMMAND, |bencher| {
        bencher.iter(|| {
            let status = antinode()
                .args(["identify", "--output", "csv"])
                .arg(&recording)
                .stdout(Stdio::null())
                .status();
            assert!(status.expect("it runs").success(), "no rows");
        });
    });
}

/// Nanoseconds a sample pair, where this run measured it.
fn nanoseconds(folder: &Path, began: SystemTime) -> Option<(String, f64)> {
    let read = |name: &str| {
        let file = folder.join("new").join(name);
        let fresh = fs::metadata(&file).ok()?.modified().ok()? >= began;
        let text = fs::read(file).ok().filter(|_| fresh)?;
        serde_json::from_slice::<serde_json::Value>(&text).ok()
    };
    let (about, estimates) = (read("benchmark.json")?, read("estimates.json")?);
    let pairs = about["throughput"]["Elements"].as_f64()?;
    let name = about["function_id"].as_str()?.to_owned();
    Some((
        name,
        estimates["median"]["point_estimate"].as_f64()? / pairs,
    ))
}

/// Prints every time over that of the peer.
fn print_ratios(folder: &Path, began: SystemTime) {
    let measured: Vec<(String, f64)> = fs::read_dir(folder.join(GROUP))
        .into_iter()
        .flatten()
        .filter_map(|entry| nanoseconds(&entry.ok()?.path(), began))
        .collect();
    let Some(&(_, peer)) = measured.iter().find(|(name, _)| name == PEER) else {
        return;
    };
    let mut ratios: Vec<_> = measured.iter().map(|(name, t)| (t / peer, name)).collect();
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    println!("\nTime a sample pair over that of idsp's sums, {peer:.2} ns:");
    for (ratio, name) in ratios {
        println!("{ratio:9.2}  {name}");
    }
}

fn main() {
    let began = SystemTime::now();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("speed");
    fs::create_dir_all(&folder).expect("the target directory can be written");
    let mut criterion = Criterion::default()
        .output_directory(&folder)
        .configure_from_args();
    let codes = codes();
    let mut group = criterion.benchmark_group(GROUP);
    group.throughput(Throughput::Elements(PAIRS as u64));
    idsp_sums(&mut group, &codes);
    stages::<i16>(&mut group, "fixed", &codes);
    stages::<f32>(&mut group, "f32", &codes);
    command(&mut group, &folder);
    group.finish();
    criterion.final_summary();
    print_ratios(&folder, began);
}
