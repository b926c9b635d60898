//! Check for samples that are all the same: a pick-off whose value never changes, in which no search can find a wave, and one signal
//! recorded as both pick-offs, whose rows show 22.5° without quadrature, and look plausible.

/// Pairs from which on equal samples are hardly chance.
const MIN_PAIRS: u64 = 64;

/// What has differed since the first pair.
#[derive(Debug, Clone, Copy, Default)]
pub struct EqualSamples {
    /// The first pair.
    first: Option<[f32; 2]>,
    /// Whether each pick-off has given another value since.
    has_moved: [bool; 2],
    /// Whether S_D has differed from S_C, and from its negative.
    has_differed: [bool; 2],
    pairs: u64,
}

impl EqualSamples {
    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        self.pairs += pairs.len() as u64;
        let Some(&next) = pairs.first() else {
            return;
        };
        let first = *self.first.get_or_insert(next);
        // What has differed is not looked at again.
        for (channel, has_moved) in self.has_moved.iter_mut().enumerate() {
            *has_moved = *has_moved || pairs.iter().any(|pair| pair[channel] != first[channel]);
        }
        // A sample that is not finite may be missing on one pick-off only.
        let numbers = pairs
            .iter()
            .filter(|pair| pair.iter().all(|value| value.is_finite()));
        for (has_differed, sign) in self.has_differed.iter_mut().zip([1.0, -1.0]) {
            *has_differed = *has_differed || numbers.clone().any(|[c, d]| sign * c != *d);
        }
    }

    /// Whether neither pick-off has changed its value.
    pub fn are_both_constant(&self) -> bool {
        self.has_moved == [false; 2]
    }

    /// A warning that names the constant pick-offs.
    pub fn constant(&self) -> Option<String> {
        let first = self.first.filter(|_| self.pairs >= MIN_PAIRS)?;
        let (who, value) = match self.has_moved {
            [false, false] => ("S_C and S_D are", format!("{} and {}", first[0], first[1])),
            [false, true] => ("S_C is", first[0].to_string()),
            [true, false] => ("S_D is", first[1].to_string()),
            [true, true] => return None,
        };
        Some(format!(
            "{who} constant at {value}: check the wiring, the converter and which channels were recorded"
        ))
    }

    /// A warning if both are one signal; not if both are zero throughout.
    pub fn same_twice(&self) -> Option<String> {
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

    /// The check of pairs that come in stretches.
    fn seen(pairs: &[[f32; 2]]) -> EqualSamples {
        let mut equal = EqualSamples::default();
        for stretch in pairs.chunks(8) {
            equal.see(stretch);
        }
        equal
    }

    fn constant(pairs: &[[f32; 2]]) -> Option<String> {
        seen(pairs).constant()
    }

    fn same_twice(pairs: &[[f32; 2]]) -> Option<String> {
        seen(pairs).same_twice()
    }

    #[test]
    fn the_pick_off_that_holds_its_value_is_named() {
        for (c, d, start) in [
            (false, false, "S_C and S_D are constant at 0.5 and -0.25: "),
            (false, true, "S_C is constant at 0.5: "),
            (true, false, "S_D is constant at -0.25: "),
        ] {
            let mut pairs = vec![[0.5, -0.25]; 100];
            pairs[57][0] += f32::from(u8::from(c));
            pairs[99][1] += f32::from(u8::from(d));
            let warning = constant(&pairs).expect("one holds its value");
            assert!(warning.starts_with(start), "{warning}");
        }
        assert!(constant(&[[0.0; 2]; 64]).is_some());
    }

    #[test]
    fn moving_pick_offs_and_too_few_samples_raise_no_warning() {
        let mut pairs = [[0.5, -0.25]; 100];
        pairs[1][0] = 0.0;
        pairs[2][1] = 0.0;
        assert_eq!(constant(&pairs), None);
        assert_eq!(constant(&[[0.5; 2]; 63]), None);
        assert_eq!(constant(&[]), None);
    }

    /// This many pairs of one signal, with S_D `times` S_C.
    fn pairs(count: usize, times: f32) -> Vec<[f32; 2]> {
        let sample = |k: usize| (0.3 * k as f32).sin();
        (0..count).map(|k| [sample(k), times * sample(k)]).collect()
    }

    #[test]
    fn one_signal_on_both_raises_a_warning() {
        let same = same_twice(&pairs(1000, 1.0)).expect("the same");
        assert!(same.contains("are the same samples: "), "{same}");
        let negative = same_twice(&pairs(1000, -1.0)).expect("the same but for the sign");
        assert!(negative.contains("the same samples but for the sign: "));
        // A missing sample shows no difference.
        let mut garbled = pairs(1000, 1.0);
        garbled[500][1] = f32::NAN;
        assert!(same_twice(&garbled).is_some());
    }

    #[test]
    fn two_signals_raise_no_warning() {
        assert_eq!(same_twice(&pairs(1000, 1.0 + f32::EPSILON)), None);
        for differing in [0, 500, 999] {
            for times in [1.0, -1.0] {
                let mut pairs = pairs(1000, times);
                pairs[differing][1] += 1e-3;
                assert_eq!(same_twice(&pairs), None, "{differing} {times}");
            }
        }
        // Zeros are equal and opposite at once, and too few pairs may be equal by chance.
        assert_eq!(same_twice(&[[0.0; 2]; 1000]), None);
        assert_eq!(same_twice(&pairs(63, 1.0)), None);
    }
}
