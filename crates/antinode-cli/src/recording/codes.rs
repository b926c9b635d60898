//! The step between a converter's codes, if they are stored in wider integers or, in text, as whole numbers.

/// Bits of the common factor, summed over all distances between codes, that occur by chance less than once in 10¹⁸ times.
const SURE_BITS: usize = 60;
/// Fewest distinct codes for that: fewer may have been chosen by hand.
const MIN_CODES: usize = 12;

/// Fewest distinct codes of a wave that repeats them, as it is sampled a whole number of times a period.
const MIN_REPEATED_CODES: usize = 6;
/// Zero bits needed in these codes, in all, beside the lowest one of each, which sums of a wave's codes may share.
const MIN_ZERO_BITS: usize = 8;
/// Coarsest step that repeated codes can show, as a share of full scale: that of 8 bits.
const MAX_STEP: f32 = 1.0 / 128.0;
/// This many distances are all even by chance less than once in 60 times; up to this number, the converter is taken to have an even number
/// of bits.
const MAX_EVEN_BY_CHANCE: usize = 6;

/// Whole numbers are taken for codes if the largest is at least this: smaller ones may be anything.
const MIN_LARGEST_CODE: f32 = 128.0;

/// The step of integer samples, multiples of `unit`, that leave their lowest bits unused. Noise is not needed: the few values that a
/// noise-free wave repeats are exact.
pub(super) fn of_integers(pairs: &[[f32; 2]], unit: f32) -> Option<f32> {
    step(pairs, unit, 1.0, true)
}

/// The step of samples that are multiples of `unit` and at most `largest`; if this `is_full_scale`, the converter's bits follow from it.
fn step(pairs: &[[f32; 2]], unit: f32, largest: f32, is_full_scale: bool) -> Option<f32> {
    let channels = [0, 1].map(|channel| codes(pairs.iter().map(|pair| pair[channel]), unit));
    let all = sorted(channels.concat());
    let distances = all.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
    let factor = distances.fold(0, common_factor);
    let bits = factor.checked_ilog2()? as usize;
    if all.len() >= MIN_CODES && bits * (all.len() - 1) >= SURE_BITS {
        return Some(factor as f32 * unit);
    }
    if all.len() < MIN_REPEATED_CODES {
        return None;
    }
    let one_side = sorted(channels.iter().flat_map(|codes| one_side(codes)).collect()).len();
    // A converter's step in wider integers is a power of two.
    let mut bits = factor.trailing_zeros();
    if one_side * (bits as usize).saturating_sub(1) < MIN_ZERO_BITS {
        return None;
    }
    let of_converter = (2.0 * largest / unit).log2().round() as u32 - bits;
    if is_full_scale && one_side <= MAX_EVEN_BY_CHANCE && of_converter % 2 == 1 {
        bits -= 1;
    }
    let step = unit * (bits as f32).exp2();
    (step > unit && step <= MAX_STEP * largest).then_some(step)
}

/// The step of text and floats that are whole numbers, if they are too few for their distances alone to show one.
pub(super) fn of_whole(pairs: &[[f32; 2]]) -> Option<f32> {
    let finite = || pairs.iter().flatten().filter(|sample| sample.is_finite());
    let largest = finite().fold(0.0, |most: f32, sample| most.max(sample.abs()));
    let is_whole = (MIN_LARGEST_CODE..1e9).contains(&largest) && finite().all(|x| x.fract() == 0.0);
    if !is_whole || codes(finite().copied(), 1.0).len() < MIN_REPEATED_CODES {
        return None;
    }
    step(pairs, 1.0, largest, false).or(Some(1.0))
}

/// The distinct codes of samples, in ascending order.
fn codes(samples: impl Iterator<Item = f32>, unit: f32) -> Vec<i64> {
    let finite = samples.filter(|sample| sample.is_finite());
    sorted(
        finite
            .map(|sample| (f64::from(sample) / f64::from(unit)) as i64)
            .collect(),
    )
}

fn sorted(mut codes: Vec<i64>) -> Vec<i64> {
    codes.sort_unstable();
    codes.dedup();
    codes
}

/// Codes folded onto the lower half of the wave: those of the upper half are as far from its middle and add no information.
fn one_side(codes: &[i64]) -> impl Iterator<Item = i64> {
    let ends = codes.first().zip(codes.last());
    let ends = ends.map_or(0, |(least, most)| least + most);
    codes.iter().map(move |&code| code.min(ends - code))
}

/// The greatest common factor; that of 0 and a number is the number.
fn common_factor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_factor(b, a % b) }
}

/// Finds the lowest bits that are the same in all integer samples.
#[derive(Debug)]
pub(super) struct Lowest {
    unit: f32,
    first: Option<i32>,
    /// Bits in which some sample differed from the first.
    differ: i32,
}

impl Lowest {
    /// For integers with a step of `unit` as they are decoded.
    pub fn new(unit: f32) -> Self {
        Self {
            unit,
            first: None,
            differ: 0,
        }
    }

    /// Looks at the next pairs.
    pub fn look(&mut self, pairs: &[[f32; 2]]) {
        let samples = pairs.as_flattened();
        if self.differ & 1 == 1 || samples.is_empty() {
            return;
        }
        let scale = 1.0 / self.unit;
        let code = |sample: f32| (sample * scale) as i32;
        let first = *self.first.get_or_insert_with(|| code(samples[0]));
        let differ = samples.iter().fold(0, |bits, &s| bits | (code(s) ^ first));
        self.differ |= differ;
    }

    /// The step between all samples so far, `unit` times a power of two; none if they are all the same.
    pub fn step(&self) -> Option<f32> {
        let bits = self.differ.trailing_zeros();
        (self.differ != 0).then(|| self.unit * (bits as f32).exp2())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A wave in codes of a converter of `bits` bits, `period` samples a period.
    fn wave(period: usize, bits: i32, phase: f64, pairs: usize) -> Vec<[f32; 2]> {
        let step = f64::exp2(f64::from(1 - bits));
        let code = |value: f64| (step * (value / step).round()) as f32;
        (0..pairs)
            .map(|k| {
                let turn = TAU * (k % period) as f64 / period as f64 + phase;
                [code(0.7 * turn.cos()), code(0.31 * (turn - 0.3).cos())]
            })
            .collect()
    }

    fn unit(container: i32) -> f32 {
        f32::exp2((1 - container) as f32)
    }

    #[test]
    fn unused_bits_of_integers_are_found_without_noise_too() {
        for (container, bits) in [(16, 8), (16, 12), (24, 12), (24, 16), (32, 24)] {
            let (unit, step) = (unit(container), unit(bits));
            // Twenty values, over and over.
            let pairs = wave(20, bits, 0.3, 2000);
            assert_eq!(of_integers(&pairs, unit), Some(step), "{container} {bits}");
            // None is found if all bits are in use, or if the signal has only two codes.
            let [fine, coarse] = [unit, step].map(|by| {
                let shifted = pairs.iter().enumerate();
                let shifted = shifted.map(|(k, pair)| [pair[0] + by * (k % 2) as f32, pair[1]]);
                of_integers(&shifted.collect::<Vec<_>>(), unit)
            });
            assert_eq!(coarse, Some(step));
            assert!(fine.is_none() || container == 32);
            assert_eq!(of_integers(&[[0.0, step]; 100], unit), None);
        }
        assert_eq!(of_integers(&[], 0.5), None);
    }

    #[test]
    fn a_few_values_show_the_step_of_a_converter() {
        for (container, bits, periods) in [
            (16, 12, &[4, 5, 6, 8, 10][..]),
            (16, 10, &[4, 5, 6, 8, 10]),
            (24, 16, &[4, 5, 6, 8, 10]),
            (16, 14, &[5, 8, 10]),
        ] {
            for &period in periods {
                let told = (0..500).map(|k| {
                    let pairs = wave(period, bits, 0.0123 * f64::from(k), 100);
                    of_integers(&pairs, unit(container))
                });
                let right = told.filter(|&step| step == Some(unit(bits))).count();
                assert!(right > 450, "{container} {bits} {period}: {right}");
            }
        }
    }

    #[test]
    fn a_few_values_that_use_all_bits_show_no_step() {
        for container in [8, 16, 24] {
            for period in [3, 4, 5, 6, 8, 10] {
                let told = (0..2000).filter(|&k| {
                    let pairs = wave(period, container, 0.003 * f64::from(k), 100);
                    of_integers(&pairs, unit(container)).is_some()
                });
                let told = told.count();
                assert!(told < 5, "{container} {period}: {told}");
            }
        }
    }

    #[test]
    fn values_made_by_hand_show_no_step() {
        let unit = unit(16);
        for levels in [
            vec![0.0, 0.5, -0.5],
            vec![0.0, 0.25, -0.25, 0.5, -0.5, 0.75, -0.75],
            vec![-0.5, -0.4375, 0.0, 0.0625, 0.125, 0.25, 0.875],
        ] {
            let pair = |k: usize| [levels[k % levels.len()], levels[(k + 1) % levels.len()]];
            let pairs: Vec<[f32; 2]> = (0..100).map(pair).collect();
            assert_eq!(of_integers(&pairs, unit), None, "{levels:?}");
        }
        // Silence, with the lowest bit now and then.
        let pairs: Vec<[f32; 2]> = (0..100)
            .map(|k| [16.0 * unit * (k % 3) as f32, 0.0])
            .collect();
        assert_eq!(of_integers(&pairs, unit), None);
    }

    #[test]
    fn whole_numbers_are_codes() {
        let scaled = |by: f32| -> Vec<[f32; 2]> {
            let pairs = wave(5, 12, 0.3, 100).into_iter();
            pairs.map(|pair| pair.map(|sample| by * sample)).collect()
        };
        assert_eq!(of_whole(&scaled(2048.0)), Some(1.0));
        assert_eq!(of_whole(&scaled(32_768.0)), Some(16.0));
        assert_eq!(of_whole(&scaled(1.0)), None);
        assert_eq!(of_whole(&scaled(2047.5)), None);
        // Numbers as small as these may be anything.
        assert_eq!(of_whole(&[[100.0, -100.0], [0.0, 0.0]]), None);
        assert_eq!(of_whole(&[[1000.0, f32::NAN], [-1000.0, 0.0]]), None);
        assert_eq!(of_whole(&[]), None);
    }

    #[test]
    fn the_lowest_bits_are_those_of_all_samples() {
        let unit = unit(16);
        let mut lowest = Lowest::new(unit);
        assert_eq!(lowest.step(), None);
        lowest.look(&[[16.0 * unit, -16.0 * unit]; 3]);
        assert_eq!(lowest.step(), Some(32.0 * unit));
        lowest.look(&[[-1.0, 0.5]]);
        assert_eq!(lowest.step(), Some(16.0 * unit));
        lowest.look(&[[1.0 - unit, 0.0]]);
        assert_eq!(lowest.step(), Some(unit));
        // Samples that are all the same show no step.
        let mut lowest = Lowest::new(unit);
        lowest.look(&[[0.25; 2]; 100]);
        lowest.look(&[]);
        assert_eq!(lowest.step(), None);
    }
}
