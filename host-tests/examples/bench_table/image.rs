//! The bench images: building, size, and a run in the emulator.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

use object::read::{Object, ObjectSegment};

const TARGET: &str = "thumbv7em-none-eabihf";
/// Profile of the kernels, which need none of a board's packages.
const PROFILE: &str = "release";
/// The whole instrument, which needs them, and the profile in which it is flashed.
const WHOLE: &str = "application";
const WHOLE_PROFILE: &str = "firmware";
/// An emulated Cortex-M4 whose clock is that of its instructions, as the images' report expects.
const EMULATOR: &str = "qemu-system-arm";
const BOARD: &[&str] = &[
    "-M",
    "netduinoplus2",
    // The instrument's reports go to the serial line, which is not read here.
    "-display",
    "none",
    "-serial",
    "null",
    "-monitor",
    "none",
    "-semihosting-config",
    "enable=on,target=native",
    "-icount",
    "shift=0,align=off,sleep=off",
    "-kernel",
];
/// Longest run of an image.
const TIMEOUT: Duration = Duration::from_secs(60);

/// A built image.
pub struct Image {
    /// Name without `bench_`.
    pub kernel: String,
    elf: PathBuf,
}

/// Report of an image.
pub struct Report {
    pub instructions: u32,
    pub units: u32,
    pub state: u32,
    pub stack: u32,
}

/// Builds every image whose source is `firmware/src/bin/bench_*.rs`.
pub fn build(root: &Path) -> Result<Vec<Image>, String> {
    let folder = root.join("firmware/src/bin");
    let entries =
        fs::read_dir(&folder).map_err(|fault| format!("{}: {fault}", folder.display()))?;
    let mut kernels: Vec<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter_map(|name| Some(name.strip_prefix("bench_")?.strip_suffix(".rs")?.into()))
        .collect();
    kernels.sort();
    let output = env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let output = std::path::absolute(output).map_err(|fault| fault.to_string())?;
    for profile in [PROFILE, WHOLE_PROFILE] {
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
        cargo
            .current_dir(root)
            .args(["build", "--quiet", "-p", "firmware", "--profile", profile])
            .args(["--target", TARGET, "--target-dir"])
            .arg(&output);
        if profile == PROFILE {
            cargo.arg("--no-default-features");
        }
        for kernel in kernels
            .iter()
            .filter(|kernel| profile_of(kernel) == profile)
        {
            cargo.args(["--bin", &format!("bench_{kernel}")]);
        }
        let built = cargo.status().map_err(|fault| format!("cargo: {fault}"))?;
        if !built.success() {
            return Err(format!(
                "the images did not build; .ci/arm-target {TARGET} gets the target if that is what is missing"
            ));
        }
    }
    let folder = output.join(TARGET);
    Ok(kernels
        .into_iter()
        .map(|kernel| Image {
            elf: folder
                .join(profile_of(&kernel))
                .join(format!("bench_{kernel}")),
            kernel,
        })
        .collect())
}

fn profile_of(kernel: &str) -> &'static str {
    if kernel == WHOLE {
        WHOLE_PROFILE
    } else {
        PROFILE
    }
}

impl Image {
    fn fault(&self, fault: impl std::fmt::Display) -> String {
        format!("bench_{}: {fault}", self.kernel)
    }

    /// Bytes that are loaded into flash: code, constants, and initial values of variables.
    pub fn flash(&self) -> Result<u32, String> {
        let bytes = fs::read(&self.elf).map_err(|fault| self.fault(fault))?;
        let elf = object::File::parse(&*bytes).map_err(|fault| self.fault(fault))?;
        Ok(elf
            .segments()
            .map(|segment| segment.file_range().1 as u32)
            .sum())
    }

    /// Runs the image to its end in the emulator.
    pub fn run(&self) -> Result<Report, String> {
        let mut emulator = Command::new(EMULATOR)
            .args(BOARD)
            .arg(&self.elf)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|fault| format!("{EMULATOR}: {fault}; is it installed?"))?;
        let began = Instant::now();
        while emulator
            .try_wait()
            .map_err(|fault| self.fault(fault))?
            .is_none()
        {
            if began.elapsed() > TIMEOUT {
                let _ = emulator.kill();
                return Err(self.fault("it does not come to its end"));
            }
            thread::sleep(Duration::from_millis(5));
        }
        let output = emulator
            .wait_with_output()
            .map_err(|fault| self.fault(fault))?;
        let text = String::from_utf8_lossy(&output.stdout);
        self.report(&text)
            .ok_or_else(|| self.fault(format!("no report in the {} bytes it printed", text.len())))
    }

    /// `bench_NAME instructions=… units=… state=… stack=…`
    fn report(&self, text: &str) -> Option<Report> {
        let line = text
            .lines()
            .find_map(|line| line.strip_prefix("bench_")?.strip_prefix(&self.kernel))?;
        let field = |name: &str| {
            line.split(' ')
                .find_map(|field| field.split_once('=').filter(|&(key, _)| key == name))
                .and_then(|(_, number)| number.parse().ok())
        };
        Some(Report {
            instructions: field("instructions")?,
            units: field("units")?,
            state: field("state")?,
            stack: field("stack")?,
        })
    }

    /// Cycles per unit, if there is an estimator.
    pub fn cycles(&self, units: u32) -> Result<Option<f64>, String> {
        let Some(estimator) = env::var_os("ANTINODE_CYCLES").filter(|name| !name.is_empty()) else {
            return Ok(None);
        };
        // These images find the longest call by the emulator's clock, which an estimator need not have.
        if self.kernel.starts_with("longest") {
            return Ok(None);
        }
        let arguments: [OsString; 4] = [
            self.elf.clone().into(),
            "--units".into(),
            units.to_string().into(),
            "--json".into(),
        ];
        let output = Command::new(&estimator)
            .args(arguments)
            .stderr(Stdio::inherit())
            .output()
            .map_err(|fault| format!("{}: {fault}", estimator.display()))?;
        let cycles = serde_json::from_slice::<serde_json::Value>(&output.stdout)
            .ok()
            .and_then(|object| object.get("cycles")?.as_f64());
        match cycles {
            Some(cycles) if output.status.success() => Ok(Some(cycles)),
            _ => Err(self.fault(format!("{} gave no cycles", estimator.display()))),
        }
    }
}
