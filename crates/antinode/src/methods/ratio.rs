//! Mean ratio of the pick-offs, formula (13).

use crate::block::Pair;

/// Running sum of S_D/S_C over a window, without samples of small S_C.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    least: f32,
    count: u32,
    sum: f64,
}

impl Ratio {
    /// An empty sum that leaves out samples with |S_C| below `least`, input units, ≥ 0: several times the noise.
    pub fn new(least: f32) -> Self {
        Self {
            least,
            count: 0,
            sum: 0.0,
        }
    }

    /// The ratio of a slice of centred sample pairs, without those of |S_C| below `least`.
    pub fn of(pairs: &[Pair], least: f32) -> Self {
        let mut ratio = Self::new(least);
        for &pair in pairs {
            ratio.push(pair);
        }
        ratio
    }

    /// Adds a centred sample pair: one f32 division, one f64 addition.
    #[inline]
    pub fn push(&mut self, pair: Pair) {
        if pair[0].abs() >= self.least && pair[0] != 0.0 {
            self.sum += f64::from(pair[1] / pair[0]);
            self.count += 1;
        }
    }

    /// ⟨S_D/S_C⟩; NaN if every sample was left out.
    pub fn mean(&self) -> f64 {
        self.sum / f64::from(self.count)
    }
}
