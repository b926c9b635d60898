//! Samples that are not finite numbers: they are delivered as they are, and reported at the end.

use super::error::Place;
use super::sample::channel_at;

/// A fault that costs no more than a pair, or a line of text.
#[derive(Debug, Clone)]
pub(super) struct Flaw {
    /// The number of pairs before it.
    pub pair: u64,
    /// The place in text, if known.
    pub place: Option<Place>,
    /// A description of it.
    pub description: String,
}

/// The samples seen so far that are not finite numbers.
#[derive(Debug, Default)]
pub(super) struct NotFinite {
    /// The first one, and the number of samples, not of pairs, but for those at the edges.
    first: Option<Flaw>,
    count: u64,
    /// Pairs without either sample at the beginning, and at the end so far: oscilloscopes leave them where a record is not filled.
    edges: [Edge; 2],
    /// Whether a pair was seen behind the first edge.
    has_begun: bool,
}

/// Pairs in turn without either sample.
#[derive(Debug, Clone, Copy, Default)]
struct Edge {
    /// The pairs before it.
    before: u64,
    pairs: u64,
}

impl NotFinite {
    /// Looks through the next `pairs`, which begin at pair `before` of the recording.
    pub fn look(&mut self, before: u64, pairs: &[[f32; 2]]) {
        // Counted without a branch: this form is compiled to vector instructions.
        let values = pairs.as_flattened().iter();
        let count: u32 = values.map(|value| u32::from(!value.is_finite())).sum();
        if count == 0 {
            self.pass_edge(!pairs.is_empty());
            return;
        }
        for (pair, at) in pairs.iter().zip(before..) {
            if pair.iter().all(|value| value.is_nan()) {
                let edge = &mut self.edges[usize::from(self.has_begun)];
                if edge.pairs == 0 {
                    edge.before = at;
                }
                edge.pairs += 1;
                continue;
            }
            self.pass_edge(true);
            if let Some(channel) = pair.iter().position(|value| !value.is_finite()) {
                let odd = pair.iter().filter(|value| !value.is_finite());
                self.count += odd.count() as u64;
                self.first
                    .get_or_insert_with(|| flaw(at, channel, pair[channel]));
            }
        }
    }

    /// Notes that pairs follow, if `any` do: what seemed to be the end is none.
    fn pass_edge(&mut self, any: bool) {
        let end = &mut self.edges[1];
        if any && end.pairs > 0 {
            self.count += 2 * end.pairs;
            let before = end.before;
            self.first.get_or_insert_with(|| flaw(before, 0, f32::NAN));
            *end = Edge::default();
        }
        self.has_begun |= any;
    }

    /// The first one to be reported, and how many they are, those at the edges too if these `count`, or if nothing lies between them.
    pub fn reported(&self, edges_count: bool) -> Option<(Flaw, u64)> {
        if self.has_begun && !edges_count {
            return Some((self.first.clone()?, self.count));
        }
        let [begin, end] = self.edges;
        let at_edge = |edge: Edge| (edge.pairs > 0).then(|| flaw(edge.before, 0, f32::NAN));
        let first = at_edge(begin)
            .or_else(|| self.first.clone())
            .or_else(|| at_edge(end))?;
        Some((first, self.count + 2 * (begin.pairs + end.pairs)))
    }

    /// The warnings about pairs at the edges that are not reported as faults.
    pub fn edge_warnings(&self) -> impl Iterator<Item = String> {
        let [begin, end] = self.edges.map(|edge| edge.pairs);
        let told = [
            (begin, "first", "begins behind"),
            (end, "last", "ends before"),
        ];
        let told = told
            .into_iter()
            .filter(|(pairs, ..)| self.has_begun && *pairs > 0);
        told.map(|(pairs, which, goes)| match pairs {
            1 => format!("the {which} sample pair has no values: the recording {goes} it"),
            _ => format!(
                "the {which} {pairs} sample pairs have no values: the recording {goes} them"
            ),
        })
    }
}

fn flaw(pair: u64, channel: usize, value: f32) -> Flaw {
    let channel = channel_at(channel);
    Flaw {
        pair,
        place: None,
        description: format!("{channel}: the value is {value}, not a finite number"),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const NONE: [f32; 2] = [f32::NAN; 2];

    /// Pairs that were looked at in pieces of this length, from pair 5 of a recording on.
    fn looked(pairs: &[[f32; 2]], length: usize) -> NotFinite {
        let mut found = NotFinite::default();
        for (index, piece) in pairs.chunks(length).enumerate() {
            found.look(5 + (index * length) as u64, piece);
            found.look(0, &[]);
        }
        found
    }

    fn pair() -> impl Strategy<Value = [f32; 2]> {
        prop_oneof![
            Just(NONE),
            Just([1.0, 2.0]),
            Just([f32::NAN, 2.0]),
            Just([1.0, f32::INFINITY]),
            Just([f32::NEG_INFINITY, f32::NAN]),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn all_but_pairs_without_values_at_the_edges_are_reported(
            pairs in proptest::collection::vec(pair(), 0..12),
            length in 1usize..6,
        ) {
            let found = looked(&pairs, length);
            let is_none = |pair: &&[f32; 2]| pair.iter().all(|value| value.is_nan());
            let begin = pairs.iter().take_while(is_none).count();
            let end = pairs.iter().rev().take_while(is_none).count();
            let all_none = begin == pairs.len();
            for edges_count in [false, true] {
                let within = if edges_count || all_none { 0..pairs.len() } else { begin..pairs.len() - end };
                let odd: Vec<_> = within
                    .flat_map(|index| [(index, 0), (index, 1)])
                    .filter(|&(index, channel)| !pairs[index][channel].is_finite())
                    .collect();
                let reported = found.reported(edges_count);
                prop_assert_eq!(reported.as_ref().map_or(0, |(_, count)| *count), odd.len() as u64);
                if let (Some((first, _)), Some(&(index, channel))) = (reported, odd.first()) {
                    prop_assert_eq!(first.pair, 5 + index as u64);
                    let expected = format!("{}: the value is {}, not a finite number", channel_at(channel), pairs[index][channel]);
                    prop_assert_eq!(first.description, expected);
                }
            }
            let warnings: Vec<String> = found.edge_warnings().collect();
            let edges = [begin, end].iter().filter(|&&pairs| pairs > 0).count();
            prop_assert_eq!(warnings.len(), if all_none { 0 } else { edges });
        }
    }

    #[test]
    fn warnings_tell_how_many_pairs_have_no_values() {
        let told = |pairs: &[[f32; 2]]| looked(pairs, 3).edge_warnings().collect::<Vec<_>>();
        let value = [1.0, 2.0];
        assert_eq!(
            told(&[NONE, NONE, NONE, NONE, value, NONE]),
            [
                "the first 4 sample pairs have no values: the recording begins behind them",
                "the last sample pair has no values: the recording ends before it",
            ]
        );
    }
}
