//! `antinode plot`: rows in, a figure of the ring-down out.

mod axis;
mod draw;
mod extent;
mod figure;
mod legend;
mod numbers;
mod panel;
mod reduce;
mod rows;
mod values;

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use crate::canvas;
use crate::digits::counted;
use crate::failure::{Failure, unwritable};
use crate::given_rows::{GivenRows, none_within};
use crate::whole_file::WholeFile;
use draw::Format;
use figure::figure;
use rows::Trust;

/// `antinode plot`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Plot {
    #[command(flatten)]
    pub given: GivenRows,
    /// The figure to write: .svg or .png.
    #[arg(short = 'o', long, value_name = "FILE")]
    pub out: PathBuf,
    /// Logarithmic axes for main amplitude, quadrature amplitude without its sign, and residual, as for a long ring-down.
    #[arg(long)]
    pub log: bool,
}

/// Draws the rows.
pub fn run(options: &Plot) -> Result<(), Failure> {
    let times = options.given.times()?;
    let format = Format::of(&options.out)?;
    // Whether the file can be written is checked before the rows are read, which may take long from a pipe.
    drop(WholeFile::create(&options.out)?);
    let (mut traces, inputs) = rows::open(&options.given.rows)?;
    let span = rows::span(&traces);
    rows::retain(&mut traces, &times);
    let rows = || traces.iter().flat_map(|trace| &trace.rows);
    let count = rows().count();
    let Some(figure) = figure(&traces, draw::COLUMNS, options.log) else {
        return Err(match (count, span) {
            (0, Some(span)) => none_within(&inputs, span),
            (0, None) => Failure::Fault(format!(
                "{inputs}: there are no rows; identify a longer recording"
            )),
            _ => Failure::Fault(format!(
                "{inputs}: none of {count} rows has a wave; see their flags"
            )),
        });
    };
    let (whole, mut file) = WholeFile::create(&options.out)?;
    let names: Vec<_> = traces.iter().map(|trace| trace.name.as_str()).collect();
    let written = match format {
        Format::Svg => draw::svg(&figure, &names)
            .map_err(|error| io::Error::other(error.to_string()))
            .and_then(|text| file.write_all(text.as_bytes())),
        Format::Png => {
            draw::png(whole.temporary(), &figure, &names).map_err(|_| canvas::not_stored())
        }
    };
    written.map_err(|fault| unwritable(whole.name(), &fault))?;
    whole.finish()?;
    let flagged = rows().filter(|row| row.trust != Trust::Clean).count();
    writeln!(
        io::stdout(),
        "{}: {} of {}; {flagged} flagged",
        options.out.display(),
        counted(count as u64, "row"),
        match names.as_slice() {
            [name] => (*name).to_owned(),
            names => format!("{} recordings", names.len()),
        }
    )?;
    Ok(())
}
