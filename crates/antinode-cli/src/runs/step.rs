//! Whether a gain or the wave steps between rows that all look clean: by too little for a window to be flagged.

use nalgebra::{SMatrix, SVector};

use super::{Row, turn};

/// Rows on each side that tell it: a step nearer to the ends of a run is not seen.
const SIDE: usize = 10;
/// Unknowns of the course about a row: a cubic, a step, and another slope.
const UNKNOWNS: usize = 6;
/// The places of the latter two.
const STEP: usize = 4;
const BEND: usize = 5;
/// Deviations that a step must be beyond what else may look like it.
const SIGMAS: f64 = 8.0;
/// So many times what a table that starts or stops within a row makes of the slopes.
const BENT: f64 = 2.0;
/// What flaws of the pick-offs make of a sudden turn, per rad: gains that differ by 5 % do.
const FLAWED: f64 = 0.1;
/// Nearer to a circle than this a_B over a_A is, no a_A is smooth.
const CIRCULAR: f64 = 0.9;
/// The rows beside may be so much of a side apart, and one side so many times the other.
const NEAR: f64 = 0.4;
const UNLIKE: f64 = 3.0;

/// The rows of a run about which a_A or a_B over a_A steps: what is before is one wave, what is behind another, and the row itself may
/// hold both. Not near rows behind which circles were left out, for amplitudes change places there.
pub fn steps(rows: &[Row], circles: &[usize]) -> Vec<usize> {
    let abouts = rows.windows(2 * SIDE + 1).enumerate();
    let is_circled = |first: usize| {
        let next = circles.partition_point(|&circle| circle <= first);
        let next = circles.get(next);
        next.is_some_and(|&circle| circle <= first + 2 * SIDE)
    };
    let mut seen: Vec<(usize, f64)> = abouts
        .filter(|&(first, _)| !is_circled(first))
        .map(|(first, about)| (first + SIDE, beyond(about)))
        .filter(|&(_, beyond)| beyond > 1.0)
        .collect();
    seen.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    let mut steps: Vec<usize> = Vec::new();
    for (index, _) in seen {
        // Rows beside a step see it too.
        if steps.iter().all(|step| step.abs_diff(index) > SIDE) {
            steps.push(index);
        }
    }
    steps.sort_unstable();
    steps
}

/// How many times as far as it may without a step the wave steps about the middle one of these rows.
fn beyond(rows: &[Row]) -> f64 {
    let circular = |row: &Row| row.quadrature.abs() > CIRCULAR * row.main;
    let Some(times) = Times::of(rows).filter(|_| !rows.iter().any(circular)) else {
        return 0.0;
    };
    let middle = rows[SIDE];
    let of_main = times.course(rows, |row| row.log_beside(&middle));
    let of_ratio = times.course(rows, Row::ratio);
    let courses = [of_main, of_ratio].map(|course| course.unwrap_or_default());
    let most = |more: f64| {
        let beyond = courses.map(|course| course.step.abs() / (course.likely + more));
        beyond[0].max(beyond[1])
    };
    if most(0.0) < 1.0 {
        return 0.0;
    }
    let of_angle = times.course(rows, |row| {
        (turn(row.angle - middle.angle), row.deviations[2])
    });
    of_angle.map_or(0.0, |course| most(FLAWED * course.step.abs()))
}

/// The times of rows about one, from the middle of its neighbours on, over the longer side.
struct Times {
    times: [f64; 2 * SIDE],
    /// How far the neighbours are from that middle.
    near: f64,
}

/// What a quantity does about a row.
#[derive(Debug, Clone, Copy)]
struct Course {
    step: f64,
    /// What may look like a step.
    likely: f64,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            step: 0.0,
            likely: f64::INFINITY,
        }
    }
}

/// The rows but for the middle one, which may be of both sides.
fn beside(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows[..SIDE].iter().chain(&rows[SIDE + 1..])
}

impl Times {
    /// None where the rows are too uneven.
    fn of(rows: &[Row]) -> Option<Self> {
        let (before, after) = (rows[SIDE - 1].time, rows[SIDE + 1].time);
        let middle = 0.5 * (before + after);
        let sides = [middle - rows[0].time, rows[2 * SIDE].time - middle];
        let (less, more) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
        let mut times = [0.0; 2 * SIDE];
        for (time, row) in times.iter_mut().zip(beside(rows)) {
            *time = (row.time - middle) / more;
        }
        let is_even = after - before < NEAR * less && more < UNLIKE * less;
        is_even.then_some(Self {
            times,
            near: 0.5 * (after - before) / more,
        })
    }

    /// The course of a quantity that has such a value and deviation in a row.
    fn course(&self, rows: &[Row], of: impl Fn(&Row) -> (f64, f64)) -> Option<Course> {
        let mut matrix = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
        let mut right = SVector::<f64, UNKNOWNS>::zeros();
        let mut squares = 0.0;
        for (&time, row) in self.times.iter().zip(beside(rows)) {
            let (value, deviation) = of(row);
            let half = 0.5 * time.signum();
            let line = [1.0, time, time * time, time.powi(3), half, half * time];
            let line = SVector::from(line) / deviation;
            matrix += line * line.transpose();
            right += line * (value / deviation);
            squares += (value / deviation).powi(2);
        }
        let covariance = matrix.try_inverse()?;
        let found = covariance * right;
        let misfit = (squares - found.dot(&right)) / (2 * SIDE - UNKNOWNS) as f64;
        let noise = covariance[(STEP, STEP)].sqrt() * misfit.max(1.0);
        Some(Course {
            step: found[STEP],
            likely: SIGMAS * noise + BENT * found[BEND].abs() * self.near,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::deviates::Deviates;

    /// Rows a second apart, of ln a_A, a_B over a_A and θ at a time beside a decay of 0.2 % a second, with noise of 10⁻⁴.
    fn rows(count: usize, seed: u64, wave: impl Fn(f64) -> [f64; 3]) -> Vec<Row> {
        let mut random = Deviates(seed);
        let row = |k: usize| {
            let time = k as f64;
            let [log, ratio, angle] = wave(time);
            let main = (log - 0.002 * time).exp();
            let values = [main, ratio * main, angle].map(|value| value + 1e-4 * random.draw());
            Row::of(time, values, [1e-4; 3])
        };
        (0..count).map(row).collect()
    }

    #[test]
    fn a_step_is_seen_where_it_is_and_nowhere_else() {
        // Of 40 deviations.
        for (index, size) in [(0, 4e-3), (0, -4e-3), (1, 4e-3)] {
            for seed in 0..200 {
                let at = 15.0 + 0.1 * seed as f64;
                let rows = rows(60, seed, |time| {
                    // A window holds a second.
                    let mut wave = [0.0, 0.1, 0.05 * time];
                    wave[index] += size * (time + 0.5 - at).clamp(0.0, 1.0);
                    wave
                });
                let found = steps(&rows, &[]);
                assert_eq!(found.len(), 1, "{index}, {size}, {at}: {found:?}");
                let apart = (found[0] as f64 - at).abs();
                assert!(apart <= 1.0, "{index}, {size}, {at}: {found:?}");
                // A circle passed meanwhile.
                assert!(steps(&rows, &[found[0]]).is_empty());
            }
        }
    }

    #[test]
    fn noise_swings_and_tables_that_stop_and_go_have_no_steps() {
        for seed in 0..300 {
            let period = 3.0 * 1.02f64.powi(seed);
            let size = 10f64.powi(seed % 4 - 4);
            // A table that goes from a time on, by up to 0.2 rad a row, with gains that differ by 3 %, a rate that splits make, or none.
            let (begins, rate) = (20.0 + 0.07 * f64::from(seed), 0.02 * f64::from(seed % 10));
            let flaw = 0.03 * f64::from(seed % 3 - 1);
            let rows = rows(100, seed as u64, |time| {
                let swing = size * (TAU * time / period).sin();
                let angle = 0.2 + rate * (time - begins).max(0.0);
                let sine = (2.0 * angle).sin();
                match seed % 5 {
                    0 => [swing, 0.1, 0.0],
                    1 => [0.0, 0.1 + swing.min(0.2), 0.0],
                    _ => [flaw * sine * sine, 0.1 + flaw * sine, angle],
                }
            });
            let steps = steps(&rows, &[]);
            assert!(steps.is_empty(), "{seed}: {steps:?}");
        }
    }
}
