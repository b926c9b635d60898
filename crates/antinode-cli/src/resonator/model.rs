//! Which unknowns the motion of each run has.

use nalgebra::DVector;

use super::motion::{GAMMA, KAPPA, PARAMETERS, RATES};
use crate::runs::Run;

/// An unknown of a run's motion: its place among all, and what one of it is in the parameters of the motion.
pub type Term = (usize, [f64; PARAMETERS]);

/// Places in the parameters of the motion: of 1/τ, and of the first of Δω.
const DECAY: usize = 0;
const FREQUENCY: usize = 3;

/// The parameters of a run's motion whose unknowns are these, at some values of all.
pub fn parameters(terms: &[Term], values: &DVector<f64>) -> [f64; PARAMETERS] {
    let mut parameters = [0.0; PARAMETERS];
    for (place, direction) in terms {
        for (parameter, by) in parameters.iter_mut().zip(direction) {
            *parameter += by * values[*place];
        }
    }
    parameters
}

/// What the runs share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Nothing: each has the decay along its pattern, and that side of the frequency's split which makes its quadrature grow.
    Each,
    /// The resonator: 1/τ, and both splits.
    Shared,
    /// The same, and γ.
    Nonlinear,
}

impl Model {
    /// The places of the first part of the splits of damping and frequency, where they are shared, behind 1/τ.
    pub const DAMPING: usize = 1;
    pub const FREQUENCY: usize = 3;
    /// The place of γ, where it is an unknown.
    pub const GAMMA: usize = GAMMA;

    /// True where the runs share a resonator.
    pub fn is_shared(self) -> bool {
        self != Self::Each
    }

    /// How many unknowns are shared.
    fn shared(self) -> usize {
        match self {
            Self::Each => 0,
            Self::Shared => GAMMA,
            Self::Nonlinear => GAMMA + 1,
        }
    }

    /// How many unknowns a run has to itself.
    fn own(self) -> usize {
        match self {
            Self::Each => 6,
            Self::Shared | Self::Nonlinear => 4,
        }
    }

    /// All unknowns of so many runs.
    pub fn unknowns(self, runs: usize) -> usize {
        self.shared() + self.own() * runs
    }

    /// The place of a run's first own unknown: κ, a_A, a_B and θ; then its decay and its side of the frequency's split where it has them.
    pub fn own_at(self, run: usize) -> usize {
        self.shared() + self.own() * run
    }

    /// The place of the decay of a run.
    pub fn decay_at(self, run: usize) -> usize {
        match self {
            Self::Each => self.own_at(run) + 4,
            Self::Shared | Self::Nonlinear => 0,
        }
    }

    /// The unknowns of a run.
    pub fn terms(self, index: usize, run: &Run) -> Vec<Term> {
        let unit = |parameter: usize| std::array::from_fn(|i| f64::from(u8::from(i == parameter)));
        let own = self.own_at(index);
        let mut terms = vec![(own, unit(KAPPA))];
        terms.extend((0..3).map(|i| (own + 1 + i, unit(RATES + i))));
        match self {
            Self::Each => {
                // Highest 22.5° from the pattern.
                let (sine, cosine) = (4.0 * run.rows[0].angle).sin_cos();
                let mut across = [0.0; PARAMETERS];
                (across[FREQUENCY], across[FREQUENCY + 1]) = (-sine, cosine);
                terms.extend([(own + 4, unit(DECAY)), (own + 5, across)]);
            }
            Self::Shared | Self::Nonlinear => {
                terms.extend((0..self.shared()).map(|i| (i, unit(i))));
            }
        }
        terms
    }
}
