//! The destination of rows: standard output, a device or a pipe as they come, or a file that gets its name once it is complete.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::options::Identify;
use crate::digits::counted;
use crate::failure::Failure;
use crate::stream_file;
use crate::tell::tell;
use crate::whole_file::WholeFile;

/// The unfinished file of the rows, if they go to a regular file.
#[derive(Clone)]
pub(super) struct Out {
    whole: Arc<Mutex<Option<WholeFile>>>,
}

impl Out {
    /// Opens the destination, and returns it with its writer.
    pub fn open(options: &Identify) -> Result<(Self, BufWriter<Box<dyn Write>>), Failure> {
        let out = |whole| Self {
            whole: Arc::new(Mutex::new(whole)),
        };
        let Some(path) = options.file() else {
            return Ok((out(None), BufWriter::new(Box::new(io::stdout().lock()))));
        };
        let (out, file, watched) = if stream_file::is_stream(path) {
            (out(None), stream_file::open(path)?, None)
        } else {
            let (whole, file) = WholeFile::create(path)?;
            let out = out(Some(whole));
            (out.clone(), file, Some(out))
        };
        let writer = UpToFault {
            file,
            name: path.display().to_string(),
            out: watched,
            fault: None,
        };
        Ok((out, BufWriter::new(Box::new(writer))))
    }

    /// Gives the complete file its name; a file without rows is dropped.
    pub fn finish(&self, rows: u64) -> Result<(), Failure> {
        let Some(whole) = self.lock().take() else {
            return Ok(());
        };
        let name = whole.name().to_owned();
        if rows == 0 {
            tell(format_args!("{name}: not written, as there are no rows"));
            return Ok(());
        }
        whole.finish()?;
        tell(format_args!("{name}: {}", counted(rows, "row")));
        Ok(())
    }

    /// Gives the file its name with the rows written so far. Nothing more is written while the returned guard is held.
    pub fn cut_short(&self) -> MutexGuard<'_, Option<WholeFile>> {
        let mut whole = self.lock();
        if let Some(whole) = whole.take() {
            let name = whole.name().to_owned();
            let any = whole.cut();
            match any.and_then(|any| any.then(|| whole.finish()).transpose()) {
                Ok(Some(())) => tell(format_args!(
                    "{name}: the rows up to this point are written"
                )),
                Ok(None) => tell(format_args!("{name}: not written, as there are no rows")),
                Err(fault) => tell(format_args!("error: {fault}")),
            }
        }
        whole
    }

    fn lock(&self) -> MutexGuard<'_, Option<WholeFile>> {
        self.whole.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A writer that repeats its first error for ever: what is still buffered would leave a hole behind what was written.
struct UpToFault {
    file: File,
    name: String,
    /// Locked while writing, so that nothing follows a file that was cut short; `None` for a stream, whose reader may block.
    out: Option<Out>,
    /// The first error.
    fault: Option<(io::ErrorKind, String)>,
}

impl Write for UpToFault {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _open = self.out.as_ref().map(Out::lock);
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
