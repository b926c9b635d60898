//! Parts of a recording in which something drives the wave: one of several ring-downs also holds their excitation.

use super::{MIN_ROWS, Row, Run, turn};
use crate::line::Times;

/// Deviations by which a decay, or the lack of one, must be significant.
const SIGNIFICANT: f64 = 10.0;
/// Share of the smallest significant decay below which there is none: the two modes of one resonator never differ that much.
const NO_DECAY: f64 = 0.1;
/// Places tried at a time in the search for a corner.
const TRIED_PLACES: usize = 32;
/// Deviation of a row, at least, as a share of that of the row before.
const MIN_DEVIATION: f64 = 0.5;

/// The energy E of the wave in a row: for a pattern at any angle, circular or not, it decays evenly.
#[derive(Debug, Clone, Copy)]
pub struct Energy {
    /// Time, s.
    pub time: f64,
    /// Half the logarithm of E, which decays as an amplitude does, and its standard deviation.
    pub log: f64,
    pub deviation: f64,
    /// The pattern's angle, rad, modulo π/2.
    pub angle: f64,
}

impl Run {
    /// The energy of the wave in each row.
    pub fn energies(&self) -> Vec<Energy> {
        let energy = |row: &Row| {
            let [of_main, of_quadrature, _] = row.deviations;
            let energy = row.main.powi(2) + row.quadrature.powi(2);
            Energy {
                time: row.time,
                log: 0.5 * energy.ln(),
                deviation: (row.main * of_main).hypot(row.quadrature * of_quadrature) / energy,
                angle: row.angle,
            }
        };
        let mut energies: Vec<_> = self.rows.iter().map(energy).collect();
        // An outlier may state next to no deviation.
        for index in 1..energies.len() {
            let min = MIN_DEVIATION * energies[index - 1].deviation;
            energies[index].deviation = energies[index].deviation.max(min);
        }
        energies
    }
}

/// A straight line through the logarithms of energies.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// Decay rate, 1/s, and what noise and flaws of the pick-offs may add to it.
    decay: f64,
    noise: f64,
    flaws: f64,
    /// Weighted sum of squared residuals, and the same per degree of freedom.
    squares: f64,
    misfit: f64,
}

impl Line {
    /// Fits the line; flaws of the pick-offs change an amplitude by the share `by_flaws` per radian that the pattern turns.
    fn through(energies: &[Energy], by_flaws: f64) -> Self {
        let each = energies.iter();
        let times = Times::new(each.clone().map(|one| [one.deviation.powi(-2), one.time]));
        let (slope, squares) = times.line(each.map(|one| one.log));
        let misfit = squares / energies.len().saturating_sub(2).max(1) as f64;
        let (mut angle, mut min, mut max) = (0.0, 0f64, 0f64);
        for pair in energies.windows(2) {
            angle += turn(pair[1].angle - pair[0].angle);
            (min, max) = (min.min(angle), max.max(angle));
        }
        let seconds = energies[energies.len() - 1].time - energies[0].time;
        Self {
            decay: -slope,
            noise: SIGNIFICANT * (misfit.max(1.0) / times.along).sqrt(),
            flaws: by_flaws * (max - min) / seconds,
            squares,
            misfit,
        }
    }

    /// True if there is no decay, compared with one of this rate, 1/s.
    fn is_driven_beside(&self, decay: f64) -> bool {
        self.decay + self.noise + self.flaws < NO_DECAY * decay
    }

    /// True if there is no decay, but a significant one on the other side of a bend.
    fn is_driven_unlike(&self, other: &Self) -> bool {
        self.is_driven_beside(other.decay - other.noise - other.flaws) && other.is_decay()
    }

    /// True if the decay is significant.
    fn is_decay(&self) -> bool {
        self.decay > self.noise
    }
}

/// Mean squared residual of a line through energies, over their own deviations: 1 in noise alone.
pub fn unevenness(energies: &[Energy]) -> f64 {
    Line::through(energies, 0.0).misfit
}

/// The place where energies change from driven to decaying or back, if there is one, and the rows a side in which it shows; fewer than
/// `side` are not tried.
fn bend(energies: &[Energy], mut side: usize, by_flaws: f64) -> Option<(usize, usize)> {
    loop {
        // The bend itself may lie anywhere between both sides.
        let apart = (side / 8).max(1);
        let whole = 2 * (side + apart);
        if whole > energies.len() {
            return None;
        }
        for from in (0..=energies.len() - whole).step_by(apart) {
            let about = &energies[from..from + whole];
            let before = Line::through(&about[..side], by_flaws);
            let after = Line::through(&about[whole - side..], by_flaws);
            if before.is_driven_unlike(&after) || after.is_driven_unlike(&before) {
                return Some((from + corner(about, side / 2), side));
            }
        }
        side *= 2;
    }
}

/// The place where two lines through energies meet, at least `end` rows from either end.
fn corner(energies: &[Energy], end: usize) -> usize {
    let squares = |at: usize| {
        let sides = [&energies[..at], &energies[at + 1..]];
        sides
            .map(|side| Line::through(side, 0.0).squares)
            .iter()
            .sum()
    };
    let mut places = end..energies.len() - end;
    loop {
        let apart = (places.len() / TRIED_PLACES).max(1);
        let sums = places.clone().step_by(apart).map(|at| (at, squares(at)));
        let best = sums.min_by(|(_, one): &(_, f64), (_, other)| one.total_cmp(other));
        let (at, _) = best.unwrap_or((end, 0.0));
        if apart == 1 {
            return at;
        }
        places = places.start.max(at - apart)..places.end.min(at + apart + 1);
    }
}

/// Splits the runs at bends: returns the decaying parts and the driven ones. If nothing is driven, returns the runs as they are.
pub fn undriven(runs: &[Run], energies: &[Vec<Energy>], by_flaws: f64) -> [Vec<Run>; 2] {
    let mut parts = Vec::new();
    for (run, energies) in runs.iter().zip(energies) {
        let mut left = vec![(0..run.rows.len(), MIN_ROWS)];
        while let Some((range, side)) = left.pop() {
            match bend(&energies[range.clone()], side, by_flaws) {
                // The row at the bend may hold some of both; with fewer rows a side, the whole range shows none.
                Some((at, side)) => left.extend([
                    (range.start + at + 1..range.end, side),
                    (range.start..range.start + at, side),
                ]),
                None if range.len() >= MIN_ROWS => parts.push((run, energies, range)),
                None => {}
            }
        }
    }
    let lines = parts
        .iter()
        .map(|(_, energies, range)| Line::through(&energies[range.clone()], by_flaws));
    let lines: Vec<_> = lines.collect();
    let decays = lines.iter().filter(|line| line.is_decay());
    let smallest = decays.map(|line| line.decay).fold(f64::INFINITY, f64::min);
    let is_driven = |line: &Line| smallest.is_finite() && line.is_driven_beside(smallest);
    if !lines.iter().any(is_driven) {
        return [runs.to_vec(), Vec::new()];
    }
    let mut found = [Vec::new(), Vec::new()];
    for ((run, _, range), line) in parts.into_iter().zip(&lines) {
        found[usize::from(is_driven(line))].push(run.with(run.rows[range].to_vec()));
    }
    found
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use antinode_sim::Deviates;

    /// Energies a second apart, with half the logarithm and the angle that `wave` gives, and noise of 10⁻⁴.
    fn energies(count: usize, seed: u64, wave: impl Fn(f64) -> [f64; 2]) -> Vec<Energy> {
        let mut random = Deviates::new(seed);
        let energy = |k: usize| {
            let time = k as f64;
            let [log, angle] = wave(time);
            Energy {
                time,
                log: log + 1e-4 * random.draw(),
                deviation: 1e-4,
                angle,
            }
        };
        (0..count).map(energy).collect()
    }

    #[test]
    fn the_beginning_or_end_of_a_drive_is_found() {
        for seed in 0..60 {
            let at = 40.0 + 1.7 * seed as f64;
            // The drive holds the wave, or makes it grow, until then or from then on.
            for [before, after] in [[0.0, -2e-3], [3e-3, -2e-3], [-2e-3, 0.0], [-2e-3, 3e-3]] {
                let found = energies(200, seed, |time| {
                    let later = time - at;
                    [before * later.min(0.0) + after * later.max(0.0), 0.3]
                });
                let bend = bend(&found, MIN_ROWS, 0.3).unwrap().0 as f64;
                assert!((bend - at).abs() < 3.0, "{before}, {after}, {at}: {bend}");
            }
        }
    }

    #[test]
    fn a_corner_is_found_to_the_row_among_many() {
        for count in [40, 500, 4000] {
            for share in [0.25, 0.5, 0.61, 0.8] {
                let at = (share * count as f64).round();
                let held = energies(count, 5, |time| [-2e-2 * (time - at).max(0.0), 0.3]);
                let found = corner(&held, MIN_ROWS / 2);
                assert!((found as f64 - at).abs() <= 1.0, "{count}, {at}: {found}");
            }
        }
    }

    #[test]
    fn ring_downs_of_any_length_are_parted_from_the_drives_between_them() {
        for seed in 0..60 {
            let mut random = Deviates::new(seed);
            // Rows at which a decay or drive begins, from 250 to 2500 rows later each.
            let mut begins = vec![0];
            for _ in 0..8 {
                let length = 250.0 * random.draw().abs().exp().min(10.0);
                begins.push(begins[begins.len() - 1] + length as usize);
            }
            let mut logs = vec![0.0];
            for (index, part) in begins.windows(2).enumerate() {
                // A slow decay, whose end only many rows show, and faster ones.
                let rate = match index {
                    0 => -2e-5,
                    1 | 3 | 5 | 7 => [0.0, 3e-3][(seed % 2) as usize],
                    _ => -2e-3,
                };
                for _ in part[0]..part[1] {
                    logs.push(logs[logs.len() - 1] + rate);
                }
            }
            let energies = energies(logs.len(), seed, |time| [logs[time as usize], 0.3]);
            let run = Run {
                rows: (0..logs.len())
                    .map(|k| Row::of(k as f64, [1.0, 0.0, 0.0], [1e-3; 3]))
                    .collect(),
                file: "a".to_owned(),
            };
            let found = undriven(&[run], &[energies], 0.3);
            for (index, part) in begins.windows(2).enumerate() {
                let spans = found[index % 2].iter();
                let spans = spans.map(|run| [run.rows[0].time, run.rows[run.rows.len() - 1].time]);
                let is_found = spans.clone().any(|[from, to]| {
                    (from - part[0] as f64).abs() < 30.0 && (to - part[1] as f64).abs() < 30.0
                });
                let spans: Vec<_> = spans.collect();
                assert!(is_found, "{seed}: {part:?} of {begins:?} in {spans:?}");
            }
            assert_eq!(found.map(|runs| runs.len()), [4, 4]);
        }
    }

    #[test]
    fn decays_swings_and_tables_that_start_have_no_bends() {
        for seed in 0..100 {
            let begins = 20.0 + f64::from(seed);
            let rate = 0.01 * f64::from(seed % 10);
            let period = 10.0 * 1.04f64.powi(seed);
            // Gains that differ by 10 %, or damping that falls to a third.
            let flaw = 0.05 * f64::from(seed % 3 - 1);
            let found = energies(300, seed as u64, |time| {
                let later = (time - begins).max(0.0);
                let angle = match seed % 4 {
                    0 => 0.0,
                    1 => 0.3 * (TAU * time / period).sin(),
                    _ => rate * later,
                };
                let damped = if seed % 4 == 0 { 2e-3 * later } else { 0.0 };
                [
                    flaw * (2.0 * angle).sin().powi(2) - 3e-3 * time + damped,
                    angle,
                ]
            });
            assert_eq!(bend(&found, MIN_ROWS, 0.3), None, "{seed}");
        }
    }
}
