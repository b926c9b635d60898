//! A pseudo-terminal as a port, with a simulated device at its other end.

use std::io::{Read, Write};
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

use super::{Run, run};
use antinode::Settings;
use antinode_telemetry::{
    Acknowledgement, Command as Asked, CommandError, CommandFrame, Configuration, Decoder,
    FrontEnd, Hello, MAX_FRAME, Report, Reporter, State,
};
use serialport::{SerialPort, TTYPort};

/// A device at the other end of a port.
pub struct Device {
    /// The port's path.
    pub path: String,
    /// The commands that the device received.
    pub asked: Receiver<Asked>,
    /// Reports for the device to send unasked.
    pub reports: Sender<Report>,
}

/// The device's end of a port, and the path of the other end, which nobody has open.
pub fn pair() -> (TTYPort, String) {
    let (mut port, other) = TTYPort::pair().unwrap();
    port.set_timeout(Duration::from_millis(10)).unwrap();
    (port, other.name().unwrap())
}

/// Waits until the other end is open and has written something, as a monitor does to greet its device.
pub fn wait_for_input(port: &mut TTYPort) {
    // Reading fails until somebody opens the other end.
    while port.read(&mut [0; 64]).is_err() {
        thread::sleep(Duration::from_millis(2));
    }
}

impl Device {
    /// A device with a ring of 64 blocks; a `loud` one sends other bytes and reports before every answer.
    pub fn start(loud: bool) -> Self {
        Self::hearing(loud, 0)
    }

    /// The same, which ignores its first `unheard` commands.
    pub fn hearing(loud: bool, mut unheard: u32) -> Self {
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
                // Reading fails while nobody has the other end open.
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
                        // The answer to another program's command.
                        let other = Acknowledgement {
                            id: !id,
                            result: Err(CommandError::Busy),
                        };
                        send(&mut port, Report::Acknowledgement(other));
                    }
                    let new = configuration.after(&command, 64);
                    // Passed on before the acknowledgement: a test that has the answer finds it there.
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
    pub fn command(&self, arguments: &str) -> Run {
        run(
            Path::new("."),
            &format!("command {} {arguments}", self.path),
        )
    }
}
