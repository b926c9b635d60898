//! Whether the wave that stands behind rows left out is still the one before them: a fault in a window may have moved it.

use nalgebra::{DMatrix, DVector};

use super::{Row, turn};

/// Rows that tell how fast the wave changes.
const FEWEST: usize = 5;
/// Rows that tell the course it takes: through fewer a parabola may go by chance.
const KNOWN: usize = 20;
/// Distances of rows across which that parabola goes on.
const NEAR: f64 = 8.5;
/// So many times what is between the parabola and a cubic the wave may lie beside it, at the least and per distance: what swings takes
/// neither course for long.
const APART: f64 = 3.0;
const PER_DISTANCE: f64 = 1.3;
/// So many times as fast as the fastest of the last changes the wave may go on.
const FASTER: f64 = 3.0;
/// Deviations that a change may be beyond what is expected.
const SIGMAS: f64 = 8.0;

/// True where the main amplitude, the quadrature amplitude or the angle jumps from the last of the `rows` of a run to `next`; not where
/// the run is too short to tell.
pub fn jumps(rows: &[Row], next: &Row) -> bool {
    let known = &rows[rows.len().saturating_sub(KNOWN)..];
    known.len() >= FEWEST
        && (0..3).any(|index| {
            let course = Course::of(known, next, index);
            course.leaves_rates() || course.leaves_curve()
        })
}

/// A polynomial at the next time, its variance there, and what it leaves of the known values over their variance.
struct Curve {
    next: f64,
    variance: f64,
    misfit: f64,
}

/// How one quantity goes on, from the last of the known rows.
struct Course {
    /// Time in s, value, and the weight of each: one over its variance.
    known: Vec<[f64; 3]>,
    next: [f64; 3],
    /// True of θ, which is known modulo π/2.
    is_angle: bool,
}

impl Course {
    /// That of the logarithm of a_A, of a_B over a_A, or of θ: a decay alone bends none of them.
    fn of(rows: &[Row], next: &Row, index: usize) -> Self {
        let last = rows.last().unwrap_or(next);
        let (start, _) = last.ratio();
        let point = |row: &Row, turned: f64| {
            let (value, deviation) = match index {
                0 => row.log_beside(last),
                1 => {
                    let (ratio, deviation) = row.ratio();
                    (ratio - start, deviation)
                }
                _ => (turned, row.deviations[2]),
            };
            [row.time - last.time, value, deviation.powi(-2)]
        };
        let mut turned = 0.0;
        let mut known = vec![point(last, 0.0)];
        for pair in rows.windows(2).rev() {
            turned -= turn(pair[1].angle - pair[0].angle);
            known.push(point(&pair[0], turned));
        }
        Self {
            known,
            next: point(next, turn(next.angle - last.angle)),
            is_angle: index == 2,
        }
    }

    /// How far the next value is, in mean distances of the known ones.
    fn distances(&self) -> f64 {
        let [first, ..] = self.known[self.known.len() - 1];
        self.next[0] / -first * (self.known.len() - 1) as f64
    }

    /// True where the next value is near and lies beside the parabola through the known ones: the further, the worse that fits these.
    fn leaves_curve(&self) -> bool {
        if self.known.len() < KNOWN || self.distances() >= NEAR {
            return false;
        }
        let (Some(parabola), Some(cubic)) = (self.curve(2), self.curve(3)) else {
            return false;
        };
        let [_, value, weight] = self.next;
        let mut beside = value - parabola.next;
        if self.is_angle {
            beside = turn(beside);
        }
        let deviation = (1.0 / weight + parabola.variance).sqrt() * parabola.misfit.max(1.0);
        let likely =
            APART.max(PER_DISTANCE * self.distances()) * (cubic.next - parabola.next).abs();
        beside.abs() > likely + SIGMAS * deviation
    }

    /// The polynomial of such a degree through the known values.
    fn curve(&self, degree: usize) -> Option<Curve> {
        let count = self.known.len();
        let [span, ..] = self.known[count - 1];
        // Of the time that is known: powers of it are then alike.
        let power = |time: f64, n: usize| (time / span).powi(n as i32);
        let rows = DMatrix::from_fn(count, degree + 1, |i, n| {
            let [time, _, weight] = self.known[i];
            power(time, n) * weight.sqrt()
        });
        let values = self
            .known
            .iter()
            .map(|[_, value, weight]| value * weight.sqrt());
        let values = DVector::from_iterator(count, values);
        let covariance = (rows.transpose() * &rows).try_inverse()?;
        let curve = &covariance * rows.transpose() * &values;
        let next = DVector::from_fn(degree + 1, |n, _| power(self.next[0], n));
        Some(Curve {
            next: next.dot(&curve),
            variance: next.dot(&(covariance * &next)),
            misfit: (values - rows * curve).norm_squared() / (count - degree - 1) as f64,
        })
    }

    /// True where the next value is further from the last one than so many times the fastest of the last changes goes.
    fn leaves_rates(&self) -> bool {
        let rates = self.known[..FEWEST]
            .windows(2)
            .map(|pair| ((pair[0][1] - pair[1][1]) / (pair[0][0] - pair[1][0])).abs());
        let [until, value, weight] = self.next;
        let likely = FASTER * rates.fold(0.0, f64::max) * until;
        let noise = (1.0 / weight + 1.0 / self.known[0][2]).sqrt();
        value.abs() > likely + SIGMAS * noise
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::deviates::Deviates;

    /// A row a second, whose quantity `index` is that, beside a decay of 2 % a second.
    fn row(time: f64, index: usize, value: f64, deviation: f64) -> Row {
        let mut values = [0.0; 3];
        values[index] = value;
        let main = (values[0] - 0.02 * time).exp();
        let of_amplitude = deviation * main;
        let deviations = [of_amplitude, of_amplitude, deviation];
        Row::of(time, [main, values[1] * main, values[2]], deviations)
    }

    /// Whether the course of quantity `index` jumps where `missing` rows are left out behind `count`.
    fn is_jump(index: usize, count: usize, missing: usize, course: impl Fn(f64) -> f64) -> bool {
        let row = |k: usize| row(k as f64, index, course(k as f64), 1e-4);
        let rows: Vec<Row> = (0..count).map(row).collect();
        jumps(&rows, &row(count + missing))
    }

    #[test]
    fn what_swings_is_hardly_ever_a_jump() {
        for (count, missing) in [
            (5, 1),
            (19, 2),
            (20, 1),
            (40, 1),
            (40, 2),
            (40, 5),
            (40, 10),
            (40, 20),
        ] {
            let [mut jumps, mut trials] = [0, 0];
            for (index, period) in (0..180).map(|k| (k as usize % 3, 3.0 * 1.08f64.powi(k / 3))) {
                for size in [1e-3, 1e-2, 0.1] {
                    for phase in 0..24 {
                        let turns = f64::from(phase) / 24.0;
                        let course = |t: f64| size * (TAU * (t / period + turns)).sin();
                        jumps += u32::from(is_jump(index, count, missing, course));
                        trials += 1;
                    }
                }
            }
            // A run that is cut in two costs little, and one that is not as much as the jump.
            let most = if missing < 8 {
                trials / 300
            } else {
                trials / 50
            };
            assert!(jumps <= most, "{count}, {missing}: {jumps} of {trials}");
        }
    }

    #[test]
    fn a_jump_is_seen_beside_noise_and_a_turn_of_any_rate() {
        let mut random = Deviates(3);
        for (index, rate) in [
            (0, 0.0),
            (0, -0.3),
            (1, 0.0),
            (1, 1e-2),
            (2, 0.0),
            (2, 0.3),
            (2, 1.0),
        ] {
            for count in [20, 40] {
                let [mut seen, mut false_ones] = [0, 0];
                for trial in 0..100 {
                    let noise: Vec<f64> = (0..50).map(|_| 1e-4 * random.draw()).collect();
                    let noise = &noise;
                    let course = |jump: f64| {
                        move |t: f64| {
                            let jumped = if t >= f64::from(count) { jump } else { 0.0 };
                            rate * t + noise[t as usize] + jumped
                        }
                    };
                    let count = count as usize;
                    let missing = 1 + trial % 2;
                    // Of 40 deviations.
                    seen += u32::from(is_jump(index, count, missing, course(4e-3)));
                    false_ones += u32::from(is_jump(index, count, missing, course(0.0)));
                }
                assert!(
                    seen >= 99 && false_ones == 0,
                    "{index}: {rate}, {seen}, {false_ones}"
                );
            }
        }
    }
}
