//! What fits read of a row.

use std::f64::consts::TAU;
use std::io::Read;

use csv::StringRecord;

use super::turn;
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

/// Those of the frequency, Hz, of the decay rate, 1/s, and of the phase, rad; rows may lack them.
const OTHER_DEVIATIONS: [&str; 3] = ["frequency_std_hz", "decay_rate_std_s", "phase_std_rad"];
/// Rows may lack it too.
const PHASE: &str = "phase_rad";

/// Curves of which a way is made.
pub const BOWS: usize = 3;

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
    /// One standard deviation of it at this time: infinite where the rows do not tell it.
    pub phase_deviation: f64,
    /// Hz, and one standard deviation of it: infinite where the rows do not tell it.
    pub frequency: f64,
    pub frequency_deviation: f64,
    /// One standard deviation each of a_A, a_B and θ_A.
    pub deviations: [f64; 3],
    /// Length of the window, s, from what it knows of an amplitude and its rate; 0 where the rows do not tell the latter.
    pub seconds: f64,
    /// How far the pattern is beside a steady turn on its way from the row before, rad: so many times what [`Row::beside`] has; 0 where it
    /// is taken to turn steadily.
    pub bow: [f64; BOWS],
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

    /// The time of a row, s, and its angle, rad, where they are numbers.
    pub fn way(&self, record: &StringRecord) -> Option<[f64; 2]> {
        let [time, _, _, angle, ..] = self.needed.map(|place| number(record, place));
        Some([time?, angle.filter(|angle| angle.is_finite())?])
    }

    /// The time of a row, s, where it is a number.
    pub fn time(&self, record: &StringRecord) -> Option<f64> {
        number(record, self.needed[0])
    }
}

/// Whether a number is finite in single precision, as rows have it.
fn is_finite(number: f64) -> bool {
    (number as f32).is_finite()
}

/// By how much noise makes the amplitude of a travelling wave longer on average, as it does any vector: its parts have twice the variance
/// of a_A. It is a small part of a deviation, but the same in all rows.
fn longer(travelling: f64, of_main: f64) -> f64 {
    let variance = 2.0 * of_main * of_main;
    // Nearer to nothing the row is circular, and no longer a series.
    if travelling.powi(2) > 16.0 * variance {
        0.5 * variance / travelling
    } else {
        0.0
    }
}

#[cfg(test)]
impl Row {
    /// A row of these a_A, a_B and θ with their deviations; what else it has is of no use.
    pub fn of(time: f64, [main, quadrature, angle]: [f64; 3], deviations: [f64; 3]) -> Self {
        Self {
            time,
            main,
            quadrature,
            angle,
            phase: None,
            phase_deviation: f64::INFINITY,
            frequency: 5332.0,
            frequency_deviation: 1e-3,
            deviations,
            seconds: 0.0,
            bow: [0.0; BOWS],
        }
    }
}

impl Row {
    /// By how much the pattern has turned since the row before at such a share of the way from that, rad.
    pub fn turned(&self, before: &Self, share: f64) -> f64 {
        let beside = Self::beside(share).into_iter().zip(self.bow);
        let beside: f64 = beside.map(|(by, bow)| by * bow).sum();
        share * turn(self.angle - before.angle) + beside
    }

    /// The curves of which a way is made, at a share of it.
    pub fn beside(share: f64) -> [f64; BOWS] {
        let middle = 2.0 * share - 1.0;
        [1.0, middle, middle * middle].map(|curve| curve * share * (1.0 - share))
    }

    /// The logarithm of a_A over another row's, and its deviation: a decay alone does not bend it.
    pub fn log_beside(&self, other: &Self) -> (f64, f64) {
        (
            (self.main / other.main).ln(),
            self.deviations[0] / self.main,
        )
    }

    /// a_B over a_A, and its deviation: a decay alone does not change it.
    pub fn ratio(&self) -> (f64, f64) {
        let [of_main, of_quadrature, _] = self.deviations;
        let ratio = self.quadrature / self.main;
        (ratio, of_quadrature.hypot(ratio * of_main) / self.main)
    }

    /// None where a number is missing or not finite, or none that rows in single precision have.
    pub fn parse(record: &StringRecord, places: &Places) -> Option<Self> {
        // Squares of other numbers may be 0 or infinite.
        let finite = |place| number(record, place).filter(|number: &f64| is_finite(*number));
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
        let [Some(of_frequency), Some(of_rate), Some(of_phase)] = places.others.map(other) else {
            return None;
        };
        let deviations = [of_main, of_quadrature, of_angle];
        let mut positive = deviations
            .into_iter()
            .chain([main, of_frequency, of_rate, of_phase]);
        // The phase is that of the time before it was rounded: doubles as large as a date, in s since 1970, are 0.2 µs apart.
        let rounded = TAU * frequency * (time.abs().next_up() - time.abs()) / 12f64.sqrt();
        // Rounded digits may make a_B the greater one, by little.
        let is_usable =
            positive.all(|number| number as f32 > 0.0) && quadrature.abs() < 1.01 * main;
        let [more, less] = [1.0, -1.0].map(|sign| longer(main + sign * quadrature, of_main));
        is_usable.then_some(Self {
            time,
            main: main - 0.5 * (more + less),
            quadrature: quadrature - 0.5 * (more - less),
            angle,
            phase: places.phase.and_then(finite),
            phase_deviation: of_phase.hypot(rounded),
            frequency,
            frequency_deviation: of_frequency,
            deviations,
            // A straight line through evenly spread samples knows its slope so much worse than its middle.
            seconds: 12f64.sqrt() * of_main / main / of_rate,
            bow: [0.0; BOWS],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deviates::Deviates;

    #[test]
    fn noise_makes_no_amplitude_longer() {
        // a_A and a_B, and their deviation: from eight of them to twenty.
        for (main, quadrature, std) in [(1.0, 0.0, 0.125), (1.0, 0.3, 0.05), (1.0, -0.4, 0.05)] {
            let mut random = Deviates(7);
            let count = 100_000;
            let mut text = COLUMNS.join(",") + "\n";
            for _ in 0..count {
                let mut travelling = |size: f64| {
                    let mut part = || 2f64.sqrt() * std * random.draw();
                    (size + part()).hypot(part())
                };
                let (plus, minus) = (travelling(main + quadrature), travelling(main - quadrature));
                let [a, b] = [0.5 * (plus + minus), 0.5 * (plus - minus)];
                text += &format!("0,{a},{b},0,5332,{std},{std},{std}\n");
            }
            let mut rows = RowFile::new("a.csv", text.as_bytes()).unwrap();
            let places = Places::of(&rows).unwrap();
            let mut sums = [0.0; 3];
            while let Some(record) = rows.next().unwrap() {
                let row = Row::parse(record, &places).unwrap();
                let as_told = number(record, places.needed[1]).unwrap();
                let values = [row.main - main, row.quadrature - quadrature, as_told - main];
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value / std / f64::from(count);
                }
            }
            // In deviations; of the mean one is 0.003. What is left is of the next order.
            let [main, quadrature, as_told] = sums;
            assert!(main.abs() < 0.013 && quadrature.abs() < 0.013, "{sums:?}");
            assert!(as_told > 0.04, "{sums:?}");
        }
    }
}
