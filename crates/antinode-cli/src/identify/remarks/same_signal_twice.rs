//! Check for one signal recorded as both pick-offs: its rows show 22.5° without quadrature, and look plausible.

/// Pairs from which on equal samples of two pick-offs are not due to chance.
const MIN_PAIRS: u64 = 64;

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
        // A sample that is not finite may be missing on one pick-off only.
        let numbers = pairs
            .iter()
            .filter(|pair| pair.iter().all(|value| value.is_finite()));
        for (has_differed, sign) in self.has_differed.iter_mut().zip([1.0, -1.0]) {
            // Once they have differed, they are not compared again.
            *has_differed = *has_differed || numbers.clone().any(|[c, d]| sign * c != *d);
        }
    }

    /// A warning if both are one signal; not if both are zero throughout.
    pub fn warning(&self) -> Option<String> {
        let how = match self.has_differed {
            [false, true] => "",
            [true, false] => " but for the sign",
            _ => return None,
        };
        (self.pairs >= MIN_PAIRS).then(|| {
            format!(
                "S_C and S_D are the same samples{how}: rows show one signal, not a pattern; check the wiring, the export, and --columns"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warning(pairs: &[[f32; 2]]) -> Option<String> {
        let mut same = SameSignalTwice::default();
        for stretch in pairs.chunks(8) {
            same.see(stretch);
        }
        same.warning()
    }

    /// This many pairs of one signal, with S_D `times` S_C.
    fn pairs(count: usize, times: f32) -> Vec<[f32; 2]> {
        let sample = |k: usize| (0.3 * k as f32).sin();
        (0..count).map(|k| [sample(k), times * sample(k)]).collect()
    }

    #[test]
    fn one_signal_on_both_raises_a_warning() {
        let same = warning(&pairs(1000, 1.0)).expect("the same");
        assert!(same.contains("are the same samples: "), "{same}");
        let negative = warning(&pairs(1000, -1.0)).expect("the same but for the sign");
        assert!(negative.contains("the same samples but for the sign: "));
        // A missing sample shows no difference.
        let mut garbled = pairs(1000, 1.0);
        garbled[500][1] = f32::NAN;
        assert!(warning(&garbled).is_some());
    }

    #[test]
    fn two_signals_raise_no_warning() {
        assert_eq!(warning(&pairs(1000, 1.0 + f32::EPSILON)), None);
        for differing in [0, 500, 999] {
            for times in [1.0, -1.0] {
                let mut pairs = pairs(1000, times);
                pairs[differing][1] += 1e-3;
                assert_eq!(warning(&pairs), None, "{differing} {times}");
            }
        }
        // Zeros are equal and opposite at once, and too few pairs may be equal by chance.
        assert_eq!(warning(&[[0.0; 2]; 1000]), None);
        assert_eq!(warning(&pairs(63, 1.0)), None);
    }
}
