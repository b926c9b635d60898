//! The columns of rows that fits use.

use antinode_ringdown::Window;
use csv::StringRecord;

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
        let [_, _, _, angle, ..] = self.needed;
        Some([self.time(record)?, finite_number(record, angle)?])
    }

    /// The time of a row, s, if it is a number.
    pub fn time(&self, record: &StringRecord) -> Option<f64> {
        let [time, ..] = self.needed;
        finite_number(record, time)
    }

    /// Reads a row; fails if a number is missing, not finite or out of the range that rows in single precision have.
    pub fn window(&self, record: &StringRecord) -> Result<Window, Unusable> {
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
        ] = self.needed;
        let (time, angle, frequency) = (finite(time)?, finite(angle)?, finite(frequency)?);
        let (main, quadrature) = (size(main)?, finite(place_of_quadrature)?);
        // Rounding of the digits may make |a_B| slightly greater than a_A.
        if quadrature.abs() >= 1.01 * main {
            return Err(Unusable {
                place: place_of_quadrature,
                needed: "within ±main_amplitude",
            });
        }
        let [of_main, of_quadrature, of_angle] =
            [size(of_main)?, size(of_quadrature)?, size(of_angle)?];
        let [phase, of_frequency, of_rate, of_phase] = self.others;
        Ok(Window {
            time,
            main_amplitude: main,
            quadrature_amplitude: quadrature,
            angle,
            phase: phase.and_then(|place| finite(place).ok()),
            frequency,
            main_amplitude_std: of_main,
            quadrature_amplitude_std: of_quadrature,
            angle_std: of_angle,
            frequency_std: deviation(of_frequency)?,
            decay_rate_std: deviation(of_rate)?,
            phase_std: deviation(of_phase)?,
        })
    }
}

/// The number in a field of a row, if it is one and finite.
fn finite_number(record: &StringRecord, place: usize) -> Option<f64> {
    number(record, place).filter(|number| number.is_finite())
}
