//! Which two of the channels that were sampled together are S_C and S_D.

use super::columns::Columns;
use super::error::Fault;
use crate::digits::counted;

/// The channels of a recording, and the places from 0 of S_C and S_D among them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Frame {
    pub channels: usize,
    pub chosen: [usize; 2],
}

impl Frame {
    /// S_C and S_D and nothing else.
    pub const PAIR: Self = Self {
        channels: 2,
        chosen: [0, 1],
    };

    /// The two of `channels` channels that the user chose by `columns`; without a choice, both of two.
    pub fn choose(channels: usize, columns: Option<&Columns>) -> Result<Self, Fault> {
        let Some(columns) = columns else {
            return match channels {
                2 => Ok(Self::PAIR),
                found => Err(Fault::new(format!(
                    "WAV header: found {}, but two are needed; {}",
                    counted(found as u64, "channel"),
                    if found < 2 {
                        "put S_C on the left channel and S_D on the right, for example with `sox -M c.wav d.wav both.wav`"
                    } else {
                        "choose those of S_C and S_D, as in --columns 1,2"
                    }
                ))),
            };
        };
        let chosen = columns
            .numbers()
            .filter(|places| places.iter().all(|place| (1..=channels).contains(place)));
        match chosen {
            Some([c, d]) => Ok(Self {
                channels,
                chosen: [c - 1, d - 1],
            }),
            None => Err(Fault::new(format!(
                "--columns {columns}: give the channel numbers of S_C and S_D, two different ones from 1 to {channels}"
            ))),
        }
    }

    /// Copies the samples of S_C and S_D, of `size` bytes each, from whole frames into `picked`.
    pub fn pick(self, frames: &[u8], size: usize, picked: &mut Vec<u8>) {
        picked.clear();
        for frame in frames.chunks_exact(self.channels * size) {
            for place in self.chosen {
                picked.extend_from_slice(&frame[place * size..][..size]);
            }
        }
    }
}
