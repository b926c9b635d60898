//! Check for pick-offs whose value never changes, in which no search can find a wave.

/// Pairs from which on equal samples of a converter are hardly chance.
const MIN_PAIRS: u64 = 64;

/// What each pick-off has held since the first pair.
#[derive(Debug, Clone, Copy, Default)]
pub struct ConstantPickOff {
    /// The first pair.
    first: Option<[f32; 2]>,
    /// Whether each pick-off has given another value since.
    has_moved: [bool; 2],
    pairs: u64,
}

impl ConstantPickOff {
    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        self.pairs += pairs.len() as u64;
        let Some(&next) = pairs.first() else {
            return;
        };
        let first = *self.first.get_or_insert(next);
        for (channel, has_moved) in self.has_moved.iter_mut().enumerate() {
            // A pick-off that moved is not looked at again.
            *has_moved = *has_moved || pairs.iter().any(|pair| pair[channel] != first[channel]);
        }
    }

    /// Whether neither pick-off has changed its value.
    pub fn are_both_constant(&self) -> bool {
        self.has_moved == [false; 2]
    }

    /// A warning that names the constant pick-offs.
    pub fn warning(&self) -> Option<String> {
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
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The warning for pairs that come in stretches.
    fn warning(pairs: &[[f32; 2]]) -> Option<String> {
        let mut constant = ConstantPickOff::default();
        for stretch in pairs.chunks(8) {
            constant.see(stretch);
        }
        constant.warning()
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
            let warning = warning(&pairs).expect("one holds its value");
            assert!(warning.starts_with(start), "{warning}");
        }
        assert!(warning(&[[0.0; 2]; 64]).is_some());
    }

    #[test]
    fn moving_pick_offs_and_too_few_samples_raise_no_warning() {
        let mut pairs = [[0.5, -0.25]; 100];
        pairs[1][0] = 0.0;
        pairs[2][1] = 0.0;
        assert_eq!(warning(&pairs), None);
        assert_eq!(warning(&[[0.5; 2]; 63]), None);
        assert_eq!(warning(&[]), None);
    }
}
