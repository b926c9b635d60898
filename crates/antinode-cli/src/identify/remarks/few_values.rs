//! Check for few distinct values where no step is known: if they are codes of a converter, deviations do not allow for its step.

/// Distinct values that count as few, at most, and in how many pairs: noise of a step shows more.
const MAX_VALUES: usize = 128;
const EXAMINED_PAIRS: usize = 1 << 16;
/// Pairs per distinct value from which on values are known to repeat.
const PAIRS_PER_VALUE: usize = 4;

/// The distinct values of the first pairs.
#[derive(Debug)]
pub(super) struct FewValues {
    /// False if a step is known, and once there are more than a few values.
    is_open: bool,
    values: Vec<f32>,
    pairs: usize,
}

impl FewValues {
    /// No samples yet; `resolution` is the converter's step, if known.
    pub fn new(resolution: Option<f32>) -> Self {
        Self {
            is_open: resolution.is_none(),
            values: Vec::new(),
            pairs: 0,
        }
    }

    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        if !self.is_open || self.pairs >= EXAMINED_PAIRS {
            return;
        }
        self.pairs += pairs.len();
        for sample in pairs.as_flattened() {
            if sample.is_finite() && !self.values.contains(sample) {
                self.values.push(*sample);
            }
            if self.values.len() > MAX_VALUES {
                self.is_open = false;
                return;
            }
        }
    }

    /// A warning if there are only a few values; for samples that show a wave.
    pub fn warning(&self) -> Option<String> {
        let count = self.values.len();
        (self.is_open && count > 0 && self.pairs >= PAIRS_PER_VALUE * count).then(|| {
            format!(
                "the first samples have only {count} distinct values: if these are codes of a converter, deviations are too small; give its \
                 step as --resolution STEP"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The warning for this many pairs of a wave, with this many values on each pick-off.
    fn warning(resolution: Option<f32>, pairs: usize, values: usize) -> Option<String> {
        let mut few = FewValues::new(resolution);
        let sample = |k: usize| (k % values) as f32 * 0.1;
        let all: Vec<[f32; 2]> = (0..pairs).map(|k| [sample(k), -1.0 - sample(k)]).collect();
        for stretch in all.chunks(8) {
            few.see(stretch);
        }
        few.warning()
    }

    #[test]
    fn a_few_values_raise_a_warning_if_no_step_is_known() {
        let eight = warning(None, 100, 4).unwrap();
        assert!(eight.contains("have only 8 distinct values"), "{eight}");
        assert!(warning(None, 100_000, 64).is_some());
        assert_eq!(warning(None, 100_000, 65), None);
        assert_eq!(warning(Some(0.1), 100, 4), None);
        assert_eq!(warning(None, 31, 4), None);
        assert_eq!(warning(None, 0, 4), None);
        // Only the first samples count.
        let mut few = FewValues::new(None);
        few.see(&[[0.0, 1.0]; EXAMINED_PAIRS]);
        few.see(&(0..1000).map(|k| [k as f32; 2]).collect::<Vec<_>>());
        assert!(few.warning().is_some());
    }
}
