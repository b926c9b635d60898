//! Serial ports, and advice if one does not open.

#[cfg(unix)]
use std::fs;
use std::io;
use std::path::Path;
use std::time::Duration;

use serialport::{ErrorKind, SerialPort, available_ports};

use crate::failure::Failure;

/// How long a read waits for a byte before it gives up for the time being.
const READ_TIMEOUT: Duration = Duration::from_millis(100);

/// True if a path can only be a port: a character device, or on Windows a name such as `COM3`, without a folder.
pub fn is_port(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        fs::metadata(path).is_ok_and(|metadata| metadata.file_type().is_char_device())
    }
    #[cfg(not(unix))]
    is_port_of_windows(&path.to_string_lossy())
}

/// True for `COM1` to `COM256`, and for any device by its full name.
#[cfg(any(not(unix), test))]
fn is_port_of_windows(name: &str) -> bool {
    let name = name.to_uppercase();
    let number = name.strip_prefix("COM").unwrap_or_default();
    let is_number = number.bytes().all(|byte| byte.is_ascii_digit());
    let is_numbered = is_number
        && number
            .parse()
            .is_ok_and(|number: u16| (1..=256).contains(&number));
    is_numbered || name.starts_with(r"\\.\")
}

/// Opens a port: 8 data bits, no parity, 1 stop bit, for this program alone.
pub fn open(path: &Path, baud: u32) -> Result<Box<dyn SerialPort>, Failure> {
    let name = path.display();
    // The library takes text alone: a link of a name that is none may lead to one that is.
    let target = match path.to_str() {
        None => path.canonicalize().unwrap_or_default(),
        Some(_) => path.to_owned(),
    };
    let error = match serialport::new(target.to_string_lossy(), baud)
        .timeout(READ_TIMEOUT)
        .open()
    {
        Ok(port) => return Ok(port),
        Err(error) => error,
    };
    // Windows ends its descriptions with a full stop.
    let told = error.description.trim_end_matches('.');
    let what = match error.kind {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => {
            "no permission to use it; on Linux join the group that owns it (dialout or uucp) and log in again".to_owned()
        }
        _ if cfg!(unix) && !path.exists() => format!("there is no such port; {}", ports()),
        _ if cfg!(unix) && !is_port(path) => format!("this is not a serial port; {}", ports()),
        _ if target.to_str().is_none() => {
            "its name is not UTF-8; give a link to it that has another name".to_owned()
        }
        ErrorKind::NoDevice => format!(
            "it does not open: {told}; close any other program that uses it; {}",
            ports()
        ),
        _ => format!(
            "it does not open at {baud} baud: {told}; check that it is a serial port, and --baud",
        ),
    };
    Err(Failure::Fault(format!("{name}: {what}")))
}

/// The failure of a port that worked before.
pub fn gone(name: &str, error: &io::Error) -> Failure {
    Failure::Fault(format!(
        "{name}: the port fails: {error}; check that the device is plugged in"
    ))
}

/// The advice to use one of this computer's ports, which it names.
pub fn ports() -> String {
    // Where there is no such folder, as in some containers, looking for ports would panic.
    let can_look = cfg!(not(target_os = "linux")) || Path::new("/sys/class/tty").is_dir();
    let ports = can_look.then(available_ports).and_then(Result::ok);
    let names: Vec<_> = ports
        .unwrap_or_default()
        .into_iter()
        .map(|port| port.port_name)
        .collect();
    if names.is_empty() {
        "this computer has no serial port now: plug the device in".to_owned()
    } else {
        format!("serial ports of this computer: {}", names.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_counts_ports_to_256() {
        for name in ["COM1", "com3", "COM10", "COM256", r"\\.\COM3"] {
            assert!(is_port_of_windows(name), "{name}");
        }
        for name in [
            "COM", "COM0", "COM257", "COM+3", "COM3.bin", "3", r".\COM3", "a.bin",
        ] {
            assert!(!is_port_of_windows(name), "{name}");
        }
    }
}
