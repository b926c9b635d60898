//! `antinode command` on a port.
#![cfg(unix)]

use std::io::{Read, Write};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use crate::common::device::{Device, pair, wait_for_input};
use crate::common::run;
use antinode::Settings;
use antinode_telemetry::{
    Acknowledgement, Cause, Command as Asked, CommandFrame, Configuration, Decoder, FrontEnd,
    Hello, MAX_FRAME, Report, Reporter, State,
};

#[test]
fn commands_are_done_and_acknowledged() {
    let device = Device::start(true);
    // The timeout is long enough that nothing is asked twice on a slow computer.
    let command = |arguments: &str| device.command(&format!("{arguments} --timeout 20"));
    let cases = [
        ("window 20", "window of 20 periods: done\n"),
        ("hop 1", "hop of 1 block: done\n"),
        ("hop 5", "hop of 5 blocks: done\n"),
        ("frequency 5332.5", "frequency 5332.5 Hz: done\n"),
        ("hum on", "hum on: done\n"),
        ("coloured on", "coloured noise on: done\n"),
        ("methods on", "methods on: done\n"),
        ("methods off", "methods off: done\n"),
        (
            "calibration --gain-ratio 1.25 --pick-off-angle -0.01",
            "calibration: gain ratio 1.25, skew 0 ns, pick-off angle -0.01 rad: done\n",
        ),
        // Values that are not given stay.
        (
            "calibration --skew-ns -250",
            "calibration: gain ratio 1.25, skew -250 ns, pick-off angle -0.01 rad: done\n",
        ),
        // Shown as typed, though the device has it in s and single precision.
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
        "frequency 5332.5 Hz",
        ", hum, coloured noise",
    ] {
        assert!(get.contains(part), "{part}: {get}");
    }
    assert_eq!(command("hop none").out, "no hop: done\n");
    assert_eq!(command("methods off").out, "methods off: done\n");
    assert_eq!(
        command("frequency search").out,
        "search for the frequency: done\n"
    );
    assert_eq!(command("hum off").out, "hum off: done\n");
    let get = command("get").out;
    assert!(get.contains("no hop, methods off"), "{get}");
    assert!(!get.contains("frequency") && !get.contains("hum"), "{get}");
    let asked: Vec<_> = device.asked.try_iter().collect();
    assert_eq!(asked[0], Asked::SetWindow { periods: 20 });
    // Each `calibration` first asks for the present values.
    assert_eq!(asked.len(), cases.len() + 3 + 6);
}

#[test]
fn a_refusal_of_the_device_is_printed_with_the_remedy() {
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
        "frequency 0",
        "frequency fast",
        "frequency nan",
        "hum",
        "coloured maybe",
        "methods",
        "",
        "get --timeout 0",
    ] {
        assert_eq!(device.command(arguments).code, 2, "{arguments}");
    }
    // The error does not suggest a spelling that would pass it as a value.
    for (arguments, told) in [
        ("window -3", "65535"),
        ("hop -3", "65535"),
        ("frequency -3", "it must be a number above 0, or search"),
    ] {
        let run = device.command(arguments);
        assert!(run.code == 2 && run.err.contains(told), "{}", run.err);
    }
    // Commands that make no sense are not sent.
    assert_eq!(device.asked.try_iter().count(), 1);
}

#[test]
fn silence_is_reported_after_the_timeout() {
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
            .contains("no acknowledgement within 0.3 s; nothing was received"),
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
    let told = "no acknowledgement within 0.1 s, sent 3 times; nothing was received";
    assert!(get.code == 1 && get.err.contains(told), "{}", get.err);
    // `restart` is not repeated: two resets are not the same as one.
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
fn settings_that_do_not_arrive_are_asked_for_again() {
    let (mut port, path) = pair();
    let device = thread::spawn(move || {
        let (mut commands, mut reporter) = (Decoder::<CommandFrame>::new(), Reporter::new());
        let mut asked = 0;
        while asked < 2 {
            let mut bytes = [0; 64];
            // Reading fails while nobody has the other end open.
            let length = port.read(&mut bytes).unwrap_or(0);
            for byte in &bytes[..length] {
                let Some(Ok(CommandFrame { id, .. })) = commands.push(*byte) else {
                    continue;
                };
                asked += 1;
                // The command ends with what it still wants.
                let configuration = Configuration::new(Settings::new(1e5), FrontEnd::DualAdc);
                let report = if asked == 1 {
                    Report::Acknowledgement(Acknowledgement { id, result: Ok(()) })
                } else {
                    Report::Hello(Hello::new("1.2.3", configuration))
                };
                let mut buffer = [0; MAX_FRAME];
                let frame = reporter.frame(&report, &mut buffer).unwrap();
                port.write_all(frame).unwrap();
            }
        }
        port
    });
    let get = run(Path::new("."), &format!("command {path} --timeout 1 get"));
    assert!(
        get.code == 0 && get.out.contains("firmware 1.2.3"),
        "{} {}",
        get.out,
        get.err
    );
    device.join().unwrap();
}

#[test]
fn a_restart_whose_acknowledgement_is_lost_is_known_by_the_start_that_follows() {
    let (mut port, path) = pair();
    let device = thread::spawn(move || {
        wait_for_input(&mut port);
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
