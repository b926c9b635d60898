//! Second moments of the pick-offs over a window: the sums of algorithms 1, 2 and 3.

use crate::block::Pair;
use crate::sample::{Sample, SamplePair};

/// Second moments of a window. Those of several windows can be added.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moments {
    /// Sample pairs.
    pub count: u32,
    /// Σ S_C², input units squared.
    pub cc: f64,
    /// Σ S_D².
    pub dd: f64,
    /// Σ S_C S_D.
    pub cd: f64,
}

impl Moments {
    /// Moments of a slice of centred sample pairs.
    pub fn of(pairs: &[Pair]) -> Self {
        let mut sums = MomentSums::<f32>::new([0.0; 2]);
        for &pair in pairs {
            sums.push(pair);
        }
        sums.take()
    }

    /// Moments of this window and `other` together.
    #[must_use = "it gives the sum, and changes neither"]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            cc: self.cc + other.cc,
            dd: self.dd + other.dd,
            cd: self.cd + other.cd,
        }
    }

    /// (⟨S_C²⟩, ⟨S_D²⟩, ⟨S_C S_D⟩); NaN for an empty window.
    pub fn means(&self) -> (f64, f64, f64) {
        let scale = 1.0 / f64::from(self.count);
        (self.cc * scale, self.dd * scale, self.cd * scale)
    }

    /// ⟨S_C² + S_D²⟩.
    pub fn power(&self) -> f64 {
        let (cc, dd, _) = self.means();
        cc + dd
    }
}

/// Accumulates [`Moments`] at sample rate from samples of type `S`.
///
/// | `S` | work per pair | range and accuracy |
/// |---|---|---|
/// | `f32` | 3 multiplications, 14 additions | 10⁶ pairs of samples up to 10¹⁵ in magnitude stay in range |
/// | `i16` | 3 multiply-accumulates | exact, except that offsets are rounded to whole codes; they, and samples less offsets, are limited to −32 768 to 32 767. The rounding of offsets adds at most ¼ code² to a mean, the converter's own steps 1/12; up to 2³² pairs a window |
/// | `i32` | as `f32` | codes are rounded to 24 bits |
#[derive(Debug, Clone)]
pub struct MomentSums<S: Sample = f32> {
    offsets: S::Centred,
    count: u32,
    sums: [S::Product; 3],
}

impl<S: Sample> MomentSums<S> {
    /// Empty sums; `offsets` of S_C and S_D, in input units, are subtracted from every sample, (4).
    pub fn new(offsets: [f32; 2]) -> Self {
        Self {
            offsets: S::offsets(offsets),
            count: 0,
            sums: Default::default(),
        }
    }

    /// Adds a sample pair.
    #[inline]
    pub fn push(&mut self, pair: impl SamplePair<S>) {
        let pair = S::centred(pair.pair(), self.offsets);
        S::add_products(&mut self.sums, pair);
        self.count += 1;
    }

    /// Adds the pairs of a slice, with the sums in registers.
    #[inline]
    pub fn extend<P: SamplePair<S>>(&mut self, pairs: &[P]) {
        let (offsets, mut sums) = (self.offsets, self.sums);
        let mut add = |pair: P| {
            let pair = S::centred(pair.pair(), offsets);
            S::add_products(&mut sums, pair);
        };
        // In eights, as the loop's own overhead is as much as a pair's work.
        let (eights, rest) = pairs.as_chunks::<8>();
        for eight in eights {
            eight.iter().copied().for_each(&mut add);
        }
        rest.iter().copied().for_each(add);
        self.sums = sums;
        self.count += pairs.len() as u32;
    }

    /// Takes the moments since the last call; the sums restart.
    pub fn take(&mut self) -> Moments {
        let [cc, dd, cd] = core::mem::take(&mut self.sums).map(S::product_to_f64);
        let count = core::mem::take(&mut self.count);
        Moments { count, cc, dd, cd }
    }
}
