//! `firmware/run`, which flashes a board, with fake tools that only print how they are called.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder with these tools, each of which prints its name and arguments; the one called `fails` fails.
fn tools(name: &str, tools: &[&str], fails: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("it can be written");
    for tool in tools {
        let status = u8::from(*tool == fails);
        let script = format!("#!/bin/sh\necho {tool} \"$@\"\nexit {status}\n");
        fs::write(folder.join(tool), script).expect("it can be written");
        let mode = fs::Permissions::from_mode(0o755);
        fs::set_permissions(folder.join(tool), mode).expect("it can be made a program");
    }
    folder
}

/// Runs `firmware/run /x/stm32f405` with no other tools than these and those that bash itself needs.
fn run(folder: &Path, serial: Option<&str>) -> Output {
    for tool in ["bash", "basename"] {
        let found = ["/bin", "/usr/bin"].map(|bin| Path::new(bin).join(tool));
        let found = found
            .iter()
            .find(|path| path.exists())
            .expect("bash is there");
        std::os::unix::fs::symlink(found, folder.join(tool)).expect("it can be linked");
    }
    let mut command = Command::new(folder.join("bash"));
    command
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/run"))
        .args(["/x/stm32f405", "--connect-under-reset"])
        .env("PATH", folder)
        .env_remove("SERIAL");
    if let Some(serial) = serial {
        command.env("SERIAL", serial);
    }
    command.output().expect("bash runs")
}

fn texts(output: &Output) -> [String; 2] {
    [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned())
}

#[test]
fn a_probe_flashes_and_gets_the_chips_name() {
    let output = run(&tools("probe", &["probe-rs"], ""), None);
    let [told, _] = texts(&output);
    assert!(output.status.success());
    assert_eq!(
        told,
        "probe-rs run --chip STM32F405RGTx /x/stm32f405 --connect-under-reset\n"
    );
    // A probe that would halt at a reset is told not to.
    let folder = tools("newer", &["probe-rs"], "");
    let script = "#!/bin/sh\n[ \"$*\" != 'run --help' ] || { echo ' --no-catch-reset'; exit; }\necho \"$@\"\n";
    fs::write(folder.join("probe-rs"), script).expect("it can be written");
    let [told, _] = texts(&run(&folder, None));
    assert_eq!(
        told,
        "run --chip STM32F405RGTx --no-catch-reset /x/stm32f405 --connect-under-reset\n"
    );
}

#[test]
fn without_a_probe_the_alternatives_are_printed() {
    let output = run(&tools("nothing", &[], ""), None);
    let [_, error] = texts(&output);
    assert!(!output.status.success());
    assert!(
        error.contains("probe-rs is not installed") && error.contains("SERIAL"),
        "{error}"
    );
}

#[test]
fn the_boot_loader_flashes_over_the_serial_line() {
    let names = ["stm32flash", "llvm-objcopy"];
    let output = run(&tools("line", &names, ""), Some("/dev/ttyUSB7"));
    let [told, error] = texts(&output);
    assert!(output.status.success(), "{error}");
    assert_eq!(
        told,
        "llvm-objcopy -O binary /x/stm32f405 /x/stm32f405.bin\nstm32flash -w /x/stm32f405.bin -v /dev/ttyUSB7\n"
    );
    assert!(error.contains("BOOT0 to ground"), "{error}");
}

#[test]
fn a_boot_loader_that_does_not_answer_is_explained() {
    let names = ["stm32flash", "arm-none-eabi-objcopy"];
    let folder = tools("silent", &names, "stm32flash");
    let output = run(&folder, Some("/dev/ttyUSB7"));
    let [_, error] = texts(&output);
    assert!(!output.status.success());
    assert!(error.contains("BOOT0 at 3.3 V"), "{error}");
    // Nor does it try without a tool that it needs.
    let output = run(&tools("bare", &["stm32flash"], ""), Some("/dev/ttyUSB7"));
    assert!(texts(&output)[1].contains("objcopy is not installed"));
}
