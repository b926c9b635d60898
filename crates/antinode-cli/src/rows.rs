//! Estimates as rows: a table to read, CSV, or JSON lines.

use std::io::{self, Write};

use antinode::Estimate;
use serde::Serialize;

use crate::digits::{decimals_of_times, exponent, fixed, heading, significant, with_std};
use crate::methods::rows::{self as of_methods, Columns};
use crate::methods::{Methods, table as method_table};
use crate::options::Format;

/// The heading of a table's first quantity, which no other format has.
pub const MAIN_AMPLITUDE: &str = "main amplitude";

/// Width of the times in a table, unless they have many decimals.
const MIN_TIME_WIDTH: usize = 10;

/// One row of CSV or JSON lines; the names are the columns.
#[derive(Debug, Serialize)]
struct Row<'a> {
    time_s: f64,
    samples: u32,
    main_amplitude: f32,
    quadrature_amplitude: f32,
    angle_rad: f64,
    phase_rad: f32,
    frequency_hz: f64,
    angle_rate_rad_s: f32,
    decay_rate_s: f32,
    main_amplitude_std: f32,
    quadrature_amplitude_std: f32,
    angle_std_rad: f32,
    frequency_std_hz: f32,
    residual_rms: f32,
    flags: &'a str,
    offset_c: f32,
    offset_d: f32,
    phase_std_rad: f32,
    angle_rate_std_rad_s: f32,
    decay_rate_std_s: f32,
    file: &'a str,
}

impl<'a> Row<'a> {
    fn new(file: &'a str, flags: &'a str, e: &Estimate) -> Self {
        // Nine decimals of an angle are finer than any bound, and twelve of a time finer than any clock: more would mean nothing, unless a
        // period is so short that the phase needs them.
        let to = |x: f64, unit: f64| (x * unit).round() / unit;
        let finest = 1e12f64.max(10f64.powf(exponent(e.frequency) + 6.0));
        let finest = finest.min(1e18);
        let mut time = to(e.time, finest);
        // A double always holds fifteen digits; a time in s since 1970 needs the few that it may hold beyond them.
        if time.abs() < 1e4 {
            time = significant(time, 15);
        }
        Self {
            time_s: time,
            samples: e.samples,
            main_amplitude: e.main_amplitude,
            quadrature_amplitude: e.quadrature_amplitude,
            angle_rad: to(e.angle, 1e9),
            phase_rad: e.phase,
            // Significant digits, not decimals: the sample rate may be 1 mHz or 1 THz.
            frequency_hz: significant(e.frequency, 13),
            angle_rate_rad_s: e.angle_rate,
            decay_rate_s: e.decay_rate,
            main_amplitude_std: e.main_amplitude_std,
            quadrature_amplitude_std: e.quadrature_amplitude_std,
            angle_std_rad: e.angle_std,
            frequency_std_hz: e.frequency_std,
            residual_rms: e.residual_rms,
            flags,
            offset_c: e.offsets[0],
            offset_d: e.offsets[1],
            phase_std_rad: e.phase_std,
            angle_rate_std_rad_s: e.angle_rate_std,
            decay_rate_std_s: e.decay_rate_std,
            file,
        }
    }
}

/// A row of JSON lines, with the methods' columns after its own where they were asked for.
#[derive(Serialize)]
struct Object<'a> {
    #[serde(flatten)]
    row: Row<'a>,
    #[serde(flatten)]
    methods: Option<Columns<'a>>,
}

/// Where rows go.
enum Sink<W: Write> {
    Table(W),
    Csv(Box<csv::Writer<W>>),
    Jsonl(W),
}

/// Prints estimates to a stream.
pub struct Rows<W: Write> {
    sink: Sink<W>,
    /// Rows printed of the present recording, and of all those before.
    count: u64,
    before: u64,
    /// True if each row has the methods' columns too.
    wide: bool,
    /// The line above the next table, if it is not yet written.
    title: Option<String>,
    /// Decimals of the times in a table.
    decimals: usize,
}

impl<W: Write> Rows<W> {
    /// Prints rows to `out` in this format; `wide` ones have the methods' columns too.
    pub fn new(out: W, format: Format, wide: bool) -> Self {
        let sink = match format {
            Format::Table => Sink::Table(out),
            // The CSV writer cannot make the header of nested rows: it is written by hand.
            Format::Csv => Sink::Csv(Box::new(
                csv::WriterBuilder::new()
                    .has_headers(!wide)
                    .from_writer(out),
            )),
            Format::Jsonl => Sink::Jsonl(out),
        };
        Self {
            sink,
            count: 0,
            before: 0,
            title: None,
            decimals: 6,
            wide,
        }
    }

    /// Begins a recording of this sample rate; `title` stands above its table.
    pub fn begin(&mut self, title: Option<String>, rate: f64) {
        self.before += std::mem::take(&mut self.count);
        self.title = title;
        self.decimals = decimals_of_times(rate);
    }

    /// Prints one window, with its methods where they were asked for and are known.
    pub fn print(
        &mut self,
        file: &str,
        estimate: &Estimate,
        methods: Option<&Methods>,
    ) -> io::Result<()> {
        self.count += 1;
        let flags = estimate.flags.to_string();
        let row = Row::new(file, &flags, estimate);
        let width = MIN_TIME_WIDTH.max(self.decimals + 4);
        match &mut self.sink {
            Sink::Table(out) => {
                // A recording without a row gets no heading.
                if self.count == 1 {
                    if self.wide && self.before == 0 {
                        method_table::legend(out)?;
                    }
                    if let Some(title) = self.title.take() {
                        writeln!(out, "{}{title}", if self.before > 0 { "\n" } else { "" })?;
                    }
                    table_heading(out, width)?;
                }
                table(out, estimate, self.decimals, width)?;
                methods.map_or(Ok(()), |methods| {
                    method_table::table(out, estimate, methods, width)
                })
            }
            Sink::Csv(out) if self.wide => {
                if self.before + self.count == 1 {
                    let own = header(&row)?;
                    out.write_record(
                        own.iter()
                            .chain(of_methods::NAMES.iter().map(String::as_str)),
                    )?;
                }
                out.serialize((row, of_methods::fields(methods)))
                    .map_err(io::Error::from)
            }
            Sink::Csv(out) => out.serialize(row).map_err(io::Error::from),
            Sink::Jsonl(out) => {
                let methods = self.wide.then_some(Columns(methods));
                serde_json::to_writer(&mut *out, &Object { row, methods })?;
                writeln!(out)
            }
        }
    }

    /// Prints lines under the last row of a table; other formats have none.
    pub fn under(&mut self, lines: &str) -> io::Result<()> {
        match &mut self.sink {
            Sink::Table(out) => out.write_all(lines.as_bytes()),
            Sink::Csv(_) | Sink::Jsonl(_) => Ok(()),
        }
    }

    /// Rows printed since [`Rows::begin`].
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Rows printed of all recordings.
    pub fn total(&self) -> u64 {
        self.before + self.count
    }

    /// Writes out what is buffered.
    pub fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Table(out) | Sink::Jsonl(out) => out.flush(),
            Sink::Csv(out) => out.flush(),
        }
    }
}

/// The names of a row's own columns.
fn header(row: &Row) -> io::Result<csv::StringRecord> {
    let mut scratch = csv::Writer::from_writer(Vec::new());
    scratch.serialize(row)?;
    let text = scratch
        .into_inner()
        .map_err(|error| io::Error::other(error.to_string()))?;
    Ok(csv::Reader::from_reader(text.as_slice()).headers()?.clone())
}

/// The line above a table whose times are so wide.
fn table_heading(out: &mut impl Write, width: usize) -> io::Result<()> {
    let names = [MAIN_AMPLITUDE, "quadrature", "angle, °", "frequency, Hz"].map(heading);
    writeln!(
        out,
        "{:>width$} {} {:>8} {:>8} {:>8}  flags",
        "time, s",
        names.join(" "),
        "turn,°/s",
        "decay,/s",
        "residual"
    )
}

/// A line of a table, with its time to so many decimals.
fn table(out: &mut impl Write, e: &Estimate, decimals: usize, width: usize) -> io::Result<()> {
    let line = format!(
        "{:>width$} {} {} {} {} {:>8} {:>8} {:>8.1e}  {}",
        fixed(decimals, e.time),
        with_std(e.main_amplitude.into(), e.main_amplitude_std.into()),
        with_std(
            e.quadrature_amplitude.into(),
            e.quadrature_amplitude_std.into()
        ),
        with_std(e.angle.to_degrees(), f64::from(e.angle_std).to_degrees()),
        with_std(e.frequency, e.frequency_std.into()),
        fixed(2, f64::from(e.angle_rate).to_degrees()),
        fixed(3, e.decay_rate.into()),
        e.residual_rms,
        e.flags,
    );
    writeln!(out, "{}", line.trim_end())
}
