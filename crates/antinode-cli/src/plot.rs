//! `antinode plot`: rows in, a figure of the ring-down out.

mod draw;
mod figure;
mod legend;
mod reduce;
mod rows;
mod scale;

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use crate::failure::Failure;
use crate::recording::{OutputError, WholeFile};
use draw::Format;
use figure::figure;
use rows::Trust;

/// `antinode plot`.
#[derive(Debug, Args)]
pub struct Plot {
    /// Rows that `antinode identify` or `antinode monitor` printed with --output csv; `-` is standard input.
    #[arg(required = true, value_name = "ROWS")]
    pub rows: Vec<PathBuf>,
    /// The figure to write: .svg or .png.
    #[arg(short = 'o', long = "to", value_name = "FILE")]
    pub to: PathBuf,
}

/// Draws the rows.
pub fn run(options: &Plot) -> Result<(), Failure> {
    let format = Format::of(&options.to)?;
    // What cannot be written is found before the rows are read, which may come through a pipe for long.
    drop(WholeFile::create(&options.to)?);
    let (traces, inputs) = rows::open(&options.rows)?;
    let rows = || traces.iter().flat_map(|trace| &trace.rows);
    let count = rows().count();
    let Some(figure) = figure(&traces, draw::COLUMNS) else {
        return Err(Failure::Recording(if count == 0 {
            format!("{inputs}: there is no row; identify a recording of more windows")
        } else {
            format!("{inputs}: not one of {count} rows has a wave; see their flags")
        }));
    };
    let (whole, mut file) = WholeFile::create(&options.to)?;
    let names: Vec<_> = traces.iter().map(|trace| trace.name.as_str()).collect();
    let written = match format {
        Format::Svg => draw::svg(&figure, &names).map(|text| file.write_all(text.as_bytes())),
        Format::Png => draw::png(whole.temporary(), &figure, &names).map(Ok),
    };
    written
        .unwrap_or_else(|error| Err(io::Error::other(error.to_string())))
        .map_err(|fault| OutputError::io(whole.name(), fault))?;
    whole.finish()?;
    let flagged = rows().filter(|row| row.trust != Trust::Clean).count();
    writeln!(
        io::stdout(),
        "{}: {count} {} of {}; {flagged} flagged",
        options.to.display(),
        if count == 1 { "row" } else { "rows" },
        match names.as_slice() {
            [name] => (*name).to_owned(),
            names => format!("{} recordings", names.len()),
        }
    )?;
    Ok(())
}
