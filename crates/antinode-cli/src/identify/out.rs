//! Where rows go: standard output, a device or a pipe as they come, or a file that takes its name once they are all there.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::options::Identify;
use crate::failure::Failure;
use crate::recording::{OutputError, WholeFile};

/// The file of the rows, if they go to one.
pub(super) struct Out {
    whole: Option<WholeFile>,
}

impl Out {
    /// Begins it, and gives what writes to it.
    pub fn open(options: &Identify) -> Result<(Self, BufWriter<Box<dyn Write>>), Failure> {
        let (whole, to): (_, Box<dyn Write>) = match options.file() {
            None => (None, Box::new(io::stdout().lock())),
            Some(path) => {
                let (whole, file) = if is_stream(path) {
                    (None, stream(path)?)
                } else {
                    let (whole, file) = WholeFile::create(path)?;
                    (Some(whole), file)
                };
                let name = path.display().to_string();
                (whole, Box::new(UpToFault::new(file, name)))
            }
        };
        Ok((Self { whole }, BufWriter::new(to)))
    }

    /// Gives the file of so many rows its name; of one that is cut, up to the last row that is whole.
    pub fn finish(self, rows: u64, is_cut: bool) -> Result<(), Failure> {
        let Some(whole) = self.whole else {
            return Ok(());
        };
        let name = whole.name().to_owned();
        if rows == 0 || is_cut && !whole.cut()? {
            eprintln!("{name}: not written, for there is no row");
            return Ok(());
        }
        whole.finish()?;
        match rows {
            _ if is_cut => eprintln!("{name}: the rows up to there are written"),
            1 => eprintln!("{name}: 1 row"),
            _ => eprintln!("{name}: {rows} rows"),
        }
        Ok(())
    }
}

/// Refuses a recording that is to be read.
pub(super) fn check_other(options: &Identify) -> Result<(), Failure> {
    if let Some(Ok(path)) = options.file().map(fs::canonicalize)
        && let mut files = options.files.iter().flat_map(fs::canonicalize)
        && files.any(|file| file == path)
    {
        return Err(Failure::Usage(format!(
            "--out: {} is a recording to be read; give the rows another name",
            path.display()
        )));
    }
    Ok(())
}

/// True for a device, a pipe, and what the command was given open: what there is no other file to take the place of.
fn is_stream(path: &Path) -> bool {
    let is_given = ["/dev/stderr", "/dev/fd", "/proc"]
        .iter()
        .any(|given| path.starts_with(given));
    is_given || fs::metadata(path).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Opens it behind what is in it already.
fn stream(path: &Path) -> Result<File, OutputError> {
    let file = File::options().append(true).open(path);
    file.map_err(|fault| OutputError::io(&path.display().to_string(), fault))
}

/// Writes until that fails, and nothing any more then: what is buffered would not follow what is there.
struct UpToFault {
    file: File,
    name: String,
    /// What the system said then.
    fault: Option<(io::ErrorKind, String)>,
}

impl UpToFault {
    fn new(file: File, name: String) -> Self {
        Self {
            file,
            name,
            fault: None,
        }
    }
}

impl Write for UpToFault {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (kind, told) = match &self.fault {
            Some(fault) => fault.clone(),
            None => match self.file.write(bytes) {
                Err(fault) if fault.kind() != io::ErrorKind::Interrupted => {
                    let told = format!("{}: {fault}", self.name);
                    self.fault.insert((fault.kind(), told)).clone()
                }
                written => return written,
            },
        };
        Err(io::Error::new(kind, told))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
