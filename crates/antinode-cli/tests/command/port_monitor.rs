//! `antinode monitor` on a port or a pipe that stays open.
#![cfg(unix)]

use std::ffi::OsStr;
use std::fs;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use crate::common::device::{Device, pair, wait_for_input};
use crate::common::send;
use antinode::{Estimate, Identifier, Settings};
use antinode_telemetry::{Command as Asked, MAX_FRAME, Reporter};

/// An estimate of a noise-free wave.
fn estimate() -> Estimate {
    let mut identifier = Identifier::<f32, 200, 16>::new(Settings::new(1e5)).unwrap();
    let pair = |k: u32| [(f64::from(k) * 0.335).cos() as f32, 0.0];
    (0..2000)
        .find_map(|k| identifier.push(pair(k)))
        .expect("a window")
}

/// A monitor of this port or pipe.
fn monitor(path: &str) -> Child {
    monitor_to(path, Stdio::piped())
}

fn monitor_to(path: &str, out: impl Into<Stdio>) -> Child {
    Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args(["monitor", path, "--format", "csv"])
        .stdout(out)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The standard error of a command that has ended or is about to.
fn told(child: &mut Child) -> String {
    let mut told = String::new();
    let mut err = child.stderr.take().unwrap();
    err.read_to_string(&mut told).unwrap();
    told
}

/// Waits until a monitor greets the device, which then sends an estimate.
fn answer(device: &Device) {
    let asked = device.asked.recv_timeout(Duration::from_secs(10));
    assert_eq!(asked, Ok(Asked::Get));
    device.reports.send(estimate().into()).unwrap();
}

/// True if a command ends within 10 s; otherwise it is killed.
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
    answer(&device);
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.next().unwrap().unwrap().starts_with("time_s,"));
    assert!(lines.next().unwrap().unwrap().ends_with(&device.path));
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let told = told(&mut child);
    assert!(
        told.starts_with("device: firmware 1.2.3, protocol 8"),
        "{told}"
    );
    // The greeting is no command of the user's.
    assert!(!told.contains("command 0"), "{told}");
    assert!(
        told.contains(": 1 estimates and 2 other reports; 0 lost, 0 damaged"),
        "{told}"
    );
}

#[test]
fn frames_that_a_monitor_begins_or_ends_within_are_not_damaged() {
    let (mut port, path) = pair();
    let mut child = monitor(&path);
    wait_for_input(&mut port);
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
fn a_port_whose_name_is_not_utf_8_is_opened() {
    let device = Device::start(false);
    let directory = tempfile::tempdir().unwrap();
    let link = directory.path().join(OsStr::from_bytes(b"port\xff"));
    // Where names must be UTF-8, as on macOS, there is no such port.
    if symlink(&device.path, &link).is_err() {
        return;
    }
    let get = Command::new(env!("CARGO_BIN_EXE_antinode"))
        .args([OsStr::new("command"), link.as_os_str(), OsStr::new("get")])
        .output()
        .unwrap();
    let out = String::from_utf8(get.stdout).unwrap();
    assert!(out.starts_with("firmware 1.2.3"), "{out}");
}

#[test]
fn a_silent_port_is_reported_while_it_is_waited_for() {
    let (mut port, path) = pair();
    let mut child = monitor(&path);
    let mut err = BufReader::new(child.stderr.take().unwrap()).lines();
    let told = err.next().unwrap().unwrap();
    let expected = format!("silent: nothing was received from {path} yet; check ");
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
fn a_port_that_falls_silent_is_reported_once_and_when_it_is_heard_again() {
    let (mut port, path) = pair();
    let mut child = monitor(&path);
    wait_for_input(&mut port);
    let (mut reporter, mut buffer) = (Reporter::new(), [0; MAX_FRAME]);
    let mut send_one = || {
        let frame = reporter.frame(&estimate().into(), &mut buffer);
        port.write_all(frame.unwrap()).unwrap();
    };
    send_one();
    let mut err = BufReader::new(child.stderr.take().unwrap()).lines();
    let told = err.next().unwrap().unwrap();
    let expected = format!("silent: nothing was received from {path} for 10 s; check ");
    assert!(told.starts_with(&expected), "{told}");
    // Nothing more is told in a silence as long again.
    thread::sleep(Duration::from_secs(11));
    send_one();
    let told = err.next().unwrap().unwrap();
    assert!(told.starts_with("silent: no longer, after 2"), "{told}");
    assert_eq!(child.try_wait().unwrap(), None);
    send("-INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let last = err.next().unwrap().unwrap();
    assert!(last.contains(": 2 estimates"), "{last}");
}

/// Waits until a command catches SIGTERM, and so SIGINT, too: for a moment after it is caught, a signal that was ignored before is still
/// lost. Where the system does not tell, waits for a second.
fn wait_until_interruptible(child: &Child) {
    for _ in 0..500 {
        let Ok(status) = fs::read_to_string(format!("/proc/{}/status", child.id())) else {
            return thread::sleep(Duration::from_secs(1));
        };
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = u64::from_str_radix(caught.unwrap().trim(), 16).unwrap();
        // Signal 15 has bit 14. SIGINT is caught before it.
        if caught >> 14 & 1 != 0 {
            return;
        }
        thread::sleep(Duration::from_millis(20));
    }
    panic!("SIGTERM is not caught");
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
    // Started as a shell script starts a job in the background: with SIGINT ignored.
    let mut child = Command::new("sh")
        .args(["-c", "trap '' INT; exec \"$0\" monitor \"$1\""])
        .arg(env!("CARGO_BIN_EXE_antinode"))
        .arg(&pipe)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait_until_interruptible(&child);
    send("-INT", &child);
    assert!(ends(&mut child));
    let told = told(&mut child);
    assert!(told.contains("no bytes were received"), "{told}");
}

/// A monitor that waits until somebody reads its rows, and what keeps it so.
fn unread() -> (Child, impl Sized) {
    let device = Device::start(false);
    let (reader, mut writer) = io::pipe().unwrap();
    let child = monitor_to(&device.path, writer.try_clone().unwrap());
    answer(&device);
    let mut lines = BufReader::new(reader).lines();
    assert!(lines.nth(1).is_some());
    // Another writer fills the pipe and waits, so that the next row waits too.
    let (is_filled, filled) = mpsc::channel();
    thread::spawn(move || {
        loop {
            // It fails once nobody can read any more.
            if writer.write_all(&[0; 1 << 14]).is_err() {
                break;
            }
            is_filled.send(()).unwrap();
        }
    });
    while filled.recv_timeout(Duration::from_secs(1)).is_ok() {}
    device.reports.send(estimate().into()).unwrap();
    thread::sleep(Duration::from_secs(2));
    (child, (device, lines, filled))
}

#[test]
fn a_monitor_whose_rows_nobody_reads_ends_at_the_second_interrupt() {
    let (mut child, _unread) = unread();
    send("-INT", &child);
    thread::sleep(Duration::from_millis(1000));
    assert_eq!(child.try_wait().unwrap(), None);
    send("-INT", &child);
    assert!(ends(&mut child));
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_monitor_whose_rows_nobody_reads_is_terminated() {
    let (mut child, _unread) = unread();
    send("-TERM", &child);
    assert!(ends(&mut child));
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[test]
fn a_monitor_that_is_terminated_tells_its_totals() {
    let device = Device::start(false);
    let mut child = monitor(&device.path);
    answer(&device);
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.nth(1).is_some());
    send("-TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let told = told(&mut child);
    assert!(told.contains(": 1 estimates and "), "{told}");
}
