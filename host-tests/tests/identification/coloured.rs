//! Coloured noise, as front ends shape it, with the setting for it and without.

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Gyro, Loss, Wave, random_wave};
use biquad::{Biquad, Coefficients, DirectForm2Transposed, Hertz, Q_BUTTERWORTH_F64, Type};
use host_tests::score::{NAMES, StatedRatio};
use host_tests::{RATE, identify_changed, identify_signal, no_wave, windows};

const SAMPLES: usize = 40_000;

/// A chain of second-order filters: kind, frequency in Hz, quality.
type Filters = &'static [(Type<f64>, f64, f64)];

/// Butterworth's fourth order, ending well below three times the frequency.
const LOW_PASS: Filters = &[
    (Type::LowPass, 8000.0, 0.541_196),
    (Type::LowPass, 8000.0, 1.306_563),
];
/// A charge amplifier tuned to the resonator.
const TUNED: Filters = &[(Type::BandPass, 5332.0, 1.0)];
/// The same, far sharper: noise about the third harmonic is a sixtieth of that about the wave.
const SHARP: Filters = &[(Type::BandPass, 5332.0, 3.0)];
/// Low-passes that end at the wave.
const ONE_POLE: Filters = &[(Type::SinglePoleLowPass, 5332.0, 1.0)];
const TWO_POLES: Filters = &[(Type::LowPass, 5332.0, Q_BUTTERWORTH_F64)];
/// A transformer or a coupling capacitor.
const HIGH_PASS: Filters = &[(Type::HighPass, 2500.0, Q_BUTTERWORTH_F64)];
/// Noise of 1/f² from 300 Hz on.
const INVERSE_SQUARE: Filters = &[(Type::SinglePoleLowPass, 300.0, 1.0)];

/// Noise of both pick-offs, with this rms before the filters.
fn noise(filters: Filters, rms: f64, seed: u64) -> Vec<[f64; 2]> {
    let filter = || -> Vec<_> {
        filters
            .iter()
            .map(|&(kind, frequency, quality)| {
                let [rate, frequency] = [RATE, frequency].map(|f| Hertz::from_hz(f).unwrap());
                let coefficients = Coefficients::from_params(kind, rate, frequency, quality);
                DirectForm2Transposed::<f64>::new(coefficients.unwrap())
            })
            .collect()
    };
    let mut both = [filter(), filter()];
    let gyro = |noise| {
        let flaws = Flaws::white(noise);
        Gyro::new(Wave::default(), flaws, RATE, seed).unwrap()
    };
    let white = gyro(rms)
        .zip(gyro(0.0))
        .map(|(with, without)| [with[0] - without[0], with[1] - without[1]]);
    let mut filtered = |pair: [f64; 2]| {
        let mut chains = both.iter_mut();
        pair.map(|x| chains.next().unwrap().iter_mut().fold(x, |x, f| f.run(x)))
    };
    // The filters settle before the first sample.
    white
        .skip(1)
        .map(&mut filtered)
        .skip(1000)
        .take(SAMPLES)
        .collect()
}

fn settings(periods: u16, coloured: bool) -> Settings {
    Settings {
        coloured,
        ..windows(periods)
    }
}

/// A wave in such noise, 2 % before the filters.
fn identified(filters: Filters, settings: Settings, flaws: &Flaws, seed: u64) -> Vec<Estimate> {
    let wave = random_wave(seed, 5332.0, 0.5);
    let noise = noise(filters, 0.02 * wave.main_amplitude, seed);
    identify_changed(wave, flaws, settings, SAMPLES, seed, |k, [c, d]| {
        [c + noise[k][0], d + noise[k][1]]
    })
}

#[test]
fn deviations_hold_in_coloured_noise_and_nothing_is_flagged() {
    for (name, filters, range) in [
        ("low-pass", LOW_PASS, 0.92..1.12),
        ("tuned", TUNED, 1.0..1.2),
        ("sharply tuned", SHARP, 1.2..1.6),
        ("high-pass", HIGH_PASS, 0.92..1.12),
        ("slow", INVERSE_SQUARE, 0.75..1.0),
        ("none", &[], 0.92..1.08),
    ] {
        for periods in [10, 50] {
            let (mut honesty, mut rows, mut flagged) = (StatedRatio::default(), 0, 0);
            for seed in 0..30 {
                let wave = random_wave(seed, 5332.0, 0.5);
                let settings = settings(periods, true);
                for estimate in identified(filters, settings, &Flaws::default(), seed) {
                    flagged += usize::from(!estimate.flags.is_empty());
                    honesty.add(&estimate, &wave);
                    rows += 1;
                }
            }
            let ratios = honesty.ratios();
            println!(
                "{name}, {periods} periods: error over stated {ratios:.3?} in {rows} windows, {flagged} flagged"
            );
            assert!(rows > 1000 && flagged == 0, "{flagged} of {rows}");
            for (ratio, name) in ratios.into_iter().zip(NAMES) {
                assert!(range.contains(&ratio), "{name} {ratio}");
            }
        }
    }
}

#[test]
fn short_windows_exceed_their_deviations_in_coloured_noise_as_documented() {
    let names = ["one pole", "two poles", "high-pass", "slow"];
    let filters = [ONE_POLE, TWO_POLES, HIGH_PASS, INVERSE_SQUARE];
    // Each within a fifth.
    for (periods, hop, documented) in [
        (5, None, [1.0, 1.1, 1.1, 0.9]),
        (4, None, [1.0, 1.0, 1.1, 0.5]),
        (3, None, [1.2, 1.3, 1.1, 0.7]),
        (2, None, [1.8, 2.5, 1.0, 1.5]),
        // Half a window.
        (8, Some(5), [1.0, 1.0, 1.1, 0.4]),
        (5, Some(5), [1.2, 1.3, 1.1, 0.7]),
        (3, Some(5), [1.6, 1.9, 1.0, 1.1]),
        (2, Some(5), [2.4, 3.6, 1.0, 2.2]),
    ] {
        for ((name, filters), documented) in names.into_iter().zip(filters).zip(documented) {
            let (mut honesty, mut rows, mut flagged) = (StatedRatio::default(), 0, 0);
            for seed in 0..10 {
                let wave = random_wave(seed, 5332.0, 0.5);
                let settings = Settings {
                    hop,
                    ..settings(periods, true)
                };
                let found = identified(filters, settings, &Flaws::default(), seed);
                rows += found.len();
                flagged += honesty.add_clean(&found, &wave);
            }
            let ratios = honesty.ratios();
            println!(
                "{name}, {periods} periods, hop {hop:?}: error over stated {ratios:.3?}, {flagged} of {rows} flagged"
            );
            let is_shortest = periods == 2 && hop.is_some();
            let most = if is_shortest { rows / 3 } else { rows / 20 };
            assert!(flagged <= most, "{flagged} of {rows}");
            for (ratio, of) in ratios.into_iter().zip(NAMES) {
                let off = ratio / documented;
                assert!((0.8..1.2).contains(&off), "{of} {ratio}");
            }
        }
    }
}

#[test]
fn without_the_setting_a_lack_of_noise_about_the_third_harmonic_is_a_misfit() {
    for filters in [LOW_PASS, SHARP] {
        let [plain, coloured] = [false, true].map(|coloured| {
            let found =
                |seed| identified(filters, settings(100, coloured), &Flaws::default(), seed);
            let rows: Vec<Estimate> = (0..10).flat_map(found).collect();
            let told = rows.iter().filter(|e| e.flags == Flags::MISFIT).count();
            let clean = rows.iter().filter(|e| e.flags.is_empty()).count();
            assert_eq!(told + clean, rows.len());
            [told, clean]
        });
        println!("misfit and clean: {plain:?}, with the setting {coloured:?}");
        assert!(plain[0] > 150 && plain[0] > 4 * plain[1], "{plain:?}");
        assert!(coloured[1] > 190 && coloured[0] == 0, "{coloured:?}");
    }
}

#[test]
fn faults_are_flagged_in_coloured_noise() {
    for seed in 0..20 {
        let at = 20_000 + 97 * seed;
        let flaws = Flaws {
            lost: vec![Loss { at, count: 3 }],
            ..Flaws::default()
        };
        let found = identified(LOW_PASS, settings(10, true), &flaws, seed);
        let near = |e: &Estimate| e.start + 400 > at && e.start < at + 400;
        let (near, far): (Vec<Estimate>, Vec<Estimate>) = found.into_iter().partition(near);
        assert!(
            near.iter().any(|e| e.flags.contains(Flags::PHASE_JUMP)),
            "seed {seed}: {near:?}"
        );
        assert!(far.iter().all(|e| e.flags.is_empty()), "seed {seed}");
    }
}

/// A wave, and settings that almost know its frequency: the first window begins with the first sample.
fn nearly_known() -> (Wave, Settings) {
    let wave = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 0.1,
        ..Wave::default()
    };
    let settings = Settings {
        frequency: Some(5350.0),
        ..settings(10, true)
    };
    (wave, settings)
}

#[test]
fn a_first_window_in_which_the_wave_begins_does_not_raise_the_noise_of_later_ones() {
    for begin in [20, 50, 80, 110, 140] {
        let (wave, settings) = nearly_known();
        let found = identify_signal(1e-3, settings, 20_000, 1, |t| {
            if t < f64::from(begin) / RATE {
                [0.0; 2]
            } else {
                wave.pick_offs(t)
            }
        });
        assert!(found.len() > 90);
        for estimate in &found[2..] {
            let deviation = f64::from(estimate.main_amplitude_std);
            assert!(deviation < 2.5e-4, "from {begin} on: {estimate:?}");
        }
    }
}

#[test]
fn noise_that_comes_and_goes_is_no_misfit() {
    let wave = Wave {
        main_amplitude: 1.0,
        quadrature_amplitude: 0.1,
        ..Wave::default()
    };
    let quiet = Flaws::white(1e-3);
    // Half of the windows have four times the noise.
    let found = identify_changed(no_wave(), &quiet, windows(10), 400_000, 3, |k, [c, d]| {
        let random = (k as u32 / 190 + 1).wrapping_mul(2_654_435_769);
        let factor = if (random >> 16).count_ones().is_multiple_of(2) {
            1.0
        } else {
            4.0
        };
        let [of_c, of_d] = wave.pick_offs(k as f64 / RATE);
        [of_c + factor * c, of_d + factor * d]
    });
    let misfits = found.iter().filter(|e| e.flags.contains(Flags::MISFIT));
    let share = misfits.count() as f64 / found.len() as f64;
    assert!(found.len() > 2000 && share < 0.02, "{share}");
}

#[test]
fn a_burst_in_the_first_window_does_not_raise_the_noise_of_later_ones() {
    let mut widened = 0;
    for seed in 0..40 {
        let (wave, settings) = nearly_known();
        // A burst of four samples, a hundred times the noise.
        let burst = 20 + 3 * seed..24 + 3 * seed;
        let found = identify_signal(1e-3, settings, 20_000, seed, |t| {
            let [c, d] = wave.pick_offs(t);
            let is_burst = burst.contains(&((t * RATE).round() as u64));
            [c + if is_burst { 0.1 } else { 0.0 }, d]
        });
        assert!(found.len() > 90);
        let is_wide = |estimate: &Estimate| estimate.main_amplitude_std > 3e-4;
        widened += u32::from(found[2..].iter().any(is_wide));
    }
    assert!(widened < 3, "{widened} of 40");
}

#[test]
fn noise_that_grows_about_the_wave_alone_is_flagged_with_the_setting() {
    let (mut told, mut rows) = (0, 0);
    for seed in 0..30 {
        let wave = random_wave(seed, 5332.0, 0.5);
        let white = Flaws::white(0.01 * wave.main_amplitude);
        // Six times the noise variance for a fifth of the time; about the third harmonic there is hardly more.
        let grown = noise(TUNED, 0.027 * wave.main_amplitude, seed + 100);
        let is_grown = |k: usize| k % 4000 >= 3200;
        let settings = settings(20, true);
        let found = identify_changed(wave, &white, settings, SAMPLES, seed, |k, [c, d]| {
            let [of_c, of_d] = if is_grown(k) { grown[k] } else { [0.0; 2] };
            [c + of_c, d + of_d]
        });
        let is_within = |e: &&Estimate| is_grown(e.start as usize) && is_grown(e.end() as usize);
        for estimate in found.iter().filter(is_within) {
            rows += 1;
            told += usize::from(estimate.flags.contains(Flags::MISFIT));
        }
    }
    println!("{told} of {rows} told");
    assert!(rows > 250 && 5 * told > 3 * rows, "{told} of {rows}");
}
