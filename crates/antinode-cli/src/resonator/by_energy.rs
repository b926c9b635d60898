//! How the frequency moves with the energy, beside a drift with time: as the wave decays both fall together.
//!
//! So each run gets powers of time of its own, and the energy what these leave: a straight line where no drift is seen, for a slow one would
//! not be, and as many powers as are seen where one is, two at least. What powers beyond those would still take off is not noise, and
//! widens the deviation. Only where the turning of patterns by their amplitudes says the same, all that goes with the energy is the energy's;
//! where it says another, or that there is none, the energy's part is not told: a temperature that settles may fall just as the energy does.

use super::ALIKE_SEEN;
use super::found::Measured;

/// Powers of time beside the energy where no drift is seen, at the least and at the most where one is, and those looked at.
const UNSEEN_POWER: usize = 1;
const LEAST_POWER: usize = 2;
const MOST_POWER: usize = 6;
const POWERS: usize = 8;
/// Deviations by which it may differ from what the turning says, seen or not.
const AGREES: f64 = 3.0;
/// Deviations by which the squares that terms take off are more than chance makes them.
const SEEN: f64 = 2.0;

/// What a row tells.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// s.
    pub time: f64,
    /// One over the variance of the frequency, 1/Hz², or 1 where that is not known.
    pub weight: f64,
    /// a_A² + a_B².
    pub energy: f64,
    /// The frequency beyond some value and what splits make of it, Hz.
    pub beyond: f64,
}

/// What the frequency is above that at rest, Hz, at an energy of one input unit squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ByEnergy {
    /// It moves so by chance.
    Chance,
    /// As the turning of patterns says, and no drift is seen: one of this many Hz/s, were there one, is one deviation.
    Alone(Measured, f64),
    /// Beside a drift, seen or not.
    Beside(Measured),
    /// It may be a drift.
    Untold,
    /// It is one, or of another cause: by the turning of patterns it would be another.
    Denied,
}

impl ByEnergy {
    /// The value, where it is told.
    pub fn told(self) -> Option<Measured> {
        match self {
            Self::Alone(by, _) | Self::Beside(by) => Some(by),
            Self::Chance | Self::Untold | Self::Denied => None,
        }
    }
}

/// Finds it from the rows of each run, where it is seen in what [`beside_one_mean`] of them has; `is_told` where their weights are known,
/// `by_turning` what the turning says.
pub fn by_energy(
    runs: &[Vec<Seen>],
    (alone, of_drift): (Sums, f64),
    is_told: bool,
    by_turning: Option<Measured>,
) -> ByEnergy {
    let beside = beside_powers(runs);
    let (rows, count): (usize, usize) = (runs.iter().map(Vec::len).sum(), runs.len());
    let scatter = |sums: &Sums, unknowns: usize| {
        let scatter = sums.left() / (rows - unknowns) as f64;
        if is_told { scatter.max(1.0) } else { scatter }
    };
    let noise = scatter(&beside[POWERS], (POWERS + 1) * count + 1);
    let is_more = |before: &Sums, after: usize, terms: usize| {
        let chance = terms as f64 + SEEN * (2.0 * terms as f64).sqrt();
        before.left() - beside[after].left() > chance * noise
    };
    let is_drift = is_more(&alone, LEAST_POWER, (LEAST_POWER + 1) * count - 1);
    let (value, std) = alone.measured(scatter(&alone, 2));
    let is_turned = by_turning.is_some_and(|(said, of_said)| said.abs() > SEEN * of_said);
    let is_denied = |(value, std): Measured| {
        by_turning.is_some_and(|(said, of_said)| (value - said).abs() > AGREES * std.hypot(of_said))
    };
    if !is_drift && is_turned && !is_denied((value, std)) {
        return ByEnergy::Alone((value, std), std / of_drift.abs());
    }
    let mut powers = LEAST_POWER..=MOST_POWER;
    let enough = powers.find(|&power| !is_more(&beside[power], power + 2, 2 * count));
    let Some(power) = (if is_drift { enough } else { Some(UNSEEN_POWER) }) else {
        return ByEnergy::Untold;
    };
    let slow = beside[power].left() - beside[POWERS].left();
    let slow = slow / ((POWERS - power) * count) as f64;
    let widened = scatter(&beside[power], (power + 1) * count + 1).max(slow);
    if beside[power].is_seen(widened) {
        let by_energy = beside[power].measured(widened);
        if is_denied(by_energy) {
            ByEnergy::Denied
        } else {
            ByEnergy::Beside(by_energy)
        }
    } else {
        ByEnergy::Untold
    }
}

/// Sums over all rows of products of the energy and the frequency beyond, from which something was taken out.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sums {
    of_energy: f64,
    product: f64,
    of_beyond: f64,
}

impl Sums {
    fn add(&mut self, weight: f64, energy: f64, beyond: f64) {
        self.of_energy += weight * energy * energy;
        self.product += weight * energy * beyond;
        self.of_beyond += weight * beyond * beyond;
    }

    /// The squares that go with the energy.
    pub fn along(&self) -> f64 {
        self.product * self.product / self.of_energy
    }

    /// True where these are beyond chance, where rows scatter so.
    pub fn is_seen(&self, scatter: f64) -> bool {
        self.along() > ALIKE_SEEN * ALIKE_SEEN * scatter
    }

    /// The squares that do not.
    fn left(&self) -> f64 {
        self.of_beyond - self.along()
    }

    /// What the frequency moves by per energy, where rows scatter so.
    fn measured(&self, scatter: f64) -> Measured {
        (
            self.product / self.of_energy,
            (scatter / self.of_energy).sqrt(),
        )
    }
}

/// The sums beside one mean of all, and by what a drift of 1 Hz/s in every run moves what the frequency seems to do with the energy.
pub fn beside_one_mean(runs: &[Vec<Seen>]) -> (Sums, f64) {
    let (mut weights, mut means) = (0.0, [0.0; 2]);
    for seen in runs.iter().flatten() {
        weights += seen.weight;
        means[0] += seen.weight * seen.energy;
        means[1] += seen.weight * seen.beyond;
    }
    let mut sums = Sums::default();
    let mut along_time = 0.0;
    for run in runs {
        for seen in run {
            let energy = seen.energy - means[0] / weights;
            sums.add(seen.weight, energy, seen.beyond - means[1] / weights);
            along_time += seen.weight * energy * (seen.time - run[0].time);
        }
    }
    (sums, along_time / sums.of_energy)
}

/// The sums beside each run's own mean and powers of time, up to each power.
fn beside_powers(runs: &[Vec<Seen>]) -> [Sums; POWERS + 1] {
    let mut all = [Sums::default(); POWERS + 1];
    for run in runs {
        let weights: Vec<_> = run.iter().map(|seen| seen.weight).collect();
        let dot = |one: &[f64], other: &[f64]| -> f64 {
            let products = one.iter().zip(other).zip(&weights);
            products
                .map(|((one, other), weight)| weight * one * other)
                .sum()
        };
        let without = |from: &mut Vec<f64>, what: &[f64]| {
            let share = dot(from, what) / dot(what, what);
            for (from, what) in from.iter_mut().zip(what) {
                *from -= share * what;
            }
        };
        let mut energy: Vec<_> = run.iter().map(|seen| seen.energy).collect();
        let mut beyond: Vec<_> = run.iter().map(|seen| seen.beyond).collect();
        // −1 to 1.
        let (first, last) = (run[0].time, run[run.len() - 1].time);
        let times: Vec<_> = run
            .iter()
            .map(|seen| (2.0 * seen.time - first - last) / (last - first))
            .collect();
        let mut powers = vec![vec![1.0; run.len()]];
        for sums in &mut all {
            let newest = &powers[powers.len() - 1];
            without(&mut energy, newest);
            without(&mut beyond, newest);
            for ((weight, energy), beyond) in weights.iter().zip(&energy).zip(&beyond) {
                sums.add(*weight, *energy, *beyond);
            }
            let mut next: Vec<_> = newest
                .iter()
                .zip(&times)
                .map(|(by, time)| by * time)
                .collect();
            for power in &powers {
                without(&mut next, power);
            }
            powers.push(next);
        }
    }
    all
}

#[cfg(test)]
mod tests;
