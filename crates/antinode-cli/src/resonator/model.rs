//! Which unknowns the motion of each run has.

use nalgebra::{DVector, RowSVector};

use super::motion::{GAMMA, KAPPA, Motion, PARAMETERS, RATES};
use crate::runs::{BOWS, Row, Run, turn};

/// An unknown of a run's motion: its place among all, and what one of it is in the parameters of the motion.
pub type Term = (usize, [f64; PARAMETERS]);

/// Straight pieces that a way becomes on which the pattern does not turn steadily.
const PIECES: u32 = 64;

/// Places in the parameters of the motion: of 1/τ, and of the first of Δω.
const DECAY: usize = 0;
const FREQUENCY: usize = 3;

/// What the runs share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Nothing: each has the decay along its pattern, and that side of the frequency's split which makes its quadrature grow.
    Each,
    /// The resonator: 1/τ, and both splits.
    Shared,
    /// The same, and γ.
    Nonlinear,
    /// As [`Each`](Self::Each), of patterns that are turned as it happens: their angles are not explained, but taken from the rows.
    EachTurned,
    /// As [`Shared`](Self::Shared), of patterns that are turned as it happens.
    SharedTurned,
}

impl Model {
    /// The places of the first part of the splits of damping and frequency, where they are shared, behind 1/τ.
    pub const DAMPING: usize = 1;
    pub const FREQUENCY: usize = 3;
    /// The place of γ, where it is an unknown.
    pub const GAMMA: usize = GAMMA;

    /// True where the runs share a resonator.
    pub fn is_shared(self) -> bool {
        !matches!(self, Self::Each | Self::EachTurned)
    }

    /// True where patterns are turned as it happens.
    pub fn is_turned(self) -> bool {
        matches!(self, Self::EachTurned | Self::SharedTurned)
    }

    /// What of a row is explained: a_A and a_B, and θ where that is not taken as it is.
    pub fn explained(self) -> usize {
        if self.is_turned() { 2 } else { 3 }
    }

    /// How many unknowns are shared.
    pub fn shared(self) -> usize {
        match self {
            Self::Each | Self::EachTurned => 0,
            Self::Shared | Self::SharedTurned => GAMMA,
            Self::Nonlinear => GAMMA + 1,
        }
    }

    /// How many unknowns a run has to itself.
    pub fn own(self) -> usize {
        match self {
            Self::Each => 6,
            Self::Shared | Self::Nonlinear | Self::EachTurned => 4,
            Self::SharedTurned => 2,
        }
    }

    /// All unknowns of so many runs.
    pub fn unknowns(self, runs: usize) -> usize {
        self.shared() + self.own() * runs
    }

    /// The place of a run's first own unknown: κ, a_A, a_B and θ, or only the amplitudes; then its decay and its side of the frequency's split
    /// where it has them.
    pub fn own_at(self, run: usize) -> usize {
        self.shared() + self.own() * run
    }

    /// The place of the decay of a run.
    pub fn decay_at(self, run: usize) -> usize {
        match self {
            Self::Each => self.own_at(run) + 4,
            Self::EachTurned => self.own_at(run) + 2,
            Self::Shared | Self::Nonlinear | Self::SharedTurned => 0,
        }
    }

    /// How a run moves from its first row on, at some values of all unknowns, of which it has these.
    pub fn motion(self, run: &Run, terms: &[Term], values: &DVector<f64>) -> Motion {
        let mut parameters = [0.0; PARAMETERS];
        for (place, direction) in terms {
            for (parameter, by) in parameters.iter_mut().zip(direction) {
                *parameter += by * values[*place];
            }
        }
        if self.is_turned() {
            parameters[RATES + 2] = run.rows[0].angle;
        }
        Motion::new(&parameters)
    }

    /// Moves on from one row to another. Where patterns are turned as it happens, gives by how much this one was turned otherwise than by
    /// what turns all, rad, and the derivatives of that.
    pub fn advance(
        self,
        motion: &mut Motion,
        from: &Row,
        to: &Row,
    ) -> (f64, RowSVector<f64, PARAMETERS>) {
        let seconds = to.time - from.time;
        if !self.is_turned() {
            motion.advance(seconds);
            return (0.0, RowSVector::zeros());
        }
        let pieces = if to.bow == [0.0; BOWS] { 1 } else { PIECES };
        let seconds = seconds / f64::from(pieces);
        let (mut beyond, mut derivatives) = (0.0, RowSVector::zeros());
        let mut turned = 0.0;
        for piece in 1..=pieces {
            let now = to.turned(from, f64::from(piece) / f64::from(pieces));
            let angle = from.angle + now;
            if seconds > 0.0 {
                let rate = (now - turned) / seconds;
                motion.steer(rate);
                let ahead = turn(motion.angle_after(seconds) - angle);
                // So that it is on the way all along, not only at its end.
                motion.steer(rate - ahead / seconds);
                beyond += ahead;
            }
            motion.advance(seconds);
            let (rest, of_rest) = motion.turn_to(angle);
            (beyond, derivatives) = (beyond + rest, derivatives + of_rest);
            turned = now;
        }
        (beyond, derivatives)
    }

    /// The unknowns of a run.
    pub fn terms(self, index: usize, run: &Run) -> Vec<Term> {
        let unit = |parameter: usize| std::array::from_fn(|i| f64::from(u8::from(i == parameter)));
        let own = self.own_at(index);
        let mut terms = Vec::new();
        if self.is_turned() {
            terms.extend((0..2).map(|i| (own + i, unit(RATES + i))));
        } else {
            terms.push((own, unit(KAPPA)));
            terms.extend((0..3).map(|i| (own + 1 + i, unit(RATES + i))));
        }
        match self {
            Self::Each | Self::EachTurned => {
                // Highest 22.5° from the pattern.
                let (sine, cosine) = (4.0 * run.rows[0].angle).sin_cos();
                let mut across = [0.0; PARAMETERS];
                (across[FREQUENCY], across[FREQUENCY + 1]) = (-sine, cosine);
                let decay = self.decay_at(index);
                terms.extend([(decay, unit(DECAY)), (decay + 1, across)]);
            }
            Self::Shared | Self::Nonlinear | Self::SharedTurned => {
                terms.extend((0..self.shared()).map(|i| (i, unit(i))));
            }
        }
        terms
    }
}
