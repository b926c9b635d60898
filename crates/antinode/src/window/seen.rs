//! What a window keeps of a block: its whitened sums, and what was watched.

use num_complex::Complex32;

use super::model::Model;
use super::response::Whitened;
use crate::block::{Block, ChannelSums, ChannelWatch};
use crate::sample::Sample;

/// A block as the solution sees it, in f32 whatever its samples were.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    pub(super) whitened: [Whitened; 2],
    pub watched: Option<Watched>,
}

/// What was watched of both pick-offs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Watched {
    /// Σ S cos 3φ + j Σ S sin 3φ, times the layout's scale.
    pub(super) third: [Complex32; 2],
    pub extremes: [Extremes; 2],
}

/// The range of one pick-off's samples.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extremes {
    pub low: f32,
    pub high: f32,
    /// The longest runs of equal samples at both ends, in one number: that at `low` in its low half, that at `high` in its high half.
    pub runs: u32,
}

impl Seen {
    pub(crate) const EMPTY: Self = Self {
        whitened: [Whitened {
            mean: 0.0,
            even: 0.0,
            odd: 0.0,
        }; 2],
        watched: None,
    };

    /// True if its samples were watched: in a window all blocks are watched, or none is.
    #[inline]
    pub(crate) fn is_watched(&self) -> bool {
        self.watched.is_some()
    }
}

impl Model {
    /// Stores what a window keeps of a block.
    #[inline]
    pub(crate) fn see<S: Sample>(&self, block: &Block<S>, seen: &mut Seen) {
        for (seen, sums) in seen.whitened.iter_mut().zip(&block.sums) {
            *seen = self.basis.whiten(
                S::sum_to_f32(sums.cosine),
                S::sum_to_f32(sums.sine),
                S::sum_to_f32(sums.sum),
            );
        }
        let [of_c, of_d] = &block.sums;
        let Some([c, d]) = &block.watch else {
            seen.watched = None;
            return;
        };
        seen.watched = Some(Watched {
            third: [third(of_c, c), third(of_d, d)],
            extremes: [extremes(c), extremes(d)],
        });
    }
}

#[inline(always)]
fn third<S: Sample>(sums: &ChannelSums<S>, watch: &ChannelWatch<S>) -> Complex32 {
    let [cosine, sine] = S::third(sums, watch);
    Complex32::new(cosine, sine)
}

#[inline(always)]
fn extremes<S: Sample>(watch: &ChannelWatch<S>) -> Extremes {
    let [low, high] = S::runs(watch).map(u32::from);
    Extremes {
        low: watch.low.to_f32(),
        high: watch.high.to_f32(),
        runs: low | high << 16,
    }
}
