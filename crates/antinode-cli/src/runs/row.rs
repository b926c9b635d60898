//! The values of a row that fits use.

use std::f64::consts::TAU;

use csv::StringRecord;

use super::turn;
use crate::failure::Failure;
use crate::row_file::{RowFile, Unusable, number};

/// Columns that rows must have.
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

/// Columns that rows may lack.
const OTHERS: [&str; 4] = [
    "phase_rad",
    "frequency_std_hz",
    "decay_rate_std_s",
    "phase_std_rad",
];

/// Curves that make up an unsteady turn.
pub const BOWS: usize = 3;

/// The values of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Time of the window's middle, s.
    pub time: f64,
    /// a_A and a_B, in the samples' unit.
    pub main: f64,
    pub quadrature: f64,
    /// θ_A, rad.
    pub angle: f64,
    /// Phase of the main wave, rad, if the rows have it.
    pub phase: Option<f64>,
    /// One standard deviation of it at this time; infinite if the rows lack it.
    pub phase_deviation: f64,
    /// Frequency, Hz, and one standard deviation of it; infinite if the rows lack it.
    pub frequency: f64,
    pub frequency_deviation: f64,
    /// One standard deviation each of a_A, a_B and θ_A.
    pub deviations: [f64; 3],
    /// Length of the window, s, from the deviations of an amplitude and of its rate; 0 if the rows lack the latter.
    pub seconds: f64,
    /// Departure of the pattern from a steady turn since the row before, rad, as coefficients of the curves of [`Row::curves`]; 0 if it is
    /// taken to turn steadily.
    pub bow: [f64; BOWS],
}

/// Places of the columns.
pub struct Places {
    needed: [usize; COLUMNS.len()],
    others: [Option<usize>; OTHERS.len()],
}

impl Places {
    /// The places in a file.
    pub fn of(rows: &RowFile) -> Result<Self, Failure> {
        let mut needed = [0; COLUMNS.len()];
        for (to, column) in needed.iter_mut().zip(COLUMNS) {
            *to = rows.needed(column)?;
        }
        let others = OTHERS.map(|column| rows.place(column));
        Ok(Self { needed, others })
    }

    /// The time of a row, s, and its angle, rad, if they are numbers.
    pub fn way(&self, record: &StringRecord) -> Option<[f64; 2]> {
        let [time, _, _, angle, ..] = self.needed.map(|place| number(record, place));
        Some([time?, angle.filter(|angle| angle.is_finite())?])
    }

    /// The time of a row, s, if it is a number.
    pub fn time(&self, record: &StringRecord) -> Option<f64> {
        let [time, ..] = self.needed;
        number(record, time)
    }
}

/// Mean increase of a travelling wave's amplitude by noise, which lengthens any vector: its components have twice the variance
/// of a_A. The increase is a small part of a deviation, but the same in all rows.
fn increase_by_noise(travelling: f64, of_main: f64) -> f64 {
    let variance = 2.0 * of_main * of_main;
    // Nearer to zero the row is circular, and the series does not hold.
    if travelling.powi(2) > 16.0 * variance {
        0.5 * variance / travelling
    } else {
        0.0
    }
}

#[cfg(test)]
impl Row {
    /// A row with these a_A, a_B and θ and their deviations; its other values do not matter.
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
    /// Turn of the pattern since the row before, rad, when this share of the time from that row has passed.
    pub fn turned(&self, before: &Self, share: f64) -> f64 {
        let beside = Self::curves(share).into_iter().zip(self.bow);
        let beside: f64 = beside.map(|(by, bow)| by * bow).sum();
        share * turn(self.angle - before.angle) + beside
    }

    /// The curves that make up an unsteady turn, at this share of the time between two rows.
    pub fn curves(share: f64) -> [f64; BOWS] {
        let middle = 2.0 * share - 1.0;
        [1.0, middle, middle * middle].map(|curve| curve * share * (1.0 - share))
    }

    /// The logarithm of a_A over that of another row, and its deviation: a decay alone does not bend it.
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

    /// Reads a row; fails if a number is missing, not finite or out of the range that rows in single precision have.
    pub fn parse(record: &StringRecord, places: &Places) -> Result<Self, Unusable> {
        // The squares of numbers beyond single precision may be 0 or infinite.
        let field = |place, needed, is_good: fn(f32) -> bool| {
            let number = number(record, place).filter(|&number: &f64| is_good(number as f32));
            number.ok_or(Unusable { place, needed })
        };
        let finite = |place| field(place, "a finite number in single precision", f32::is_finite);
        let size = |place| {
            let is_size = |size: f32| size > 0.0 && size.is_finite();
            field(place, "a number above 0 in single precision", is_size)
        };
        let deviation = |place: Option<usize>| {
            let of = |place| field(place, "a number above 0", |size| size > 0.0);
            place.map_or(Ok(f64::INFINITY), of)
        };
        let [
            time,
            main,
            place_of_quadrature,
            angle,
            frequency,
            of_main,
            of_quadrature,
            of_angle,
        ] = places.needed;
        let (time, angle, frequency) = (finite(time)?, finite(angle)?, finite(frequency)?);
        let (main, quadrature) = (size(main)?, finite(place_of_quadrature)?);
        // Rounding of the digits may make |a_B| slightly greater than a_A.
        if quadrature.abs() >= 1.01 * main {
            return Err(Unusable {
                place: place_of_quadrature,
                needed: "within ±main_amplitude",
            });
        }
        let deviations = [size(of_main)?, size(of_quadrature)?, size(of_angle)?];
        let [of_main, ..] = deviations;
        let [phase, of_frequency, of_rate, of_phase] = places.others;
        let of_frequency = deviation(of_frequency)?;
        let (of_rate, of_phase) = (deviation(of_rate)?, deviation(of_phase)?);
        // The phase belongs to the time before rounding: doubles as large as a date, in s since 1970, are 0.2 µs apart.
        let rounded = TAU * frequency * (time.abs().next_up() - time.abs()) / 12f64.sqrt();
        let [more, less] =
            [1.0, -1.0].map(|sign| increase_by_noise(main + sign * quadrature, of_main));
        Ok(Self {
            time,
            main: main - 0.5 * (more + less),
            quadrature: quadrature - 0.5 * (more - less),
            angle,
            phase: phase.and_then(|place| finite(place).ok()),
            phase_deviation: of_phase.hypot(rounded),
            frequency,
            frequency_deviation: of_frequency,
            deviations,
            // For a straight line through evenly spread samples, this is the ratio of the deviations of middle and slope.
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
    fn amplitudes_are_free_of_the_bias_of_noise() {
        // a_A, a_B and their deviation: a_A of 8 or 20 deviations.
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
            let mut rows = RowFile::new("a.csv", std::io::Cursor::new(text.to_owned())).unwrap();
            let places = Places::of(&rows).unwrap();
            let mut sums = [0.0; 3];
            while rows.advance().unwrap() {
                let record = rows.record();
                let row = Row::parse(record, &places).unwrap();
                let as_printed = number(record, places.needed[1]).unwrap();
                let values = [
                    row.main - main,
                    row.quadrature - quadrature,
                    as_printed - main,
                ];
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value / std / f64::from(count);
                }
            }
            // In deviations; that of the mean is 0.003. What is left is of the next order.
            let [main, quadrature, as_printed] = sums;
            assert!(main.abs() < 0.013 && quadrature.abs() < 0.013, "{sums:?}");
            assert!(as_printed > 0.04, "{sums:?}");
        }
    }
}
