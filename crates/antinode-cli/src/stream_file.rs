//! Files that are streams: devices, pipes and inherited descriptors, to which is written as it comes.

use std::fs::{self, File};
use std::path::Path;

use crate::failure::{Failure, unwritable};

/// True for a device, a pipe, or an inherited descriptor: for what no finished file can replace.
pub fn is_stream(path: &Path) -> bool {
    let is_given = ["/dev/stderr", "/dev/fd", "/proc"]
        .iter()
        .any(|given| path.starts_with(given));
    is_given
        || cfg!(windows) && is_device_of_windows(path)
        || fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// True for names of Windows devices, which are the same in every directory.
fn is_device_of_windows(path: &Path) -> bool {
    let names = ["NUL", "CON", r"\\.\NUL", r"\\.\CON"];
    names
        .iter()
        .any(|name| path.as_os_str().eq_ignore_ascii_case(name))
}

/// Opens a device or a pipe, behind its present contents.
pub fn open(path: &Path) -> Result<File, Failure> {
    // The console of Windows cannot be appended to.
    let file = if cfg!(windows) {
        File::options().write(true).open(path)
    } else {
        File::options().append(true).open(path)
    };
    file.map_err(|fault| unwritable(&path.display().to_string(), &fault))
}
