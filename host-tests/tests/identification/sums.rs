//! The block sums and the watch of every arithmetic: overflow, forms of pairs, the third harmonic, extremes.

use antinode::block::Demodulator;
use antinode::phase::PhaseStep;
use antinode::{Packed, Sample, SamplePair};

/// The sums of one block of codes at full scale, with the signs that make them largest.
fn sums_at_full_scale<S: Sample>(length: u16, least: S, most: S) -> [[f64; 3]; 2]
where
    [S; 2]: SamplePair<S>,
{
    let step = PhaseStep::from_period(f32::from(length.max(4)));
    let mut demodulator = Demodulator::<S, 256>::new(step, length, 0, true);
    let middle = f64::from(length - 1) / 2.0;
    let mut block = None;
    for k in 0..length {
        let phase = std::f64::consts::TAU * (f64::from(k) - middle) / f64::from(length.max(4));
        let pick = |weight: f64| if weight < 0.0 { least } else { most };
        block = demodulator
            .push([pick(phase.cos()), pick(phase.sin())])
            .copied();
    }
    let block = block.expect("the block is whole");
    block.sums.map(|sums| {
        [sums.cosine, sums.sine, sums.sum]
            .map(|sum| f64::from(S::sum_to_f32(sum)) / f64::from(block.layout.scale.max(1)))
    })
}

#[test]
fn nothing_overflows_at_full_scale() {
    for length in 1..=256u16 {
        // f32 never overflows with the same signs: the integers must agree with it.
        let float = sums_at_full_scale(length, -1f32, 1.0);
        let short = sums_at_full_scale(length, i16::MIN, i16::MAX);
        let long = sums_at_full_scale(length, i32::MIN, i32::MAX);
        for (codes, full_scale) in [(short, 32_768.0), (long, 2_147_483_648.0)] {
            for channel in 0..2 {
                for i in 0..2 {
                    let error = (codes[channel][i] / full_scale - float[channel][i]).abs();
                    let room =
                        1e-4 * f64::from(length) + 2.0 * f64::from(length).powi(2) / 65_535.0;
                    assert!(
                        error < room,
                        "length {length}, channel {channel}, sum {i}: {error}"
                    );
                }
            }
        }
        // With all samples at the rail the plain sum is at its limit.
        let step = PhaseStep::from_period(20.0);
        let mut demodulator = Demodulator::<i16, 256>::new(step, length, 0, false);
        let rail = vec![Packed(0x8000_8000); usize::from(length)];
        let (_, block) = demodulator.push_slice(&rail);
        let sums = block.expect("the block is whole").sums;
        assert_eq!(sums[0].sum, i32::from(i16::MIN) * i32::from(length));
    }
}

#[test]
fn packed_codes_and_single_words_give_the_same_blocks() {
    let step = PhaseStep::from_period(18.75);
    let pairs: Vec<[i16; 2]> = (0..2_000)
        .map(|k: i32| [(k * 7_919) as i16, (k * 104_729) as i16])
        .collect();
    let packed: Vec<Packed> = pairs.iter().map(|&pair| pair.into()).collect();
    let mut single = Demodulator::<i16, 64>::new(step, 19, 0, true);
    let expected: Vec<_> = pairs
        .iter()
        .filter_map(|&pair| single.push(pair).copied())
        .collect();
    // Cut at every length, so that slices begin at even and at odd samples, and mixed with single pushes.
    for cut in 1..40 {
        let mut mixed = Demodulator::<i16, 64>::new(step, 19, 0, true);
        let mut found = Vec::new();
        for (i, part) in packed.chunks(cut).enumerate() {
            if i % 3 == 2 {
                found.extend(part.iter().filter_map(|word| mixed.push(word.0).copied()));
                continue;
            }
            let mut part = part;
            while !part.is_empty() {
                let (taken, block) = mixed.push_slice(part);
                found.extend(block.copied());
                part = &part[taken..];
            }
        }
        assert_eq!(found, expected, "slices of {cut}");
    }
}

/// The sums about the third harmonic of one block of random samples within ±1, times `full_scale`.
fn third_sums<S: Sample>(length: u16, full_scale: f32, code: fn(f32) -> S) -> [[f64; 2]; 2]
where
    [S; 2]: SamplePair<S>,
{
    let step = PhaseStep::from_period(18.75);
    let mut demodulator = Demodulator::<S, 64>::new(step, length, 0, true);
    let pairs: Vec<[S; 2]> = (0..i32::from(length))
        .map(|k| {
            [1_640_531_527, 1_013_904_223].map(|step| {
                let sample = (k + 1).wrapping_mul(step) as f32 / 2_147_483_648.0;
                code(0.99 * full_scale * sample)
            })
        })
        .collect();
    let (_, block) = demodulator.push_slice(&pairs);
    let block = block.expect("the block is whole");
    let watch = block.watch.as_ref().expect("it is watched");
    let scale = full_scale * f32::from(block.layout.scale.max(1));
    core::array::from_fn(|channel| {
        S::third(&block.sums[channel], &watch[channel]).map(|sum| f64::from(sum / scale))
    })
}

#[test]
fn sums_about_the_third_harmonic_are_the_same_in_every_arithmetic() {
    for length in 4..=64 {
        let float = third_sums(length, 1.0, |x| x);
        let short = third_sums(length, 32_768.0, |x| x as i16);
        let long = third_sums(length, 2_147_483_648.0, |x| x as i32);
        let room = 1e-4 * f64::from(length) + f64::from(length).powi(2) / 65_535.0;
        for codes in [short, long] {
            for (found, wanted) in codes.as_flattened().iter().zip(float.as_flattened()) {
                let error = (found - wanted).abs();
                assert!(error < room, "length {length}: {error} of {wanted}");
            }
        }
    }
}

/// Asserts that the watch gives the least and the greatest of each block's samples, however these come.
fn extremes_are_watched<S: Sample + PartialOrd>(code: fn(i32) -> S)
where
    [S; 2]: SamplePair<S>,
{
    const LENGTH: u16 = 19;
    let pairs: Vec<[S; 2]> = (0..1900i32)
        .map(|k| [1_640_531_527, 1_013_904_223].map(|step| code(k.wrapping_mul(step))))
        .collect();
    let step = PhaseStep::from_period(18.75);
    for slice in [1, 5, 19, 50, 1900] {
        let mut demodulator = Demodulator::<S, 64>::new(step, LENGTH, 0, true);
        let mut blocks = Vec::new();
        for mut part in pairs.chunks(slice) {
            while let [pair, ..] = part {
                let (taken, block) = if slice == 1 {
                    (1, demodulator.push(*pair))
                } else {
                    demodulator.push_slice(part)
                };
                blocks.extend(block.copied());
                part = &part[taken..];
            }
        }
        assert_eq!(blocks.len(), 100);
        for (block, samples) in blocks.iter().zip(pairs.chunks(LENGTH.into())) {
            let watch = block.watch.as_ref().expect("it is watched");
            for (channel, watch) in watch.iter().enumerate() {
                let [mut low, mut high] = [samples[0][channel]; 2];
                for pair in samples {
                    let sample = pair[channel];
                    low = if sample < low { sample } else { low };
                    high = if sample > high { sample } else { high };
                }
                assert!(watch.low == low && watch.high == high, "slices of {slice}");
            }
        }
    }
}

#[test]
fn watched_extremes_are_those_of_the_block() {
    extremes_are_watched(|code| code as f32);
    extremes_are_watched(|code| (code >> 16) as i16);
    extremes_are_watched(|code| code);
}
