//! Serial ports, and what to do where one does not open.

#[cfg(unix)]
use std::fs;
use std::io;
use std::path::Path;
use std::time::Duration;

use serialport::{ErrorKind, SerialPort, available_ports};

use crate::failure::Failure;

/// How long a read waits for a byte before it looks around.
const PATIENCE: Duration = Duration::from_millis(100);

/// True where a path can only be a port: a character device, or on Windows a name such as `COM3`, which is in no folder.
pub fn is_port(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        fs::metadata(path).is_ok_and(|metadata| metadata.file_type().is_char_device())
    }
    #[cfg(not(unix))]
    {
        let name = path.to_string_lossy().to_uppercase();
        name.starts_with(r"\\.\")
            || name
                .strip_prefix("COM")
                .is_some_and(|number| number.parse::<u8>().is_ok())
    }
}

/// Opens a port: 8 data bits, no parity, 1 stop bit, for this program alone.
pub fn open(path: &Path, baud: u32) -> Result<Box<dyn SerialPort>, Failure> {
    let name = path.display();
    let error = match serialport::new(path.to_string_lossy(), baud)
        .timeout(PATIENCE)
        .open()
    {
        Ok(port) => return Ok(port),
        Err(error) => error,
    };
    // Windows ends it as a sentence.
    let told = error.description.trim_end_matches('.');
    let what = match error.kind {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => {
            "no permission to use it; on Linux join the group that owns it (dialout or uucp) and log in again".to_owned()
        }
        _ if cfg!(unix) && !path.exists() => format!("there is no such port; {}", ports()),
        _ if cfg!(unix) && !is_port(path) => format!("this is no serial port; {}", ports()),
        ErrorKind::NoDevice => format!(
            "it does not open: {told}; end any other program that holds it, or else: {}",
            ports()
        ),
        _ => format!(
            "it does not open at {baud} baud: {told}; check that it is a serial port, and --baud",
        ),
    };
    Err(Failure::Recording(format!("{name}: {what}")))
}

/// The ports of this computer, as a remedy.
pub fn ports() -> String {
    let names: Vec<_> = available_ports()
        .unwrap_or_default()
        .into_iter()
        .map(|port| port.port_name)
        .collect();
    if names.is_empty() {
        "plug the device in: this computer has no serial port now".to_owned()
    } else {
        format!("this computer has: {}", names.join(", "))
    }
}
