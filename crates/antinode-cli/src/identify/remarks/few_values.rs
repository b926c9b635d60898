//! A few values over and over, where no step is known: a converter's may make them so, and deviations do not allow for it.

/// The most values that are few, and in how many pairs: noise of a step shows more.
const MOST: usize = 128;
const ENOUGH: usize = 1 << 16;
/// So many pairs for each value show that they repeat.
const REPEATED: usize = 4;

/// The values of the first pairs.
#[derive(Debug)]
pub(super) struct FewValues {
    /// False where it is of no matter any more.
    is_open: bool,
    values: Vec<f32>,
    pairs: usize,
}

impl FewValues {
    /// Of samples whose step may be known.
    pub fn new(resolution: Option<f32>) -> Self {
        Self {
            is_open: resolution.is_none(),
            values: Vec::new(),
            pairs: 0,
        }
    }

    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        if !self.is_open || self.pairs >= ENOUGH {
            return;
        }
        self.pairs += pairs.len();
        for sample in pairs.as_flattened() {
            if sample.is_finite() && !self.values.contains(sample) {
                self.values.push(*sample);
            }
            if self.values.len() > MOST {
                self.is_open = false;
                return;
            }
        }
    }

    /// What to tell of samples that show a wave.
    pub fn told(&self) -> Option<String> {
        let count = self.values.len();
        (self.is_open && count > 0 && self.pairs >= REPEATED * count).then(|| {
            format!(
                "the first samples show {count} values over and over: if these are codes of a converter, deviations are too small; give its step, \
                 --resolution STEP"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told of so many pairs of a wave, with so many values on each pick-off.
    fn told(resolution: Option<f32>, pairs: usize, values: usize) -> Option<String> {
        let mut few = FewValues::new(resolution);
        let sample = |k: usize| (k % values) as f32 * 0.1;
        let all: Vec<[f32; 2]> = (0..pairs).map(|k| [sample(k), -1.0 - sample(k)]).collect();
        for stretch in all.chunks(8) {
            few.see(stretch);
        }
        few.told()
    }

    #[test]
    fn a_few_values_are_told_where_no_step_is_known() {
        let eight = told(None, 100, 4).unwrap();
        assert!(eight.contains("show 8 values over and over"), "{eight}");
        assert!(told(None, 100_000, 64).is_some());
        assert_eq!(told(None, 100_000, 65), None);
        assert_eq!(told(Some(0.1), 100, 4), None);
        assert_eq!(told(None, 31, 4), None);
        assert_eq!(told(None, 0, 4), None);
    }
}
