//! The unknowns of each run's motion.

use std::f64::consts::TAU;

use nalgebra::{DVector, SVector};

use super::curve::{BY_ENERGY, CURVES, IN_TIME};
use super::motion::{KAPPA, Motion, PARAMETERS, RATES};
use crate::runs::{BOWS, Row, Run, turn};

/// Number of parameters of the motion and of its curves of damping.
pub const ALL: usize = PARAMETERS + CURVES;

/// An unknown of a run's motion: its place among all, and its direction in the parameters.
pub type Term = (usize, [f64; ALL]);

/// Steady pieces into which an unsteady turn between two rows is divided.
const PIECES: u32 = 64;

/// Places in the parameters of the motion: of 1/τ, and of the first component of Δω.
const DECAY: usize = 0;
const FREQUENCY: usize = 3;

/// What the runs share, and what turns their patterns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
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

/// How the damping of both modes changes while a wave rings down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Damping {
    /// Not at all.
    Steady,
    /// In proportion to the energy, and in all runs alike.
    ByEnergy,
    /// In each run by itself: 1/τ is one of its own, with so many curves over time, or none.
    InTime(usize),
}

/// The unknowns of a fit: the shared ones, which are 1/τ, the splits, γ and the damping by energy, as far as there are any; then each run's
/// own, which are κ, a_A, a_B and θ, or only the amplitudes, its decay, its component of the frequency split, and its curves of damping.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Model {
    pub kind: Kind,
    pub damping: Damping,
}

impl Model {
    /// The model with a damping that is steady.
    pub fn steady(kind: Kind) -> Self {
        Self {
            kind,
            damping: Damping::Steady,
        }
    }

    /// True if the runs share a resonator.
    pub fn is_shared(self) -> bool {
        !matches!(self.kind, Kind::Each | Kind::EachUnsteady)
    }

    /// True if patterns are turned unsteadily.
    pub fn is_unsteady(self) -> bool {
        matches!(self.kind, Kind::EachUnsteady | Kind::SharedUnsteady)
    }

    /// True if all runs have the same 1/τ.
    pub fn is_decay_shared(self) -> bool {
        self.is_shared() && !matches!(self.damping, Damping::InTime(_))
    }

    /// Number of curves of damping that a run has of its own.
    pub fn curves(self) -> usize {
        match self.damping {
            Damping::Steady | Damping::ByEnergy => 0,
            Damping::InTime(curves) => curves,
        }
    }

    /// Number of values in a row that are explained: a_A and a_B, and θ unless it is taken as it is.
    pub fn explained(self) -> usize {
        if self.is_unsteady() { 2 } else { 3 }
    }

    /// The places of the first components of the splits of damping and frequency if they are shared.
    pub fn splits_at(self) -> [usize; 2] {
        let damping = usize::from(self.is_decay_shared());
        [damping, damping + 2]
    }

    /// The place of γ, if it is an unknown.
    pub fn gamma_at(self) -> usize {
        self.splits_at()[1] + 2
    }

    /// The place of the damping by energy, if it is an unknown.
    pub fn by_energy_at(self) -> usize {
        match self.kind {
            Kind::Each | Kind::EachUnsteady => 0,
            Kind::Shared | Kind::SharedUnsteady => self.gamma_at(),
            Kind::Nonlinear => self.gamma_at() + 1,
        }
    }

    /// Number of shared unknowns.
    pub fn shared(self) -> usize {
        self.by_energy_at() + usize::from(self.damping == Damping::ByEnergy)
    }

    /// Number of unknowns of a run's wave: κ, a_A, a_B and θ, or only the amplitudes.
    fn of_wave(self) -> usize {
        if self.is_unsteady() { 2 } else { 4 }
    }

    /// Number of unknowns that a run has of its own.
    pub fn own(self) -> usize {
        let of_decay = match (self.is_shared(), self.is_decay_shared()) {
            (true, true) => 0,
            (true, false) => 1,
            (false, _) => 2,
        };
        self.of_wave() + of_decay + self.curves()
    }

    /// Number of all unknowns.
    pub fn unknowns(self, runs: usize) -> usize {
        self.shared() + self.own() * runs
    }

    /// The place of a run's first own unknown.
    pub fn own_at(self, run: usize) -> usize {
        self.shared() + self.own() * run
    }

    /// The place of the decay of a run.
    pub fn decay_at(self, run: usize) -> usize {
        if self.is_decay_shared() {
            0
        } else {
            self.own_at(run) + self.of_wave()
        }
    }

    /// The place of a run's first curve of damping, if it has any.
    pub fn curves_at(self, run: usize) -> usize {
        self.own_at(run + 1) - self.curves()
    }

    /// These values of the unknowns of another model, of the same kind or without γ, as values of this one, with 0 for unknowns that it
    /// lacks.
    pub fn values_from(self, other: Self, values: &DVector<f64>, runs: usize) -> DVector<f64> {
        let mut all = DVector::zeros(self.unknowns(runs));
        let mut copy = |to: usize, from: usize, count: usize| {
            all.rows_mut(to, count).copy_from(&values.rows(from, count));
        };
        if self.is_shared() {
            let [to, from] = [self, other].map(|model| model.splits_at()[0]);
            copy(to, from, other.by_energy_at() - from);
        }
        for run in 0..runs {
            let [to, from] = [self, other].map(|model| model.own_at(run));
            copy(to, from, self.own().min(other.own()));
            copy(self.decay_at(run), other.decay_at(run), 1);
        }
        all
    }

    /// The values of a run's parameters, of which it has `terms`, for these values of all unknowns.
    pub fn parameters(terms: &[Term], values: &DVector<f64>) -> [f64; ALL] {
        let mut parameters = [0.0; ALL];
        for (place, direction) in terms {
            for (parameter, by) in parameters.iter_mut().zip(direction) {
                *parameter += by * values[*place];
            }
        }
        parameters
    }

    /// The motion of a run from its first row on, with these parameters, without the curves of damping.
    pub fn motion(self, run: &Run, parameters: &[f64; ALL]) -> Motion {
        let mut parameters: [f64; PARAMETERS] = std::array::from_fn(|i| parameters[i]);
        if self.is_unsteady() {
            parameters[RATES + 2] = run.rows[0].angle;
        }
        let motion = Motion::new(&parameters).of_frequency(TAU * run.rows[0].frequency);
        match self.kind {
            Kind::Nonlinear => motion,
            _ => motion.without_gamma(),
        }
    }

    /// Moves on from one row to another. If patterns are turned unsteadily, returns the part of the turn that is not due to rotation, rad,
    /// and its derivatives.
    pub fn advance(
        self,
        motion: &mut Motion,
        from: &Row,
        to: &Row,
    ) -> (f64, SVector<f64, PARAMETERS>) {
        let seconds = to.time - from.time;
        if !self.is_unsteady() {
            motion.advance(seconds);
            return (0.0, SVector::zeros());
        }
        let pieces = if to.bow == [0.0; BOWS] { 1 } else { PIECES };
        let seconds = seconds / f64::from(pieces);
        let (mut beyond, mut derivatives) = (0.0, SVector::zeros());
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
        let decay = self.decay_at(index);
        terms.push((decay, unit(DECAY)));
        if self.is_shared() {
            let [damping, _] = self.splits_at();
            let splits_and_gamma = damping..self.by_energy_at();
            terms.extend(splits_and_gamma.map(|at| (at, unit(DECAY + 1 + at - damping))));
        } else {
            // The frequency is highest 22.5° from the pattern.
            let (sine, cosine) = (4.0 * run.rows[0].angle).sin_cos();
            let mut across = [0.0; ALL];
            (across[FREQUENCY], across[FREQUENCY + 1]) = (-sine, cosine);
            terms.push((decay + 1, across));
        }
        match self.damping {
            Damping::Steady => {}
            Damping::ByEnergy => terms.push((self.by_energy_at(), unit(PARAMETERS + BY_ENERGY))),
            Damping::InTime(curves) => {
                let at = self.curves_at(index);
                terms.extend((0..curves).map(|i| (at + i, unit(PARAMETERS + IN_TIME + i))));
            }
        }
        terms
    }
}
