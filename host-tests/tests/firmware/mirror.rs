//! The same pipeline on the host, on the same codes, in the same rounds as `replay`.

use antinode::{Packed, Sample, SamplePair};
use antinode_telemetry::{Cause, FrontEnd, Receiver, Report};
use firmware::pipeline::{Places, Queues};
use firmware::sampling::{Lapse, Ready, Source, both, is_at_rail_12};
use firmware::settings::{DUAL_ADC_RAILS, HALF, configuration};

/// Codes from memory.
pub struct Recorded<'a> {
    rest: &'a [Packed],
    half: &'a [Packed],
}

impl<'a> Recorded<'a> {
    /// All of them are still to come.
    pub fn new(codes: &'a [Packed]) -> Self {
        Self {
            rest: codes,
            half: &[],
        }
    }
}

impl Source for Recorded<'_> {
    type Pair = Packed;

    fn next(&mut self) -> Ready {
        (self.half, self.rest) = self.rest.split_at(HALF.min(self.rest.len()));
        if self.half.is_empty() {
            Ready::Nothing
        } else {
            Ready::Pairs
        }
    }

    fn pairs(&self) -> &[Packed] {
        self.half
    }

    fn is_intact(&self) -> bool {
        true
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        Lapse { cause, lost: 0 }
    }

    fn rails(&self) -> [Packed; 2] {
        both(DUAL_ADC_RAILS)
    }

    fn is_at_rail(&self, pair: Packed) -> bool {
        is_at_rail_12(pair)
    }
}

/// What a device must report on `recording` after it was sent `commands`, with `slow` halves in each round.
pub fn reports<S: Sample>(recording: &[Packed], commands: &[u8], slow: usize) -> Vec<Report>
where
    Packed: SamplePair<S>,
{
    let (mut queues, mut places) = (Queues::<S>::new(), Places::new());
    let configuration = configuration(FrontEnd::Synthetic, DUAL_ADC_RAILS);
    let mut parts = queues
        .split(&mut places, configuration, Cause::Unknown)
        .expect("the settings can be");
    let mut receiver = Receiver::new();
    let mut reports = Vec::new();
    for &byte in commands {
        parts.inbox.put(byte);
    }
    let mut source = Recorded::new(recording);
    let mut first = true;
    loop {
        for _ in 0..slow {
            // The device answers its commands before the first pair.
            if !first {
                parts.gatherer.serve(&mut source);
            }
        }
        first = false;
        parts.instrument.poll(0, |_| {});
        let mut sent = Vec::new();
        while let Some(run) = parts.out.run() {
            sent.extend_from_slice(&run);
            parts.out.release(run);
        }
        for byte in sent {
            if let Some(report) = receiver.push(byte) {
                reports.push(report.expect("a sound frame"));
            }
        }
        if source.rest.is_empty() && source.half.is_empty() {
            return reports;
        }
    }
}
