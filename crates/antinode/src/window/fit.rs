//! Block sums become a window's waves: the exact least-squares fit over any run of blocks.
//!
//! Each pick-off is Re(z(t)·e^{jωt}) + d with a slowly changing z. About a carrier near ω it has five linear parameters, z, z′ and
//! d at the middle of the window, and both pick-offs share one 5×5 matrix that does not depend on the data. What is not linear,
//! the exponential course of the two travelling waves z₊ = z_C + j z_D and z₋ = z_C − j z_D, is predicted exactly and fitted by
//! Gauss–Newton steps on the rest.

use num_complex::Complex32;

use super::normal::{Normal, PARAMETERS, Row};
use super::response::{Basis, Response, whiten};
use crate::block::{Block, Layout};
use crate::calibration::{Calibration, Correction};
use crate::phase::{Phase, PhaseStep};

/// Beyond this phase (rad) between a window's middle and its end the carrier is moved before the fit is believed.
const CARRIER_REACH: f32 = 0.05;
/// A fit that still moves by more than this share of the wave has found nothing.
const NEAR: f32 = 0.01;
/// A fit that moves by less than this, or by less than its noise, is not stepped again.
const SETTLED: f32 = 2e-6;
/// Blocks between two exact exponentials; between them a recursion, whose rounding grows by 6·10⁻⁸ a block.
const ANCHOR: usize = 8;

/// Everything about a window's fit that does not depend on its samples.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub layout: Layout,
    pub blocks: u16,
    pub carrier: PhaseStep,
    calibration: Calibration,
    sample_rate: f32,
    basis: Basis,
    response: Response,
    normal: Normal,
    correction: Correction,
    /// Covariance of (Re z, Im z, Re z′, Im z′) for noise of one a sample.
    pub covariance: [[f32; 4]; 4],
}

/// The two travelling waves at the middle of a window, and their courses.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Waves {
    /// z₊ and z₋.
    pub value: [Complex32; 2],
    /// z₊′ and z₋′ for each half window.
    pub change: [Complex32; 2],
    /// What of the change is exponential: z′/z, or nothing where a wave is too small to have a course of its own.
    slope: [Complex32; 2],
    /// What is left of the change: it runs linearly.
    rest: [Complex32; 2],
}

/// What a fit found.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub waves: Waves,
    pub offsets: [f32; 2],
    /// Sum of the squared whitened residuals, and its degrees of freedom.
    pub residual: f32,
    pub freedom: f32,
    /// The largest share of one block in `residual`.
    pub worst_block: f32,
    /// The most that one step of both phasors between two blocks would take off `residual`, 4 degrees of freedom.
    pub step: f32,
    /// Third harmonic of each pick-off: complex amplitude, input units.
    pub third: [Complex32; 2],
    /// Noise variance a sample seen about the third harmonic, and its degrees of freedom.
    pub third_noise: f32,
    pub third_freedom: f32,
    /// False when the steps did not settle.
    pub settled: bool,
}

/// Parameters of both pick-offs, as they stand in the normal equations.
#[derive(Debug, Clone, Copy, Default)]
struct Parameters {
    z: [Complex32; 2],
    slope: [Complex32; 2],
    offset: [f32; 2],
}

/// What one pass over the blocks gathers.
#[derive(Default)]
struct Pass {
    gradient: [Row; 2],
    residual: f32,
    worst: f32,
    step: f32,
    third: [Complex32; 2],
    third_power: f32,
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
            basis,
            response: Response::new(layout, &basis, carrier),
            normal: Normal::ZERO,
            correction: calibration.at(1.0 / carrier.period(), sample_rate),
            covariance: [[0.0; 4]; 4],
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

    /// Half the window, in samples.
    pub(crate) fn half(&self) -> f32 {
        0.5 * f32::from(self.blocks) * f32::from(self.layout.length)
    }

    /// Degrees of freedom that the residual has.
    fn freedom(&self) -> f32 {
        2.0 * (f32::from(self.basis.rank) * f32::from(self.blocks) - PARAMETERS as f32).max(0.5)
    }

    /// Correction of the pick-offs at the carrier.
    pub(crate) fn correction(&self) -> &Correction {
        &self.correction
    }

    /// Time of the middle of block `index`, −1…1 over the window, and the carrier there.
    #[inline]
    fn place(&self, index: usize) -> (f32, Phase) {
        let twice_blocks = 2 * index as i64 + 1 - i64::from(self.blocks);
        let u = twice_blocks as f32 / f32::from(self.blocks);
        (
            u,
            self.carrier
                .after_half_samples(twice_blocks * i64::from(self.layout.length)),
        )
    }

    /// The three design rows of a block: mean, even, odd.
    #[inline]
    fn rows(&self, u: f32, unit: Complex32) -> [Row; 3] {
        let (c, s) = (unit.re, unit.im);
        let per_sample = 1.0 / self.half();
        let even = |level: f32, slope: f32, offset: f32| {
            let (l, k) = (level * u, slope * per_sample);
            [level * c, -level * s, l * c + k * s, k * c - l * s, offset]
        };
        let r = &self.response;
        let (l, k) = (r.odd.level * u, r.odd.slope * per_sample);
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
        self.normal = Normal::ZERO;
        for index in 0..usize::from(self.blocks) {
            let (u, phase) = self.place(index);
            for row in &self.rows(u, phase.unit()) {
                self.normal.add(row);
            }
        }
        self.normal.factorise();
        for i in 0..4 {
            let mut unit = [0.0; PARAMETERS];
            unit[i] = 1.0;
            self.covariance[i].copy_from_slice(&self.normal.solve(unit)[..4]);
        }
    }

    /// The travelling waves of ideal pick-offs from the raw parameters.
    fn waves(&self, parameters: &Parameters) -> Waves {
        let travelling = |raw: [Complex32; 2]| {
            let [c, d] = self.correction.correct(raw);
            let turned = Complex32::new(-d.im, d.re);
            [c + turned, c - turned]
        };
        // Channel D was sampled later: what it saw lies that much further along its course.
        let [c, d] = parameters.z;
        let d = d - parameters.slope[1] * (self.correction.delay / self.half());
        let value = travelling([c, d]);
        let change = travelling(parameters.slope);
        let slope = core::array::from_fn(|w| {
            let power = value[w].norm_sqr();
            let steady = change[w].norm_sqr() < 0.25 * power;
            if steady {
                change[w] * value[w].conj() / power
            } else {
                Complex32::ZERO
            }
        });
        let rest = core::array::from_fn(|w| change[w] - slope[w] * value[w]);
        Waves {
            value,
            change,
            slope,
            rest,
        }
    }

    /// One pass: residuals of every block against the prediction, and their gradient.
    fn pass<'a>(
        &self,
        blocks: impl Iterator<Item = &'a Block>,
        waves: &Waves,
        offset: [f32; 2],
    ) -> Pass {
        let mut pass = Pass::default();
        let per_sample = 1.0 / self.half();
        let advance = waves
            .slope
            .map(|s| exponential(s * (2.0 / f32::from(self.blocks))));
        let first = waves.slope.map(|s| s * per_sample);
        let mut steps = Steps::new(self.blocks, &self.response);
        let mut course = [Complex32::ONE; 2];
        for (index, block) in blocks.enumerate() {
            let (u, phase) = self.place(index);
            let unit = phase.unit();
            if index % ANCHOR == 0 {
                course = waves.slope.map(|s| exponential(s * u));
            }
            let mut local = [[Complex32::ZERO; 2]; 3];
            for wave in 0..2 {
                let level = waves.value[wave] * course[wave] * unit;
                let rest = waves.rest[wave] * unit;
                local[0][wave] = level + rest * u;
                local[1][wave] = level * first[wave] + rest * per_sample;
                local[2][wave] = level * first[wave] * first[wave];
                course[wave] *= advance[wave];
            }
            let mut raw = local.map(|[plus, minus]| {
                let d = (plus - minus) * 0.5;
                self.correction
                    .distort([(plus + minus) * 0.5, Complex32::new(d.im, -d.re)])
            });
            raw[0][1] += raw[1][1] * self.correction.delay;
            raw[1][1] += raw[2][1] * self.correction.delay;
            let rows = self.rows(u, unit);
            let seen = whiten(&self.basis, block);
            let mut level = [[0.0; 2]; 2];
            let mut power = 0.0;
            for channel in 0..2 {
                let v = raw.map(|both| both[channel]);
                let predicted = self.response.predict(&v, offset[channel]);
                let rest = [
                    seen[channel].mean - predicted.mean,
                    seen[channel].even - predicted.even,
                    seen[channel].odd - predicted.odd,
                ];
                for (row, rest) in rows.iter().zip(rest) {
                    power += rest * rest;
                    // The first two weights are those of z itself.
                    level[channel][0] += row[0] * rest;
                    level[channel][1] += row[1] * rest;
                    for (sum, weight) in pass.gradient[channel].iter_mut().zip(row) {
                        *sum += weight * rest;
                    }
                }
                let third = self
                    .response
                    .third_rest(&block.channels[channel], &v, offset[channel]);
                pass.third[channel] += third * Phase(phase.0.wrapping_mul(3)).unit().conj();
                pass.third_power += third.norm_sqr();
            }
            pass.step = pass.step.max(steps.add(u, level));
            pass.residual += power;
            pass.worst = if power > pass.worst {
                power
            } else {
                pass.worst
            };
        }
        pass
    }

    /// Fits `blocks`, which are as many as the model was built for.
    fn fit<'a>(&self, blocks: impl Iterator<Item = &'a Block> + Clone) -> Fit {
        let mut parameters = Parameters::default();
        let mut settled = false;
        let mut pass = Pass::default();
        let mut explained = 0.0;
        for step in 0..6 {
            let waves = self.waves(&parameters);
            pass = self.pass(blocks.clone(), &waves, parameters.offset);
            let mut moved = 0.0;
            let mut total = 0.0;
            explained = 0.0;
            for channel in 0..2 {
                let gradient = pass.gradient[channel];
                let change = self.normal.solve(gradient);
                explained += gradient
                    .iter()
                    .zip(&change)
                    .map(|(g, x)| g * x)
                    .sum::<f32>();
                let z = Complex32::new(change[0], change[1]);
                let slope = Complex32::new(change[2], change[3]);
                parameters.z[channel] += z;
                parameters.slope[channel] += slope;
                parameters.offset[channel] += change[4];
                moved += z.norm_sqr() + slope.norm_sqr();
                total += parameters.z[channel].norm_sqr();
            }
            // Enough when the last step is small beside the noise, or beside rounding.
            let rest = (pass.residual - explained) / self.freedom();
            settled = step > 0 && moved <= NEAR * NEAR * total;
            if settled && (explained < 0.3 * rest || moved <= SETTLED * SETTLED * total) {
                break;
            }
        }
        let blocks = f32::from(self.blocks);
        let length = f32::from(self.layout.length);
        let coherent = (pass.third[0].norm_sqr() + pass.third[1].norm_sqr()) / blocks;
        let third_freedom = 4.0 * (blocks - 1.0);
        Fit {
            waves: self.waves(&parameters),
            offsets: parameters.offset,
            residual: (pass.residual - explained).max(0.0),
            freedom: self.freedom(),
            // Measured before the last step: what that step took away is no fault of the block's.
            worst_block: (pass.worst - explained).max(0.0),
            step: pass.step,
            third: pass.third.map(|sum| sum * (2.0 / (blocks * length))),
            third_noise: (pass.third_power - coherent).max(0.0) / (0.5 * length * third_freedom),
            third_freedom,
            settled,
        }
    }
}

/// Looks for a step of the phasors between two blocks: the sum of the residuals so far, against what noise would make it.
struct Steps {
    /// Mean weight of z in a block, over all phases of the carrier.
    weight: f32,
    blocks: f32,
    /// Σu² over the window, u being the blocks' middles.
    spread: f32,
    count: f32,
    time: f32,
    sum: [[f32; 2]; 2],
}

impl Steps {
    fn new(blocks: u16, response: &Response) -> Self {
        let levels = [response.mean, response.even, response.odd].map(|answer| answer.level);
        let blocks = f32::from(blocks);
        Self {
            weight: 0.5 * levels.iter().map(|level| level * level).sum::<f32>(),
            blocks,
            spread: (blocks - 1.0 / blocks) / 3.0,
            count: 0.0,
            time: 0.0,
            sum: [[0.0; 2]; 2],
        }
    }

    /// Takes the next block's residual along z; gives what a step after it would explain.
    fn add(&mut self, u: f32, level: [[f32; 2]; 2]) -> f32 {
        self.count += 1.0;
        self.time += u;
        let mut power = 0.0;
        for (sum, level) in self.sum.iter_mut().flatten().zip(level.iter().flatten()) {
            *sum += level;
            power += *sum * *sum;
        }
        // A step is known by what of it is neither constant nor slope.
        let room = self.count
            - self.count * self.count / self.blocks
            - self.time * self.time / self.spread;
        if room > 0.2 {
            power / (self.weight * room)
        } else {
            0.0
        }
    }
}

impl Fit {
    /// |z|² of each (ideal) pick-off.
    pub(crate) fn channel_power(&self) -> [f32; 2] {
        let [plus, minus] = self.waves.value;
        [
            0.25 * (plus + minus).norm_sqr(),
            0.25 * (plus - minus).norm_sqr(),
        ]
    }
}

impl Waves {
    /// The common phase advance beyond the carrier, rad a half window, weighted by the power of the waves.
    fn drift(&self) -> f32 {
        let power = self.value[0].norm_sqr() + self.value[1].norm_sqr();
        if power > 0.0 {
            let turned = |w: usize| (self.change[w] * self.value[w].conj()).im;
            (turned(0) + turned(1)) / power
        } else {
            0.0
        }
    }
}

/// e^x for a small complex x.
fn exponential(x: Complex32) -> Complex32 {
    Phase::from_radians(x.im).unit() * libm::expf(x.re)
}

/// Solves a run of blocks from a carrier known to `uncertainty` rad a sample.
///
/// A carrier too rough for the whole window is first refined in its middle: a single jump to a long window would slip a turn.
pub(crate) fn solve<'a>(
    model: &mut Model,
    blocks: impl Iterator<Item = &'a Block> + Clone,
    count: u16,
    carrier: PhaseStep,
    mut uncertainty: f32,
) -> Fit {
    let length = f32::from(model.layout.length);
    let shortest = count
        .min((2.5 * carrier.period() / length) as u16 + 1)
        .max(count.min(4));
    let reach = |uncertainty: f32| {
        let blocks = 1.0 / (uncertainty * length + 1e-9);
        if blocks >= f32::from(count) {
            count
        } else {
            (blocks as u16).max(shortest)
        }
    };
    let mut span = reach(uncertainty);
    let mut carrier = carrier;
    let mut fit;
    let mut moves = 0;
    loop {
        model.retune(carrier, span);
        let skipped = usize::from((count - span) / 2);
        fit = model.fit(blocks.clone().skip(skipped).take(usize::from(span)));
        let drift = fit.waves.drift();
        let half = model.half();
        if span == count && (drift.abs() <= CARRIER_REACH || moves >= 4) {
            break;
        }
        if drift.abs() > 1.5 || !drift.is_finite() {
            // The wave is nowhere near: the caller sees a fit that did not settle.
            model.retune(carrier, count);
            fit = model.fit(blocks.clone().take(usize::from(count)));
            fit.settled = false;
            break;
        }
        carrier = carrier.shifted(drift / half);
        if span == count {
            moves += 1;
            continue;
        }
        let power = fit.waves.value[0].norm_sqr() + fit.waves.value[1].norm_sqr();
        let noise = fit.residual / fit.freedom;
        // Four standard deviations of the frequency, from the bound.
        uncertainty = 4.0 * libm::sqrtf(2.0 * noise * model.covariance[3][3] / power) / half;
        span = reach(uncertainty).max(span + 1).min(count);
    }
    fit
}
