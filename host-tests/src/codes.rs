//! Streams of converter codes, and their identification in any arithmetic of the core.

use antinode::{Estimate, Identifier, Sample, SamplePair, Settings};
use antinode_sim::{Flaws, Gyro, Wave};

use crate::RATE;

/// A wave scaled to `share` of a converter's full scale, and its flaws scaled alike, with a converter of `bits`.
pub fn converted(wave: &Wave, flaws: &Flaws, bits: u32, share: f64) -> (Wave, Flaws) {
    let full_scale = f64::from(bits - 1).exp2();
    let scale = share * full_scale / wave.main_amplitude;
    (
        Wave {
            main_amplitude: wave.main_amplitude * scale,
            quadrature_amplitude: wave.quadrature_amplitude * scale,
            ..*wave
        },
        Flaws {
            noise: flaws.noise * scale,
            offset_c: flaws.offset_c * scale,
            offset_d: flaws.offset_d * scale,
            bits: Some(bits),
            full_scale,
            ..flaws.clone()
        },
    )
}

/// Settings for codes of `bits` bits and windows of `periods`.
pub fn settings(bits: u32, periods: u16) -> Settings {
    let full_scale = f64::from(bits - 1).exp2() as f32;
    Settings {
        periods,
        rails: Some([-full_scale, full_scale - 1.0]),
        resolution: Some(1.0),
        ..Settings::new(RATE)
    }
}

/// The codes of a gyro with a converter step of 1.
pub fn codes(wave: Wave, flaws: &Flaws, samples: usize, seed: u64) -> Vec<[i32; 2]> {
    let gyro = Gyro::new(wave, flaws.clone(), RATE, seed).expect("the test's gyro is valid");
    gyro.take(samples)
        .map(|pair| pair.map(|x| x as i32))
        .collect()
}

/// Identifies codes in the arithmetic of `S`, from cold; gives all estimates.
pub fn identify<S: Sample>(
    codes: &[[i32; 2]],
    settings: Settings,
    sample: impl Fn(i32) -> S,
) -> Vec<Estimate>
where
    [S; 2]: SamplePair<S>,
{
    identify_up_to::<S, 256>(codes, settings, sample)
}

/// As [`identify`], with blocks of up to `N` pairs.
pub fn identify_up_to<S: Sample, const N: usize>(
    codes: &[[i32; 2]],
    settings: Settings,
    sample: impl Fn(i32) -> S,
) -> Vec<Estimate>
where
    [S; 2]: SamplePair<S>,
{
    let core = Identifier::<S, N, 256>::new(settings).expect("the test's settings are valid");
    let mut core = Box::new(core);
    codes
        .iter()
        .filter_map(|pair| core.push(pair.map(&sample)))
        .collect()
}
