//! Everything about a window's fit that does not depend on its samples: built once, kept while the frequency stays.

use num_complex::Complex32;

use super::normal::{Normal, PARAMETERS, Row};
use super::response::{Basis, Response};
use crate::block::Layout;
use crate::calibration::{Calibration, Correction};
use crate::order::greater;
use crate::phase::{Phase, PhaseStep};

/// A window of blocks about a carrier, and what its samples would not change.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub layout: Layout,
    pub blocks: u16,
    pub carrier: PhaseStep,
    calibration: Calibration,
    sample_rate: f32,
    pub(super) basis: Basis,
    pub(super) response: Response,
    /// Half the window, in samples, and one over it.
    pub half: f32,
    pub(super) per_half: f32,
    /// Correction of the pick-offs at the carrier.
    pub correction: Correction,
    /// Inverse of the normal matrix: covariance of (Re z, Im z, Re z′, Im z′, d) for noise of one a sample.
    pub covariance: [Row; PARAMETERS],
}

impl Model {
    pub(crate) fn new(
        layout: Layout,
        carrier: PhaseStep,
        blocks: u16,
        calibration: Calibration,
        sample_rate: f32,
    ) -> Self {
        let basis = Basis::new(layout);
        let mut model = Self {
            layout,
            blocks,
            carrier,
            calibration,
            sample_rate,
            response: Response::new(layout, &basis, carrier),
            basis,
            half: 0.0,
            per_half: 0.0,
            correction: calibration.at(1.0 / carrier.period(), sample_rate),
            covariance: [[0.0; PARAMETERS]; PARAMETERS],
        };
        model.build();
        model
    }

    /// Moves the carrier, or changes the number of blocks.
    pub(crate) fn retune(&mut self, carrier: PhaseStep, blocks: u16) {
        if carrier != self.carrier {
            self.carrier = carrier;
            self.response = Response::new(self.layout, &self.basis, carrier);
            self.correction = self
                .calibration
                .at(1.0 / carrier.period(), self.sample_rate);
        } else if blocks == self.blocks {
            return;
        }
        self.blocks = blocks;
        self.build();
    }

    /// Degrees of freedom that the residual of both pick-offs has.
    pub(super) fn freedom(&self) -> f32 {
        2.0 * greater(
            f32::from(self.basis.rank) * f32::from(self.blocks) - PARAMETERS as f32,
            0.5,
        )
    }

    /// Blocks, twice, from the middle of the window to that of block `index`.
    fn twice_blocks(&self, index: u16) -> i32 {
        2 * i32::from(index) + 1 - i32::from(self.blocks)
    }

    /// Time of the middle of block `index`: −1 to 1 over the window.
    #[inline]
    pub(super) fn time(&self, index: u16) -> f32 {
        self.twice_blocks(index) as f32 / f32::from(self.blocks)
    }

    /// Phase of the carrier in the middle of block `index`, zero in the middle of the window.
    #[inline]
    pub(super) fn phase(&self, index: u16) -> Phase {
        let half_samples = i64::from(self.twice_blocks(index)) * i64::from(self.layout.length);
        self.carrier.after_half_samples(half_samples)
    }

    /// The design rows of a block, for its mean, even and odd sums.
    fn rows(&self, u: f32, unit: Complex32) -> [Row; 3] {
        let (c, s) = (unit.re, unit.im);
        let even = |level: f32, slope: f32, offset: f32| {
            let (l, k) = (level * u, slope * self.per_half);
            [level * c, -level * s, l * c + k * s, k * c - l * s, offset]
        };
        let r = &self.response;
        let (l, k) = (r.odd.level * u, r.odd.slope * self.per_half);
        [
            even(r.mean.level, r.mean.slope, r.offset),
            even(r.even.level, r.even.slope, 0.0),
            [
                r.odd.level * s,
                r.odd.level * c,
                l * s + k * c,
                l * c - k * s,
                0.0,
            ],
        ]
    }

    fn build(&mut self) {
        self.half = 0.5 * f32::from(self.blocks) * f32::from(self.layout.length);
        self.per_half = 1.0 / self.half;
        let mut normal = Normal::ZERO;
        for index in 0..self.blocks {
            for row in &self.rows(self.time(index), self.phase(index).unit()) {
                normal.add(row);
            }
        }
        normal.factorise();
        for (i, row) in self.covariance.iter_mut().enumerate() {
            let mut unit = [0.0; PARAMETERS];
            unit[i] = 1.0;
            *row = normal.solve(unit);
        }
    }
}
