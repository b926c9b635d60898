//! Builds the images, and runs `replay` in QEMU with its serial line on a socket.

use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use antinode::Packed;
use antinode_telemetry::{CommandFrame, MAX_FRAME, Receiver, Report, frame};

/// The profile and the target of the images.
const PROFILE: &str = "firmware";
const TARGET: &str = "thumbv7em-none-eabihf";
/// Longest run.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder for this test only.
pub fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("firmware");
    fs::create_dir_all(&folder).expect("the target directory can be written");
    folder
}

/// Builds all images of the firmware with these features; gives their folder.
fn build(features: &[&str], images: &[&str]) -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .parent()
        .expect("the folder lies in the target directory");
    let mut cargo = Command::new(env!("CARGO"));
    cargo
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .args(["build", "--quiet", "-p", "firmware", "--profile", PROFILE])
        .args(["--target", TARGET, "--target-dir"])
        .arg(target)
        .args(features.iter().flat_map(|feature| ["--features", feature]));
    for image in images {
        cargo.args(["--bin", image]);
    }
    let status = cargo.status().expect("cargo runs");
    assert!(status.success(), "the images must build");
    let copies = folder().join(features.join("+"));
    fs::create_dir_all(&copies).expect("it can be written");
    for image in images {
        fs::copy(
            target.join(TARGET).join(PROFILE).join(image),
            copies.join(image),
        )
        .expect("built");
    }
    copies
}

/// The images, built once.
pub fn images() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        // One after the other, as both builds use the same folder.
        let float = build(&["f32"], &["replay"]);
        let fixed = build(&[], &["stm32f405", "stm32f405_ad7380", "check_memory"]);
        let replay = build(&["methods"], &["replay"]);
        fs::copy(replay.join("replay"), fixed.join("replay")).expect("built");
        fs::copy(float.join("replay"), fixed.join("replay_f32")).expect("built");
        fixed
    })
}

/// QEMU, which is stopped with its owner.
pub struct Emulator(Child);

impl Emulator {
    /// The command that runs `image`, without window and monitor.
    pub fn of(image: &str) -> Command {
        let mut command = Command::new("qemu-system-arm");
        command
            .args(["-machine", "netduinoplus2", "-display", "none"])
            .args(["-monitor", "none", "-kernel"])
            .arg(images().join(image))
            .stdin(Stdio::null());
        command
    }

    /// Starts the command.
    pub fn begin(command: &mut Command) -> Self {
        Self(command.spawn().expect("qemu-system-arm must be installed"))
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A running image.
pub struct Device {
    emulator: Emulator,
    line: UnixStream,
    receiver: Receiver,
    began: Instant,
    /// Path of its log.
    pub log: PathBuf,
    /// Reports received so far.
    pub reports: Vec<Report>,
}

impl Device {
    /// Starts `image` on a recording, with options for its command line.
    pub fn start(image: &str, recording: &[Packed], options: &str) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let folder = folder();
        let name = format!("{number}.raw");
        let bytes: Vec<u8> = recording.iter().flat_map(|p| p.0.to_le_bytes()).collect();
        fs::write(folder.join(&name), bytes).expect("it can be written");
        // The path of a socket is limited to 107 bytes.
        let socket = std::env::temp_dir().join(format!("antinode-{}-{number}", std::process::id()));
        let log = folder.join(format!("{number}.log"));
        let listener = UnixListener::bind(&socket).expect("a socket can be made");
        let args: String = std::iter::once(name.as_str())
            .chain(options.split_ascii_whitespace())
            .map(|word| format!(",arg={word}"))
            .collect();
        let emulator = Emulator::begin(
            Emulator::of(image)
                .current_dir(&folder)
                .args(["-serial", &format!("unix:{}", socket.display())])
                .args([
                    "-semihosting-config",
                    &format!("enable=on,target=native{args}"),
                ])
                // Semihosting writes the log there.
                .stdout(fs::File::create(&log).expect("it can be written")),
        );
        let (line, _) = listener.accept().expect("QEMU opens the line");
        fs::remove_file(&socket).expect("it is there");
        line.set_read_timeout(Some(Duration::from_millis(50)))
            .expect("a socket has a timeout");
        let mut device = Self {
            emulator,
            line,
            receiver: Receiver::new(),
            began: Instant::now(),
            log,
            reports: Vec::new(),
        };
        // Before this its USART is off and drops bytes.
        assert!(device.read_until(|reports| !reports.is_empty()));
        device
    }

    /// Sends bytes.
    pub fn send(&mut self, bytes: &[u8]) {
        self.line.write_all(bytes).expect("the line is open");
    }

    /// Sends a command.
    pub fn command(&mut self, id: u16, command: antinode_telemetry::Command) {
        self.send(&bytes(id, command));
    }

    /// Reads until `enough` gives true; false if the run has ended before.
    pub fn read_until(&mut self, enough: impl Fn(&[Report]) -> bool) -> bool {
        let mut buffer = [0; 4096];
        while !enough(&self.reports) {
            assert!(self.began.elapsed() < PATIENCE, "the image does not end");
            match self.line.read(&mut buffer) {
                Ok(0) => return false,
                Ok(length) => {
                    for &byte in &buffer[..length] {
                        if let Some(report) = self.receiver.push(byte) {
                            self.reports.push(report.expect("a sound frame"));
                        }
                    }
                }
                // A process that was stopped and goes on is interrupted, too.
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                // QEMU has ended before it took all bytes.
                Err(error) if error.kind() == ErrorKind::ConnectionReset => return false,
                Err(error) => panic!("{error}"),
            }
        }
        true
    }

    /// Reads to the end; gives all reports, the count of missing ones, and the duration in s.
    pub fn finish(mut self) -> (Vec<Report>, u64, f64) {
        self.read_until(|_| false);
        let status = self.emulator.0.wait().expect("it was started");
        assert!(status.success(), "QEMU says {status}");
        assert_eq!(self.receiver.damaged(), 0);
        let took = self.began.elapsed().as_secs_f64();
        (
            std::mem::take(&mut self.reports),
            self.receiver.lost(),
            took,
        )
    }
}

/// The bytes of a command.
pub fn bytes(id: u16, command: antinode_telemetry::Command) -> Vec<u8> {
    let mut buffer = [0; MAX_FRAME];
    frame(&CommandFrame { id, command }, &mut buffer)
        .expect("it fits")
        .to_vec()
}
