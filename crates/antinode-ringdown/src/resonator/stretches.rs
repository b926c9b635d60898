//! Joins rows of a run into stretches: the advance of the phase from row to row gives the frequency far better than the rows by themselves.

use std::f64::consts::TAU;

use super::by_energy::Point;
use crate::line::Times;
use crate::runs::Row;

/// Deviations of the phase's advance that must lie within half a turn: with fewer, the number of turns is ambiguous.
const MIN_KNOWN: f64 = 6.0;

/// The frequency of a row.
#[derive(Debug, Clone, Copy)]
pub struct RowFrequency<'a> {
    pub row: &'a Row,
    /// The part due to the splits, Hz.
    pub by_splits: f64,
    /// The same, averaged since the row before.
    pub by_splits_since: f64,
    /// One over the variance of the frequency, 1/Hz².
    pub weight: f64,
}

impl RowFrequency<'_> {
    fn energy(&self) -> f64 {
        self.row.main.powi(2) + self.row.quadrature.powi(2)
    }

    /// Turns of the phase up to the next row, beyond those of a frequency; `None` if they are ambiguous.
    fn run_on(&self, next: &Self, frequency: f64) -> Option<f64> {
        let (one, other) = (self.row, next.row);
        let seconds = other.time - one.time;
        let deviation = (0.5 * seconds * one.frequency_deviation.hypot(other.frequency_deviation))
            .hypot(one.phase_deviation.hypot(other.phase_deviation) / TAU);
        let expected = (0.5 * (one.frequency + other.frequency) - frequency) * seconds;
        let run = (one.phase? - other.phase?) / TAU - frequency * seconds - expected;
        (MIN_KNOWN * deviation < 0.5).then(|| expected + run - run.round())
    }
}

/// The stretches of a run, of at most `max_rows` rows; frequencies are relative to `from`, Hz.
pub fn stretches(run: &[RowFrequency], max_rows: usize, from: f64) -> Vec<Point> {
    let mut stretches = Vec::new();
    let mut begun: Option<Stretch> = None;
    for row_frequency in run {
        let is_taken = begun
            .as_mut()
            .is_some_and(|stretch| stretch.rows.len() < max_rows && stretch.join(row_frequency));
        if !is_taken {
            let done = begun.replace(Stretch::begin(row_frequency));
            stretches.extend(done.map(|done| done.point(from)));
        }
    }
    stretches.extend(begun.map(|last| last.point(from)));
    stretches
}

/// Rows whose phases are joined.
struct Stretch<'a> {
    rows: Vec<RowFrequency<'a>>,
    /// Integrals from the first row to each: of turns beyond those of the first row's frequency and of the splits, of the energy, and of
    /// the time.
    run: Vec<[f64; 3]>,
}

impl<'a> Stretch<'a> {
    fn begin(first: &RowFrequency<'a>) -> Self {
        Self {
            rows: vec![*first],
            run: vec![[0.0; 3]],
        }
    }

    /// Joins a row, if the turns of its phase are not ambiguous.
    fn join(&mut self, next: &RowFrequency<'a>) -> bool {
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let Some(turns) = last.run_on(next, first.row.frequency) else {
            return false;
        };
        let seconds = next.row.time - last.row.time;
        let mean = |of: fn(&RowFrequency) -> f64| 0.5 * (of(&last) + of(next));
        let since = mean(|row_frequency| row_frequency.row.time) - first.row.time;
        let [all, energy, time] = self.run[self.run.len() - 1];
        self.run.push([
            all + turns - next.by_splits_since * seconds,
            energy + mean(|row_frequency| row_frequency.energy()) * seconds,
            time + since * seconds,
        ]);
        self.rows.push(*next);
        true
    }

    /// The frequency from its phases and from its rows' own frequencies, relative to `from`, Hz.
    fn point(&self, from: f64) -> Point {
        let first = self.rows[0].row;
        let (mut weight, mut sums) = (0.0, [0.0; 3]);
        let mut add = |more: f64, values: [f64; 3]| {
            weight += more;
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += more * value;
            }
        };
        for row_frequency in &self.rows {
            let own = row_frequency.row.frequency - first.frequency - row_frequency.by_splits;
            add(
                row_frequency.weight,
                [
                    own,
                    row_frequency.energy(),
                    row_frequency.row.time - first.time,
                ],
            );
        }
        // The slopes of straight lines through the integrals, weighted by the noise of the phases.
        let times = Times::new(self.rows.iter().map(|row_frequency| {
            let row = row_frequency.row;
            [(TAU / row.phase_deviation).powi(2), row.time - first.time]
        }));
        if times.along > 0.0 {
            let slope = |i: usize| times.line(self.run.iter().map(|run| run[i])).0;
            add(times.along, std::array::from_fn(slope));
        }
        let [excess, energy, time] = sums.map(|sum| sum / weight);
        Point {
            time: first.time + time,
            weight,
            energy,
            excess: first.frequency - from + excess,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use antinode_sim::Deviates;

    /// Seconds between rows, and the deviations of a row of that length: of its phase, rad, and of its frequency, Hz.
    const EVERY: f64 = 0.01;
    const OF_PHASE: f64 = 1e-3;
    const OF_FREQUENCY: f64 = 3.464 * OF_PHASE / (TAU * EVERY);

    /// A row whose phase has run this many turns.
    fn row(time: f64, frequency: f64, turns: f64, random: &mut Deviates) -> Row {
        let turn = |turns: f64| TAU * (turns - turns.round());
        Row {
            time,
            main: 1.0,
            quadrature: 0.1,
            angle: 0.3,
            phase: Some(turn(-turns + OF_PHASE * random.draw() / TAU)),
            phase_deviation: OF_PHASE,
            frequency: frequency + OF_FREQUENCY * random.draw(),
            frequency_deviation: OF_FREQUENCY,
            deviations: [1e-3; 3],
            seconds: EVERY,
            bow: Default::default(),
        }
    }

    /// Rows of a frequency that is 5332.1 Hz at first and drifts by 10 mHz/s.
    fn rows(count: usize, seed: u64) -> Vec<Row> {
        let mut random = Deviates::new(seed);
        let times = (0..count).map(|k| EVERY * k as f64);
        times
            .map(|time| {
                let turns = 5332.1 * time + 0.005 * time * time;
                row(100.0 + time, 5332.1 + 0.01 * time, turns, &mut random)
            })
            .collect()
    }

    fn row_frequency(rows: &[Row]) -> Vec<RowFrequency<'_>> {
        let weight = OF_FREQUENCY.powi(-2);
        let row_frequency = rows.iter().map(|row| RowFrequency {
            row,
            by_splits: 0.02,
            by_splits_since: 0.02,
            weight,
        });
        row_frequency.collect()
    }

    #[test]
    fn phases_improve_the_frequency_by_as_many_times_as_a_stretch_has_rows() {
        let (mut squares, mut count, mut min) = (0.0, 0.0, f64::INFINITY);
        for seed in 0..20 {
            let rows = rows(3000, seed);
            let seen = stretches(&row_frequency(&rows), 30, 5330.0);
            assert_eq!(seen.len(), 100);
            for seen in &seen {
                let truth = 5332.1 + 0.01 * (seen.time - 100.0) - 0.02 - 5330.0;
                squares += (seen.excess - truth).powi(2) * seen.weight;
                count += 1.0;
                min = min.min(seen.weight);
                assert!((seen.energy - 1.01).abs() < 1e-12);
            }
        }
        let rms = f64::sqrt(squares / count);
        assert!((0.95..1.05).contains(&rms), "{rms}");
        // By the mean of 30 rows alone, the weight would be 30 times that of one.
        let gain = f64::sqrt(min * OF_FREQUENCY.powi(2) / 30.0);
        assert!((28.0..33.0).contains(&gain), "{gain}");
    }

    #[test]
    fn ambiguous_phases_are_not_joined() {
        let mut rows = rows(3000, 1);
        for row in &mut rows[1000..] {
            // A gap so long that turns may be missed: half a turn is four deviations.
            row.time += 3.2;
        }
        for row in &mut rows[2000..] {
            row.phase = None;
        }
        let seen = stretches(&row_frequency(&rows), 30, 5330.0);
        // 1000 and 1000 rows in stretches of 30, and 1000 by themselves.
        assert_eq!(seen.len(), 34 + 34 + 1000);
        for seen in &seen[2 * 34..] {
            assert!((seen.weight * OF_FREQUENCY.powi(2) - 1.0).abs() < 1e-9);
        }
        for seen in &seen[..2 * 34] {
            let late = if seen.time > 111.6 { 3.2 } else { 0.0 };
            let truth = 5332.1 + 0.01 * (seen.time - late - 100.0) - 0.02 - 5330.0;
            assert!((seen.excess - truth).abs() < 5.0 / seen.weight.sqrt());
        }
    }
}
