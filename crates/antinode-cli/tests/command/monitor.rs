//! `antinode monitor` on recorded bytes: rows, counts, and the cost of damage.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::{RATE, Row, WAVE, rows, run, run_with, wav};
use antinode::{Estimate, Identifier, Settings};
use antinode_telemetry::*;

/// The estimates that `identify` makes of a recording.
fn estimates(codes: &[[i16; 2]]) -> Vec<Estimate> {
    let step = 1.0 / 32_768.0;
    let settings = Settings {
        rails: Some([step - 1.0, 1.0 - step]),
        resolution: Some(step),
        ..Settings::new(RATE)
    };
    let mut identifier = Box::new(Identifier::<f32, 256, 1024>::new(settings).unwrap());
    let pairs: Vec<_> = codes
        .iter()
        .map(|pair| pair.map(|code| f32::from(code) * step))
        .collect();
    let mut estimates = Vec::new();
    identifier.extend(&pairs, |estimate| estimates.push(estimate));
    estimates
}

/// A device that writes to memory.
#[derive(Default)]
struct Device {
    reporter: Reporter,
    wire: Vec<u8>,
}

impl Device {
    /// The bytes of the next report.
    fn frame(&mut self, report: Report) -> Vec<u8> {
        let mut buffer = [0; MAX_FRAME];
        self.reporter.frame(&report, &mut buffer).unwrap().to_vec()
    }

    fn send(&mut self, report: Report) {
        let frame = self.frame(report);
        self.wire.extend(frame);
    }

    fn hello(&mut self) {
        let settings = Settings {
            frequency: Some(5320.0),
            ..Settings::new(RATE)
        };
        let configuration = Configuration::new(settings, FrontEnd::DualAdc);
        self.send(Report::Hello(Hello::new("0.1.0", configuration)));
    }
}

/// A stream with garbage, one damaged frame (the 5th estimate) and one missing (the 8th).
fn hurt(estimates: &[Estimate]) -> Vec<u8> {
    let mut device = Device::default();
    device.wire.extend(b"boot loader says hello\r\n");
    device.hello();
    device.send(Report::State(State::Started(Cause::BrownOut)));
    device.send(Report::State(State::Searching));
    for (i, &estimate) in estimates.iter().enumerate() {
        let mut frame = device.frame(estimate.into());
        match i {
            4 => frame[20] ^= 0x40,
            7 => frame.clear(),
            9 => device.wire.extend([0xff; 700]),
            _ => {}
        }
        device.wire.extend(frame);
    }
    device.send(Report::Counters(Counters {
        uptime_ms: 12_300,
        pairs: 1_230_000,
        overruns: 2,
        ..Counters::default()
    }));
    device.send(Report::State(State::Fault(Cause::Overrun)));
    // The power fails in the middle of a frame.
    let last = device.frame(Report::State(State::Tracking));
    device.wire.extend(&last[..4]);
    device.wire
}

#[test]
fn rows_are_those_of_identify_but_for_damaged_and_missing_ones() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let codes = WAVE.codes(5000);
    fs::write(here.join("a.wav"), wav(&codes)).unwrap();
    let estimates = estimates(&codes);
    let wire = hurt(&estimates);
    fs::write(here.join("a.bin"), &wire).unwrap();
    let mut expected = rows(here, "a.wav");
    assert_eq!(expected.len(), estimates.len());
    assert!(expected.len() > 20);
    expected.remove(7);
    expected.remove(4);

    for (source, input) in [("a.bin", Vec::new()), ("-", wire.clone())] {
        let run = run_with(here, &format!("monitor {source} --format csv"), input);
        assert_eq!(run.code, 0, "{}", run.err);
        let got = Row::all(&run.out);
        assert_eq!(got.len(), expected.len());
        for (got, expected) in got.iter().zip(&expected) {
            assert_eq!(got.unnamed(), expected.unnamed());
        }
        let name = if source == "-" {
            "standard input"
        } else {
            source
        };
        assert_eq!(got[0].text("file"), name);
        let told: Vec<_> = run.err.lines().collect();
        let expected = [
            "damaged: incomplete, or not a frame",
            "device: firmware 0.1.0, protocol 8, dual ADC, 100000 Hz, window 10 periods, no hop, methods off, \
             gain ratio 1, skew 0 ns, pick-off angle 0 rad, start angle 0.7853982 rad, frequency 5320 Hz",
            "state: started: brown-out",
            "state: searching for a wave",
            "lost: 1 before the next report",
            "counters: up 12.3 s, 1230000 sample pairs, 2 ADC overruns",
            "state: fault: overrun",
            // Within the same second as the ones before.
            "lost: 1 more",
            "damaged: 3 times, the last: incomplete, or not a frame",
        ];
        assert_eq!(told[..told.len() - 1], expected);
        let summary = format!(
            "{name}: {} estimates and 5 other reports; 2 lost, 4 damaged; {} bytes in ",
            estimates.len() - 2,
            wire.len()
        );
        assert!(told.last().unwrap().starts_with(&summary), "{}", run.err);
    }
}

#[test]
fn damage_on_a_noisy_line_is_told_once_a_second_and_counted() {
    let directory = tempfile::tempdir().unwrap();
    let mut device = Device::default();
    device.hello();
    for i in 0..200 {
        let mut frame = device.frame(Report::State(State::Searching));
        if i % 2 == 0 {
            frame[3] ^= 0x40;
        }
        device.wire.extend(frame);
    }
    let run = run_with(directory.path(), "monitor -", device.wire);
    let told = run.err.lines().filter(|line| line.starts_with("damaged: "));
    // At once and at the end, and each second on a slow computer.
    assert!(told.count() < 20, "{}", run.err);
    assert!(run.err.contains("100 lost, 100 damaged; "), "{}", run.err);
}

#[test]
fn a_table_shows_methods_under_their_row() {
    let directory = tempfile::tempdir().unwrap();
    let mut device = Device::default();
    let estimate = estimates(&WAVE.codes(2000))[0];
    device.send(estimate.into());
    let method = MethodValues {
        main_amplitude: 0.625,
        quadrature_amplitude: -0.0625,
        angle: 0.25,
        rank: 3,
    };
    device.send(Report::Methods(Methods {
        start: estimate.start,
        methods: [method; 4],
        disagree: true,
    }));
    device.send(estimate.into());
    let table = run_with(directory.path(), "monitor -", device.wire.clone());
    let lines: Vec<_> = table.out.lines().collect();
    assert_eq!(
        (table.code, lines.len()),
        (0, 1 + 1 + 4 + 1 + 1),
        "{}",
        table.out
    );
    assert!(lines[0].contains("main amplitude"));
    assert!(lines[2].contains("method 1") && lines[2].contains("0.625000"));
    assert!(lines[5].contains("method 4") && lines[5].contains("14.32394"));
    assert!(lines[6].contains("disagree"));
    let json = run_with(directory.path(), "monitor - --format jsonl", device.wire);
    assert_eq!(json.out.lines().count(), 2);
}

/// Runs `monitor`, which must exit 1 with a last line that holds all of these.
fn fault(directory: &Path, arguments: &str, input: Vec<u8>, told: &[&str]) {
    let run = run_with(directory, &format!("monitor {arguments}"), input);
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    let last = run.err.lines().last().unwrap();
    assert!(last.starts_with("error: "), "{}", run.err);
    for part in told {
        assert!(last.contains(part), "`{part}` is not in {last}");
    }
}

#[test]
fn bytes_that_are_no_telemetry_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fault(
        here,
        "none.bin",
        Vec::new(),
        &["none.bin: ", "there is no port and no file of this name"],
    );
    fault(here, ".", Vec::new(), &[".: ", "directory"]);
    fault(
        here,
        "-",
        Vec::new(),
        &["standard input: ", "no bytes were received"],
    );
    let garbage: Vec<u8> = (0..100_000u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8)
        .collect();
    fs::write(here.join("garbage.bin"), &garbage).unwrap();
    fault(
        here,
        "garbage.bin",
        Vec::new(),
        &[
            "no telemetry in 100000 bytes",
            "--baud applies to ports only",
        ],
    );
    fault(
        here,
        "-",
        garbage,
        &["no telemetry in 100000 bytes", "--baud"],
    );
    assert_eq!(run(here, "monitor a --format xml").code, 2);
    assert_eq!(run(here, "monitor a --baud 0").code, 2);
    assert_eq!(run(here, "monitor").code, 2);
}

#[test]
fn a_row_is_there_as_soon_as_its_frame_and_a_reader_may_leave() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["monitor", "-", "--format", "csv"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut device = Device::default();
    let mut input = child.stdin.take().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let estimate = estimates(&WAVE.codes(2000))[0];
    for i in 0..3 {
        let frame = device.frame(estimate.into());
        input.write_all(&frame).unwrap();
        if i == 0 {
            assert!(lines.next().unwrap().unwrap().starts_with("time_s,"));
        }
        assert!(lines.next().unwrap().unwrap().ends_with("standard input"));
    }
    drop(lines);
    let frame = device.frame(estimate.into());
    // The command may have ended before it reads all of this.
    while input.write_all(&frame).is_ok() {}
    assert_eq!(child.wait().unwrap().code(), Some(0));
}
