//! Detection of jumps of the wave across rows that are left out or missing: a fault in their windows may have changed it.

use nalgebra::{DMatrix, DVector};

use super::{Row, turn};

/// Rows that show how fast the wave changes.
const RATE_ROWS: usize = 5;
/// Rows that show the course of the wave: fewer may lie on a parabola by chance.
const CURVE_ROWS: usize = 20;
/// Gap, in distances of rows, below which that parabola is extrapolated.
const MAX_DISTANCE: f64 = 8.5;
/// Distance from the parabola that is allowed, as multiples of that between it and a cubic: at least, and per distance of rows. A swing
/// follows neither for long.
const MIN_ALLOWED: f64 = 3.0;
const ALLOWED_PER_DISTANCE: f64 = 1.3;
/// Rate of change that is allowed, as a multiple of the fastest of the last ones.
const MAX_RATE: f64 = 3.0;
/// Deviations by which a change may exceed what is allowed.
const SIGMAS: f64 = 8.0;

/// True if the main amplitude, the quadrature amplitude or the angle jumps from the last of the `rows` of a run to `next`; false if
/// the run is too short to tell.
pub fn jumps(rows: &[Row], next: &Row) -> bool {
    let known = &rows[rows.len().saturating_sub(CURVE_ROWS)..];
    known.len() >= RATE_ROWS
        && (0..3).any(|index| {
            let course = Course::of(known, next, index);
            course.leaves_rates() || course.leaves_curve()
        })
}

/// A polynomial through known values: its value and variance at the next time, and its mean squared residual over their variances.
struct Curve {
    next: f64,
    variance: f64,
    misfit: f64,
}

/// The course of one quantity, relative to the last of the known rows.
struct Course {
    /// Time in s, value, and the weight of each: one over its variance.
    known: Vec<[f64; 3]>,
    next: [f64; 3],
    /// True for θ, which is known modulo π/2.
    is_angle: bool,
}

impl Course {
    /// The course of ln a_A, of a_B over a_A, or of θ, for an `index` of 0 to 2: a decay alone bends none of them.
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

    /// The time to the next value, in mean distances of the known ones.
    fn distances(&self) -> f64 {
        let [first, ..] = self.known[self.known.len() - 1];
        self.next[0] / -first * (self.known.len() - 1) as f64
    }

    /// True if the next value is near and lies off the parabola through the known ones; a parabola that fits these worse allows for more.
    fn leaves_curve(&self) -> bool {
        if self.known.len() < CURVE_ROWS || self.distances() >= MAX_DISTANCE {
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
        let allowed = MIN_ALLOWED.max(ALLOWED_PER_DISTANCE * self.distances())
            * (cubic.next - parabola.next).abs();
        beside.abs() > allowed + SIGMAS * deviation
    }

    /// The polynomial of this degree through the known values.
    fn curve(&self, degree: usize) -> Option<Curve> {
        let count = self.known.len();
        let [span, ..] = self.known[count - 1];
        // In units of the known span, powers of time are alike in size.
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

    /// True if the next value is further from the last one than a multiple of the fastest of the last rates allows.
    fn leaves_rates(&self) -> bool {
        let rates = self.known[..RATE_ROWS]
            .windows(2)
            .map(|pair| ((pair[0][1] - pair[1][1]) / (pair[0][0] - pair[1][0])).abs());
        let [until, value, weight] = self.next;
        let allowed = MAX_RATE * rates.fold(0.0, f64::max) * until;
        let noise = (1.0 / weight + 1.0 / self.known[0][2]).sqrt();
        value.abs() > allowed + SIGMAS * noise
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use antinode_sim::Deviates;

    /// A row whose quantity `index` has this value, beside a decay of 2 % a second.
    fn row(time: f64, index: usize, value: f64, deviation: f64) -> Row {
        let mut values = [0.0; 3];
        values[index] = value;
        let main = (values[0] - 0.02 * time).exp();
        let of_amplitude = deviation * main;
        let deviations = [of_amplitude, of_amplitude, deviation];
        Row::of(time, [main, values[1] * main, values[2]], deviations)
    }

    /// Whether a course of quantity `index`, with a row a second, seems to jump across `missing` rows after `count`.
    fn is_jump(index: usize, count: usize, missing: usize, course: impl Fn(f64) -> f64) -> bool {
        let row = |k: usize| row(k as f64, index, course(k as f64), 1e-4);
        let rows: Vec<Row> = (0..count).map(row).collect();
        jumps(&rows, &row(count + missing))
    }

    #[test]
    fn a_swing_is_hardly_ever_a_jump() {
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
            // A run cut in two for nothing costs little; a jump that is missed costs as much as it is large.
            let max = if missing < 8 {
                trials / 300
            } else {
                trials / 50
            };
            assert!(jumps <= max, "{count}, {missing}: {jumps} of {trials}");
        }
    }

    #[test]
    fn across_a_long_gap_the_rates_before_it_tell() {
        // A change that comes at another rate behind these rows.
        let bent = |rate: f64| move |t: f64| 1e-3 * t + (rate - 1e-3) * (t - 39.0).max(0.0);
        for index in 0..3 {
            for (missing, rate, is_seen) in [
                (5, 2e-3, true),
                (9, 2e-3, false),
                (20, 2e-3, false),
                (40, 2e-3, false),
                (9, 5e-3, true),
                (40, 5e-3, true),
            ] {
                // The amplitude decays besides.
                let decay = if index == 0 { 0.02 } else { 0.0 };
                let seen = is_jump(index, 40, missing, |t| decay * t + bent(rate)(t));
                assert_eq!(seen, is_seen, "{index}, {missing}, {rate}");
            }
        }
    }

    #[test]
    fn a_jump_is_seen_beside_noise_and_a_turn_of_any_rate() {
        let mut random = Deviates::new(3);
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
                    // A jump of 40 deviations.
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
