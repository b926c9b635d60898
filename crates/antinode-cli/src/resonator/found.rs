//! What the fit found, and the quantities that follow from it.

use nalgebra::DVector;

use super::is_alike;
use super::model::Model;
use crate::normal::Factors;
use crate::runs::{BEYOND_NOISE, Run};

/// Of fewer deviations than this, what amplitudes turn patterns by is taken to be nothing: more would be missed than it spares.
const NONLINEAR_SEEN: f64 = 2.0;
/// Of fewer it is not told: one in twenty resonators without it would seem to have it.
const NONLINEAR_TOLD: f64 = 3.0;

/// From this residual over the rows' own deviations on, the runs do not explain the rows each by itself.
pub(super) const TOGETHER: f64 = 1.5;

/// Noise that is coloured a little leaves as small a residual; less by so many deviations of chance is below noise.
const BELOW_NOISE: f64 = 0.9;
const BELOW_SEEN: f64 = 5.0;

/// A variance that is less than another's by so many deviations of chance is less.
const LESS_SEEN: f64 = 5.0;

/// What was found.
#[derive(Debug)]
pub struct Found {
    /// What the runs share.
    pub(super) model: Model,
    pub(super) values: DVector<f64>,
    /// Of the equations about the values, and what variances are multiplied by where the residual is beyond the rows' own deviations.
    pub(super) factors: Factors,
    pub(super) widening: f64,
    /// The rms residual over the rows' own deviations: 1 where there is nothing but noise.
    pub residual: f64,
    /// How much alike the residuals of rows that follow each other are, −1 to 1: 0 where there is nothing but noise.
    pub alike: f64,
    /// Numbers of the rows that are explained: a_A and a_B, and θ but where patterns are turned as it happens.
    pub count: f64,
    pub(super) of_runs: Vec<OfRun>,
    /// What a_A a_B turns a pattern by, as it would be an unknown, where it is none for it is not seen.
    pub(super) unseen_turning: Option<Measured>,
}

/// What was found of a run.
#[derive(Debug)]
pub(super) struct OfRun {
    /// The means of R/E and of S/E.
    pub shares: [f64; 2],
    /// The rms residual over the rows' own deviations.
    pub residual: f64,
    /// Where patterns are turned as it happens: by how much this one was turned beside what the splits made of that, rad/s, the derivatives
    /// of this by the unknowns, and the noise of its angles in it.
    pub rotation: f64,
    pub of_rotation: Vec<(usize, f64)>,
    pub rotation_noise: f64,
}

/// A value and its standard deviation.
pub type Measured = (f64, f64);

/// What moves the frequency of a row.
pub struct Moved {
    /// What the splits add to it, rad/s, as [`Found::splits`] takes it.
    pub by_splits: [f64; 4],
    /// The same, on average since the row before, by Simpson's rule.
    pub by_splits_since: [f64; 4],
    /// By how much what the turning of the pattern makes of it differs from what it made of the row before, rad/s.
    pub change: f64,
}

/// What the runs share.
#[derive(Debug)]
pub struct Resonator {
    /// The mean 1/τ of both modes, 1/s.
    pub decay: Measured,
    /// The split of damping, 1/s, and the angle at which damping is greatest, rad.
    pub damping_split: [Measured; 2],
    /// The split of frequency, rad/s, and the angle at which the frequency is highest, rad.
    pub frequency_split: [Measured; 2],
    /// What rotation turns the pattern of each run by, rad/s.
    pub rotations: Vec<Measured>,
    /// What a_A a_B of one input unit squared turns a pattern by, rad/s, where that is seen and nothing else moves: flaws of pick-offs
    /// look like it.
    pub turning_by_amplitudes: Option<Measured>,
}

impl Found {
    /// The variance of an unknown.
    pub(super) fn variance(&self, place: usize) -> f64 {
        self.factors.variance(&[(place, 1.0)]) * self.widening
    }

    /// A value whose derivatives by the unknowns are these.
    fn measured(&self, value: f64, gradient: &[(usize, f64)]) -> Measured {
        let variance = self.factors.variance(gradient) * self.widening;
        (value, variance.sqrt())
    }

    /// A sum of unknowns.
    fn sum(&self, terms: &[(usize, f64)]) -> Measured {
        let value = terms.iter().map(|&(index, by)| by * self.values[index]);
        self.measured(value.sum(), terms)
    }

    /// 1/τ along the pattern of a run, 1/s.
    pub fn decay_of_run(&self, run: usize) -> Measured {
        let mut terms = vec![(self.model.decay_at(run), 1.0)];
        if self.model.is_shared() {
            let shares = self.of_runs[run].shares.iter().enumerate();
            terms.extend(shares.map(|(i, share)| (Model::DAMPING + i, 0.5 * share)));
        }
        self.sum(&terms)
    }

    /// What the runs share, where they tell it.
    pub fn resonator(&self) -> Option<Resonator> {
        self.model.is_shared().then(|| Resonator {
            decay: self.sum(&[(self.model.decay_at(0), 1.0)]),
            damping_split: self.split(Model::DAMPING),
            frequency_split: self.split(Model::FREQUENCY),
            rotations: (0..self.of_runs.len())
                .map(|run| self.rotation(run))
                .collect(),
            turning_by_amplitudes: self
                .turning_beyond_noise()
                .filter(|_| !self.is_beyond_noise()),
        })
    }

    /// What rotation turns the pattern of a run by, rad/s.
    fn rotation(&self, run: usize) -> Measured {
        if !self.model.is_turned() {
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

    /// True where patterns are turned as it happens, not steadily.
    pub fn is_turned(&self) -> bool {
        self.model.is_turned()
    }

    /// True where nothing but noise is left.
    pub fn is_explained(&self) -> bool {
        self.residual < TOGETHER && !self.is_alike()
    }

    /// True where residuals of rows that follow each other are alike, and not by chance.
    pub fn is_alike(&self) -> bool {
        is_alike(self.alike, self.count)
    }

    /// True where it is told that more than noise is left.
    pub fn is_beyond_noise(&self) -> bool {
        self.residual > BEYOND_NOISE || self.is_alike()
    }

    /// True where less than noise is left, and not by chance, or what is left is alike from row to row though it is less.
    pub fn is_below_noise(&self) -> bool {
        let least = BELOW_NOISE - BELOW_SEEN / (2.0 * self.count).sqrt();
        let alike = self.alike / self.residual.powi(2).min(1.0);
        self.residual < least || !self.is_alike() && is_alike(alike, self.count)
    }

    /// True where it leaves less than another, and not by chance.
    pub fn explains_more(&self, other: &Self) -> bool {
        let less = (other.residual / self.residual).powi(2) - 1.0;
        let chance = LESS_SEEN * (2.0 / self.count + 2.0 / other.count).sqrt();
        less > chance || other.is_alike() && !self.is_alike()
    }

    /// What a_A a_B of one input unit squared turns a pattern by, rad/s, seen or not, where the rows tell it.
    pub(super) fn turning_by_amplitudes(&self) -> Option<Measured> {
        if self.model == Model::Nonlinear {
            Some(self.sum(&[(Model::GAMMA, -1.0)]))
        } else {
            self.unseen_turning
        }
    }

    /// The same where it would be told if nothing else moved.
    fn turning_beyond_noise(&self) -> Option<Measured> {
        self.turning_by_amplitudes()
            .filter(|(turning, std)| turning.abs() > NONLINEAR_TOLD * std)
    }

    /// True where what amplitudes turn patterns by is not told for what else moves alone.
    pub fn withholds_turning(&self) -> bool {
        self.is_beyond_noise() && self.turning_beyond_noise().is_some()
    }

    /// True where amplitudes are seen to turn patterns.
    pub fn is_nonlinear(&self) -> bool {
        self.turning_by_amplitudes()
            .is_some_and(|(turning, std)| turning.abs() > NONLINEAR_SEEN * std)
    }

    /// What moves the frequency of each row.
    pub fn frequency_moved(&self, runs: &[Run]) -> Vec<Moved> {
        let mut list = Vec::new();
        for (index, run) in runs.iter().enumerate() {
            let terms = self.model.terms(index, run);
            let mut motion = self.model.motion(run, &terms, &self.values);
            let mut last = &run.rows[0];
            let mut before = motion.frequency_by_turning();
            let mut by_splits_before = motion.frequency_by_splits(0.0);
            for row in &run.rows {
                self.model.advance(&mut motion, last, row);
                let half_back = 0.5 * (last.time - row.time);
                last = row;
                let by_turning = motion.frequency_by_turning();
                let by_splits = motion.frequency_by_splits(0.0);
                let between = motion.frequency_by_splits(half_back);
                let by_splits_since = std::array::from_fn(|i| {
                    (by_splits_before[i] + 4.0 * between[i] + by_splits[i]) / 6.0
                });
                by_splits_before = by_splits;
                list.push(Moved {
                    by_splits,
                    by_splits_since,
                    change: by_turning - std::mem::replace(&mut before, by_turning),
                });
            }
        }
        list
    }

    /// A sum over both parts of the damping's split and both of the frequency's; nothing where they are not told.
    pub fn splits(&self, by: &[f64; 4]) -> Measured {
        if !self.model.is_shared() {
            return (0.0, 0.0);
        }
        let terms = by.iter().enumerate();
        let terms: Vec<_> = terms.map(|(i, &by)| (Model::DAMPING + i, by)).collect();
        self.sum(&terms)
    }

    /// The size of a split whose parts along cosine and sine stand at `at`, and its angle.
    fn split(&self, at: usize) -> [Measured; 2] {
        let (c, s) = (self.values[at], self.values[at + 1]);
        let size = c.hypot(s).max(f64::MIN_POSITIVE);
        let (cosine, sine) = (c / size, s / size);
        let turned = 0.25 / size;
        [
            self.measured(size, &[(at, cosine), (at + 1, sine)]),
            self.measured(
                0.25 * s.atan2(c),
                &[(at, -turned * sine), (at + 1, turned * cosine)],
            ),
        ]
    }
}
