//! The first pairs that are identified, gathered until they are enough to tell something by: a pipe may begin with one alone.

/// Some periods; no more, lest the rows of a pipe come before what is wrong with them.
const ENOUGH: usize = 512;

/// Pairs gathered before they are identified.
#[derive(Debug, Default)]
pub(super) struct First {
    pairs: Vec<[f32; 2]>,
    /// Pairs gathered, and not yet identified.
    ahead: usize,
    is_given: bool,
}

impl First {
    /// Sees the next pairs that are to be identified, some of them not for the first time; gives all, once they are enough.
    pub fn see(&mut self, pairs: &[[f32; 2]]) -> Option<Vec<[f32; 2]>> {
        if !self.is_given && pairs.len() > self.ahead {
            self.pairs.extend(&pairs[self.ahead..]);
            self.ahead = pairs.len();
        }
        if self.pairs.len() < ENOUGH {
            return None;
        }
        self.rest()
    }

    /// So many pairs have been identified.
    pub fn pass(&mut self, pairs: usize) {
        self.ahead = self.ahead.saturating_sub(pairs);
    }

    /// All there are, where they were not enough.
    pub fn rest(&mut self) -> Option<Vec<[f32; 2]>> {
        self.is_given = true;
        let pairs = std::mem::take(&mut self.pairs);
        (!pairs.is_empty()).then_some(pairs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_given_once_in_their_order() {
        let all: Vec<[f32; 2]> = (0..5000).map(|k| [k as f32, 0.0]).collect();
        for (stretch, step) in [(1, 1), (7, 3), (1000, 8), (512, 8), (5000, 4999)] {
            let mut first = First::default();
            let mut given = Vec::new();
            for mut pairs in all.chunks(stretch) {
                while !pairs.is_empty() {
                    given.extend(first.see(pairs));
                    let taken = step.min(pairs.len());
                    first.pass(taken);
                    pairs = &pairs[taken..];
                }
            }
            assert_eq!(given.len(), 1, "{stretch} {step}");
            assert!(given[0].len() >= ENOUGH && all.starts_with(&given[0]));
            assert!(first.rest().is_none());
        }
    }

    #[test]
    fn too_few_are_given_at_the_end() {
        assert!(First::default().rest().is_none());
        let mut first = First::default();
        assert!(first.see(&[[1.0; 2]; 9]).is_none());
        assert_eq!(first.rest().map(|pairs| pairs.len()), Some(9));
    }
}
