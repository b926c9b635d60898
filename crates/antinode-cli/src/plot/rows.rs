//! The rows to be drawn, by recording.

use std::ops::Range;
use std::path::PathBuf;

use antinode::Flags;
use csv::StringRecord;

use super::numbers::drawable;
use crate::failure::Failure;
use crate::given_rows::{recording_of, told_apart};
use crate::median::median;
use crate::row_file::{self, RowFile, Unusable, number};

/// Quantities that are drawn: their columns, and those of their deviations.
pub const QUANTITIES: [(&str, Option<&str>); 5] = [
    ("main_amplitude", Some("main_amplitude_std")),
    ("quadrature_amplitude", Some("quadrature_amplitude_std")),
    ("angle_rad", Some("angle_std_rad")),
    ("frequency_hz", Some("frequency_std_hz")),
    ("residual_rms", None),
];
/// Distance of windows, as a multiple of the usual one, beyond which rows are missing between them.
const GAP: f64 = 1.5;

/// How far a row is to be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trust {
    /// No flag.
    Clean,
    /// A flag other than `lost`.
    Flagged,
    /// The flag `lost`: no number means anything.
    Lost,
}

/// The values of a row to be drawn.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Time, s.
    pub time: f64,
    /// In the order of [`QUANTITIES`].
    pub values: [f64; QUANTITIES.len()],
    /// One standard deviation each; NaN if there is none.
    pub deviations: [f32; QUANTITIES.len()],
    /// Sample pairs of the window; 1 if the rows do not say.
    samples: u32,
    pub trust: Trust,
    /// True if it does not continue from the row before.
    pub begins: bool,
}

/// The rows of a recording.
#[derive(Debug)]
pub struct Trace {
    pub name: String,
    pub rows: Vec<Row>,
}

/// Reads files of rows, `-` being standard input, and returns the recordings and the names of the files.
pub fn open(paths: &[PathBuf]) -> Result<(Vec<Trace>, String), Failure> {
    let mut traces: Vec<Trace> = Vec::new();
    let mut recordings = Vec::new();
    let mut names = Vec::new();
    for path in paths {
        let file = RowFile::open(path)?;
        let input = file.name().to_owned();
        let new = read(file)?;
        recordings.extend(new.iter().map(|trace| (input.clone(), trace.name.clone())));
        traces.extend(new);
        names.push(input);
    }
    for (trace, name) in traces.iter_mut().zip(told_apart(&recordings)) {
        trace.name = name;
    }
    Ok((traces, names.join(", ")))
}

/// The recordings of a file of rows.
pub fn read(mut rows: RowFile) -> Result<Vec<Trace>, Failure> {
    let time = rows.needed("time_s")?;
    let flags = rows.needed("flags")?;
    let mut places = [(0, None); QUANTITIES.len()];
    for (to, (value, deviation)) in places.iter_mut().zip(QUANTITIES) {
        let deviation = deviation.and_then(|column| rows.place(column));
        *to = (rows.needed(value)?, deviation);
    }
    let samples = rows.place("samples");
    let file = rows.place("file");
    let input = rows.name().to_owned();
    let mut traces: Vec<Trace> = Vec::new();
    let mut current = 0;
    while rows.advance()? {
        let record = rows.record();
        let row = parse(record, time, flags, places, samples);
        let row = row.map_err(|unusable| rows.unusable(unusable))?;
        let name = file.map_or(input.as_str(), |file| &record[file]);
        let new = || Trace {
            name: name.to_owned(),
            rows: Vec::new(),
        };
        current = recording_of(&mut traces, current, |trace| trace.name == name, new);
        if drawable(row.time).is_some() {
            traces[current].rows.push(row);
        }
    }
    for trace in &mut traces {
        find_gaps(&mut trace.rows);
    }
    Ok(traces)
}

/// Reads a row; fails if a field is no number.
fn parse(
    record: &StringRecord,
    time: usize,
    flags: usize,
    places: [(usize, Option<usize>); QUANTITIES.len()],
    samples: Option<usize>,
) -> Result<Row, Unusable> {
    let number = |place| {
        let needed = "a number";
        number(record, place).ok_or(Unusable { place, needed })
    };
    let mut values = [0.0; QUANTITIES.len()];
    let mut deviations = [f32::NAN; QUANTITIES.len()];
    for (index, (value, deviation)) in places.into_iter().enumerate() {
        values[index] = number(value)?;
        if let Some(deviation) = deviation {
            deviations[index] = number(deviation)? as f32;
        }
    }
    let samples = samples.map_or(Ok(1.0), number)?;
    let flags = row_file::flags(record, flags)?;
    Ok(Row {
        time: number(time)?,
        values,
        deviations,
        samples: samples as u32,
        trust: if flags.is_empty() {
            Trust::Clean
        } else if flags.contains(Flags::LOST) {
            Trust::Lost
        } else {
            Trust::Flagged
        },
        // The pattern may have turned unseen.
        begins: flags.contains(Flags::REACQUIRED),
    })
}

/// Finds the rows before which others are missing.
fn find_gaps(rows: &mut [Row]) {
    // In units of the windows' lengths, which may change.
    let step = |pair: &[Row]| {
        let samples = f64::from(pair[0].samples) + f64::from(pair[1].samples);
        (pair[1].time - pair[0].time) / samples.max(1.0)
    };
    let mut steps: Vec<f64> = rows
        .windows(2)
        .map(step)
        .filter(|&step| step > 0.0)
        .collect();
    let usual = median(&mut steps).unwrap_or(0.0);
    for index in 1..rows.len() {
        let step = step(&rows[index - 1..=index]);
        // If time goes back, another recording begins.
        rows[index].begins |= step < 0.0 || step > GAP * usual;
    }
}

/// The first and the last time, s; `None` without rows.
pub fn span(traces: &[Trace]) -> Option<[f64; 2]> {
    let rows = traces.iter().flat_map(|trace| &trace.rows);
    let ends = rows.map(|row| [row.time; 2]);
    ends.reduce(|[first, last], [time, _]| [first.min(time), last.max(time)])
}

/// Keeps the rows at these times, s, and the recordings that have any.
pub fn retain(traces: &mut Vec<Trace>, times: &Range<f64>) {
    for trace in traces.iter_mut() {
        trace.rows.retain(|row| times.contains(&row.time));
    }
    traces.retain(|trace| !trace.rows.is_empty());
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "time_s,samples,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,residual_rms,flags,file\n";

    fn traces(rows: &[(f64, u32, &str, &str)]) -> Vec<Trace> {
        let lines = rows.iter().map(|(time, samples, flags, file)| {
            format!("{time},{samples},0.5,0,0.1,5332,0.01,{flags},{file}\n")
        });
        let text: String = std::iter::once(HEADER.to_owned()).chain(lines).collect();
        read(RowFile::new("it", std::io::Cursor::new(text.to_owned())).unwrap()).unwrap()
    }

    /// Indices of the rows at which a line begins, apart from the first.
    fn begins(rows: &[(f64, u32, &str, &str)]) -> Vec<usize> {
        let traces = traces(rows);
        assert_eq!(traces.len(), 1);
        let rows = traces[0].rows.iter().enumerate();
        rows.filter(|(_, row)| row.begins).map(|(k, _)| k).collect()
    }

    #[test]
    fn missing_rows_are_seen() {
        let at =
            |times: &[f64]| -> Vec<_> { times.iter().map(|&time| (time, 100, "", "a")).collect() };
        assert!(begins(&at(&[0.0, 1.0, 2.1, 3.0, 4.0])).is_empty());
        assert_eq!(
            begins(&at(&[0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 9.0, 12.0, 13.0])),
            [3, 6, 7]
        );
        assert_eq!(begins(&at(&[0.0, 1.0, 2.0, 0.5, 1.5, 2.5])), [3]);
        assert!(begins(&at(&[1.0])).is_empty());
        // Windows that become longer.
        let longer = [
            (0.0, 100),
            (1.0, 100),
            (2.0, 100),
            (3.0, 100),
            (4.5, 200),
            (6.5, 200),
        ];
        assert!(begins(&longer.map(|(time, samples)| (time, samples, "", "a"))).is_empty());
    }

    #[test]
    fn flags_decide_how_far_a_row_is_trusted() {
        let flags = ["", "lost+dead_channel", "reacquired", "misfit"];
        let rows: Vec<_> = (0..4)
            .map(|k| (f64::from(k), 100, flags[k as usize], "a"))
            .collect();
        assert_eq!(begins(&rows), [2]);
        let trust = traces(&rows)[0]
            .rows
            .iter()
            .map(|row| row.trust)
            .collect::<Vec<_>>();
        assert_eq!(
            trust,
            [Trust::Clean, Trust::Lost, Trust::Flagged, Trust::Flagged]
        );
    }

    #[test]
    fn each_recording_has_a_trace() {
        let files = ["a", "a", "b", "a", "b"];
        let rows: Vec<_> = (0..5)
            .map(|k| (f64::from(k), 100, "", files[k as usize]))
            .collect();
        let traces = traces(&rows);
        let lengths: Vec<_> = traces
            .iter()
            .map(|trace| (trace.name.as_str(), trace.rows.len()))
            .collect();
        assert_eq!(lengths, [("a", 3), ("b", 2)]);
    }
}
