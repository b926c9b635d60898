//! The stream against the formulas, flaw by flaw.

use super::*;
use crate::timed::{ClipSpan, Dropout, DropoutKind, Loss};
use std::f64::consts::TAU;

const RATE: f64 = 100_000.0;

fn gyro(flaws: Flaws) -> Gyro {
    Gyro::new(Wave::default(), flaws, RATE, 42).unwrap()
}

fn noisy() -> Flaws {
    Flaws::white(0.1)
}

fn lost(losses: &[(u64, u64)]) -> Vec<Loss> {
    losses
        .iter()
        .map(|&(at, count)| Loss { at, count })
        .collect()
}

#[test]
fn without_flaws_the_samples_are_the_formulas() {
    let wave = Wave {
        angle_rate: 0.5,
        decay_rate: 0.1,
        ..Wave::default()
    };
    for (k, pair) in Gyro::new(wave, Flaws::default(), RATE, 0)
        .unwrap()
        .take(1000)
        .enumerate()
    {
        let [c, d] = wave.pick_offs(k as f64 / RATE);
        assert!(
            (pair[0] - c).abs() < 1e-13 && (pair[1] - d).abs() < 1e-13,
            "sample {k}"
        );
    }
}

#[test]
fn lost_samples_leave_the_others_alone() {
    let whole: Vec<[f64; 2]> = gyro(noisy()).take(40).collect();
    let losses = lost(&[(20, 5), (0, 2), (8, 1), (9, 2), (22, 6), (35, 0)]);
    let mut gyro = gyro(Flaws {
        lost: losses,
        ..noisy()
    });
    let expected: Vec<u64> = (0..40)
        .filter(|k| ![0, 1, 8, 9, 10].contains(k) && !(20..28).contains(k))
        .collect();
    for &k in &expected {
        assert_eq!(gyro.index(), k);
        assert_eq!(gyro.next(), Some(whole[k as usize]), "sample {k}");
    }
}

#[test]
fn a_lost_sample_is_a_jump_of_phase() {
    let phase = |z: (f64, f64)| z.1.atan2(z.0);
    let wave = Wave {
        angle: 0.0,
        quadrature_amplitude: 0.0,
        frequency: 1000.0,
        ..Wave::default()
    };
    let gyro = Gyro::new(
        wave,
        Flaws {
            lost: lost(&[(100, 3)]),
            ..Flaws::default()
        },
        RATE,
        0,
    )
    .unwrap();
    let samples: Vec<f64> = gyro.take(200).map(|s| s[0]).collect();
    // One period is 100 samples: demodulate the record's two halves against one reference.
    let demodulate = |from: usize| {
        (from..from + 100).fold((0.0, 0.0), |(x, y), k| {
            let reference = TAU * k as f64 / 100.0;
            (
                x + samples[k] * reference.cos(),
                y - samples[k] * reference.sin(),
            )
        })
    };
    let jump = phase(demodulate(100)) - phase(demodulate(0));
    assert!((jump - 3.0 * TAU * 1000.0 / RATE).abs() < 1e-12, "{jump}");
}

#[test]
fn nth_is_next_many_times() {
    let flaws = Flaws {
        lost: lost(&[(3, 2), (5, 1), (64, 100), (300, 1), (299, 1)]),
        ..noisy()
    };
    for n in [0, 1, 2, 3, 4, 60, 61, 62, 150, 195, 196, 400] {
        let (mut jumping, mut walking) = (gyro(flaws.clone()), gyro(flaws.clone()));
        for _ in 0..n {
            walking.next();
        }
        for _ in 0..3 {
            assert_eq!(jumping.nth(n), walking.next(), "{n}");
            assert_eq!(jumping.index(), walking.index(), "{n}");
            for _ in 0..n {
                walking.next();
            }
        }
    }
    assert!(gyro(flaws).nth(usize::MAX).is_some());
}

#[test]
fn dropouts_of_every_kind() {
    let dropout = |from, to, kind, channel| Dropout {
        from,
        to,
        kind,
        channel,
    };
    let dropouts = vec![
        dropout(300e-5, 310e-5, DropoutKind::NoiseOnly, None),
        dropout(0.0, 10e-5, DropoutKind::Hold, None),
        dropout(100e-5, 110e-5, DropoutKind::Zero, Some(Channel::C)),
        dropout(105e-5, 115e-5, DropoutKind::Hold, Some(Channel::D)),
        dropout(310e-5, 315e-5, DropoutKind::Hold, Some(Channel::C)),
        dropout(110e-5, 112e-5, DropoutKind::Hold, Some(Channel::C)),
    ];
    let offsets = Flaws {
        offset_c: 3.0,
        offset_d: -3.0,
        ..noisy()
    };
    let whole: Vec<[f64; 2]> = gyro(offsets.clone()).take(400).collect();
    let clean: Vec<[f64; 2]> = gyro(Flaws::default()).take(400).collect();
    let broken: Vec<[f64; 2]> = gyro(Flaws {
        dropouts,
        ..offsets
    })
    .take(400)
    .collect();
    let floor_c = |k: usize| whole[k][0] - clean[k][0];
    for k in 0..400 {
        let (c, d) = match k {
            0..10 => (0.0, 0.0),
            100..112 => (0.0, if k < 105 { whole[k][1] } else { whole[104][1] }),
            112..115 => (whole[k][0], whole[104][1]),
            300..310 => (floor_c(k), whole[k][1] - clean[k][1]),
            310..315 => (floor_c(309), whole[k][1]),
            _ => whole[k].into(),
        };
        let pair = broken[k];
        assert!(
            (pair[0] - c).abs() < 1e-14 && (pair[1] - d).abs() < 1e-14,
            "sample {k}: {pair:?}, {c} {d}"
        );
    }
    assert!((floor_c(305) - 3.0).abs() < 0.5);
}

#[test]
fn clipping_everywhere_and_for_a_time() {
    let clip_spans = vec![
        ClipSpan {
            from: 0.002,
            to: 0.003,
            level: 0.5,
        },
        ClipSpan {
            from: 0.001,
            to: 0.002,
            level: 1.8,
        },
    ];
    let whole: Vec<[f64; 2]> = gyro(noisy()).take(400).collect();
    let clipped = gyro(Flaws {
        clip: Some(1.5),
        clip_spans,
        ..noisy()
    });
    for (k, (pair, before)) in clipped.zip(&whole).enumerate() {
        let level = if (200..300).contains(&k) { 0.5 } else { 1.5 };
        assert_eq!(pair, before.map(|s| s.clamp(-level, level)), "{k}");
    }
}

#[test]
fn codes_are_the_values() {
    let adc = Flaws {
        bits: Some(12),
        full_scale: 1.0,
        ..noisy()
    };
    let lsb = adc.lsb().unwrap();
    let mut range = (0, 0);
    for (pair, codes) in gyro(adc.clone()).zip(gyro(adc).codes().unwrap()).take(2000) {
        assert_eq!(pair, codes.map(|code| f64::from(code) * lsb));
        let [c, d] = codes;
        range = (range.0.min(c).min(d), range.1.max(c).max(d));
    }
    assert_eq!(range, (-2048, 2047)); // a wave of twice the full scale: both ends are reached
    let fine = Flaws {
        bits: Some(16),
        full_scale: 4.0,
        ..noisy()
    };
    for (pair, before) in gyro(fine).zip(gyro(noisy())).take(2000) {
        assert!((pair[0] - before[0]).abs() <= 2.0 / 32768.0 + 1e-15);
        assert!((pair[1] - before[1]).abs() <= 2.0 / 32768.0 + 1e-15);
    }
    assert!(matches!(gyro(noisy()).codes(), Err(Error::NoBits)));
}

#[test]
fn what_cannot_be_is_refused() {
    let new = |flaws, rate| Gyro::new(Wave::default(), flaws, rate, 0).err();
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            new(Flaws::default(), rate),
            Some(Error::OutOfRange {
                what: "sample_rate",
                ..
            })
        ));
    }
    for (at, count) in [(1, u64::MAX), (MAX_INDEX, 1), (0, MAX_INDEX + 1)] {
        let error = new(
            Flaws {
                lost: lost(&[(at, count)]),
                ..Flaws::default()
            },
            RATE,
        );
        assert_eq!(error, Some(Error::EndlessLoss { at, count }));
    }
    let dropout = |from, to, channel| Dropout {
        from,
        to,
        kind: DropoutKind::Zero,
        channel,
    };
    let two = |a, b| Flaws {
        dropouts: vec![dropout(0.0, 2.0, a), dropout(1.0, 3.0, b)],
        ..Flaws::default()
    };
    let overlap = Some(Error::Overlap {
        what: "dropouts",
        index: 100_000,
    });
    assert_eq!(new(two(None, Some(Channel::D)), RATE), overlap);
    assert_eq!(new(two(Some(Channel::C), Some(Channel::C)), RATE), overlap);
    assert_eq!(new(two(Some(Channel::C), Some(Channel::D)), RATE), None);
    let no_wave = Wave {
        main_amplitude: -1.0,
        ..Wave::default()
    };
    assert!(matches!(
        Gyro::new(no_wave, Flaws::default(), RATE, 0),
        Err(Error::OutOfRange {
            what: "main_amplitude",
            ..
        })
    ));
    let clipped = |spans: &[(f64, f64)]| Flaws {
        clip_spans: spans
            .iter()
            .map(|&(from, to)| ClipSpan {
                from,
                to,
                level: 1.0,
            })
            .collect(),
        ..Flaws::default()
    };
    let overlap = Error::Overlap {
        what: "clip_spans",
        index: 100_000,
    };
    assert_eq!(new(clipped(&[(0.0, 2.0), (1.0, 3.0)]), RATE), Some(overlap));
    assert_eq!(
        new(clipped(&[(1.0, 1.0)]), RATE).unwrap().to_string(),
        "one of clip_spans goes from 1 s to 1 s: it must end after it begins, and both ends must be finite"
    );
}
