//! Detection of steps of a gain or the wave between rows that all look clean, as the step is too small for a window to be flagged.

use nalgebra::{SMatrix, SVector};

use super::{Row, turn};

/// Rows examined on each side: a step nearer to the ends of a run is not seen.
const SIDE: usize = 10;
/// Unknowns of the course about a row: a cubic, a step, and a change of slope.
const UNKNOWNS: usize = 6;
/// The places of the last two.
const STEP: usize = 4;
const BEND: usize = 5;
/// Deviations by which a step must exceed what else may look like it.
const SIGMAS: f64 = 8.0;
/// Multiple that is allowed of the step that a change of slope would make, if a table starts or stops within a row.
const MAX_BEND: f64 = 2.0;
/// Step that flaws of the pick-offs make of a sudden turn, per rad: gains that differ by 5 % do.
const STEP_BY_FLAWS: f64 = 0.1;
/// Ratio of |a_B| to a_A above which the pattern is too near to a circle for a_A to be smooth.
const CIRCULAR_RATIO: f64 = 0.9;
/// Distance of the middle row's neighbours, at most, as a share of the shorter side, and ratio of the sides, at most.
const MAX_GAP: f64 = 0.4;
const MAX_UNLIKE: f64 = 3.0;

/// Numbers of the rows at which a_A or a_B over a_A steps: the rows before show one wave, those after another, and the row itself may
/// hold both. None near circular rows that were left out, as amplitudes change places there.
pub fn steps(rows: &[Row], circles: &[usize]) -> Vec<usize> {
    let abouts = rows.windows(2 * SIDE + 1).enumerate();
    let is_circled = |first: usize| {
        let next = circles.partition_point(|&circle| circle <= first);
        let next = circles.get(next);
        next.is_some_and(|&circle| circle <= first + 2 * SIDE)
    };
    let mut seen: Vec<(usize, f64)> = abouts
        .filter(|&(first, _)| !is_circled(first))
        .map(|(first, about)| (first + SIDE, step_ratio(about)))
        .filter(|&(_, step_ratio)| step_ratio > 1.0)
        .collect();
    seen.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    let mut steps: Vec<usize> = Vec::new();
    for (index, _) in seen {
        // Rows near a step show it too.
        if steps.iter().all(|step| step.abs_diff(index) > SIDE) {
            steps.push(index);
        }
    }
    steps.sort_unstable();
    steps
}

/// The wave's step at the middle one of these rows, over the largest that may seem to be there without a step.
fn step_ratio(rows: &[Row]) -> f64 {
    let circular = |row: &Row| row.quadrature.abs() > CIRCULAR_RATIO * row.main;
    let Some(about) = About::of(rows).filter(|_| !rows.iter().any(circular)) else {
        return 0.0;
    };
    let middle = rows[SIDE];
    let of_main = about.step(rows, |row| row.log_beside(&middle));
    let of_ratio = about.step(rows, Row::ratio);
    let largest = |more: f64| {
        let ratio = |step: Step| step.size.abs() / (step.allowed + more);
        let [by_main, by_ratio] = [of_main, of_ratio].map(|step| step.map_or(0.0, ratio));
        by_main.max(by_ratio)
    };
    if largest(0.0) < 1.0 {
        return 0.0;
    }
    let of_angle = about.step(rows, |row| {
        (turn(row.angle - middle.angle), row.deviations[2])
    });
    of_angle.map_or(0.0, |step| largest(STEP_BY_FLAWS * step.size.abs()))
}

/// The times of rows about a middle one, from halfway between its neighbours, in units of the longer side.
struct About {
    times: [f64; 2 * SIDE],
    /// Distance of the neighbours from there.
    near: f64,
}

/// The step of a quantity at a row.
#[derive(Debug, Clone, Copy)]
struct Step {
    size: f64,
    /// The largest step that there may seem to be without one.
    allowed: f64,
}

/// The rows but for the middle one, which may belong to both sides.
fn beside(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows[..SIDE].iter().chain(&rows[SIDE + 1..])
}

impl About {
    /// `None` if the rows are too unevenly spaced.
    fn of(rows: &[Row]) -> Option<Self> {
        let (before, after) = (rows[SIDE - 1].time, rows[SIDE + 1].time);
        let middle = 0.5 * (before + after);
        let sides = [middle - rows[0].time, rows[2 * SIDE].time - middle];
        let (less, more) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
        let mut times = [0.0; 2 * SIDE];
        for (time, row) in times.iter_mut().zip(beside(rows)) {
            *time = (row.time - middle) / more;
        }
        let is_even = after - before < MAX_GAP * less && more < MAX_UNLIKE * less;
        is_even.then_some(Self {
            times,
            near: 0.5 * (after - before) / more,
        })
    }

    /// Fits the step of a quantity; `of` gives its value and deviation in a row.
    fn step(&self, rows: &[Row], of: impl Fn(&Row) -> (f64, f64)) -> Option<Step> {
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
        Some(Step {
            size: found[STEP],
            allowed: SIGMAS * noise + MAX_BEND * found[BEND].abs() * self.near,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use antinode_sim::Deviates;

    /// Rows a second apart, with ln a_A, a_B over a_A and θ that `wave` gives, a decay of 0.2 % a second, and noise of 10⁻⁴.
    fn rows(count: usize, seed: u64, wave: impl Fn(f64) -> [f64; 3]) -> Vec<Row> {
        let mut random = Deviates::new(seed);
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
        // A step of 40 deviations.
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
                // Near a circular row that was left out there is none.
                assert!(steps(&rows, &[found[0]]).is_empty());
            }
        }
    }

    #[test]
    fn noise_swings_and_tables_that_stop_and_go_have_no_steps() {
        for seed in 0..300 {
            let period = 3.0 * 1.02f64.powi(seed);
            let size = 10f64.powi(seed % 4 - 4);
            // A table that starts to turn, by up to 0.2 rad a row, with gains that differ by 3 % either way, or not at all.
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
