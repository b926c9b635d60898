//! The unknowns of each run's motion.

use std::f64::consts::TAU;

use nalgebra::{DVector, RowSVector};

use super::motion::{GAMMA, KAPPA, Motion, PARAMETERS, RATES};
use crate::runs::{BOWS, Row, Run, turn};

/// An unknown of a run's motion: its place among all, and its direction in the parameters of the motion.
pub type Term = (usize, [f64; PARAMETERS]);

/// Steady pieces into which an unsteady turn between two rows is divided.
const PIECES: u32 = 64;

/// Places in the parameters of the motion: of 1/τ, and of the first component of Δω.
const DECAY: usize = 0;
const FREQUENCY: usize = 3;

/// The unknowns that the runs share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// Nothing: each has the decay along its pattern, and the component of the frequency split that makes its quadrature grow.
    Each,
    /// The resonator: 1/τ, and both splits.
    Shared,
    /// The same, and γ.
    Nonlinear,
    /// As [`Each`](Self::Each), for patterns that are turned unsteadily: their angles are not explained, but taken from the rows.
    EachUnsteady,
    /// As [`Shared`](Self::Shared), for patterns that are turned unsteadily.
    SharedUnsteady,
}

impl Model {
    /// The places of the first components of the splits of damping and frequency if they are shared, after 1/τ.
    pub const DAMPING: usize = 1;
    pub const FREQUENCY: usize = 3;
    /// The place of γ, if it is an unknown.
    pub const GAMMA: usize = GAMMA;

    /// True if the runs share a resonator.
    pub fn is_shared(self) -> bool {
        !matches!(self, Self::Each | Self::EachUnsteady)
    }

    /// True if patterns are turned unsteadily.
    pub fn is_unsteady(self) -> bool {
        matches!(self, Self::EachUnsteady | Self::SharedUnsteady)
    }

    /// Number of values in a row that are explained: a_A and a_B, and θ unless it is taken as it is.
    pub fn explained(self) -> usize {
        if self.is_unsteady() { 2 } else { 3 }
    }

    /// Number of shared unknowns.
    pub fn shared(self) -> usize {
        match self {
            Self::Each | Self::EachUnsteady => 0,
            Self::Shared | Self::SharedUnsteady => GAMMA,
            Self::Nonlinear => GAMMA + 1,
        }
    }

    /// Number of unknowns that a run has of its own.
    pub fn own(self) -> usize {
        match self {
            Self::Each => 6,
            Self::Shared | Self::Nonlinear | Self::EachUnsteady => 4,
            Self::SharedUnsteady => 2,
        }
    }

    /// Number of all unknowns.
    pub fn unknowns(self, runs: usize) -> usize {
        self.shared() + self.own() * runs
    }

    /// The place of a run's first own unknown. Its unknowns are κ, a_A, a_B and θ, or only the amplitudes; then its decay and its component
    /// of the frequency split, if it has them.
    pub fn own_at(self, run: usize) -> usize {
        self.shared() + self.own() * run
    }

    /// The place of the decay of a run.
    pub fn decay_at(self, run: usize) -> usize {
        match self {
            Self::Each => self.own_at(run) + 4,
            Self::EachUnsteady => self.own_at(run) + 2,
            Self::Shared | Self::Nonlinear | Self::SharedUnsteady => 0,
        }
    }

    /// The motion of a run from its first row on, for these values of all unknowns, of which the run has `terms`.
    pub fn motion(self, run: &Run, terms: &[Term], values: &DVector<f64>) -> Motion {
        let mut parameters = [0.0; PARAMETERS];
        for (place, direction) in terms {
            for (parameter, by) in parameters.iter_mut().zip(direction) {
                *parameter += by * values[*place];
            }
        }
        if self.is_unsteady() {
            parameters[RATES + 2] = run.rows[0].angle;
        }
        Motion::new(&parameters).of_frequency(TAU * run.rows[0].frequency)
    }

    /// Moves on from one row to another. If patterns are turned unsteadily, returns the part of the turn that is not due to rotation, rad,
    /// and its derivatives.
    pub fn advance(
        self,
        motion: &mut Motion,
        from: &Row,
        to: &Row,
    ) -> (f64, RowSVector<f64, PARAMETERS>) {
        let seconds = to.time - from.time;
        if !self.is_unsteady() {
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
                // So that the pattern follows the way all along, not only at its end.
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
        if self.is_unsteady() {
            terms.extend((0..2).map(|i| (own + i, unit(RATES + i))));
        } else {
            terms.push((own, unit(KAPPA)));
            terms.extend((0..3).map(|i| (own + 1 + i, unit(RATES + i))));
        }
        match self {
            Self::Each | Self::EachUnsteady => {
                // The frequency is highest 22.5° from the pattern.
                let (sine, cosine) = (4.0 * run.rows[0].angle).sin_cos();
                let mut across = [0.0; PARAMETERS];
                (across[FREQUENCY], across[FREQUENCY + 1]) = (-sine, cosine);
                let decay = self.decay_at(index);
                terms.extend([(decay, unit(DECAY)), (decay + 1, across)]);
            }
            Self::Shared | Self::Nonlinear | Self::SharedUnsteady => {
                terms.extend((0..self.shared()).map(|i| (i, unit(i))));
            }
        }
        terms
    }
}
