//! Settings at the ends of their ranges work, and those just beyond are refused; no row has meaningless numbers without a flag.

use antinode::{Estimate, Flags, Identifier, Settings, Tracker};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::random::Random;
use host_tests::score::{StatedRatio, errors};
use host_tests::{Core, RATE, calibrated, gyro, identify, identify_parts, stream, windows};

/// True if the core accepts windows of ten periods with this change.
fn is_taken(change: impl Fn(&mut Settings)) -> bool {
    let mut settings = windows(10);
    change(&mut settings);
    Core::new(settings).is_ok()
}

#[test]
fn ranges_include_their_ends_and_nothing_beyond() {
    type Put = fn(&mut Settings, f64);
    let ranges: [(Put, f64, f64); 5] = [
        (|s, x| s.sample_rate = x, 1e-3, 1e12),
        (|s, x| s.start_angle = x as f32, -1e4, 1e4),
        (|s, x| s.calibration.gain_ratio = x as f32, 0.1, 10.0),
        (|s, x| s.calibration.skew = x as f32, -1e-3, 1e-3),
        (|s, x| s.calibration.pick_off_angle = x as f32, -0.3, 0.3),
    ];
    for (i, (put, least, most)) in ranges.into_iter().enumerate() {
        let past = 1e-6 * (most - least).min(least.abs());
        for (value, wanted) in [
            (least, true),
            (most, true),
            (least - past, false),
            (most + 1e-6 * most, false),
            (f64::NAN, false),
            (f64::INFINITY, false),
            (f64::NEG_INFINITY, false),
        ] {
            assert_eq!(is_taken(|s| put(s, value)), wanted, "range {i}: {value}");
        }
    }
    for rails in [[0.0, 0.0], [f32::NAN, 1.0], [-1.0, f32::NAN]] {
        assert!(!is_taken(|s| s.rails = Some(rails)));
    }
    for resolution in [-1.0, f32::NAN, f32::INFINITY] {
        assert!(!is_taken(|s| s.resolution = Some(resolution)));
    }
    assert!(is_taken(|s| s.rails = Some([-f32::MAX, f32::MAX])));
    assert!(is_taken(|s| s.resolution = Some(f32::MIN_POSITIVE)));
}

#[test]
fn a_ring_allows_windows_of_two_blocks_less() {
    for (periods, wanted) in [(1, false), (2, true), (14, true), (15, false)] {
        assert_eq!(Tracker::<16>::new(windows(periods)).is_ok(), wanted);
    }
}

#[test]
fn calibrations_at_the_ends_of_their_ranges_correct_the_pick_offs() {
    for (gain_ratio, skew, pick_off_angle) in [
        (0.1, 0.0, 0.3),
        (10.0, 0.0, -0.3),
        (1.0, 1e-4, 0.3),
        (0.1, -1e-4, 0.0),
        // Over five turns of the pattern.
        (1.0, 1e-3, -0.1),
        (1.0, -1e-3, 0.1),
    ] {
        let wave = Wave {
            angle_rate: 1.0,
            decay_rate: 1.0,
            ..random_wave(3, 5332.0, 0.3)
        };
        let flaws = Flaws {
            gain_ratio,
            skew,
            pick_off_angle,
            ..Flaws::default()
        };
        let settings = calibrated(&flaws, 50);
        let found = identify(wave, &flaws, settings, 20_000, 0);
        assert!(found.len() > 15);
        for estimate in found {
            let [main, quadrature, angle, frequency] = errors(&estimate, &wave);
            let size = wave.main_amplitude;
            // Angles of several turns have fewer digits.
            let limit = 1e-6 + 3e-3 * skew.abs();
            assert!(estimate.flags.is_empty(), "{estimate:?}");
            assert!(
                main.abs().max(quadrature.abs()) < limit * size && angle.abs() < limit,
                "{gain_ratio}, {skew} s, {pick_off_angle} rad: {main:e} {quadrature:e} {angle:e}"
            );
            assert!(frequency.abs() < 1e-8 * RATE, "{frequency:e}");
        }
    }
}

#[test]
fn a_front_accepts_periods_up_to_its_capacity_only() {
    for (period, is_taken) in [(38.0, true), (39.7, true), (41.5, false), (60.0, false)] {
        let wave = Wave {
            frequency: RATE / period,
            ..Wave::default()
        };
        let mut core = Identifier::<f32, 40, 16>::new(windows(10)).unwrap();
        let mut found = Vec::new();
        let pairs = stream(wave, Flaws::default(), 20_000, 1);
        core.extend(&pairs, |e| found.push(e));
        assert_eq!(found.len() > 40, is_taken, "{period} samples a period");
        assert_eq!(core.is_searching(), !is_taken);
        for estimate in found {
            assert!(estimate.flags.is_empty());
            assert!((estimate.frequency - wave.frequency).abs() < 1e-3);
        }
    }
}

#[test]
fn an_impossibly_large_loss_leaves_indices_that_can_be_doubled() {
    let pairs = stream(Wave::default(), Flaws::default(), 6000, 1);
    for lost in [1 << 62, 3 << 61, u64::MAX - 2000] {
        let mut core = Core::new(windows(5)).unwrap();
        core.extend(&pairs[..3000], |_| ());
        core.skip(lost);
        let index = lost.wrapping_add(3000) % (1 << 62);
        assert_eq!(core.index(), index);
        let mut count = 0;
        core.extend(&pairs[3000..], |estimate| {
            count += 1;
            let middle = estimate.start as f64 + 0.5 * f64::from(estimate.samples - 1);
            assert!(estimate.start >= index && (estimate.time * RATE / middle - 1.0).abs() < 1e-12);
        });
        assert!(count > 20, "{lost}: {count}");
    }
}

#[test]
fn rows_are_the_same_to_the_bit_however_far_from_the_start() {
    let (wave, flaws) = gyro(5);
    let mut pairs = stream(wave, flaws, 40_000, 5);
    // Events that use earlier windows: a spike, and a silence after which the wave is searched anew.
    pairs[9_000] = [7.0, -5.0];
    pairs[20_000..21_000].fill([0.0; 2]);
    let rows = |start: u64| {
        let mut core = Core::new(windows(10)).unwrap();
        core.skip(start);
        let mut rows = Vec::new();
        core.extend(&pairs[..30_000], |e| rows.push(e));
        core.skip(700);
        core.extend(&pairs[30_700..], |e| rows.push(e));
        assert_eq!(core.index(), start + 40_000);
        for row in &mut rows {
            let middle = 2.0 * row.start as f64 + f64::from(row.samples) - 1.0;
            let time = middle / (2.0 * RATE);
            assert!((row.time / time - 1.0).abs() < 1e-15, "{start}: {row:?}");
            row.start -= start;
            row.time = 0.0;
        }
        assert!(rows.len() > 180, "{}", rows.len());
        format!("{rows:?}")
    };
    let first = rows(0);
    // Where indices, or twice these, exceed 32 bits, the integers exact in f32 and f64, and all but two bits.
    for bits in [23, 24, 30, 31, 32, 52, 53, 60, 61] {
        assert!(rows((1 << bits) - 19_000) == first, "2^{bits}");
    }
}

#[test]
fn any_sample_rate_scales_times_and_frequencies_to_their_last_digits() {
    let (wave, flaws) = gyro(7);
    let pairs = stream(wave, flaws, 8000, 7);
    let rows = |rate: f64| {
        let settings = Settings {
            sample_rate: rate,
            ..windows(10)
        };
        identify_parts(&[&pairs], settings)
    };
    let first = rows(RATE);
    assert!(first.len() > 30);
    let mut random = Random::new(1);
    for _ in 0..50 {
        // 10⁻³ to 10¹² Hz, none of them a number in f32.
        let rate = 10f64.powf(4.5 + 7.5 * f64::from(random.draw()));
        let factor = rate / RATE;
        for (row, first) in rows(rate).iter().zip(&first) {
            assert_eq!(row.flags, first.flags);
            let exact = [
                first.time / factor / row.time,
                first.frequency * factor / row.frequency,
            ];
            assert!(
                exact.iter().all(|ratio| (ratio - 1.0).abs() < 1e-15),
                "{rate}: {exact:?}"
            );
            let rates = |e: &Estimate| {
                [
                    e.angle_rate,
                    e.decay_rate,
                    e.frequency_std,
                    e.angle_rate_std,
                    e.decay_rate_std,
                ]
                .map(f64::from)
            };
            for (rate, first) in rates(row).into_iter().zip(rates(first)) {
                assert!((first * factor / rate - 1.0).abs() < 1e-6, "{row:?}");
            }
        }
    }
}

#[test]
fn a_row_that_is_not_lost_states_a_frequency_and_deviations() {
    let mut random = Random::new(1);
    let mut rows = 0;
    // Noise, and both pick-offs' wires at a voltage with noise on it.
    for (level, noise) in [(0.0, 1.0), (1.0, 1e-3), (1.0, 0.1)] {
        let pairs: Vec<[f32; 2]> = (0..40_000)
            .map(|_| [level, -0.03 * level].map(|level| level + noise * random.draw()))
            .collect();
        for (period, periods) in [(2.5, 2), (2.6, 3), (3.5, 2), (18.75, 2)] {
            for watch in [true, false] {
                let settings = Settings {
                    watch,
                    frequency: Some((RATE / period) as f32),
                    ..windows(periods)
                };
                let mut core = Core::new(settings).unwrap();
                core.extend(&pairs, |e| {
                    let stated = [
                        e.main_amplitude_std,
                        e.quadrature_amplitude_std,
                        e.angle_std,
                        e.phase_std,
                        e.frequency_std,
                        e.angle_rate_std,
                        e.decay_rate_std,
                    ];
                    let is_stated = stated.iter().all(|&std| std > 0.0 && std.is_finite());
                    let is_sound = e.frequency > 0.0 && is_stated;
                    assert!(is_sound || e.flags.contains(Flags::LOST), "{e:?}");
                    rows += 1;
                });
            }
        }
    }
    assert!(rows > 100, "{rows}");
}

/// The largest ratio, over angles, of rms errors of a_A, a_B and θ to their deviations, and the rms over all angles, for a pattern that
/// turns by `turn` in a window of ten periods.
fn of_turning(gain_ratio: f64, turn: f64) -> [f64; 2] {
    let of_three = |ratio: &StatedRatio| {
        let [main, quadrature, angle, _] = ratio.ratios();
        [main, quadrature, angle]
    };
    let angle_rate = turn * RATE / 190.0;
    let (mut worst, mut all) = (0f64, StatedRatio::default());
    for place in 0..16 {
        let mut here = StatedRatio::default();
        for seed in 0..150 {
            // The second window, of 190 pairs, has this angle at its middle.
            let middle = std::f64::consts::FRAC_PI_2 * f64::from(place) / 16.0;
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.1,
                angle: middle - angle_rate * 284.5 / RATE,
                phase: 0.1 * seed as f64,
                angle_rate,
                ..Wave::default()
            };
            let flaws = Flaws {
                noise: 5e-3 * gain_ratio.min(1.0),
                gain_ratio,
                ..Flaws::default()
            };
            let settings = Settings {
                frequency: Some(5332.0),
                ..calibrated(&flaws, 10)
            };
            let estimate = identify(wave, &flaws, settings, 400, seed)[1];
            assert_eq!((estimate.start, estimate.samples), (190, 190));
            here.add(&estimate, &wave);
            all.add(&estimate, &wave);
        }
        worst = of_three(&here).into_iter().fold(worst, f64::max);
    }
    let squares: f64 = of_three(&all).map(|ratio| ratio * ratio).iter().sum();
    [worst, (squares / 3.0).sqrt()]
}

#[test]
fn turning_patterns_behind_unequal_gains_exceed_their_deviations_as_documented() {
    for (gain_ratio, turn, most) in [
        (10.0, 0.1, 1.3),
        (10.0, 0.25, 1.9),
        (10.0, 0.5, 2.7),
        (0.1, 0.5, 2.7),
        (2.0, 0.5, 1.3),
        (0.5, 0.5, 1.3),
    ] {
        let [worst, all] = of_turning(gain_ratio, turn);
        println!(
            "gain ratio {gain_ratio}, {turn} rad: {worst:.2} at the worst angle, {all:.2} over all"
        );
        // The largest of 48 ratios scatters.
        assert!(
            (0.9 * most..1.1 * most).contains(&worst) && all < 1.15,
            "{gain_ratio}, {turn} rad: {worst} {all}"
        );
    }
}

#[test]
fn the_greatest_waves_and_samples_are_identified_in_windows_of_ten_thousand_pairs() {
    for (amplitude, offset) in [(1e17, 0.0), (0.4e17, 1e17)] {
        let wave = Wave {
            main_amplitude: amplitude,
            quadrature_amplitude: 0.1 * amplitude,
            frequency: RATE / 199.0,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 1e-3 * amplitude,
            offset_c: offset,
            offset_d: offset,
            ..Flaws::default()
        };
        let found = identify(wave, &flaws, windows(50), 34_000, 1);
        assert!(found.len() == 3, "{amplitude:e}: {}", found.len());
        assert!(found.iter().all(|row| row.flags.is_empty()), "{found:?}");
    }
}
