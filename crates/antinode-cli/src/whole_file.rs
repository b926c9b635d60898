//! Files that get their name only once they are complete.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{PathPersistError, TempPath};

use crate::failure::{Failure, unwritable};

/// Longest line of a text that is written, bytes.
const MAX_LINE: u64 = 1 << 16;

/// A file under a temporary name in the directory of its final one; whatever has that name stays until the new file is complete.
pub struct WholeFile {
    file: String,
    target: PathBuf,
    /// Deleted when dropped, unless it is given its name.
    temporary: TempPath,
}

impl WholeFile {
    /// Begins a file, and gives the handle to write to it.
    pub fn create(path: &Path) -> Result<(Self, File), Failure> {
        let file = path.display().to_string();
        let error = |told: String| Failure::Fault(format!("{file}: {told}"));
        let there = fs::metadata(path).ok();
        let target = match &there {
            Some(there) if !there.is_file() => {
                return Err(error(
                    "this exists and is not a file; give the path of a file".to_owned(),
                ));
            }
            Some(there) if there.permissions().readonly() => {
                return Err(error(
                    "this file is read-only, and stays as it is; give another name, or make it writable"
                        .to_owned(),
                ));
            }
            Some(_) if is_held(path) => {
                return Err(error(
                    "another program has this file open; close it there, or give another name"
                        .to_owned(),
                ));
            }
            // A link is kept: the file that it leads to is replaced, or made.
            Some(_) => fs::canonicalize(path).map_err(|fault| unwritable(&file, &fault))?,
            None => match fs::read_link(path) {
                Ok(missing) => path.with_file_name(missing),
                Err(_) => path.to_owned(),
            },
        };
        let parent = target.parent().filter(|name| !name.as_os_str().is_empty());
        let directory = parent.unwrap_or(Path::new("."));
        if !directory.is_dir() {
            let directory = directory.display();
            return Err(error(format!(
                "there is no directory `{directory}`; make it first, or correct the path"
            )));
        }
        // From its root, with the mark without which Windows gives no file a path of more than 260 characters.
        let directory = fs::canonicalize(directory).unwrap_or_else(|_| directory.to_owned());
        let target = directory.join(target.file_name().unwrap_or_default());
        let mut builder = tempfile::Builder::new();
        // Encoders choose the format by the extension.
        let ending = target.extension().map_or(String::new(), |ending| {
            format!(".{}", ending.to_string_lossy())
        });
        let suffix = format!(".tmp{ending}");
        builder.prefix(".antinode-").suffix(&suffix);
        // The permissions of an ordinary new file: temporary files are private by default.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // The temporary name would tell the user nothing.
        let plain = |fault: io::Error| unwritable(&file, &fault.kind().into());
        let (output, temporary) = builder.tempfile_in(&directory).map_err(plain)?.into_parts();
        // Set while the file is empty, as others may not be allowed to read its content.
        if let Some(there) = there {
            output.set_permissions(there.permissions()).map_err(plain)?;
        }
        let whole = Self {
            file,
            target,
            temporary,
        };
        Ok((whole, output))
    }

    /// Writes a file of these bytes, still without its name.
    pub fn of(path: &Path, bytes: &[u8]) -> Result<Self, Failure> {
        let (whole, mut output) = Self::create(path)?;
        match output.write_all(bytes) {
            Ok(()) => Ok(whole),
            Err(fault) => Err(unwritable(&whole.file, &fault)),
        }
    }

    /// Gives the file its name, or keeps it under its temporary one if it cannot have it; dropped without this, it leaves nothing behind.
    pub fn finish(self) -> Result<(), Failure> {
        let Self {
            file,
            target,
            temporary,
        } = self;
        // It must be on the disk before it replaces a file that may be good.
        let synced = File::options().write(true).open(&temporary);
        synced
            .and_then(|output| output.sync_all())
            .map_err(|fault| unwritable(&file, &fault))?;
        let Err(PathPersistError { error, path }) = temporary.persist(target) else {
            return Ok(());
        };
        // The file is kept: it may be the work of hours.
        Err(match path.keep() {
            Ok(kept) => {
                let kept = kept.file_name().unwrap_or_default().display().to_string();
                Failure::Fault(format!(
                    "{file}: cannot be given this name: {error}; the complete data are beside it in `{kept}`: check what is at this path, and \
                     whether another program has it open, then rename them"
                ))
            }
            Err(_) => unwritable(&file, &error),
        })
    }

    /// Cuts off an unfinished last line, as a full disk leaves one; false if no line is whole.
    pub fn cut(&self) -> Result<bool, Failure> {
        self.cut_to_lines()
            .map_err(|fault| unwritable(&self.file, &fault))
    }

    fn cut_to_lines(&self) -> io::Result<bool> {
        let mut output = File::options()
            .read(true)
            .write(true)
            .open(&self.temporary)?;
        let from = output.metadata()?.len().saturating_sub(MAX_LINE);
        output.seek(SeekFrom::Start(from))?;
        let mut last = Vec::new();
        output.read_to_end(&mut last)?;
        let Some(end) = last.iter().rposition(|&byte| byte == b'\n') else {
            return Ok(false);
        };
        output.set_len(from + end as u64 + 1)?;
        Ok(true)
    }

    /// The temporary path of the file.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// The path, as it was given.
    pub fn name(&self) -> &str {
        &self.file
    }
}

/// True if another program has the file open and does not let it be replaced, which happens on Windows only.
#[cfg(windows)]
fn is_held(path: &Path) -> bool {
    use std::os::windows::fs::OpenOptionsExt;
    /// The right to delete a file, which it takes to replace it.
    const DELETE: u32 = 0x0001_0000;
    /// The error code where another program does not share this right.
    const SHARING_VIOLATION: i32 = 32;
    let opened = File::options().access_mode(DELETE).open(path);
    opened.is_err_and(|fault| fault.raw_os_error() == Some(SHARING_VIOLATION))
}

#[cfg(not(windows))]
fn is_held(_: &Path) -> bool {
    false
}
