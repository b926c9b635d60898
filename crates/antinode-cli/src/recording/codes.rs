//! The step between a converter's codes, where integers of more bits hold them or text has them as whole numbers.

/// Bits that all distances of codes have in common by chance less than once in 10¹⁸ times.
const SHARED_BITS: usize = 60;
/// Fewer codes than these may have been chosen by hand.
const FEWEST: usize = 12;

/// A wave that is sampled a whole number of times a period shows but a few codes: with as many of them, a step that a converter may have
/// is told by as many bits beside the lowest, which sums of a wave's codes may share.
const FEW: usize = 6;
const BITS_OF_FEW: usize = 8;
/// The coarsest step told by a few codes, as a share of full scale: that of 8 bits.
const COARSEST: f32 = 1.0 / 128.0;
/// As many distances are all even by chance less than once in 60 times; where there are fewer, converters have an even number of bits.
const SURELY_ODD: usize = 6;

/// Whole numbers up to this size may be any.
const LEAST_WHOLE: f32 = 128.0;

/// The step of samples with `unit` between them where they use few of their bits: a wave without noise that repeats a few values tells
/// it too, for these are exact.
pub(super) fn of_integers(pairs: &[[f32; 2]], unit: f32) -> Option<f32> {
    step(pairs, unit, 1.0, true)
}

/// The step of samples with `unit` between them, of which the largest may be as large; where full scale is known, so are their bits.
fn step(pairs: &[[f32; 2]], unit: f32, largest: f32, is_full_scale: bool) -> Option<f32> {
    let channels = [0, 1].map(|channel| codes(pairs.iter().map(|pair| pair[channel]), unit));
    let all = sorted(channels.concat());
    let distances = all.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
    let factor = distances.fold(0, common_factor);
    let bits = factor.checked_ilog2()? as usize;
    if all.len() >= FEWEST && bits * (all.len() - 1) >= SHARED_BITS {
        return Some(factor as f32 * unit);
    }
    if all.len() < FEW {
        return None;
    }
    let one_side = sorted(channels.iter().flat_map(|codes| one_side(codes)).collect()).len();
    // Of a converter in more bits, the steps are a power of two.
    let mut bits = factor.trailing_zeros();
    if one_side * (bits as usize).saturating_sub(1) < BITS_OF_FEW {
        return None;
    }
    let of_converter = (2.0 * largest / unit).log2().round() as u32 - bits;
    if is_full_scale && one_side <= SURELY_ODD && of_converter % 2 == 1 {
        bits -= 1;
    }
    let step = unit * (bits as f32).exp2();
    (step > unit && step <= COARSEST * largest).then_some(step)
}

/// The step of text and floats that are whole numbers, of which there are too few to tell one otherwise.
pub(super) fn of_whole(pairs: &[[f32; 2]]) -> Option<f32> {
    let finite = || pairs.iter().flatten().filter(|sample| sample.is_finite());
    let largest = finite().fold(0.0, |most: f32, sample| most.max(sample.abs()));
    let is_whole = (LEAST_WHOLE..1e9).contains(&largest) && finite().all(|x| x.fract() == 0.0);
    if !is_whole || codes(finite().copied(), 1.0).len() < FEW {
        return None;
    }
    step(pairs, 1.0, largest, false).or(Some(1.0))
}

/// The codes of samples, in their order.
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

/// Codes without those of the other half of a wave, which are as far from its middle and tell nothing more.
fn one_side(codes: &[i64]) -> impl Iterator<Item = i64> {
    let ends = codes.first().zip(codes.last());
    let ends = ends.map_or(0, |(least, most)| least + most);
    codes.iter().map(move |&code| code.min(ends - code))
}

/// The greatest factor of both; that of 0 and a number is the number.
fn common_factor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_factor(b, a % b) }
}

/// The lowest bits of integers, as long as they have been the same in all samples.
#[derive(Debug)]
pub(super) struct Lowest {
    unit: f32,
    first: Option<i32>,
    /// Bits that some sample had otherwise than the first.
    differ: i32,
}

impl Lowest {
    /// Of integers with so much between them.
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

    /// The power of two by which all samples are apart; none where they are all the same.
    pub fn step(&self) -> Option<f32> {
        let bits = self.differ.trailing_zeros();
        (self.differ != 0).then(|| self.unit * (bits as f32).exp2())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A wave of codes of so many bits, so many of them a period.
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
    fn the_bits_that_integers_leave_out_are_found_without_noise_too() {
        for (container, bits) in [(16, 8), (16, 12), (24, 12), (24, 16), (32, 24)] {
            let (unit, step) = (unit(container), unit(bits));
            // Twenty values, over and over.
            let pairs = wave(20, bits, 0.3, 2000);
            assert_eq!(of_integers(&pairs, unit), Some(step), "{container} {bits}");
            // With all their bits in use, or next to nothing there, none is told.
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
    fn a_few_values_tell_the_step_of_a_converter() {
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
    fn a_few_values_that_use_their_bits_tell_none() {
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
    fn values_made_by_hand_tell_none() {
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
        // As many as that may be counted by hand.
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
        // All that are the same tell nothing.
        let mut lowest = Lowest::new(unit);
        lowest.look(&[[0.25; 2]; 100]);
        lowest.look(&[]);
        assert_eq!(lowest.step(), None);
    }
}
