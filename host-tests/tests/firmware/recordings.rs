//! Simulated recordings in the format of a 12-bit dual converter.

use antinode::Packed;
use antinode_sim::{ClipSpan, Dropout, DropoutKind, Flaws, Gyro, Loss, Wave};
use host_tests::RATE;

/// The wave of all recordings, in codes.
pub const WAVE: Wave = Wave {
    main_amplitude: 1500.0,
    quadrature_amplitude: 80.0,
    angle: 0.4,
    phase: 0.7,
    frequency: 5332.0,
    frequency_rate: 0.0,
    angle_rate: 0.0,
    decay_rate: 0.0,
    damping_split: 0.0,
    damping_angle: 0.0,
    frequency_split: 0.0,
    frequency_angle: 0.0,
};

/// Codes of 12 bits about the middle of the range.
pub fn codes(wave: Wave, flaws: Flaws, pairs: usize) -> Vec<Packed> {
    let flaws = Flaws {
        bits: Some(12),
        full_scale: 2048.0,
        ..flaws
    };
    let gyro = Gyro::new(wave, flaws, RATE, 7).expect("it can be");
    let unipolar = |code: i32| (code + 2048) as u32;
    gyro.codes()
        .expect("there is a converter")
        .take(pairs)
        .map(|[c, d]| Packed(unipolar(c) | unipolar(d) << 16))
        .collect()
}

/// Flaws with little noise, and offsets.
pub fn quiet() -> Flaws {
    Flaws {
        noise: 2.0,
        offset_c: 20.0,
        offset_d: -15.0,
        ..Flaws::default()
    }
}

/// All kinds of recordings, one second each, with their names.
pub fn all() -> Vec<(&'static str, Vec<Packed>)> {
    let second = |wave, flaws| codes(wave, flaws, RATE as usize);
    let dropout = |from, to, kind| Dropout {
        from,
        to,
        kind,
        channel: None,
    };
    vec![
        (
            "clean",
            second(
                WAVE,
                Flaws {
                    noise: 0.3,
                    ..quiet()
                },
            ),
        ),
        (
            "noisy",
            second(
                WAVE,
                Flaws {
                    noise: 150.0,
                    ..quiet()
                },
            ),
        ),
        (
            "decaying",
            second(
                Wave {
                    decay_rate: 2.0,
                    ..WAVE
                },
                quiet(),
            ),
        ),
        (
            "precessing",
            second(
                Wave {
                    angle_rate: 6.0,
                    ..WAVE
                },
                quiet(),
            ),
        ),
        (
            "dropout",
            second(
                WAVE,
                Flaws {
                    dropouts: vec![
                        dropout(0.3, 0.304, DropoutKind::Hold),
                        dropout(0.6, 0.65, DropoutKind::NoiseOnly),
                    ],
                    lost: vec![Loss {
                        at: 20_000,
                        count: 7,
                    }],
                    ..quiet()
                },
            ),
        ),
        (
            "clipping",
            second(
                Wave {
                    main_amplitude: 1950.0,
                    ..WAVE
                },
                Flaws {
                    gain_ratio: 1.6,
                    clip_spans: vec![ClipSpan {
                        from: 0.0,
                        to: 0.5,
                        level: 1800.0,
                    }],
                    ..quiet()
                },
            ),
        ),
    ]
}
