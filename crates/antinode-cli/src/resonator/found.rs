//! What the fit found, and the quantities that follow from it.

use nalgebra::{DMatrix, DVector};

use super::model::{Model, parameters};
use super::motion::Motion;
use crate::runs::Run;

/// Of fewer deviations than this, what amplitudes turn patterns by is taken to be nothing: more would be missed than it spares.
const NONLINEAR_SEEN: f64 = 2.0;

/// What was found.
#[derive(Debug)]
pub struct Found {
    /// What the runs share.
    pub(super) model: Model,
    pub(super) values: DVector<f64>,
    /// Of the values, widened where the residual is beyond the rows' own deviations.
    pub(super) covariance: DMatrix<f64>,
    /// The rms residual over the rows' own deviations: 1 where there is nothing but noise.
    pub residual: f64,
    /// How much alike the residuals of rows that follow each other are, −1 to 1: 0 where there is nothing but noise.
    pub alike: f64,
    /// The means of R/E and of S/E over each run.
    pub(super) shares: Vec<[f64; 2]>,
}

/// A value and its standard deviation.
pub type Measured = (f64, f64);

/// What moves the frequency of a row.
pub struct Moved {
    /// What the splits add to it, rad/s, as [`Found::splits`] takes it; nothing where they are not told.
    pub by_splits: [f64; 4],
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
    /// What a_A a_B of one input unit squared turns a pattern by, rad/s, where that is seen.
    pub turning_by_amplitudes: Option<Measured>,
}

impl Found {
    /// A value whose derivatives by the unknowns are these.
    fn measured(&self, value: f64, gradient: &[(usize, f64)]) -> Measured {
        let mut variance = 0.0;
        for (i, left) in gradient {
            for (j, right) in gradient {
                variance += left * right * self.covariance[(*i, *j)];
            }
        }
        (value, variance.max(0.0).sqrt())
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
            let shares = self.shares[run].iter().enumerate();
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
            rotations: (0..self.shares.len())
                .map(|run| self.sum(&[(self.model.own_at(run), -0.5)]))
                .collect(),
            turning_by_amplitudes: self.turning_by_amplitudes(),
        })
    }

    /// What a_A a_B of one input unit squared turns a pattern by, rad/s, where it is an unknown.
    pub(super) fn turning_by_amplitudes(&self) -> Option<Measured> {
        (self.model == Model::Nonlinear).then(|| self.sum(&[(Model::GAMMA, -1.0)]))
    }

    /// True where amplitudes are seen to turn patterns.
    pub(super) fn is_nonlinear(&self) -> bool {
        self.turning_by_amplitudes()
            .is_some_and(|(turning, std)| turning.abs() > NONLINEAR_SEEN * std)
    }

    /// What moves the frequency of each row.
    pub fn frequency_moved(&self, runs: &[Run]) -> Vec<Moved> {
        let mut list = Vec::new();
        for (index, run) in runs.iter().enumerate() {
            let mut motion = Motion::new(&parameters(&self.model.terms(index, run), &self.values));
            let mut time = run.rows[0].time;
            let mut before = motion.frequency_by_turning();
            for row in &run.rows {
                motion.advance(row.time - time);
                time = row.time;
                let by_turning = motion.frequency_by_turning();
                let by_splits = if self.model.is_shared() {
                    motion.frequency_by_splits()
                } else {
                    [0.0; 4]
                };
                list.push(Moved {
                    by_splits,
                    change: by_turning - std::mem::replace(&mut before, by_turning),
                });
            }
        }
        list
    }

    /// A sum over both parts of the damping's split and both of the frequency's.
    pub fn splits(&self, by: &[f64; 4]) -> Measured {
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
