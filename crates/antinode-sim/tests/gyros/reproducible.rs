//! The same bits for the same seed, on every platform and in every version until a release says otherwise.

use antinode_sim::{Channel, ClipSpan, Dropout, DropoutKind, Flaws, Gyro, Loss, Wave, random_wave};

/// 64-bit FNV-1a over the bits of the samples.
fn hash(gyro: Gyro, samples: usize) -> u64 {
    gyro.take(samples)
        .flatten()
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        })
}

fn everything() -> Flaws {
    Flaws {
        noise: 0.05,
        coloured_noise: 0.0,
        coloured_corner: 1000.0,
        offset_c: 0.01,
        hum: 0.0,
        hum_frequency: 50.0,
        offset_d: -0.02,
        gain_ratio: 1.01,
        skew: 1e-6,
        pick_off_angle: 0.002,
        cubic: 0.003,
        clip: Some(1.9),
        clip_spans: vec![ClipSpan {
            from: 0.01,
            to: 0.02,
            level: 1.0,
        }],
        bits: None,
        full_scale: 0.0,
        jitter: 1e-8,
        lost: vec![Loss { at: 777, count: 33 }],
        dropouts: vec![Dropout {
            from: 0.03,
            to: 0.04,
            kind: DropoutKind::Hold,
            channel: Some(Channel::C),
        }],
    }
}

fn split() -> Wave {
    Wave {
        damping_split: 0.1,
        damping_angle: 0.4,
        frequency_split: 0.05,
        frequency_angle: -0.3,
        ..moving()
    }
}

fn moving() -> Wave {
    Wave {
        frequency_rate: 0.1,
        angle_rate: 0.2,
        decay_rate: 0.3,
        ..Wave::default()
    }
}

#[test]
fn golden_values() {
    let noise = Flaws::white(0.1);
    let values: Vec<_> = Gyro::new(Wave::default(), noise, 100_000.0, 2021)
        .expect("a good gyro")
        .take(3)
        .collect();
    // Shortest decimals: each stands for one f64 alone, so this is equality to the bit.
    let expected = [
        [0.8171047772212097, 1.4488461334047977],
        [1.1312604043240433, 1.517749899493066],
        [0.7839012299565389, 1.7193060514643796],
    ];
    assert_eq!(values, expected);
}

#[test]
fn golden_hashes() {
    let gyro = |wave, flaws, seed| Gyro::new(wave, flaws, 100_000.0, seed).expect("a good gyro");
    let steady = Wave {
        frequency_rate: 0.0,
        ..moving()
    };
    let found = [
        hash(gyro(steady, Flaws::default(), 0), 100_000),
        hash(gyro(moving(), Flaws::default(), 0), 100_000),
        hash(gyro(moving(), everything(), 1), 100_000),
        hash(
            gyro(
                steady,
                Flaws {
                    jitter: 0.0,
                    bits: Some(16),
                    full_scale: 2.0,
                    ..everything()
                },
                2,
            ),
            100_000,
        ),
        hash(
            gyro(random_wave(4, 7000.0, 0.5), everything(), u64::MAX),
            100_000,
        ),
        hash(
            gyro(
                Wave {
                    frequency_rate: 0.0,
                    ..split()
                },
                Flaws::default(),
                0,
            ),
            100_000,
        ),
        hash(gyro(split(), everything(), 1), 100_000),
    ];
    let expected = [
        0x43bb_22c4_4c1a_9f13,
        0xe3ee_7525_3397_067a,
        0x3658_add8_94f0_14cc,
        0x47c0_1c5e_8b35_44ea,
        0x777d_ea0d_40b1_c0d9,
        0xe3ee_9916_72dd_24be,
        0x1b35_0be2_1d21_cf23,
    ];
    assert_eq!(found, expected, "{found:#x?}");
}

#[test]
fn the_seed_is_all_the_chance_there_is() {
    let gyro = |seed| Gyro::new(moving(), everything(), 100_000.0, seed).expect("a good gyro");
    assert_eq!(hash(gyro(5), 10_000), hash(gyro(5), 10_000));
    assert_ne!(hash(gyro(5), 10_000), hash(gyro(6), 10_000));
    let still = |seed| Gyro::new(moving(), Flaws::default(), 100_000.0, seed).expect("a good gyro");
    assert_eq!(hash(still(5), 10_000), hash(still(6), 10_000));
}

#[test]
fn angles_of_no_splits_change_no_bit() {
    for frequency_rate in [0.0, 0.1] {
        let wave = Wave {
            frequency_rate,
            ..moving()
        };
        let no_splits = Wave {
            damping_split: 0.0,
            frequency_split: 0.0,
            frequency_rate,
            ..split()
        };
        let gyro = |wave| Gyro::new(wave, everything(), 100_000.0, 1).expect("a good gyro");
        assert_eq!(hash(gyro(no_splits), 10_000), hash(gyro(wave), 10_000));
        for index in [0, 1, 77_777, 1 << 40] {
            assert_eq!(gyro(no_splits).truth_at(index), gyro(wave).truth_at(index));
        }
    }
}
