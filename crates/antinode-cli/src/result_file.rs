//! Where a result goes: standard output, a stream, or a file that gets its name once it is complete.

use std::io::{self, Write};
use std::path::{self, Path, PathBuf};

use clap::Args;

use crate::failure::{Failure, unwritable};
use crate::options::Format;
use crate::recording::place;
use crate::stream_file;
use crate::whole_file::WholeFile;

/// The file that a result is written to, if any.
#[derive(Debug, Args)]
pub struct ResultFile {
    /// Write to this file instead of standard output, `-`: CSV if it ends in .csv, JSON lines if in .jsonl, unless --output says otherwise.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

impl ResultFile {
    /// The file; `None` for standard output.
    pub fn file(&self) -> Option<&Path> {
        file_of(self.out.as_deref())
    }

    /// The format that its name asks for: a table if it has none.
    pub fn format(&self) -> Result<Format, Failure> {
        format_of(self.out.as_deref())
    }

    /// Rejects a file that is one of those to be read, or that cannot be written: reading may take long.
    pub fn check(&self, rows: &[PathBuf]) -> Result<(), Failure> {
        self.file()
            .map_or(Ok(()), |path| check("--out", path, rows))
    }

    /// Writes the result.
    pub fn write(&self, result: &[u8]) -> Result<(), Failure> {
        let Some(path) = self.file() else {
            io::stdout().lock().write_all(result)?;
            return Ok(());
        };
        write(path, result)
    }
}

/// Writes a file of these bytes, at once or, if it is no stream, under its name once it is complete.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if stream_file::is_stream(path) {
        let written = stream_file::open(path)?.write_all(bytes);
        return written.map_err(|fault| unwritable(&path.display().to_string(), &fault));
    }
    WholeFile::of(path, bytes)?.finish()
}

/// The file that is asked for; `None` for standard output.
pub fn file_of(out: Option<&Path>) -> Option<&Path> {
    let is_standard = |out: &&Path| ["-", "/dev/stdout"].map(Path::new).contains(out);
    out.filter(|out| !is_standard(out))
}

/// Rejects a file for the residual that is also the one of the result.
pub fn check_residual(residual: &Path, out: Option<&Path>) -> Result<(), Failure> {
    let full = |path: &Path| path::absolute(path).ok();
    if out.is_some_and(|out| full(out) == full(residual)) {
        return Err(Failure::Usage(
            "--residual and --out are the same file; give one of them another name".to_owned(),
        ));
    }
    Ok(())
}

/// Rejects a file to be written, which an option names, if it is one of those to be read; `what` says what these are.
pub fn check_is_no_input(
    option: &str,
    path: &Path,
    inputs: &[PathBuf],
    what: &str,
) -> Result<(), Failure> {
    let there = place(path);
    let mut inputs = inputs.iter().map(|input| place(input));
    if there.is_some() && inputs.any(|input| input == there) {
        return Err(Failure::Usage(format!(
            "{option}: {} {what} to be read; give the result another name",
            path.display()
        )));
    }
    Ok(())
}

/// Rejects a file to be written, which an option names, if it is one of those of rows to be read or cannot be written.
pub fn check(option: &str, path: &Path, rows: &[PathBuf]) -> Result<(), Failure> {
    check_is_no_input(option, path, rows, "has rows")?;
    if stream_file::is_stream(path) {
        return stream_file::open(path).map(drop);
    }
    WholeFile::create(path).map(drop)
}

/// The format of what is written to a file, by the ending of its name: a table if there is none.
pub fn format_of(out: Option<&Path>) -> Result<Format, Failure> {
    let ending = out.and_then(|out| out.extension());
    let ending = ending.map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("csv") => Ok(Format::Csv),
        Some("jsonl" | "ndjson" | "json") => Ok(Format::Jsonl),
        None | Some("txt") => Ok(Format::Table),
        Some(other) => Err(Failure::Usage(format!(
            "--out: .{other} is not a format of rows; end the name in .csv, .jsonl or .txt, or give --output"
        ))),
    }
}
