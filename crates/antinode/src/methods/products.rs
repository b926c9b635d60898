//! Mean products of the pick-offs with a reference: CC, CS, DC, DS of (14) and, times 2, the C and S of (24).

use num_complex::Complex64;

use crate::block::{Block, Layout, Pair};
use crate::sample::Sample;

/// Mean products of a window with cos ωt and sin ωt, t from the window's first sample, in input units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Products {
    /// Sample pairs.
    pub count: u32,
    /// ω of the reference, rad a sample.
    pub omega: f64,
    /// CC = ⟨S_C cos ωt⟩ and DC = ⟨S_D cos ωt⟩.
    pub cosine: [f64; 2],
    /// CS = ⟨S_C sin ωt⟩ and DS = ⟨S_D sin ωt⟩.
    pub sine: [f64; 2],
    /// ⟨S_C⟩ and ⟨S_D⟩.
    pub mean: [f64; 2],
}

impl Products {
    /// Products of a slice of centred sample pairs at `omega` rad a sample, in f64: for one frequency of a search, or on a PC. An empty
    /// slice gives NaN.
    pub fn of(pairs: &[Pair], omega: f64) -> Self {
        let (sine, cosine) = libm::sincos(omega);
        let advance = Complex64::new(cosine, -sine);
        let mut unit = Complex64::new(1.0, 0.0);
        let mut sums = [Complex64::ZERO; 2];
        let mut mean = [0.0; 2];
        for pair in pairs {
            for i in 0..2 {
                let sample = f64::from(pair[i]);
                sums[i] += unit * sample;
                mean[i] += sample;
            }
            unit *= advance;
        }
        Self::new(pairs.len() as u32, omega, sums, mean)
    }

    /// Products of successive blocks of one layout, from the demodulator's sums at its frequency. `None` if there is no block.
    pub fn from_blocks<'a, S: Sample>(
        blocks: impl IntoIterator<Item = &'a Block<S>>,
    ) -> Option<Self> {
        let mut blocks = blocks.into_iter().peekable();
        let first = **blocks.peek()?;
        let step = first.layout.step;
        let omega = core::f64::consts::TAU * f64::from(step.0) / 4_294_967_296.0;
        let weights = Weights::of(first.layout);
        let mut sums = [Complex64::ZERO; 2];
        let mut mean = [0.0; 2];
        let mut count = 0;
        for block in blocks {
            // From the window's first sample to the block's middle.
            let samples = block.start.wrapping_sub(first.start) as f64
                + 0.5 * (f64::from(block.layout.length) - 1.0);
            let (sine, cosine) = libm::sincos(omega * samples);
            let value = |sum| f64::from(S::sum_to_f32(sum));
            for (i, channel) in block.sums.iter().enumerate() {
                let sum = value(channel.sum);
                let own = weights.unrounded(value(channel.cosine), value(channel.sine), sum);
                sums[i] += own * Complex64::new(cosine, -sine);
                mean[i] += sum;
            }
            count += u32::from(block.layout.length);
        }
        Some(Self::new(count, omega, sums, mean))
    }

    fn new(count: u32, omega: f64, sums: [Complex64; 2], mean: [f64; 2]) -> Self {
        let scale = 1.0 / f64::from(count);
        Self {
            count,
            omega,
            cosine: sums.map(|sum| sum.re * scale),
            sine: sums.map(|sum| -sum.im * scale),
            mean: mean.map(|sum| sum * scale),
        }
    }

    /// These products after `offsets` of S_C and S_D are subtracted from every sample, (4).
    #[must_use = "it gives others, and changes none"]
    pub fn centred(&self, offsets: [f64; 2]) -> Self {
        let unit = mean_harmonic(1, self.omega, self.count);
        let mut centred = *self;
        for (i, offset) in offsets.into_iter().enumerate() {
            centred.cosine[i] -= offset * unit.re;
            centred.sine[i] += offset * unit.im;
            centred.mean[i] -= offset;
        }
        centred
    }

    /// Q of (24), input units squared: 2 a_A a_B. Its sign is that of the quadrature.
    pub fn q(&self) -> f64 {
        8.0 * (self.sine[1] * self.cosine[0] - self.sine[0] * self.cosine[1])
    }

    /// Products of a combination of the pick-offs: ⟨S cos ωt⟩ and ⟨S sin ωt⟩ for S = x S_C + y S_D.
    pub fn along(&self, x: f64, y: f64) -> (f64, f64) {
        (
            x * self.cosine[0] + y * self.cosine[1],
            x * self.sine[0] + y * self.sine[1],
        )
    }
}

/// Correction for the weights of a block of integer samples, which are cosine and sine rounded to whole numbers.
struct Weights {
    /// Σ cos²/Σ w cos and Σ sin²/Σ w sin.
    gains: [f64; 2],
    /// ⟨w⟩ and ⟨cos⟩ over the block, of the cosine's weights w.
    levels: [f64; 2],
}

impl Weights {
    fn of(layout: Layout) -> Self {
        let exact = Layout { scale: 0, ..layout };
        let (mut squares, mut products, mut levels) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        for k in 0..layout.length {
            let (reference, rounded) = (exact.reference(k), layout.reference(k));
            let pairs = [
                (reference.cosine, rounded.cosine),
                (reference.sine, rounded.sine),
            ];
            for (i, (wave, weight)) in pairs.into_iter().enumerate() {
                squares[i] += f64::from(wave * wave);
                products[i] += f64::from(wave) * f64::from(weight);
            }
            levels[0] += f64::from(rounded.cosine);
            levels[1] += f64::from(reference.cosine);
        }
        let scale = 1.0 / f64::from(layout.length);
        // A block of one sample has no sine.
        let gain = |i: usize| {
            if products[i] == 0.0 {
                0.0
            } else {
                squares[i] / products[i]
            }
        };
        Self {
            gains: [gain(0), gain(1)],
            levels: levels.map(|level| level * scale),
        }
    }

    /// Σ S e^{−jφ} of a block, from its sums with rounded weights.
    fn unrounded(&self, cosine: f64, sine: f64, sum: f64) -> Complex64 {
        let [weights, wave] = self.levels;
        Complex64::new(
            (cosine - weights * sum) * self.gains[0] + wave * sum,
            -sine * self.gains[1],
        )
    }
}

/// ⟨e^{−jmωt}⟩ over `count` samples from t = 0, ω in rad a sample: the Dirichlet sum whose smallness for m = 2 is condition (8).
pub(super) fn mean_harmonic(m: u32, omega: f64, count: u32) -> Complex64 {
    let half = 0.5 * f64::from(m) * omega;
    let n = f64::from(count);
    let below = libm::sin(half);
    let size = if below == 0.0 {
        1.0
    } else {
        libm::sin(n * half) / (n * below)
    };
    let (sine, cosine) = libm::sincos(half * (n - 1.0));
    Complex64::new(size * cosine, -size * sine)
}

/// ⟨cos²⟩, ⟨sin²⟩ and ⟨sin cos⟩ of ωt over a window: exact by Dirichlet sums, without the assumption (8).
pub(super) struct Means {
    cosines: f64,
    sines: f64,
    mixed: f64,
}

impl Means {
    pub(super) fn new(omega: f64, count: u32) -> Self {
        let double = mean_harmonic(2, omega, count);
        Self {
            cosines: 0.5 * (1.0 + double.re),
            sines: 0.5 * (1.0 - double.re),
            mixed: -0.5 * double.im,
        }
    }

    /// ⟨(u cos + v sin)(x cos + y sin)⟩.
    pub(super) fn product(&self, u: f64, v: f64, x: f64, y: f64) -> f64 {
        u * x * self.cosines + v * y * self.sines + (u * y + v * x) * self.mixed
    }
}
