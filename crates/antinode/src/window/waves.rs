//! The two travelling waves of a window, and what blocks would sum of them.
//!
//! z₊ = z_C + j z_D and z₋ = z_C − j z_D each run as one exponential while the pattern precesses and decays. So every sum of every
//! block is the real part of a constant times the wave's phasor there: the constants are made once a pass, the phasors by one
//! complex product a block.

use num_complex::Complex32;

use super::model::Model;
use super::response::Answer;

/// Blocks between two exact exponentials; between them a recursion, whose rounding grows by 6·10⁻⁸ a block.
const ANCHOR: u16 = 8;

/// The raw parameters of both pick-offs, as they stand in the normal equations.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Parameters {
    pub z: [Complex32; 2],
    pub slope: [Complex32; 2],
    pub offset: [f32; 2],
}

/// The travelling waves at the middle of a window, and their courses.
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

impl Waves {
    /// The waves of ideal pick-offs from the raw parameters.
    pub(super) fn new(model: &Model, parameters: &Parameters) -> Self {
        let correction = &model.correction;
        let travelling = |raw: [Complex32; 2]| {
            let [c, d] = correction.correct(raw);
            let turned = Complex32::new(-d.im, d.re);
            [c + turned, c - turned]
        };
        // Channel D was sampled later: what it saw lies that much further along its course.
        let [c, d] = parameters.z;
        let d = d - parameters.slope[1] * (correction.delay / model.half());
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
        let rest = core::array::from_fn(|w| {
            if slope[w] == Complex32::ZERO {
                change[w]
            } else {
                Complex32::ZERO
            }
        });
        Self {
            value,
            change,
            slope,
            rest,
        }
    }

    /// The raw parameters that these waves have `later` samples on, had they kept their course.
    pub(super) fn parameters(
        &self,
        model: &Model,
        later: f32,
        turn: Complex32,
    ) -> [[Complex32; 2]; 2] {
        let correction = &model.correction;
        let half = model.half();
        let windows = later / half;
        let grown = |w: usize| {
            let ahead = exponential(self.slope[w & 1] * windows);
            (self.value[w & 1] * ahead + self.rest[w & 1] * windows) * turn
        };
        let grown = [grown(0), grown(1)];
        let slope = |w: usize| {
            if self.slope[w & 1] == Complex32::ZERO {
                self.rest[w & 1] * turn
            } else {
                grown[w & 1] * self.slope[w & 1]
            }
        };
        let slope = [slope(0), slope(1)];
        let pick_offs = |[plus, minus]: [Complex32; 2]| {
            let apart = (plus - minus) * 0.5;
            correction.distort([(plus + minus) * 0.5, Complex32::new(apart.im, -apart.re)])
        };
        let (mut z, slope) = (pick_offs(grown), pick_offs(slope));
        z[1] += slope[1] * (correction.delay / half);
        [z, slope]
    }

    /// The greatest |z′/z|² of the waves, a half window.
    pub(super) fn reach(&self) -> f32 {
        let [plus, minus] = self.slope.map(|slope| slope.norm_sqr());
        if plus > minus { plus } else { minus }
    }

    /// |z₊|² + |z₋|².
    pub(crate) fn power(&self) -> f32 {
        self.value[0].norm_sqr() + self.value[1].norm_sqr()
    }

    /// The common phase advance beyond the carrier, rad a half window, weighted by the power of the waves.
    pub(super) fn drift(&self) -> f32 {
        let turned = |w: usize| (self.change[w] * self.value[w].conj()).im;
        let power = self.power();
        if power > 0.0 {
            (turned(0) + turned(1)) / power
        } else {
            0.0
        }
    }
}

/// The phasors of both waves and of the carrier, from block to block.
pub(super) struct Course<'a> {
    model: &'a Model,
    waves: Waves,
    /// What a block adds to the phase and the logarithm of each wave, as a factor.
    factor: [Complex32; 2],
    turn: Complex32,
    running: [Complex32; 2],
    unit: Complex32,
    /// Time of the next block's middle, and the time between two.
    u: f32,
    advance: f32,
    index: u16,
    /// True when a wave has more than an exponential course.
    is_bent: bool,
}

/// One block's phasors.
pub(super) struct Here {
    pub u: f32,
    /// The carrier at the block's middle.
    pub unit: Complex32,
    /// z₊ and z₋ there, turned with the carrier.
    pub waves: [Complex32; 2],
}

impl<'a> Course<'a> {
    pub(super) fn new(model: &'a Model, waves: &Waves) -> Self {
        let turn = model
            .carrier
            .after_half_samples(2 * i64::from(model.layout.length))
            .unit();
        let blocks = f32::from(model.blocks);
        Self {
            model,
            waves: *waves,
            factor: waves
                .slope
                .map(|slope| exponential(slope * (2.0 / blocks)) * turn),
            turn,
            running: [Complex32::ZERO; 2],
            unit: Complex32::ONE,
            u: model.time(0),
            advance: 2.0 / blocks,
            index: 0,
            is_bent: waves.rest != [Complex32::ZERO; 2],
        }
    }

    /// The next block.
    #[inline(always)]
    pub(super) fn next(&mut self) -> Here {
        let index = self.index;
        self.index += 1;
        let u = self.u;
        self.u += self.advance;
        if index.is_multiple_of(ANCHOR) {
            self.unit = self.model.phase(index).unit();
            let waves = &self.waves;
            let at =
                |w: usize| waves.value[w & 1] * exponential(waves.slope[w & 1] * u) * self.unit;
            self.running = [at(0), at(1)];
        } else {
            self.unit *= self.turn;
            self.running = [
                self.running[0] * self.factor[0],
                self.running[1] * self.factor[1],
            ];
        }
        let mut waves = self.running;
        if self.is_bent {
            let rest = self.waves.rest.map(|rest| rest * self.unit * u);
            waves = [waves[0] + rest[0], waves[1] + rest[1]];
        }
        Here {
            u,
            unit: self.unit,
            waves,
        }
    }
}

/// e^x for |x| up to 1: within 3·10⁻⁶ there, and 10⁻⁸ up to 0.5.
fn exponential(x: Complex32) -> Complex32 {
    const INVERSE: [f32; 8] = [
        1.0 / 8.0,
        1.0 / 7.0,
        1.0 / 6.0,
        1.0 / 5.0,
        1.0 / 4.0,
        1.0 / 3.0,
        1.0 / 2.0,
        1.0,
    ];
    INVERSE
        .iter()
        .fold(Complex32::ONE, |sum, &inverse| sum * x * inverse + 1.0)
}

/// The constants by which one sum of one pick-off answers to z₊ and z₋: it is the real part of their products.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gains([Complex32; 2]);

impl Gains {
    #[inline(always)]
    pub(super) fn of(&self, here: &Here) -> f32 {
        let [p, m] = &self.0;
        let [plus, minus] = &here.waves;
        p.re * plus.re - p.im * plus.im + m.re * minus.re - m.im * minus.im
    }
}

/// What the two waves make of the pick-offs: raw z_C and z_D are these factors times z₊ and z₋.
pub(super) struct Mixing {
    /// Of each pick-off, for each wave.
    factors: [[Complex32; 2]; 2],
    /// z′/z of each wave, a sample.
    slope: [Complex32; 2],
}

impl Mixing {
    pub(super) fn new(model: &Model, waves: &Waves) -> Self {
        let per_sample = 1.0 / model.half();
        let slope = waves.slope.map(|slope| slope * per_sample);
        let mut factors = [[Complex32::ZERO; 2]; 2];
        for (w, side) in [1.0, -1.0].into_iter().enumerate() {
            let ideal = [Complex32::new(0.5, 0.0), Complex32::new(0.0, -0.5 * side)];
            let [c, d] = model.correction.distort(ideal);
            factors[0][w] = c;
            factors[1][w] = d * (slope[w] * model.correction.delay + 1.0);
        }
        Self { factors, slope }
    }

    /// The gains of each pick-off in a sum that is even in time: level·Re v₀ + slope·Im v₁ + curve·Re v₂.
    pub(super) fn even(&self, answer: &Answer) -> [Gains; 2] {
        self.gains(self.slope.map(|s| {
            let turned = Complex32::new(s.im, -s.re) * answer.slope;
            turned + s * s * answer.curve + answer.level
        }))
    }

    /// The gains of each pick-off in a sum that is odd in time: level·Im v₀ + slope·Re v₁ + curve·Im v₂.
    pub(super) fn odd(&self, answer: &Answer) -> [Gains; 2] {
        self.gains(self.slope.map(|s| {
            let turned = Complex32::new(-s.im, s.re) * answer.slope;
            let gain = turned + s * s * answer.curve + answer.level;
            // The imaginary part of a number is the real part of −j times it.
            Complex32::new(gain.im, -gain.re)
        }))
    }

    fn gains(&self, of_waves: [Complex32; 2]) -> [Gains; 2] {
        self.factors
            .map(|factors| Gains([factors[0] * of_waves[0], factors[1] * of_waves[1]]))
    }
}
