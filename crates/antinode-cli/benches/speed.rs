//! What the core costs on this machine, as ratios to the same four sums with the crate idsp in the same run:
//! `cargo bench -p antinode-cli`.

use std::fs;
use std::hint::black_box;
use std::num::Wrapping;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use antinode::block::Demodulator;
use antinode::phase::PhaseStep;
use antinode::{Front, Identifier, Sample, SamplePair, Settings};
use antinode_sim::{Flaws, Gyro, Wave};
use idsp::{Accu, cossin};

const RATE: f64 = 100_000.0;
const FREQUENCY: f64 = 5_332.0;
/// Sample pairs that a kernel works through.
const PAIRS: usize = 1 << 16;
/// Seconds of the recording that the command reads: long beside what it takes to start.
const SECONDS: usize = 40;
/// Pairs of a half-buffer.
const HALF_BUFFER: usize = 128;

type Code = [i16; 2];

/// Names of what was measured, and nanoseconds a sample pair.
#[derive(Default)]
struct Times(Vec<(String, f64)>);

impl Times {
    /// Measures a kernel on `PAIRS` pairs, and keeps its shortest time.
    fn add<T>(&mut self, name: impl Into<String>, work: impl FnMut() -> T) {
        self.add_shortest(name, 500, PAIRS, work);
    }

    /// Keeps the shortest of so many times of work on so many pairs: whatever else runs here only adds to it.
    fn add_shortest<T>(
        &mut self,
        name: impl Into<String>,
        runs: usize,
        pairs: usize,
        mut work: impl FnMut() -> T,
    ) {
        let times = (0..runs).map(|_| {
            let began = Instant::now();
            black_box(work());
            began.elapsed().as_nanos() as f64
        });
        let shortest = times.fold(f64::INFINITY, f64::min);
        self.0.push((name.into(), shortest / pairs as f64));
    }

    /// Prints all, the shortest first, over that of the peer.
    fn print(mut self, peer: f64) {
        self.0.sort_by(|a, b| a.1.total_cmp(&b.1));
        println!("Time a sample pair over that of idsp's sums, {peer:.2} ns:");
        for (name, time) in self.0 {
            println!("{:9.2}  {name}", time / peer);
        }
    }
}

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
fn idsp_sums(codes: &[Code]) -> [i64; 4] {
    let step = (FREQUENCY / RATE * 32f64.exp2()) as i32;
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
}

fn demodulator<S: Sample>(watch: bool) -> Demodulator<S, 200> {
    let step = PhaseStep::from_period((RATE / FREQUENCY) as f32);
    Demodulator::new(step, 19, 0, watch)
}

/// The stages of the core in one arithmetic.
fn stages<S: Sample>(times: &mut Times, arithmetic: &str, codes: &[Code])
where
    Code: SamplePair<S>,
{
    for (name, watch) in [("block", false), ("watch", true)] {
        let mut demodulator = demodulator::<S>(watch);
        times.add(format!("{name} {arithmetic}"), || {
            for half in black_box(codes).chunks(HALF_BUFFER) {
                let mut pairs = half;
                while !pairs.is_empty() {
                    let (taken, block) = demodulator.push_slice(pairs);
                    black_box(block);
                    pairs = &pairs[taken..];
                }
            }
        });
    }
    let mut demodulator = demodulator::<S>(false);
    times.add(format!("push {arithmetic}"), || {
        for &pair in black_box(codes) {
            black_box(demodulator.push(pair));
        }
    });
    let mut front = Front::<S, 200>::new(Settings::new(RATE)).expect("valid");
    times.add(format!("acquire {arithmetic}"), || {
        for &pair in black_box(codes) {
            black_box(front.push(pair));
            if !front.is_searching() {
                front.search();
            }
        }
    });
    let mut identifier = Identifier::<S, 200, 16>::new(Settings::new(RATE)).expect("valid");
    times.add(format!("pipeline {arithmetic}"), || {
        for half in black_box(codes).chunks(HALF_BUFFER) {
            identifier.extend(half, |estimate| {
                black_box(&estimate);
            });
        }
    });
}

/// Runs the command as it is installed, in a folder for recordings.
fn run(folder: &Path, arguments: &str) {
    let status = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .current_dir(folder)
        .args(arguments.split(' '))
        .stdout(Stdio::null())
        .status();
    assert!(status.expect("it runs").success(), "{arguments}");
}

fn main() {
    let codes = codes();
    let mut times = Times::default();
    times.add("idsp sums", || idsp_sums(&codes));
    let peer = times.0[0].1;
    stages::<i16>(&mut times, "fixed", &codes);
    stages::<f32>(&mut times, "f32", &codes);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("speed");
    fs::create_dir_all(&folder).expect("the target directory can be written");
    run(
        &folder,
        &format!("simulate --noise 0.002 --seconds {SECONDS} -o it.wav"),
    );
    // A 16-bit WAV file in, rows of CSV out.
    let pairs = SECONDS * RATE as usize;
    times.add_shortest("identify, WAV to CSV", 10, pairs, || {
        run(&folder, "identify --output csv it.wav");
    });
    times.print(peer);
}
