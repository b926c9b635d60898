//! Which unknowns the motion of each run has.

use super::motion::{PARAMETERS, RATES};
use crate::runs::Run;

/// An unknown of a run's motion: its place among all, and what one of it is in the parameters of the motion.
pub type Term = (usize, [f64; PARAMETERS]);

/// Places in the parameters of the motion: of 1/τ, and of the first of each split.
const DECAY: usize = 0;
const DAMPING: usize = 1;
const FREQUENCY: usize = 3;
const KAPPA: usize = 5;

/// What the runs share: each split if they tell it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Model {
    /// The damping: 1/τ, δ c_τ and δ s_τ; else each run has a decay of its own, that along its pattern.
    pub damping: bool,
    /// The split of frequency: Δω c_ω and Δω s_ω; else each run has that part of it that makes its quadrature grow.
    pub frequency: bool,
}

impl Model {
    /// The place of the first unknown of the damping, where it is shared.
    pub const DAMPING: usize = 0;

    /// That of the frequency's split.
    pub fn frequency_at(self) -> usize {
        if self.damping { 3 } else { 0 }
    }

    /// How many unknowns are shared.
    fn shared(self) -> usize {
        self.frequency_at() + if self.frequency { 2 } else { 0 }
    }

    /// How many unknowns a run has to itself.
    fn own(self) -> usize {
        4 + usize::from(!self.damping) + usize::from(!self.frequency)
    }

    /// All unknowns of so many runs.
    pub fn unknowns(self, runs: usize) -> usize {
        self.shared() + self.own() * runs
    }

    /// The place of a run's first own unknown: κ, a_A, a_B and θ; then its decay and its frequency's split where it has them.
    pub fn own_at(self, run: usize) -> usize {
        self.shared() + self.own() * run
    }

    /// The place of the decay of a run.
    pub fn decay_at(self, run: usize) -> usize {
        if self.damping {
            Self::DAMPING
        } else {
            self.own_at(run) + 4
        }
    }

    /// The unknowns of a run.
    pub fn terms(self, index: usize, run: &Run) -> Vec<Term> {
        let unit = |parameter: usize| std::array::from_fn(|i| f64::from(u8::from(i == parameter)));
        let own = self.own_at(index);
        let mut terms = vec![(own, unit(KAPPA)), (self.decay_at(index), unit(DECAY))];
        terms.extend((0..3).map(|i| (own + 1 + i, unit(RATES + i))));
        if self.damping {
            terms.extend((0..2).map(|i| (Self::DAMPING + 1 + i, unit(DAMPING + i))));
        }
        if self.frequency {
            terms.extend((0..2).map(|i| (self.frequency_at() + i, unit(FREQUENCY + i))));
        } else {
            // Highest 22.5° from the pattern.
            let (sine, cosine) = (4.0 * run.rows[0].angle).sin_cos();
            let mut across = [0.0; PARAMETERS];
            (across[FREQUENCY], across[FREQUENCY + 1]) = (-sine, cosine);
            terms.push((own + self.own() - 1, across));
        }
        terms
    }
}
