//! Dropouts as spans of samples, and the values recorded in them.

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

/// The dropouts of one channel.
#[derive(Debug, Clone)]
pub(crate) struct Dropouts {
    channel: usize,
    spans: Spans<DropoutKind>,
    /// The value held and the first sample of the dropout that holds it.
    held: Option<(u64, f64)>,
}

impl Dropouts {
    pub fn new(flaws: &Flaws, channel: Channel, sample_rate: f64) -> Result<Dropouts, Error> {
        let of_channel = flaws
            .dropouts
            .iter()
            .filter(|dropout| dropout.channel.is_none_or(|only| only == channel));
        let spans: Result<Vec<_>, _> = of_channel
            .map(|d| Span::of_times(d.from, d.to, sample_rate, d.kind, "dropouts"))
            .collect();
        let spans = Spans::new(spans?);
        check_apart(spans.all(), "dropouts")?;
        Ok(Dropouts {
            channel: channel as usize,
            spans,
            held: None,
        })
    }

    /// What is recorded at `index`, if that is in a dropout. To be called before `front` is at `index`: a value to hold is computed when its
    /// dropout begins, and coloured noise does not go back.
    pub fn at(&mut self, index: u64, front: &mut Front) -> Option<Fill> {
        let span = self.spans.at(index)?;
        Some(match span.what {
            DropoutKind::Zero => Fill::Constant(0.0),
            DropoutKind::NoiseOnly => Fill::Floor,
            DropoutKind::Hold => {
                let held = self.held.filter(|(first, _)| *first == span.first);
                let value =
                    held.map_or_else(|| self.value_before(span.first, front), |held| held.1);
                self.held = Some((span.first, value));
                Fill::Constant(value)
            }
        })
    }

    /// The value recorded before the dropout that begins at `first`; 0 if there is none.
    fn value_before(&self, mut first: u64, front: &mut Front) -> f64 {
        let spans = self.spans.all();
        let place = spans.partition_point(|span| span.first < first);
        let mut kind = None;
        // The sample before may itself lie in a dropout.
        for before in spans.iter().take(place).rev() {
            if before.end != first {
                break;
            }
            if before.what != DropoutKind::Hold {
                kind = Some(before.what);
                break;
            }
            first = before.first;
        }
        let Some(before) = first.checked_sub(1) else {
            return 0.0;
        };
        let Input { signal, floor } = front.at(before);
        match kind {
            Some(DropoutKind::Zero) => 0.0,
            Some(_) => floor[self.channel],
            None => signal[self.channel],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dropout, Gyro, Wave};

    fn gyro(flaws: Flaws) -> Gyro {
        Gyro::new(Wave::default(), flaws, 100_000.0, 42).unwrap()
    }

    #[test]
    fn a_value_is_held_wherever_the_stream_begins_and_computed_only_then() {
        let held = |from, to| Dropout {
            from,
            to,
            kind: DropoutKind::Hold,
            channel: None,
        };
        let flaws = |dropouts| Flaws {
            coloured_noise: 0.1,
            dropouts,
            ..Flaws::white(0.1)
        };
        let near = gyro(flaws(vec![
            held(100e-5, 110e-5),
            held(110e-5, 120e-5),
            held(300e-5, 310e-5),
        ]));
        let pairs: Vec<[f64; 2]> = near.clone().take(400).collect();
        assert_eq!(pairs[119], gyro(flaws(vec![])).nth(99).unwrap());
        for first in [99, 100, 105, 115, 120, 305] {
            let from = near.clone().skip(first).take(400 - first);
            assert!(from.eq(pairs[first..].iter().copied()), "from {first}");
        }
        // Coloured noise of 10^14 samples would take days.
        let (done, is_done) = std::sync::mpsc::channel();
        let far = flaws(vec![held(1e9, 2e9)]);
        std::thread::spawn(move || done.send(gyro(far).next()));
        let first = is_done.recv_timeout(std::time::Duration::from_secs(10));
        assert_eq!(first, Ok(gyro(flaws(vec![])).next()));
    }
}
