//! The result of a fit, and the quantities that follow from it.

use nalgebra::DVector;

use super::curve;
use super::fit;
use super::model::{Damping, Kind, Model};
use crate::normal::Factors;
use crate::runs::{BEYOND_NOISE, EXPLAINED, is_alike};

/// Deviations below which the turning of patterns by amplitudes is taken to be 0: a higher limit would miss more than it spares.
const NONLINEAR_USED: f64 = 2.0;
/// Deviations below which it is not reported: at the limit above, one in twenty resonators without it would seem to have it.
const NONLINEAR_REPORTED: f64 = 3.0;

/// Residual that slightly coloured noise may leave, and the deviations of chance by which a smaller one is below noise.
const BELOW_NOISE: f64 = 0.9;
const BELOW_CHANCE: f64 = 5.0;

/// Deviations of chance by which one variance must be below another to be significantly less.
const LESS_CHANCE: f64 = 5.0;

/// The result of a fit.
#[derive(Debug)]
pub struct Found {
    /// The unknowns that the runs share, and the values of all unknowns.
    pub(super) model: Model,
    pub(super) values: DVector<f64>,
    /// Factors of the equations about the values, and the widening of variances if the residual exceeds the rows' own deviations.
    pub(super) factors: Factors,
    pub(super) widening: f64,
    /// The rms residual over the rows' own deviations: 1 in noise alone.
    pub residual: f64,
    /// Correlation of consecutive rows' residuals, −1 to 1: 0 in noise alone.
    pub alike: f64,
    /// Number of values in the rows that are explained: a_A and a_B, and θ unless patterns are turned unsteadily.
    pub count: f64,
    pub(super) of_runs: Vec<RunResult>,
    /// The turning of a pattern by a_A a_B that a fit with this unknown gave, if it is no unknown as it was not significant.
    pub(super) unseen_turning: Option<Measured>,
}

/// The result for one run.
#[derive(Debug)]
pub(super) struct RunResult {
    /// The means of R/E and of S/E.
    pub shares: [f64; 2],
    /// The rms residual over the rows' own deviations.
    pub residual: f64,
    /// If patterns are turned unsteadily: the mean rate of this one without the part due to the splits, rad/s, its derivatives by the
    /// unknowns, and the noise of the angles in it.
    pub rotation: f64,
    pub of_rotation: Vec<(usize, f64)>,
    pub rotation_noise: f64,
}

/// A value and its standard deviation.
pub type Measured = (f64, f64);

/// The resonator that the runs share.
#[derive(Debug)]
pub struct Resonator {
    /// The mean 1/τ of both modes, 1/s.
    pub decay: Measured,
    /// 1/τ of the mode that is damped most, and of the other, 1/s.
    pub decays: [Measured; 2],
    /// The split of damping, 1/s, and the angle at which damping is greatest, rad.
    pub damping_split: [Measured; 2],
    /// The split of frequency, rad/s, and the angle at which the frequency is highest, rad.
    pub frequency_split: [Measured; 2],
    /// Rate at which rotation turns the pattern of each run, rad/s.
    pub rotations: Vec<Measured>,
    /// Rate at which a_A a_B of one input unit squared turns a pattern, rad/s, if that is significant, nothing but noise is left, and the
    /// damping does not change: flaws of pick-offs, and a gain that drifts, look like it.
    pub turning_by_amplitudes: Option<Measured>,
}

impl Found {
    /// The variance of an unknown.
    pub(super) fn variance(&self, place: usize) -> f64 {
        self.factors.variance(&[(place, 1.0)]) * self.widening
    }

    /// True if the rows determine both splits; `each` is the fit without them, if there is one.
    pub(super) fn is_known(&self, each: Option<&Self>) -> bool {
        fit::is_known(self.model, |at| self.variance(at), self, each)
    }

    /// A value with its deviation, from its derivatives by the unknowns.
    fn measured(&self, value: f64, gradient: &[(usize, f64)]) -> Measured {
        let variance = self.factors.variance(gradient) * self.widening;
        (value, variance.sqrt())
    }

    /// A linear combination of unknowns.
    fn sum(&self, terms: &[(usize, f64)]) -> Measured {
        let value = terms.iter().map(|&(index, by)| by * self.values[index]);
        self.measured(value.sum(), terms)
    }

    /// 1/τ along the pattern of a run, 1/s.
    pub fn decay_of_run(&self, run: usize) -> Measured {
        let mut terms = vec![(self.model.decay_at(run), 1.0)];
        if self.model.is_shared() {
            let [damping, _] = self.model.splits_at();
            let shares = self.of_runs[run].shares.iter().enumerate();
            terms.extend(shares.map(|(i, share)| (damping + i, 0.5 * share)));
        }
        self.sum(&terms)
    }

    /// The mean 1/τ of both modes, 1/s, plus half the splits of damping in this direction: if each run has its own, their mean weighted by
    /// their variances, whose deviation is wider if they differ by more than theirs.
    fn decay(&self, [cosine, sine]: [f64; 2]) -> Measured {
        let runs = self.of_runs.len();
        let [damping, _] = self.model.splits_at();
        let mut weights = DVector::zeros(self.model.unknowns(runs));
        let mut scatter = 0.0;
        if self.model.is_decay_shared() {
            weights[self.model.decay_at(0)] = 1.0;
        } else {
            let places: Vec<_> = (0..runs).map(|run| self.model.decay_at(run)).collect();
            for &place in &places {
                weights[place] = 1.0 / self.variance(place);
            }
            let all = weights.sum();
            weights /= all;
            let mean = self.values.dot(&weights);
            let squares = places
                .iter()
                .map(|&place| weights[place] * (self.values[place] - mean).powi(2));
            // Of differences that are chance this is 1/`all`, which the variance has already.
            scatter = (squares.sum::<f64>() / (runs as f64 - 1.0).max(1.0) - 1.0 / all).max(0.0);
        }
        weights[damping] += 0.5 * cosine;
        weights[damping + 1] += 0.5 * sine;
        let variance = self.factors.solve(&weights).dot(&weights) * self.widening;
        (self.values.dot(&weights), (variance + scatter).sqrt())
    }

    /// Sum of the squared residuals, in the rows' own deviations.
    pub(super) fn squares(&self) -> f64 {
        self.residual * self.residual * (self.count - self.values.len() as f64)
    }

    /// Change of the decay rate of a run with time, 1/s², if the damping changes with time.
    pub fn decay_drift(&self, run: usize, seconds: f64) -> Option<Measured> {
        let by = curve::drift(seconds);
        let is_seen = self.model.curves() > 0;
        is_seen.then(|| self.sum(&[(self.model.curves_at(run), by)]))
    }

    /// Rise of the decay rate at an a_A² + a_B² of one input unit squared, 1/s, if the damping depends on it.
    pub fn decay_by_energy(&self) -> Option<Measured> {
        let is_seen = self.model.damping == Damping::ByEnergy;
        is_seen.then(|| self.sum(&[(self.model.by_energy_at(), 1.0)]))
    }

    /// The resonator, if the runs determine it.
    pub fn resonator(&self) -> Option<Resonator> {
        let [damping, frequency] = self.model.splits_at();
        self.model.is_shared().then(|| Resonator {
            decay: self.decay([0.0; 2]),
            decays: [1.0, -1.0].map(|sign| {
                let (_, direction) = self.direction(damping);
                self.decay(direction.map(|part| sign * part))
            }),
            damping_split: self.split(damping),
            frequency_split: self.split(frequency),
            rotations: (0..self.of_runs.len())
                .map(|run| self.rotation(run))
                .collect(),
            turning_by_amplitudes: self
                .turning_beyond_noise()
                .filter(|_| !self.is_turning_doubtful()),
        })
    }

    /// Rate at which rotation turns the pattern of a run, rad/s.
    fn rotation(&self, run: usize) -> Measured {
        if !self.model.is_unsteady() {
            return self.sum(&[(self.model.own_at(run), -0.5)]);
        }
        let of_run = &self.of_runs[run];
        let (rotation, std) = self.measured(of_run.rotation, &of_run.of_rotation);
        (rotation, std.hypot(of_run.rotation_noise))
    }

    /// The rms residual of a run over its rows' own deviations, and one standard deviation of it.
    pub fn residual_of_run(&self, run: usize, rows: usize) -> Measured {
        let count = (2 * self.model.explained() * rows) as f64;
        let residual = self.of_runs[run].residual;
        (residual, residual / count.sqrt())
    }

    /// True if nothing but noise is left.
    pub fn is_explained(&self) -> bool {
        self.residual < EXPLAINED && !self.is_alike()
    }

    /// True if residuals of consecutive rows are correlated beyond chance.
    pub fn is_alike(&self) -> bool {
        is_alike(self.alike, self.count)
    }

    /// True if so much more than noise is left that there is a warning.
    pub fn is_beyond_noise(&self) -> bool {
        self.residual > BEYOND_NOISE || self.is_alike()
    }

    /// True if less than noise is left, beyond chance, or if residuals below noise are correlated from row to row.
    pub fn is_below_noise(&self) -> bool {
        let min = BELOW_NOISE - BELOW_CHANCE / (2.0 * self.count).sqrt();
        let alike = self.alike / self.residual.powi(2).min(1.0);
        self.residual < min || !self.is_alike() && is_alike(alike, self.count)
    }

    /// True if it leaves less than another, beyond chance, or has no correlated residuals while the other has.
    pub(super) fn explains_more(&self, other: &Self) -> bool {
        let less = (other.residual / self.residual).powi(2) - 1.0;
        let chance = LESS_CHANCE * (2.0 / self.count + 2.0 / other.count).sqrt();
        less > chance || other.is_alike() && !self.is_alike()
    }

    /// Rate at which a_A a_B of one input unit squared turns a pattern, rad/s, significant or not, if the rows determine it.
    pub(super) fn turning_by_amplitudes(&self) -> Option<Measured> {
        if self.model.kind == Kind::Nonlinear {
            Some(self.sum(&[(self.model.gamma_at(), -1.0)]))
        } else {
            self.unseen_turning
        }
    }

    /// The same, if it is significant enough to be reported.
    fn turning_beyond_noise(&self) -> Option<Measured> {
        self.turning_by_amplitudes()
            .filter(|(turning, std)| turning.abs() > NONLINEAR_REPORTED * std)
    }

    /// True if something else may look like the turning by amplitudes.
    fn is_turning_doubtful(&self) -> bool {
        self.is_beyond_noise() || !self.is_damping_steady()
    }

    /// True if no steady rotation explains the rows: pattern angles are taken from them, and say nothing about the splits.
    pub fn is_unsteady(&self) -> bool {
        self.model.is_unsteady()
    }

    /// How the damping changes.
    pub fn damping(&self) -> Damping {
        self.model.damping
    }

    /// True if the damping does not change while a wave rings down.
    pub fn is_damping_steady(&self) -> bool {
        matches!(self.model.damping, Damping::Steady | Damping::InTime(0))
    }

    /// True if it is significant, but not reported because something else may look like it.
    pub fn withholds_turning(&self) -> bool {
        self.is_turning_doubtful() && self.turning_beyond_noise().is_some()
    }

    /// True if amplitudes turn patterns significantly.
    pub(super) fn is_nonlinear(&self) -> bool {
        self.turning_by_amplitudes()
            .is_some_and(|(turning, std)| turning.abs() > NONLINEAR_USED * std)
    }

    /// A linear combination of both components of the damping split and both of the frequency split; 0 if they are not determined.
    pub(super) fn splits(&self, by: &[f64; 4]) -> Measured {
        if !self.model.is_shared() {
            return (0.0, 0.0);
        }
        let [damping, _] = self.model.splits_at();
        let terms: Vec<_> = (damping..).zip(by.iter().copied()).collect();
        self.sum(&terms)
    }

    /// The size of a split, whose cosine and sine components are at `at` and after it, and both over that.
    fn direction(&self, at: usize) -> (f64, [f64; 2]) {
        let (c, s) = (self.values[at], self.values[at + 1]);
        let size = c.hypot(s).max(f64::MIN_POSITIVE);
        (size, [c / size, s / size])
    }

    /// The size of a split and its angle, as [`direction`](Self::direction).
    fn split(&self, at: usize) -> [Measured; 2] {
        let (size, [cosine, sine]) = self.direction(at);
        let turned = 0.25 / size;
        [
            self.measured(size, &[(at, cosine), (at + 1, sine)]),
            self.measured(
                0.25 * sine.atan2(cosine),
                &[(at, -turned * sine), (at + 1, turned * cosine)],
            ),
        ]
    }
}
