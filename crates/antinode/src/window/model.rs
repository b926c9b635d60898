//! The part of a window's fit that does not depend on its samples: built once, and kept while the frequency stays.

use num_complex::Complex32;

use super::normal::{Covariance, Normal, PARAMETERS, Row};
use super::response::{Answer, Basis, Response};
use crate::block::Layout;
use crate::calibration::{Calibration, Correction};
use crate::cut::MIN_HUM_PERIODS;
use crate::phase::{Phase, PhaseStep};

/// A window of blocks about a carrier, whatever its samples are.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub layout: Layout,
    pub blocks: u16,
    pub carrier: PhaseStep,
    calibration: Calibration,
    sample_rate: f32,
    pub(super) basis: Basis,
    /// 1 if the blocks of a window share an offset, 0 if each has its own.
    pub(crate) shared: f32,
    pub(super) response: Response,
    /// Half the window's samples, and one over that.
    pub half: f32,
    pub per_half: f32,
    /// Time, in half windows, and turn of the carrier from one block to the next.
    pub(super) advance: f32,
    pub(super) turn: Complex32,
    /// The carrier at the middle of the first block.
    pub(super) first: Complex32,
    /// Correction of the pick-offs at the carrier.
    pub correction: Correction,
    pub covariance: Covariance,
}

impl Model {
    #[cfg(test)]
    pub(crate) fn new(
        layout: Layout,
        carrier: PhaseStep,
        blocks: u16,
        calibration: Calibration,
        sample_rate: f32,
        own_offsets: bool,
    ) -> Self {
        let mut model = Self::empty(layout, calibration, sample_rate);
        model.begin(own_offsets);
        model.retune(carrier, blocks);
        model
    }

    /// A model to be built in its place by [`Model::begin`]: a copy of it would take its size in stack.
    #[inline(always)]
    pub(crate) fn empty(layout: Layout, calibration: Calibration, sample_rate: f32) -> Self {
        Self {
            layout,
            blocks: 0,
            carrier: layout.step,
            calibration,
            sample_rate,
            basis: Basis::default(),
            shared: 1.0,
            response: Response::default(),
            half: 0.0,
            per_half: 0.0,
            advance: 0.0,
            turn: Complex32::ONE,
            first: Complex32::ONE,
            correction: Correction::default(),
            covariance: Covariance::default(),
        }
    }

    /// Builds what depends on the layout alone, which is all that it takes to see blocks; the rest is built by [`Model::retune`].
    pub(crate) fn begin(&mut self, own_offsets: bool) {
        let layout = self.layout;
        self.basis = Basis::new(layout);
        // An offset of its own costs a block of a period or more next to nothing, but a shorter one what it knows of the wave.
        let is_long = f32::from(layout.length) > MIN_HUM_PERIODS * layout.step.period();
        self.shared = if own_offsets && is_long { 0.0 } else { 1.0 };
    }

    /// Moves the carrier, or changes the number of blocks.
    #[inline]
    pub(crate) fn retune(&mut self, carrier: PhaseStep, blocks: u16) {
        if carrier != self.carrier || blocks != self.blocks {
            (self.carrier, self.blocks) = (carrier, blocks);
            self.build();
        }
    }

    /// Degrees of freedom of both pick-offs' residual.
    pub(super) fn freedom(&self) -> f32 {
        // An offset of its own takes a block's mean, and is no parameter of the window.
        let own = 1.0 - self.shared;
        let sums = (f32::from(self.basis.rank) - own) * f32::from(self.blocks);
        2.0 * (sums - (PARAMETERS as f32 - own))
    }

    /// Twice the number of blocks from the middle of the window to that of block `index`.
    fn twice_blocks(&self, index: u16) -> i32 {
        2 * i32::from(index) + 1 - i32::from(self.blocks)
    }

    /// Time of the middle of block `index`: −1 to 1 over the window.
    #[inline]
    pub(super) fn time(&self, index: u16) -> f32 {
        0.5 * self.advance * self.twice_blocks(index) as f32
    }

    /// Time and carrier at the middle of block `index`, without the errors of a recursion.
    #[inline]
    pub(super) fn carrier(&self, index: usize) -> (f32, Complex32) {
        let index = index as u16;
        let unit = if index == 0 {
            self.first
        } else if self.twice_blocks(index) == 0 {
            Complex32::ONE
        } else {
            self.phase(index).unit()
        };
        (self.time(index), unit)
    }

    /// Phase of the carrier at the middle of block `index`; it is zero at the middle of the window.
    pub(super) fn phase(&self, index: u16) -> Phase {
        let half_samples = i64::from(self.twice_blocks(index)) * i64::from(self.layout.length);
        self.carrier.after_half_samples(half_samples)
    }

    /// The design rows of a block, for its mean, even and odd sums, each split into its even and its odd side.
    fn rows(&self, u: f32, unit: Complex32) -> [[Row; 2]; 3] {
        let (c, s) = (unit.re, unit.im);
        let even = |answer: &Answer, share: f32, offset: f32| {
            let (level, k) = (answer.level * share, answer.slope * share);
            let l = level * u;
            [
                [level * c, k * c - l * s, offset],
                [-level * s, l * c + k * s, 0.0],
            ]
        };
        let r = &self.response;
        let (l, k) = (r.odd.level * u, r.odd.slope);
        [
            // If each block has its own offset, its mean says nothing of the wave.
            even(&r.mean, self.shared, r.offset),
            even(&r.even, 1.0, 0.0),
            [
                [r.odd.level * s, l * c + k * s, 0.0],
                [r.odd.level * c, l * s - k * c, 0.0],
            ],
        ]
    }

    #[inline(never)]
    fn build(&mut self) {
        self.half = 0.5 * f32::from(self.blocks) * f32::from(self.layout.length);
        self.per_half = 1.0 / self.half;
        self.response = Response::new(self.layout, &self.basis, self.carrier, self.per_half);
        self.correction = self
            .calibration
            .at(1.0 / self.carrier.period(), self.sample_rate);
        self.advance = 2.0 / f32::from(self.blocks);
        let block = 2 * i64::from(self.layout.length);
        self.turn = self.carrier.after_half_samples(block).unit();
        self.first = self.phase(0).unit();
        self.covariance = self.covariance();
    }

    /// Covariance of the parameters, from the design rows of all blocks.
    #[inline(never)]
    fn covariance(&self) -> Covariance {
        let [mut even, mut odd] = [Normal::ZERO; 2];
        for index in 0..self.blocks {
            for [even_row, odd_row] in &self.rows(self.time(index), self.phase(index).unit()) {
                even.add(even_row);
                odd.add(odd_row);
            }
        }
        Covariance {
            even: even.inverse(),
            odd: odd.inverse(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::Cut;

    #[test]
    fn every_window_has_degrees_of_freedom_for_its_noise() {
        for periods in [2, 3, 4, 5, 7, 10, 20] {
            for (has_hop, own_offsets) in [(false, false), (true, false), (false, true)] {
                let cut = Cut {
                    periods,
                    has_hop,
                    own_offsets,
                };
                for i in 0..200 {
                    // 2.5 to 200 samples a period.
                    let period = 2.5 * libm::powf(200.0 / 2.5, i as f32 / 200.0);
                    let length = cut.length(period, 200);
                    let layout = Layout::unrounded(PhaseStep::from_period(period), length);
                    let (blocks, ideal) = (cut.blocks(layout), Calibration::IDEAL);
                    let model = Model::new(layout, layout.step, blocks, ideal, 1e5, own_offsets);
                    let freedom = model.freedom();
                    if own_offsets && periods >= cut.min_hum_periods() {
                        assert_eq!(model.shared, 0.0, "{period}, {periods}");
                    }
                    assert!(
                        freedom >= 2.0,
                        "{period}, {periods}, {has_hop}, {own_offsets}: {freedom}"
                    );
                }
            }
        }
    }
}
