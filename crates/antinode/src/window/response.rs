//! How a block's sums depend on a wave at a given carrier, computed exactly over the block's samples.
//!
//! Within a block the wave of one pick-off is S(κ) = Re v(κ)·cos ωκ − Im v(κ)·sin ωκ + d, κ in samples from the block's middle,
//! with v(κ) = v₀ + v₁κ + ½v₂κ². Even and odd parts separate, so each sum sees only a few of the numbers in v.

use num_complex::Complex32;

use crate::arch::square_root;
use crate::block::Layout;
use crate::phase::PhaseStep;
use crate::sum::Sum;

/// Turns the three correlated sums of a block into independent numbers of equal noise: the noise of one sample.
///
/// The vectors are 1, the cosine less its mean, and the sine, each scaled to length one.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Basis {
    one: f32,
    cosine: f32,
    cosine_mean: f32,
    sine: f32,
    /// What a slope of one over two blocks adds to the odd sum.
    pub ramp: f32,
    /// What a second difference of one between blocks adds to the even sum.
    pub bow: f32,
    /// One over the layout's scale.
    pub unit: f32,
    /// Number of the three vectors that a block resolves: 1 for a block of one sample, else 2 or 3.
    pub rank: u8,
}

/// The whitened sums of one pick-off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Whitened {
    pub mean: f32,
    pub even: f32,
    pub odd: f32,
}

/// How one whitened sum depends on v, with κ in half windows: an even sum is the real part of `level`·v₀ − j·`slope`·v₁ + `curve`·v₂, an
/// odd one its imaginary part.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Answer {
    pub level: f32,
    pub slope: f32,
    pub curve: f32,
}

/// The answers of all sums of a block at one carrier.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Response {
    pub mean: Answer,
    pub even: Answer,
    pub odd: Answer,
    /// What an offset of one adds to the mean: √length.
    pub offset: f32,
    /// Answers of the third harmonic's sums, times the layout's scale.
    pub third_even: Answer,
    pub third_odd: Answer,
    pub third_offset: f32,
}

impl Basis {
    #[inline(never)]
    pub(crate) fn new(layout: Layout) -> Self {
        let n = f32::from(layout.length);
        let [mut mean, mut square, mut sine, mut slope, mut bend] = [Sum::default(); 5];
        for (weight, k) in second_half(layout) {
            let reference = layout.reference(k);
            let twice = layout.twice_from_middle(k) as i32 as f32;
            let (cosine, weighted) = (weight * reference.cosine, weight * reference.sine);
            mean.add(cosine);
            square.add(cosine * reference.cosine);
            sine.add(weighted * reference.sine);
            slope.add(twice * weighted);
            bend.add(twice * twice * cosine);
        }
        let cosine_mean = mean.get() / n;
        // Of the cosine less its mean.
        let even = square.get() - cosine_mean * mean.get();
        let bend = bend.get() - cosine_mean * n * (n * n - 1.0) * (1.0 / 3.0);
        // A vector shorter than this is only rounding: a block of one or two samples has no room for it.
        let least = 1e-4 * n * layout.one() * layout.one();
        let inverse = |square: f32| {
            if square > least {
                1.0 / square_root(square)
            } else {
                0.0
            }
        };
        let (cosine, sine) = (inverse(even), inverse(sine.get()));
        let one = 1.0 / square_root(n);
        Self {
            one,
            cosine,
            cosine_mean,
            sine,
            ramp: 0.25 * slope.get() * sine * one / n,
            bow: 0.125 * bend * cosine * one / (n * n),
            unit: 1.0 / layout.one(),
            rank: 1 + u8::from(cosine > 0.0) + u8::from(sine > 0.0),
        }
    }

    /// The whitened sums of one pick-off, from its raw ones.
    #[inline]
    pub(crate) fn whiten(&self, cosine: f32, sine: f32, sum: f32) -> Whitened {
        Whitened {
            mean: sum * self.one,
            even: (cosine - self.cosine_mean * sum) * self.cosine,
            odd: sine * self.sine,
        }
    }
}

impl Response {
    /// Projection of a block's sums along z, against the carrier at the block's middle; `known` is the part of its mean that tells of the
    /// wave.
    #[inline(always)]
    pub(crate) fn along(&self, sums: &Whitened, known: f32) -> Complex32 {
        Complex32::new(
            self.mean.level * known + self.even.level * sums.even,
            self.odd.level * sums.odd,
        )
    }

    /// The same along z′, besides the projection along z times the time of the block's middle.
    #[inline(always)]
    pub(crate) fn across(&self, sums: &Whitened, known: f32) -> Complex32 {
        Complex32::new(
            -self.odd.slope * sums.odd,
            self.mean.slope * known + self.even.slope * sums.even,
        )
    }

    /// The same response with slopes per block, not per half window, in a window of `blocks`.
    #[inline(always)]
    pub(crate) fn in_blocks(mut self, blocks: u16) -> Self {
        let per_block = 0.5 * f32::from(blocks);
        for answer in [&mut self.mean, &mut self.even, &mut self.odd] {
            answer.slope *= per_block;
        }
        self
    }

    /// The answers of blocks of `layout` to a wave at `carrier`; `per_half` is one over half the window's samples.
    #[inline(never)]
    pub(crate) fn new(layout: Layout, basis: &Basis, carrier: PhaseStep, per_half: f32) -> Self {
        let mut sums = [[Sum::default(); 3]; 5];
        let mut third_offset = Sum::default();
        for (weight, k) in second_half(layout) {
            let reference = layout.reference(k);
            let twice = layout.twice_from_middle(k);
            let t = 0.5 * per_half * twice as i32 as f32;
            let wave = carrier.after_half_samples(twice).unit() * weight;
            // An odd sum sees a wave as an even one sees it turned by a quarter.
            let turned = Complex32::new(-wave.im, wave.re);
            let weighted = [
                wave * basis.one,
                wave * ((reference.cosine - basis.cosine_mean) * basis.cosine),
                turned * (reference.sine * basis.sine),
                wave * reference.third_cosine,
                turned * reference.third_sine,
            ];
            for (sums, wave) in sums.iter_mut().zip(weighted) {
                add(sums, wave, t);
            }
            third_offset.add(weight * reference.third_cosine);
        }
        let answer = |s: &[Sum; 3]| Answer {
            level: s[0].get(),
            slope: s[1].get(),
            curve: s[2].get(),
        };
        Self {
            mean: answer(&sums[0]),
            even: answer(&sums[1]),
            odd: answer(&sums[2]),
            offset: square_root(f32::from(layout.length)),
            third_even: answer(&sums[3]),
            third_odd: answer(&sums[4]),
            third_offset: third_offset.get(),
        }
    }
}

/// The samples of the second half of a block and the weights, 2 or 1, by which sums over them are those over the block: all that is summed is
/// even about its middle.
fn second_half(layout: Layout) -> impl Iterator<Item = (f32, u16)> {
    (layout.length / 2..layout.length).map(move |k| {
        let is_middle = 2 * u32::from(k) + 1 == u32::from(layout.length);
        (if is_middle { 1.0 } else { 2.0 }, k)
    })
}

/// Adds the terms of a wave's level, slope and curve from its sample at time `t`.
#[inline(never)]
fn add(sums: &mut [Sum; 3], wave: Complex32, t: f32) {
    sums[0].add(wave.re);
    sums[1].add(-wave.im * t);
    sums[2].add(0.5 * wave.re * t * t);
}
