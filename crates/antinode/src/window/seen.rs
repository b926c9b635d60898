//! What a window keeps of a block: its sums made independent, and what was watched.

use num_complex::Complex32;

use super::model::Model;
use super::response::Whitened;
use crate::block::{Block, ChannelWatch};
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
    /// Σ S cos 3φ + j Σ S sin 3φ.
    pub(super) third: [Complex32; 2],
    pub extremes: [Extremes; 2],
}

/// The range of one pick-off's samples.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extremes {
    pub low: f32,
    pub high: f32,
    pub low_run: u16,
    pub high_run: u16,
}

impl Model {
    /// Takes a block into a window.
    #[inline(always)]
    pub(crate) fn see<S: Sample>(&self, block: &Block<S>) -> Seen {
        let unit = 1.0 / self.layout.one();
        let watched = |channel: &ChannelWatch<S>| {
            let third = Complex32::new(
                S::sum_to_f32(channel.third_cosine),
                S::sum_to_f32(channel.third_sine),
            );
            let [low_run, high_run] = S::runs(&channel.runs);
            let extremes = Extremes {
                low: channel.low.to_f32(),
                high: channel.high.to_f32(),
                low_run,
                high_run,
            };
            (third * unit, extremes)
        };
        Seen {
            whitened: block.sums.map(|sums| {
                self.basis.whiten(
                    S::sum_to_f32(sums.cosine),
                    S::sum_to_f32(sums.sine),
                    S::sum_to_f32(sums.sum),
                )
            }),
            watched: block.watch.as_ref().map(|[c, d]| {
                let (c, d) = (watched(c), watched(d));
                Watched {
                    third: [c.0, d.0],
                    extremes: [c.1, d.1],
                }
            }),
        }
    }
}
