//! Decides whether a stretch of samples is one wave of about the proposed period, and refines the period.

use num_complex::Complex32;

use crate::block::Pair;
use crate::phase::PhaseStep;
use crate::scalar::greater;

/// Share of the signal's power that a wave may leave unexplained; 20 % noise leaves 14 %.
const MAX_UNEXPLAINED: f32 = 0.3;
/// Limit of [`chance`]: white noise passes a trial with a probability of up to 600 times this.
const FALSE_ALARM: f32 = 1e-11;
/// Unexplained share above which the residuals must be shown to be noise, not a second tone.
const TONE_SHARE: f32 = 2e-3;
/// The same for stretches of [`LONG_PERIODS`], which tell a wave with a tone of 20 % beside it from two equal tones.
const LOUD_TONE_SHARE: f32 = 0.1;
/// Periods from which on a stretch is long.
const LONG_PERIODS: f32 = 2.6;

/// Least-squares fit of a wave, its linear change and an offset to a stretch of samples of known length.
///
/// The columns of the design are cos φ, −sin φ, u cos φ, −u sin φ and 1, with φ and u from the middle of the stretch: even and odd
/// columns are orthogonal, and two samples equally far from the middle share a row.
#[derive(Debug, Clone)]
pub(crate) struct Trial {
    step: PhaseStep,
    length: usize,
    count: usize,
    sums: Sums,
}

/// Sums of a trial.
#[derive(Debug, Clone, Copy)]
struct Sums {
    row: Row,
    /// Squares and products of the even columns: (0,0), (0,3), (3,3), (0,4), (3,4). Those of the odd columns follow from them.
    even: [f32; 5],
    gradient: [[f32; 5]; 2],
    square: f32,
}

impl Sums {
    /// Adds the next row of the design for `rows` samples, one or two: `sum` for the even columns, `difference` for the odd ones.
    #[inline]
    fn add(&mut self, rows: f32, sum: Pair, difference: Pair) {
        let [c, s, uc, us] = self.row.next();
        // A row's products count once for each of its samples.
        let (all_c, all_us) = (rows * c, rows * us);
        // Written out: compiled for size, loops over arrays would take twice as long.
        self.even[0] += all_c * c;
        self.even[1] += all_c * us;
        self.even[2] += all_us * us;
        self.even[3] += all_c;
        self.even[4] += all_us;
        let [of_c, of_d] = &mut self.gradient;
        add(of_c, [c, s, uc, us], sum[0], difference[0]);
        add(of_d, [c, s, uc, us], sum[1], difference[1]);
    }
}

/// Adds a row to the right-hand sides of one pick-off.
#[inline(always)]
fn add(gradient: &mut [f32; 5], [c, s, uc, us]: [f32; 4], sum: f32, difference: f32) {
    gradient[0] += c * sum;
    gradient[1] += s * difference;
    gradient[2] += uc * difference;
    gradient[3] += us * sum;
    gradient[4] += sum;
}

/// Inverse of a symmetric 2×2 matrix.
struct Inverse {
    entries: [f32; 3],
}

impl Inverse {
    /// Inverse of the matrix with entries (0,0), (0,1), (1,1).
    fn new([a, b, d]: [f32; 3]) -> Self {
        let scale = 1.0 / (a * d - b * b);
        Self {
            entries: [d * scale, -b * scale, a * scale],
        }
    }

    #[inline(always)]
    fn solve(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [a, b, d] = self.entries;
        [a * x + b * y, b * x + d * y]
    }
}

/// Rows of the design, one after another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    /// cos φ − j sin φ.
    unit: Complex32,
    turn: Complex32,
    u: f32,
    advance: f32,
}

impl Row {
    pub(super) const NONE: Self = Self {
        unit: Complex32::ZERO,
        turn: Complex32::ZERO,
        u: 0.0,
        advance: 0.0,
    };

    /// Makes this the first row of a design.
    fn begin(&mut self, step: PhaseStep, length: usize) {
        self.turn = step.after_half_samples(-2).unit();
        self.advance = 2.0 / length as f32;
        self.restart(step, length);
    }

    /// Goes back to the first row.
    fn restart(&mut self, step: PhaseStep, length: usize) {
        let before_middle = length as i32 - 1;
        self.unit = step.after_half_samples(i64::from(before_middle)).unit();
        self.u = -0.5 * before_middle as f32 * self.advance;
    }

    /// The next row, without its last column, which is 1.
    #[inline]
    pub(super) fn next(&mut self) -> [f32; 4] {
        let (Complex32 { re, im }, u) = (self.unit, self.u);
        self.unit *= self.turn;
        self.u += self.advance;
        [re, im, u * re, u * im]
    }
}

/// Fit of a stretch that may be a wave.
#[derive(Debug, Clone)]
pub(crate) struct Fitted {
    /// Period in samples.
    pub period: f32,
    /// Variance of the samples, both pick-offs together.
    pub power: f32,
    /// Unexplained share of the power, less the share that needs no second look: above 0 the residuals must still be shown to be noise,
    /// not a second tone.
    pub doubt: f32,
    /// Coefficients of cos φ, −sin φ, u cos φ, −u sin φ and 1, for each pick-off.
    pub parameters: [[f32; 5]; 2],
}

impl Trial {
    /// A trial of no samples.
    pub(crate) const NONE: Self = Self {
        step: PhaseStep(0),
        length: 0,
        count: 0,
        sums: Sums {
            row: Row::NONE,
            even: [0.0; 5],
            gradient: [[0.0; 5]; 2],
            square: 0.0,
        },
    };

    /// Begins a trial of a period of `period` samples over a stretch of `length` samples, in place.
    pub(crate) fn begin(&mut self, period: f32, length: usize) {
        self.step = PhaseStep::from_period(period);
        self.length = length;
        self.count = 0;
        self.sums.row.begin(self.step, length);
        self.sums.even = [0.0; 5];
        self.sums.gradient = [[0.0; 5]; 2];
        self.sums.square = 0.0;
    }

    /// Takes the next sample.
    #[cfg(feature = "mean-return")]
    pub(crate) fn push(&mut self, sample: Pair) {
        self.sums.add(1.0, sample, sample);
        self.sums.square += sample[0] * sample[0] + sample[1] * sample[1];
        self.count += 1;
    }

    /// True once all samples are taken.
    #[cfg(feature = "mean-return")]
    pub(crate) fn is_whole(&self) -> bool {
        self.count >= self.length
    }

    /// Takes samples in twos: the next one from the start, and the next one from the end backwards.
    #[inline(always)]
    pub(crate) fn push_ends(&mut self, ends: impl Iterator<Item = [Pair; 2]>) {
        let mut sums = self.sums;
        for [a, b] in ends {
            let (sum, difference) = ([a[0] + b[0], a[1] + b[1]], [a[0] - b[0], a[1] - b[1]]);
            sums.add(2.0, sum, difference);
            sums.square += a[0] * a[0];
            sums.square += a[1] * a[1];
            sums.square += b[0] * b[0];
            sums.square += b[1] * b[1];
        }
        self.sums = sums;
    }

    /// Coefficients of both pick-offs: a stretch of two periods or more determines them.
    fn parameters(&self) -> [[f32; 5]; 2] {
        let [cc, cus, usus, c1, us1] = self.sums.even;
        let n = self.length as f32;
        let per_sample = 1.0 / n;
        // From cos² + sin² = 1, and Σ u² = (n² − 1)/3n.
        let odd = Inverse::new([n - cc, cus, (n - per_sample) / 3.0 - usus]);
        // With the offset eliminated, the even columns are two as well.
        let (mean_c, mean_us) = (c1 * per_sample, us1 * per_sample);
        let even = Inverse::new([cc - c1 * mean_c, cus - c1 * mean_us, usus - us1 * mean_us]);
        self.sums.gradient.map(|[c, s, uc, us, sum]| {
            let [x_s, x_uc] = odd.solve([s, uc]);
            let [x_c, x_us] = even.solve([c - mean_c * sum, us - mean_us * sum]);
            let offset = per_sample * sum - mean_c * x_c - mean_us * x_us;
            [x_c, x_s, x_uc, x_us, offset]
        })
    }

    /// The wave, if the completed stretch holds one. Its residual is taken to be at least `rounding` in power per pair.
    pub(crate) fn fitted(&self, rounding: f32) -> Option<Fitted> {
        let parameters = self.parameters();
        let n = self.length as f32;
        let mut explained = 0.0;
        let mut turned = 0.0;
        let mut size = 0.0;
        for (gradient, x) in self.sums.gradient.iter().zip(&parameters) {
            explained += gradient.iter().zip(x).map(|(g, x)| g * x).sum::<f32>();
            let (z, change) = (Complex32::new(x[0], x[1]), Complex32::new(x[2], x[3]));
            turned += (change * z.conj()).im;
            size += z.norm_sqr();
        }
        let sums = self.sums.gradient.map(|gradient| gradient[4]);
        let power = self.sums.square - (sums[0] * sums[0] + sums[1] * sums[1]) / n;
        if power <= 1e-6 * self.sums.square {
            return None;
        }
        let left = self.sums.square - explained;
        // Samples with only a few values are now and then fitted without residual by chance.
        let rest = greater(rounding * n, left) / power;
        let drift = turned / size;
        if !(rest < MAX_UNEXPLAINED && chance(rest, self.length) < FALSE_ALARM && drift.abs() < 1.0)
        {
            return None;
        }
        let period = self.step.shifted(2.0 * drift / n).period();
        let tone = if n < LONG_PERIODS * period {
            TONE_SHARE
        } else {
            LOUD_TONE_SHARE
        };
        Some(Fitted {
            period,
            power: power / n,
            doubt: rest - tone,
            parameters,
        })
    }

    /// Sets `row` to the first one of the design, for a second pass over the same samples.
    pub(super) fn restart(&self, row: &mut Row) {
        *row = self.sums.row;
        row.restart(self.step, self.length);
    }
}

/// Probability that a fit of white noise, of n pairs, leaves an unexplained share below `rest`, but for a factor: rest^(n−5).
///
/// Of 2n numbers, their means and eight parameters are fitted, so the share follows Beta(n − 5, 4). At the limit the factor, a polynomial
/// of the third degree in 1 − rest, is 50 to 600 for n of 10 to 24.
fn chance(rest: f32, n: usize) -> f32 {
    let (mut chance, mut power) = (1.0, rest);
    let mut left = n.saturating_sub(5);
    while left > 0 {
        if left % 2 == 1 {
            chance *= power;
        }
        power *= power;
        left /= 2;
    }
    chance
}
