//! Files that take their name only once they are whole.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::OutputError;

/// A file under a temporary name beside the one it will have; whatever is there stays until then.
pub struct WholeFile {
    file: String,
    target: PathBuf,
    /// Deleted unless it is given its name.
    temporary: TempPath,
}

impl WholeFile {
    /// Begins a file, and gives what writes to it.
    pub fn create(path: &Path) -> Result<(Self, File), OutputError> {
        let file = path.display().to_string();
        let target = match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() => return Err(OutputError::NotAFile { file }),
            // A link keeps leading to the file it leads to.
            Ok(_) => fs::canonicalize(path).map_err(|fault| OutputError::io(&file, fault))?,
            Err(_) => path.to_owned(),
        };
        let parent = target.parent().filter(|name| !name.as_os_str().is_empty());
        let directory = parent.unwrap_or(Path::new("."));
        if !directory.is_dir() {
            let directory = directory.display().to_string();
            return Err(OutputError::NoDirectory { file, directory });
        }
        let mut builder = tempfile::Builder::new();
        // Encoders tell the format by the ending.
        let ending = target.extension().map_or(String::new(), |ending| {
            format!(".{}", ending.to_string_lossy())
        });
        let suffix = format!(".tmp{ending}");
        builder.prefix(".antinode-").suffix(&suffix);
        // The permissions of any new file, not those of a secret one.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        // The temporary name would tell the user nothing.
        let plain = |fault: io::Error| OutputError::io(&file, fault.kind().into());
        let (output, temporary) = builder.tempfile_in(directory).map_err(plain)?.into_parts();
        let whole = Self {
            file,
            target,
            temporary,
        };
        Ok((whole, output))
    }

    /// A file of this text, whole but without its name yet.
    pub fn text(path: &Path, text: &str) -> Result<Self, OutputError> {
        let (whole, mut output) = Self::create(path)?;
        match output.write_all(text.as_bytes()) {
            Ok(()) => Ok(whole),
            Err(fault) => Err(OutputError::io(&whole.file, fault)),
        }
    }

    /// Gives the file its name; dropped without this, it leaves nothing behind.
    pub fn finish(self) -> Result<(), OutputError> {
        let Self {
            file,
            target,
            temporary,
        } = self;
        // On the disk before it replaces what may be a good file.
        let synced = File::options().write(true).open(&temporary);
        synced
            .and_then(|output| output.sync_all())
            .and_then(|()| temporary.persist(target).map_err(|fault| fault.error))
            .map_err(|fault| OutputError::io(&file, fault))
    }

    /// Where it is until then.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// The path, as it was given.
    pub fn name(&self) -> &str {
        &self.file
    }
}
