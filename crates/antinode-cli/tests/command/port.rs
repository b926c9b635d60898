//! `antinode command` and `antinode monitor` on a port: a pseudo-terminal with a device at its other end.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::common::{run, send};
use antinode::{Estimate, Identifier, Settings};
use antinode_telemetry::{
    Acknowledgement, Cause, Command as Asked, CommandError, CommandFrame, Configuration, Decoder,
    FrontEnd, Hello, MAX_FRAME, Report, Reporter, State,
};
use serialport::{SerialPort, TTYPort};

/// A device at the other end of a port.
struct Device {
    /// The port's path.
    path: String,
    /// What the device was asked for.
    asked: Receiver<Asked>,
    /// What it reports of itself.
    reports: Sender<Report>,
}

/// The port's two ends; the path is open again to whoever wants it alone.
fn pair() -> (TTYPort, String) {
    let (mut port, other) = TTYPort::pair().unwrap();
    port.set_timeout(Duration::from_millis(10)).unwrap();
    (port, other.name().unwrap())
}

impl Device {
    /// A device with a ring of 64 blocks; `loud` ones say other things before every answer.
    fn start(loud: bool) -> Self {
        Self::hearing(loud, 0)
    }

    /// The same, that does not hear so many of its first commands.
    fn hearing(loud: bool, mut unheard: u32) -> Self {
        let (mut port, path) = pair();
        let (asked_sender, asked) = channel();
        let (reports, reported) = channel::<Report>();
        thread::spawn(move || {
            let mut reporter = Reporter::new();
            let mut commands = Decoder::<CommandFrame>::new();
            let mut configuration = Configuration::new(Settings::new(100_000.0), FrontEnd::DualAdc);
            let mut send = |port: &mut TTYPort, report| {
                let mut buffer = [0; MAX_FRAME];
                let frame = reporter.frame(&report, &mut buffer).unwrap();
                let _ = port.write_all(frame);
            };
            loop {
                for report in reported.try_iter() {
                    send(&mut port, report);
                }
                let mut buffer = [0; 64];
                // While nobody holds the other end, reading fails.
                let Ok(length) = port.read(&mut buffer) else {
                    thread::sleep(Duration::from_millis(2));
                    continue;
                };
                for &byte in &buffer[..length] {
                    let Some(Ok(CommandFrame { id, command })) = commands.push(byte) else {
                        continue;
                    };
                    if unheard > 0 {
                        unheard -= 1;
                        continue;
                    }
                    if loud {
                        let _ = port.write_all(b"noise\0");
                        send(&mut port, Report::State(State::Tracking));
                        // The answer to somebody else.
                        let other = Acknowledgement {
                            id: !id,
                            result: Err(CommandError::Busy),
                        };
                        send(&mut port, Report::Acknowledgement(other));
                    }
                    let new = configuration.after(&command, 64);
                    // Told before it is acknowledged: whoever has the answer finds it here.
                    if asked_sender.send(command).is_err() {
                        return;
                    }
                    if let Ok(new) = new {
                        configuration = new;
                        send(&mut port, Report::Hello(Hello::new("1.2.3", new)));
                    }
                    let result = new.map(|_| ());
                    send(
                        &mut port,
                        Report::Acknowledgement(Acknowledgement { id, result }),
                    );
                }
            }
        });
        Self {
            path,
            asked,
            reports,
        }
    }

    /// Runs `antinode command` on it.
    fn command(&self, arguments: &str) -> crate::common::Run {
        run(
            Path::new("."),
            &format!("command {} {arguments}", self.path),
        )
    }
}

#[test]
fn commands_are_done_and_acknowledged() {
    let device = Device::start(true);
    // Nothing is asked again, however slow this computer is.
    let command = |arguments: &str| device.command(&format!("{arguments} --timeout 20"));
    let cases = [
        ("window 20", "window of 20 periods: done\n"),
        ("hop 1", "hop of 1 block: done\n"),
        ("hop 5", "hop of 5 blocks: done\n"),
        ("methods on", "methods on: done\n"),
        ("methods off", "methods off: done\n"),
        (
            "calibration --gain-ratio 1.25 --pick-off-angle -0.01",
            "calibration: gain ratio 1.25, skew 0 ns, pick-off angle -0.01 rad: done\n",
        ),
        // What is not given stays.
        (
            "calibration --skew-ns -250",
            "calibration: gain ratio 1.25, skew -250 ns, pick-off angle -0.01 rad: done\n",
        ),
        // As it was typed, though the device has it in s and single precision.
        (
            "calibration --skew-ns 15",
            "calibration: gain ratio 1.25, skew 15 ns, pick-off angle -0.01 rad: done\n",
        ),
        ("restart", "restart: done\n"),
    ];
    for (arguments, told) in cases {
        let run = command(arguments);
        assert_eq!(
            (run.code, run.out.as_str(), run.err.as_str()),
            (0, told, ""),
            "{arguments}"
        );
    }
    let get = command("get --baud 115200").out;
    for part in [
        "firmware 1.2.3",
        "window 20 periods",
        "hop 5 blocks",
        "methods off",
        "gain ratio 1.25",
        "skew 15 ns",
    ] {
        assert!(get.contains(part), "{part}: {get}");
    }
    assert_eq!(command("hop none").out, "no hop: done\n");
    assert_eq!(command("methods off").out, "methods off: done\n");
    let get = command("get").out;
    assert!(get.contains("no hop, methods off"), "{get}");
    let asked: Vec<_> = device.asked.try_iter().collect();
    assert_eq!(asked[0], Asked::SetWindow { periods: 20 });
    // Each calibration asks what there is first.
    assert_eq!(asked.len(), cases.len() + 3 + 4);
}

#[test]
fn what_the_device_refuses_is_told_with_the_remedy() {
    let device = Device::start(false);
    let run = device.command("window 63 --timeout 20");
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    let told = "refused: 63 periods a window: the ring of blocks holds at most 62";
    assert!(run.err.contains(told), "{}", run.err);
    for arguments in [
        "hop 0",
        "hop many",
        "calibration",
        "calibration --gain-ratio 0",
        "calibration --skew-ns 1e9",
        "calibration --pick-off-angle 1",
        "window",
        "window 1",
        "methods",
        "",
        "get --timeout 0",
    ] {
        assert_eq!(device.command(arguments).code, 2, "{arguments}");
    }
    // Not how to write it so that it would be taken for a number.
    for arguments in ["window -3", "hop -3"] {
        let run = device.command(arguments);
        assert!(run.code == 2 && run.err.contains("65535"), "{}", run.err);
    }
    // What makes no sense is not sent.
    assert_eq!(device.asked.try_iter().count(), 1);
}

#[test]
fn silence_is_told_after_the_time_out() {
    let (_port, path) = pair();
    let start = Instant::now();
    let asked = run(
        Path::new("."),
        &format!("command {path} --timeout 0.3 restart"),
    );
    assert!(start.elapsed() >= Duration::from_millis(300));
    assert_eq!(asked.code, 1);
    assert!(
        asked
            .err
            .contains("no acknowledgement within 0.3 s; nothing came"),
        "{}",
        asked.err
    );
}

#[test]
fn a_command_that_is_not_heard_is_sent_again() {
    let device = Device::hearing(true, 2);
    let window = device.command("--timeout 1 window 20");
    assert_eq!((window.code, window.err.as_str()), (0, ""));
    assert_eq!(device.asked.try_iter().count(), 1);
    let deaf = Device::hearing(false, 3);
    let get = deaf.command("--timeout 0.1 get");
    let told = "no acknowledgement within 0.1 s, asked 3 times; nothing came";
    assert!(get.code == 1 && get.err.contains(told), "{}", get.err);
    // A second reset is not the same as one.
    let deaf = Device::hearing(false, 1);
    let restart = deaf.command("--timeout 0.1 restart");
    assert!(
        restart.code == 1 && !restart.err.contains("times"),
        "{}",
        restart.err
    );
    assert_eq!(deaf.asked.try_iter().count(), 0);
}

#[test]
fn a_restart_whose_acknowledgement_is_lost_is_told_by_the_start_that_follows() {
    let (mut port, path) = pair();
    let device = thread::spawn(move || {
        // While nobody holds the other end, reading fails.
        while port.read(&mut [0; 64]).is_err() {
            thread::sleep(Duration::from_millis(2));
        }
        let mut buffer = [0; MAX_FRAME];
        let started = Report::State(State::Started(Cause::Command));
        let frame = Reporter::new().frame(&started, &mut buffer).unwrap();
        port.write_all(frame).unwrap();
        port
    });
    let restart = run(
        Path::new("."),
        &format!("command {path} --timeout 5 restart"),
    );
    let told = (restart.code, restart.out.as_str(), restart.err.as_str());
    assert_eq!(told, (0, "restart: done\n", ""));
    device.join().unwrap();
}

/// An estimate of a noise-free wave.
fn estimate() -> Estimate {
    let mut identifier = Identifier::<f32, 200, 16>::new(Settings::new(1e5)).unwrap();
    let pair = |k: u32| [(f64::from(k) * 0.335).cos() as f32, 0.0];
    (0..2000)
        .find_map(|k| identifier.push(pair(k)))
        .expect("a window")
}

/// A monitor on this port, or on anything else that comes to it.
fn monitor(path: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["monitor", path, "--format", "csv"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// What a command that has ended, or is about to, says.
fn told(child: &mut Child) -> String {
    let mut told = String::new();
    let mut err = child.stderr.take().unwrap();
    err.read_to_string(&mut told).unwrap();
    told
}

/// True where a command ends within 10 s; it is gone then in any case.
fn ends(child: &mut Child) -> bool {
    for _ in 0..500 {
        if child.try_wait().unwrap().is_some() {
            return true;
        }
        thread::sleep(Duration::from_millis(20));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    false
}

#[test]
fn a_monitor_on_a_port_shows_what_comes_until_it_is_interrupted() {
    let device = Device::start(false);
    let mut child = monitor(&device.path);
    assert_eq!(
        device.asked.recv_timeout(Duration::from_secs(10)),
        Ok(Asked::Get)
    );
    device.reports.send(estimate().into()).unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.next().unwrap().unwrap().starts_with("time_s,"));
    assert!(lines.next().unwrap().unwrap().ends_with(&device.path));
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let told = told(&mut child);
    assert!(
        told.starts_with("device: firmware 1.2.3, protocol 7"),
        "{told}"
    );
    assert!(
        told.contains(": 1 estimates and 2 other reports; 0 lost, 0 damaged"),
        "{told}"
    );
}

#[test]
fn frames_that_a_monitor_begins_or_ends_within_are_not_damaged() {
    let (mut port, path) = pair();
    let mut child = monitor(&path);
    // Its greeting: it listens.
    while port.read(&mut [0; 64]).is_err() {
        thread::sleep(Duration::from_millis(2));
    }
    let (mut reporter, mut buffer) = (Reporter::new(), [0; MAX_FRAME]);
    let mut frame = || {
        let frame = reporter.frame(&estimate().into(), &mut buffer);
        frame.unwrap().to_vec()
    };
    port.write_all(&frame()[40..]).unwrap();
    port.write_all(&frame()).unwrap();
    port.write_all(&frame()[..40]).unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.next().unwrap().unwrap().starts_with("time_s,"));
    assert!(lines.next().is_some());
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let told = told(&mut child);
    let summary = format!("{path}: 1 estimates and 0 other reports; 0 lost, 0 damaged; ");
    assert!(told.starts_with(&summary), "{told}");
}

#[test]
fn a_silent_port_is_told_of_while_it_is_waited_for() {
    let (mut port, path) = pair();
    let mut child = monitor(&path);
    let mut err = BufReader::new(child.stderr.take().unwrap()).lines();
    let told = err.next().unwrap().unwrap();
    let expected = format!("silent: nothing has come from {path} yet; check ");
    assert!(told.starts_with(&expected), "{told}");
    let mut buffer = [0; MAX_FRAME];
    let frame = Reporter::new().frame(&estimate().into(), &mut buffer);
    port.write_all(frame.unwrap()).unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.nth(1).is_some());
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let last = err.next().unwrap().unwrap();
    assert!(last.contains(": 1 estimates"), "{last}");
}

#[test]
fn a_monitor_of_a_pipe_that_nobody_writes_into_is_interrupted() {
    let directory = tempfile::tempdir().unwrap();
    let pipe = directory.path().join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let mut child = monitor(pipe.to_str().unwrap());
    thread::sleep(Duration::from_millis(300));
    send("-INT", &child);
    assert!(ends(&mut child));
}

#[test]
fn a_monitor_whose_rows_nobody_reads_ends_at_the_second_interrupt() {
    let device = Device::start(false);
    let mut child = monitor(&device.path);
    assert_eq!(
        device.asked.recv_timeout(Duration::from_secs(10)),
        Ok(Asked::Get)
    );
    // More rows than a pipe holds.
    let estimate = estimate();
    for _ in 0..2000 {
        device.reports.send(estimate.into()).unwrap();
    }
    thread::sleep(Duration::from_secs(2));
    send("-INT", &child);
    thread::sleep(Duration::from_millis(200));
    assert_eq!(child.try_wait().unwrap(), None);
    send("-INT", &child);
    assert!(ends(&mut child));
    assert_eq!(child.wait().unwrap().code(), Some(130));
}
