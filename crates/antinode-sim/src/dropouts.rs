//! Dropouts as spans of samples, with the values recorded in them.

use crate::error::Error;
use crate::flaws::Flaws;
use crate::front::{Front, Input};
use crate::spans::{Span, Spans, check_apart};
use crate::timed::{Channel, DropoutKind};

/// Value that a channel records in a dropout.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Fill {
    Constant(f64),
    Floor,
}

impl Fill {
    pub fn value(self, floor: f64) -> f64 {
        match self {
            Fill::Constant(value) => value,
            Fill::Floor => floor,
        }
    }
}

/// The dropouts of one channel, with the values held.
pub(crate) fn fills(
    flaws: &Flaws,
    channel: Channel,
    sample_rate: f64,
    front: &mut Front,
) -> Result<Spans<Fill>, Error> {
    let of_channel = flaws
        .dropouts
        .iter()
        .filter(|dropout| dropout.channel.is_none_or(|only| only == channel));
    let spans: Result<Vec<_>, _> = of_channel
        .map(|d| Span::of_times(d.from, d.to, sample_rate, d.kind, "dropouts"))
        .collect();
    let spans = Spans::new(spans?);
    check_apart(spans.all(), "dropouts")?;
    let mut filled: Vec<Span<Fill>> = Vec::new();
    for span in spans.all() {
        let what = match span.what {
            DropoutKind::Zero => Fill::Constant(0.0),
            DropoutKind::NoiseOnly => Fill::Floor,
            DropoutKind::Hold => Fill::Constant(match span.first.checked_sub(1) {
                None => 0.0,
                Some(before) => {
                    let Input { signal, floor } = front.at(before);
                    let (signal, floor) = (signal[channel as usize], floor[channel as usize]);
                    // The sample before may itself lie in a dropout.
                    let last = filled.last().filter(|last| last.end == span.first);
                    last.map_or(signal, |last| last.what.value(floor))
                }
            }),
        };
        filled.push(Span {
            first: span.first,
            end: span.end,
            what,
        });
    }
    Ok(Spans::new(filled))
}
