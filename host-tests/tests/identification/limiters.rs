//! Hard limiters, which have a fifth harmonic too.

use antinode::{Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::{RATE, identify, windows};

#[test]
fn a_hard_limiter_is_flagged_where_its_fifth_harmonic_folds_onto_the_third() {
    // A crest a twentieth above the limit has hardly two samples there: only the harmonics show it.
    for period in [7.9, 8.05, 8.1] {
        for limit in [0.95, 1.05] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.05,
                angle: 0.03,
                frequency: RATE / period,
                ..Wave::default()
            };
            let flaws = Flaws {
                noise: 1e-4,
                clip: Some(limit),
                ..Flaws::default()
            };
            let samples = (100.0 * period * 20.0) as usize;
            let found = identify(wave, &flaws, windows(20), samples, 1);
            let clipped = found.iter().filter(|e| e.flags.contains(Flags::CLIPPED));
            let (count, rows) = (clipped.count(), found.len());
            println!("{period} samples a period, limit {limit}: {count} of {rows} clipped");
            assert!(rows > 90);
            if limit < 1.0 {
                assert!(10 * count > 9 * rows, "{period}: {count} of {rows}");
            } else {
                assert!(found.iter().all(|e| e.flags.is_empty()), "{period}");
            }
        }
    }
}

/// Windows of a wave of `period` samples that a limiter at an unknown level cuts by `over`: their count, those without a flag, and the
/// largest relative error of a_A in the latter.
fn limited(wave: Wave, period: f64, over: f64, settings: Settings, seed: u64) -> [f64; 3] {
    let peak = (0..200)
        .flat_map(|k| wave.pick_offs(f64::from(k) * period / 200.0 / RATE))
        .fold(0f64, |peak, x| peak.max(x.abs()));
    let flaws = Flaws {
        noise: 1e-3 * wave.main_amplitude,
        clip: Some(peak / over),
        ..Flaws::default()
    };
    let samples = (12.0 * period * f64::from(settings.periods)) as usize;
    let (mut rows, mut clean, mut worst) = (0.0, 0.0, 0f64);
    for estimate in identify(wave, &flaws, settings, samples, seed) {
        rows += 1.0;
        if estimate.flags.is_empty() {
            clean += 1.0;
            let error = f64::from(estimate.main_amplitude) / wave.main_amplitude - 1.0;
            worst = worst.max(error.abs());
        }
    }
    [rows, clean, worst]
}

/// Share of windows without a flag, and the largest relative error of a_A in them.
fn unflagged(limited: impl Iterator<Item = [f64; 3]>) -> [f64; 2] {
    let [rows, clean, worst] = limited
        .reduce(|a, b| [a[0] + b[0], a[1] + b[1], a[2].max(b[2])])
        .unwrap();
    assert!(rows > 50.0);
    [clean / rows, worst]
}

#[test]
fn limits_at_an_unknown_level_are_flagged_at_most_periods_as_documented() {
    // How far the stronger pick-off's crests would exceed the limit, and the largest share without a flag: below 6.3 and near 10 samples a
    // period other harmonics fold onto the third, and may take it away.
    for (over, most) in [(1.2, 0.05), (1.1, 0.4), (1.05, 0.4)] {
        for period in [
            4.4, 5.1, 5.9, 6.005, 6.6, 8.05, 9.4, 9.9, 11.95, 18.75, 50.3,
        ] {
            let [clean, off] = unflagged((0..12).map(|seed| {
                let wave = random_wave(seed, RATE / period, 0.1);
                limited(wave, period, over, windows(10), seed)
            }));
            println!(
                "{period} samples a period, {over} times the limit: {clean:.2} without a flag, off by {off:.3}"
            );
            let is_folded = period < 6.3 || period == 9.9;
            let may_be_more = is_folded && over == 1.05 || period == 5.1 && over == 1.1;
            assert!(off < 0.04 && (clean < most || may_be_more));
        }
    }
}

#[test]
fn limiting_is_flagged_in_short_windows_from_the_stated_samples_a_period_on() {
    for (periods, below, least) in [(2, 5.2, 14.0), (3, 4.3, 10.5), (4, 4.3, 8.0), (5, 4.3, 5.0)] {
        for (over, most_off) in [(1.2, 0.11), (1.5, 0.26), (2.0, 0.43)] {
            let share = |shortest: f64, longest: f64| {
                unflagged((0..120).map(|seed| {
                    let place = (seed as f64 * 0.618_034).fract();
                    let period = shortest * (longest / shortest).powf(place);
                    let wave = random_wave(seed, RATE / period, 0.3);
                    let settings = Settings {
                        frequency: Some(wave.frequency as f32),
                        ..windows(periods)
                    };
                    limited(wave, period, over, settings, seed)
                }))
            };
            let ([short, off], [long, _]) = (share(below, least), share(least, 30.0));
            println!(
                "{periods} periods, {over} times the limit: {short:.2} without a flag below {least} samples, off by {off:.2}, {long:.3} above"
            );
            assert!(short > 0.1 && short < 0.95 && off < most_off && long < 0.02);
        }
    }
}

#[test]
fn a_weak_third_harmonic_is_flagged_where_no_image_of_another_is_near() {
    // Blocks of two periods tell the third harmonic from the image of the fifth: its amplitude is not shared with that.
    for period in [9.3, 10.2] {
        let wave = Wave {
            main_amplitude: 1.0,
            angle: 0.0,
            frequency: RATE / period,
            ..Wave::default()
        };
        for (third, is_clipped) in [(0.9e-3, false), (1.2e-3, true)] {
            let flaws = Flaws {
                noise: 1e-5,
                cubic: 4.0 * third,
                ..Flaws::default()
            };
            let found = identify(wave, &flaws, windows(50), 10_000, 1);
            assert!(found.len() > 15);
            let wanted = Flags::empty();
            let wanted = if is_clipped { Flags::CLIPPED } else { wanted };
            for estimate in &found {
                assert_eq!(estimate.flags, wanted, "{period}, {third}");
            }
        }
    }
}
