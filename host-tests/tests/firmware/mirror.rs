//! The same pipeline on the host, with the same codes in the same rounds as in `replay`.

use antinode::{Packed, Sample, SamplePair};
use antinode_telemetry::{Cause, FrontEnd, Receiver, Report};
use firmware::pipeline::{Places, Queues};
use firmware::sampling::{DUAL_ADC_RAILS, Lapse, Ready, Source, both, is_at_rail_12};
use firmware::settings::{HALF, configuration};

/// A source of codes from memory.
pub struct Recorded<'a> {
    rest: &'a [Packed],
    half: &'a [Packed],
    /// Count of halves given.
    given: usize,
    /// The half, from 1, that is overwritten while it is read.
    torn: usize,
}

/// Pairs that are lost after a torn half.
pub const MISSED: u32 = 77;

impl<'a> Recorded<'a> {
    /// A source with all codes still to come.
    pub fn new(codes: &'a [Packed]) -> Self {
        Self {
            rest: codes,
            half: &[],
            given: 0,
            torn: 0,
        }
    }

    /// The same, but half number `half`, from 1, is overwritten while it is read.
    pub fn torn(codes: &'a [Packed], half: usize) -> Self {
        Self {
            torn: half,
            ..Self::new(codes)
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
            self.given += 1;
            Ready::Pairs
        }
    }

    fn pairs(&self) -> &[Packed] {
        self.half
    }

    fn is_intact(&self) -> bool {
        self.given != self.torn
    }

    fn restart(&mut self, cause: Cause) -> Lapse {
        let lost = if self.is_intact() { 0 } else { MISSED };
        self.rest = &self.rest[lost as usize..];
        self.torn = 0;
        Lapse { cause, lost }
    }

    fn rails(&self) -> [Packed; 2] {
        both(DUAL_ADC_RAILS)
    }

    fn is_at_rail(&self, pair: Packed) -> bool {
        is_at_rail_12(pair)
    }
}

/// Reports of a device on `recording` after `commands`, with `slow` halves in each round.
pub fn reports<S: Sample>(recording: &[Packed], commands: &[u8], slow: usize) -> Vec<Report>
where
    Packed: SamplePair<S>,
{
    // The device answers its commands before the first pair.
    reports_of(Recorded::new(recording), (0, commands), slow)
}

/// Reports of a device on a source after `commands` in this round.
pub fn reports_of<S: Sample>(
    mut source: Recorded,
    (round, commands): (usize, &[u8]),
    slow: usize,
) -> Vec<Report>
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
    for at in 0.. {
        for _ in 0..slow {
            if at > 0 {
                parts.gatherer.serve(&mut source);
            }
        }
        if at == round {
            commands.iter().for_each(|&byte| parts.inbox.put(byte));
        }
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
            break;
        }
    }
    reports
}
