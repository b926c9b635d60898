//! What fits read of a row.

use std::io::Read;

use csv::StringRecord;

use crate::failure::Failure;
use crate::row_file::{RowFile, number};

/// Columns that are read.
const COLUMNS: [&str; 8] = [
    "time_s",
    "main_amplitude",
    "quadrature_amplitude",
    "angle_rad",
    "frequency_hz",
    "main_amplitude_std",
    "quadrature_amplitude_std",
    "angle_std_rad",
];

/// Those of the frequency, Hz, and of the decay rate, 1/s; rows may lack them.
const OTHER_DEVIATIONS: [&str; 2] = ["frequency_std_hz", "decay_rate_std_s"];
/// Rows may lack it too.
const PHASE: &str = "phase_rad";

/// What is used of a row.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// s.
    pub time: f64,
    /// a_A and a_B, in the samples' unit.
    pub main: f64,
    pub quadrature: f64,
    /// θ_A, rad.
    pub angle: f64,
    /// Of the main wave, rad, where the rows tell it.
    pub phase: Option<f64>,
    /// Hz, and one standard deviation of it: infinite where the rows do not tell it.
    pub frequency: f64,
    pub frequency_deviation: f64,
    /// One standard deviation each of a_A, a_B and θ_A.
    pub deviations: [f64; 3],
    /// Length of the window, s, from what it knows of an amplitude and its rate; 0 where the rows do not tell the latter.
    pub seconds: f64,
}

/// Where the columns stand.
pub struct Places {
    needed: [usize; COLUMNS.len()],
    others: [Option<usize>; OTHER_DEVIATIONS.len()],
    phase: Option<usize>,
}

impl Places {
    /// Those of a file.
    pub fn of(rows: &RowFile<impl Read>) -> Result<Self, Failure> {
        let mut needed = [0; COLUMNS.len()];
        for (to, column) in needed.iter_mut().zip(COLUMNS) {
            *to = rows.needed(column)?;
        }
        let others = OTHER_DEVIATIONS.map(|column| rows.place(column));
        Ok(Self {
            needed,
            others,
            phase: rows.place(PHASE),
        })
    }

    /// The time of a row, s, where it is a number.
    pub fn time(&self, record: &StringRecord) -> Option<f64> {
        number(record, self.needed[0])
    }
}

impl Row {
    /// None where a number is missing or not finite.
    pub fn parse(record: &StringRecord, places: &Places) -> Option<Self> {
        let finite = |place| number(record, place).filter(|number: &f64| number.is_finite());
        let [
            Some(time),
            Some(main),
            Some(quadrature),
            Some(angle),
            Some(frequency),
            Some(of_main),
            Some(of_quadrature),
            Some(of_angle),
        ] = places.needed.map(finite)
        else {
            return None;
        };
        let other =
            |place: Option<usize>| place.map_or(Some(f64::INFINITY), |place| number(record, place));
        let (of_frequency, of_rate) = (other(places.others[0])?, other(places.others[1])?);
        let deviations = [of_main, of_quadrature, of_angle];
        let mut positive = deviations.into_iter().chain([main, of_frequency, of_rate]);
        let is_usable = positive.all(|number| number > 0.0);
        is_usable.then_some(Self {
            time,
            main,
            quadrature,
            angle,
            phase: places.phase.and_then(finite),
            frequency,
            frequency_deviation: of_frequency,
            deviations,
            // A straight line through evenly spread samples knows its slope so much worse than its middle.
            seconds: 12f64.sqrt() * of_main / main / of_rate,
        })
    }
}
