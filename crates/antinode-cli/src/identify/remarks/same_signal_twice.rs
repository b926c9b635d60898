//! One signal recorded as both pick-offs: its rows stand at 22.5° without quadrature, and look well.

/// Two pick-offs of a wave are not the same in as many pairs.
const ENOUGH: u64 = 64;

/// Whether S_D is S_C, sample for sample, or its negative.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SameSignalTwice {
    /// Whether S_D has differed from S_C, and from its negative.
    has_differed: [bool; 2],
    pairs: u64,
}

impl SameSignalTwice {
    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        self.pairs += pairs.len() as u64;
        // What is no finite number may be missing in one of them.
        let numbers = pairs
            .iter()
            .filter(|pair| pair.iter().all(|value| value.is_finite()));
        for (has_differed, sign) in self.has_differed.iter_mut().zip([1.0, -1.0]) {
            // Not looked at any more from the first pair on that differs.
            *has_differed = *has_differed || numbers.clone().any(|[c, d]| sign * c != *d);
        }
    }

    /// What to tell of pick-offs that do not hold one value all the time.
    pub fn told(&self) -> Option<String> {
        let how = match self.has_differed {
            [false, true] => "",
            [true, false] => " but for the sign",
            _ => return None,
        };
        (self.pairs >= ENOUGH).then(|| {
            format!(
                "S_C and S_D are the same samples{how}: rows show one signal, not a pattern; check the wiring, the export, and --columns"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(pairs: &[[f32; 2]]) -> Option<String> {
        let mut same = SameSignalTwice::default();
        for stretch in pairs.chunks(8) {
            same.see(stretch);
        }
        same.told()
    }

    /// As many pairs of one signal, S_D so many times S_C.
    fn pairs(count: usize, times: f32) -> Vec<[f32; 2]> {
        let sample = |k: usize| (0.3 * k as f32).sin();
        (0..count).map(|k| [sample(k), times * sample(k)]).collect()
    }

    #[test]
    fn one_signal_on_both_is_told() {
        let same = told(&pairs(1000, 1.0)).expect("the same");
        assert!(same.contains("are the same samples: "), "{same}");
        let negative = told(&pairs(1000, -1.0)).expect("the same but for the sign");
        assert!(negative.contains("the same samples but for the sign: "));
        // One that is missing tells nothing.
        let mut garbled = pairs(1000, 1.0);
        garbled[500][1] = f32::NAN;
        assert!(told(&garbled).is_some());
    }

    #[test]
    fn two_signals_are_not() {
        assert_eq!(told(&pairs(1000, 1.0 + f32::EPSILON)), None);
        for differing in [0, 500, 999] {
            for times in [1.0, -1.0] {
                let mut pairs = pairs(1000, times);
                pairs[differing][1] += 1e-3;
                assert_eq!(told(&pairs), None, "{differing} {times}");
            }
        }
        // Nothing at all is both, and too few may be so by chance.
        assert_eq!(told(&[[0.0; 2]; 1000]), None);
        assert_eq!(told(&pairs(63, 1.0)), None);
    }
}
