//! Rows of a run become stretches: how far the phase runs on from row to row tells the frequency far better than the rows by themselves.

use std::f64::consts::TAU;

use super::by_energy::Seen;
use super::line::Times;
use crate::runs::Row;

/// Deviations of what the phase runs on by that must lie within half a turn: else nobody knows how many turns it was.
const KNOWN: f64 = 6.0;

/// What a row tells of the frequency.
#[derive(Debug, Clone, Copy)]
pub struct Told<'a> {
    pub row: &'a Row,
    /// What splits make of it, Hz.
    pub by_splits: f64,
    /// The same, on average since the row before.
    pub by_splits_since: f64,
    /// One over the variance of the frequency, 1/Hz².
    pub weight: f64,
}

impl Told<'_> {
    fn energy(&self) -> f64 {
        self.row.main.powi(2) + self.row.quadrature.powi(2)
    }

    /// The turns by which the phase runs beyond those of a frequency up to the next row; none where they are not known.
    fn run_on(&self, next: &Self, frequency: f64) -> Option<f64> {
        let (one, other) = (self.row, next.row);
        let seconds = other.time - one.time;
        let deviation = (0.5 * seconds * one.frequency_deviation.hypot(other.frequency_deviation))
            .hypot(one.phase_deviation.hypot(other.phase_deviation) / TAU);
        let expected = (0.5 * (one.frequency + other.frequency) - frequency) * seconds;
        let run = (one.phase? - other.phase?) / TAU - frequency * seconds - expected;
        (KNOWN * deviation < 0.5).then(|| expected + run - run.round())
    }
}

/// The stretches of a run, of so many rows at the most; frequencies are beyond `from`, Hz.
pub fn stretches(run: &[Told], most: usize, from: f64) -> Vec<Seen> {
    let mut stretches = Vec::new();
    let mut begun: Option<Stretch> = None;
    for told in run {
        let is_taken = begun
            .as_mut()
            .is_some_and(|stretch| stretch.rows.len() < most && stretch.takes(told));
        if !is_taken {
            let done = begun.replace(Stretch::begin(told));
            stretches.extend(done.map(|done| done.seen(from)));
        }
    }
    stretches.extend(begun.map(|last| last.seen(from)));
    stretches
}

/// Rows whose phases are joined.
struct Stretch<'a> {
    rows: Vec<Told<'a>>,
    /// What each has run up to since the first: the turns beyond those of the first one's frequency and of splits, and the integrals of the
    /// energy and of the time.
    run: Vec<[f64; 3]>,
}

impl<'a> Stretch<'a> {
    fn begin(first: &Told<'a>) -> Self {
        Self {
            rows: vec![*first],
            run: vec![[0.0; 3]],
        }
    }

    /// Takes a row, if its phase joins those before.
    fn takes(&mut self, next: &Told<'a>) -> bool {
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let Some(turns) = last.run_on(next, first.row.frequency) else {
            return false;
        };
        let seconds = next.row.time - last.row.time;
        let mean = |of: fn(&Told) -> f64| 0.5 * (of(&last) + of(next));
        let since = mean(|told| told.row.time) - first.row.time;
        let [all, energy, time] = self.run[self.run.len() - 1];
        self.run.push([
            all + turns - next.by_splits_since * seconds,
            energy + mean(|told| told.energy()) * seconds,
            time + since * seconds,
        ]);
        self.rows.push(*next);
        true
    }

    /// What it tells, of its phases and of its rows' own frequencies; frequencies are beyond `from`, Hz.
    fn seen(&self, from: f64) -> Seen {
        let first = self.rows[0].row;
        let (mut weight, mut sums) = (0.0, [0.0; 3]);
        let mut add = |more: f64, values: [f64; 3]| {
            weight += more;
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += more * value;
            }
        };
        for told in &self.rows {
            let own = told.row.frequency - first.frequency - told.by_splits;
            add(
                told.weight,
                [own, told.energy(), told.row.time - first.time],
            );
        }
        // The slopes of the straight lines through what was run up to, by as much as the noise of the phases leaves.
        let times = Times::new(self.rows.iter().map(|told| {
            let row = told.row;
            [(TAU / row.phase_deviation).powi(2), row.time - first.time]
        }));
        if times.along > 0.0 {
            let slope = |i: usize| times.slope(self.run.iter().map(|run| run[i]));
            add(times.along, std::array::from_fn(slope));
        }
        let [beyond, energy, time] = sums.map(|sum| sum / weight);
        Seen {
            time: first.time + time,
            weight,
            energy,
            beyond: first.frequency - from + beyond,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deviates::Deviates;

    /// Seconds between rows, and the deviations of a row of that length: of its phase, rad, and of its frequency, Hz.
    const EVERY: f64 = 0.01;
    const OF_PHASE: f64 = 1e-3;
    const OF_FREQUENCY: f64 = 3.464 * OF_PHASE / (TAU * EVERY);

    /// A row at a time whose phase has run so many turns.
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
        let mut random = Deviates(seed);
        let times = (0..count).map(|k| EVERY * k as f64);
        times
            .map(|time| {
                let turns = 5332.1 * time + 0.005 * time * time;
                row(100.0 + time, 5332.1 + 0.01 * time, turns, &mut random)
            })
            .collect()
    }

    fn told(rows: &[Row]) -> Vec<Told<'_>> {
        let weight = OF_FREQUENCY.powi(-2);
        let told = rows.iter().map(|row| Told {
            row,
            by_splits: 0.02,
            by_splits_since: 0.02,
            weight,
        });
        told.collect()
    }

    #[test]
    fn phases_tell_the_frequency_as_many_times_better_as_a_stretch_has_rows() {
        let (mut squares, mut count, mut least) = (0.0, 0.0, f64::INFINITY);
        for seed in 0..20 {
            let rows = rows(3000, seed);
            let seen = stretches(&told(&rows), 30, 5330.0);
            assert_eq!(seen.len(), 100);
            for seen in &seen {
                let truth = 5332.1 + 0.01 * (seen.time - 100.0) - 0.02 - 5330.0;
                squares += (seen.beyond - truth).powi(2) * seen.weight;
                count += 1.0;
                least = least.min(seen.weight);
                assert!((seen.energy - 1.01).abs() < 1e-12);
            }
        }
        let rms = f64::sqrt(squares / count);
        assert!((0.95..1.05).contains(&rms), "{rms}");
        // Of the mean of 30 rows it would be 30 times one's.
        let gain = f64::sqrt(least * OF_FREQUENCY.powi(2) / 30.0);
        assert!((28.0..33.0).contains(&gain), "{gain}");
    }

    #[test]
    fn phases_that_do_not_join_are_not_joined() {
        let mut rows = rows(3000, 1);
        for row in &mut rows[1000..] {
            // So long a gap that turns may be missed.
            row.time += 10.0;
        }
        for row in &mut rows[2000..] {
            row.phase = None;
        }
        let seen = stretches(&told(&rows), 30, 5330.0);
        // 1000 and 1000 rows by 30, and 1000 by themselves.
        assert_eq!(seen.len(), 34 + 34 + 1000);
        for seen in &seen[2 * 34..] {
            assert!((seen.weight * OF_FREQUENCY.powi(2) - 1.0).abs() < 1e-9);
        }
        for seen in &seen[..2 * 34] {
            let late = if seen.time > 115.0 { 10.0 } else { 0.0 };
            let truth = 5332.1 + 0.01 * (seen.time - late - 100.0) - 0.02 - 5330.0;
            assert!((seen.beyond - truth).abs() < 5.0 / seen.weight.sqrt());
        }
    }
}
