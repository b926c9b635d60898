//! Settings with a known frequency: the error that it may have, the periods that are allowed, and the results of a wrong one.

use antinode::{Estimate, Flags, Front, Identifier, Settings, SettingsError};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::codes::{codes, converted, identify_up_to};
use host_tests::random::Random;
use host_tests::score::{NAMES, Score, StatedRatio};
use host_tests::{Core, RATE, gyro, identify, identify_changed, identify_parts, stream, windows};

/// Settings for windows of `periods` of a wave, with the known frequency `off` times itself from the truth.
fn told(periods: u16, frequency: f64, off: f64) -> Settings {
    Settings {
        frequency: Some((frequency * (1.0 + off)) as f32),
        ..windows(periods)
    }
}

/// A wave of `period` samples, and flaws with noise of 2 % and an offset.
fn noisy(period: f64, seed: u64) -> (Wave, Flaws) {
    let wave = random_wave(seed, RATE / period, 0.5);
    let a = wave.main_amplitude;
    let flaws = Flaws {
        noise: 0.02 * a,
        offset_c: 0.3 * a,
        offset_d: -0.1 * a,
        ..Flaws::default()
    };
    (wave, flaws)
}

/// Scores the windows of a stream; asserts that the first begins with the first sample and that all are clean.
fn add(score: &mut Score, found: &[Estimate], wave: &Wave, noise: f64, label: &str) {
    let starts = found.first().map(|estimate| estimate.start);
    assert_eq!(starts, Some(0), "{label}");
    for estimate in found {
        assert!(estimate.flags.is_empty(), "{label}: {estimate:?}");
        score.add(estimate, wave, noise);
    }
}

fn check(score: &Score, least: usize, limit: f64, label: &str) {
    let error = score.error();
    println!(
        "{label}: {} windows, rms error/bound {error:.3?}",
        score.windows()
    );
    assert!(score.windows() >= least, "{label}: {}", score.windows());
    for (name, error) in NAMES.iter().zip(error) {
        assert!(error <= limit, "{label}: {name} at {error:.3} of the bound");
    }
}

#[test]
fn windows_reach_the_bound_from_the_first_sample_on() {
    check_the_bound(&[2.6, 4.0, 18.75]);
}

#[test]
fn windows_of_slow_waves_reach_the_bound_from_the_first_sample_on() {
    check_the_bound(&[190.0]);
}

/// Waves of these periods in samples, with the known frequency exact and up to 5 % off.
fn check_the_bound(waves: &[f64]) {
    for &period in waves {
        let cases: Vec<(u16, f64)> = [10, 50]
            .into_iter()
            .flat_map(|periods| [-0.05, 0.0, 0.05].map(|off| (periods, off)))
            .filter(|(_, off)| period * (1.0 - off) >= 2.5)
            .collect();
        let label = |(periods, off)| {
            format!("{period} samples a period, {periods} periods, told {off} off")
        };
        let samples = |periods| (period * f64::from(periods) * 5.6) as usize;
        let mut scores = vec![Score::default(); cases.len()];
        for seed in 0..400 {
            let (wave, flaws) = noisy(period, seed);
            let pairs = stream(wave, flaws.clone(), samples(50), seed);
            for (score, &(periods, off)) in scores.iter_mut().zip(&cases) {
                let pairs = &pairs[..samples(periods)];
                let found = identify_parts(&[pairs], told(periods, wave.frequency, off));
                add(score, &found, &wave, flaws.noise, &label((periods, off)));
            }
        }
        for (score, case) in scores.iter().zip(cases) {
            // Blocks of the wrong length lose up to 2 %, and the test scatters.
            check(score, 1900, 1.1, &label(case));
        }
    }
}

#[test]
fn noise_nearly_as_large_as_the_wave_hides_no_wave_in_long_windows() {
    for (period, noise) in [(3.3, 0.5), (5.0, 0.5), (8.0, 0.8), (12.0, 0.8), (60.0, 0.8)] {
        for periods in [200, 1000] {
            let mut honesty = StatedRatio::default();
            for seed in 0..10 {
                let wave = random_wave(seed, RATE / period, 0.3);
                let flaws = Flaws::white(noise * wave.main_amplitude);
                let samples = (period * f64::from(periods) * 5.6) as usize;
                let settings = told(periods, wave.frequency, 0.0);
                let mut core =
                    Box::new(antinode::Identifier::<f32, 256, 1024>::new(settings).unwrap());
                let mut found = Vec::new();
                core.extend(&stream(wave, flaws, samples, seed), |e| found.push(e));
                let label = format!("{period} samples a period, {periods} periods, seed {seed}");
                assert_eq!(
                    found.first().map(|estimate| estimate.start),
                    Some(0),
                    "{label}"
                );
                for estimate in &found {
                    assert!(estimate.flags.is_empty(), "{label}: {}", estimate.flags);
                    honesty.add(estimate, &wave);
                }
            }
            for ratio in honesty.ratios() {
                assert!((0.65..1.45).contains(&ratio), "{period} {periods}: {ratio}");
            }
        }
    }
}

#[test]
fn the_shortest_windows_know_their_noise() {
    for period in [2.52, 2.6, 2.7] {
        let (mut honesty, mut rows, mut flagged) = (StatedRatio::default(), 0, 0);
        for seed in 0..100 {
            let (wave, flaws) = noisy(period, seed);
            let found = identify(wave, &flaws, told(2, wave.frequency, 0.0), 3000, seed);
            assert!(found.iter().all(|estimate| estimate.samples >= 6));
            rows += found.len();
            flagged += honesty.add_clean(&found, &wave);
        }
        let ratios = honesty.ratios();
        println!(
            "2 periods of {period} samples: error over stated {ratios:.3?}, {flagged} of {rows} flagged"
        );
        assert!(rows > 40_000 && flagged * 1000 < rows);
        assert!(ratios.iter().all(|ratio| (0.85..1.15).contains(ratio)));
    }
}

#[test]
fn periods_may_be_as_long_as_a_block_in_any_arithmetic() {
    for period in [2.6, 300.0, 1000.0] {
        let mut scores = [Score::default(); 3];
        let label = format!("{period} samples a period");
        for seed in 0..200 {
            let (wave, flaws) = noisy(period, seed);
            let (wave, flaws) = converted(&wave, &flaws, 16, 0.42);
            let settings = Settings {
                rails: Some([-32_768.0, 32_767.0]),
                resolution: Some(1.0),
                ..told(10, wave.frequency, 0.01)
            };
            let stream = codes(wave, &flaws, (period * 57.0) as usize, seed);
            let found = [
                identify_up_to::<f32, 1024>(&stream, settings, |code| code as f32),
                identify_up_to::<i16, 1024>(&stream, settings, |code| code as i16),
                identify_up_to::<i32, 1024>(&stream, settings, |code| code),
            ];
            for (score, found) in scores.iter_mut().zip(found) {
                add(score, &found, &wave, flaws.noise, &label);
            }
        }
        for (score, arithmetic) in scores.iter().zip(["f32", "i16", "i32"]) {
            check(score, 950, 1.12, &format!("{label}, {arithmetic}"));
        }
    }
}

#[test]
fn loud_noise_over_long_periods_is_no_misfit() {
    let period = 16_000.0;
    let (wave, mut flaws) = noisy(period, 1);
    flaws.noise = 0.8 * wave.main_amplitude;
    let settings = told(10, wave.frequency, 0.0);
    let mut core = Box::new(Identifier::<f32, 16_384, 16>::new(settings).unwrap());
    let mut rows = 0;
    for pair in Gyro::new(wave, flaws, RATE, 1).unwrap().take(6_400_000) {
        if let Some(row) = core.push(pair.map(|x| x as f32)) {
            assert!(row.flags.is_empty(), "{row:?}");
            rows += 1;
        }
    }
    assert_eq!(rows, 39);
}

#[test]
fn noise_in_which_a_search_finds_no_period_does_not_hinder() {
    let mut score = Score::default();
    let mut searched = 0;
    for seed in 0..200 {
        let (wave, mut flaws) = noisy(18.75, seed);
        flaws.noise = 0.8 * wave.main_amplitude;
        let samples = (18.75 * 50.0 * 5.1) as usize;
        searched += identify(wave, &flaws, windows(50), samples, seed).len();
        let settings = told(50, wave.frequency, 0.002);
        for estimate in identify(wave, &flaws, settings, samples, seed) {
            assert!(estimate.flags.is_empty(), "{estimate:?}");
            score.add(&estimate, &wave, flaws.noise);
        }
    }
    check(&score, 990, 1.12, "noise of 80 %");
    assert!(searched < 300, "{searched} of 1000 windows without it");
}

#[test]
fn a_wave_that_comes_back_is_tracked_without_a_search() {
    let (wave, flaws) = gyro(3);
    let settings = told(10, wave.frequency, 0.03);
    let found = identify_changed(wave, &flaws, settings, 60_000, 3, |k, pair| {
        if (20_000..30_000).contains(&k) {
            [0.0; 2]
        } else {
            pair
        }
    });
    let (before, after): (Vec<&Estimate>, Vec<&Estimate>) = found
        .iter()
        .filter(|e| e.end() <= 20_000 || e.start >= 30_000)
        .partition(|e| e.start < 20_000);
    assert!(before.len() > 100 && after.len() > 150);
    assert!(before.iter().all(|estimate| estimate.flags.is_empty()));
    // Within two windows of the first pair, if not at once: blocks of silence have no wave to begin with.
    assert!(after[0].start < 30_000 + 2 * 188, "{:?}", after[0]);
    assert!(after[0].flags.contains(Flags::REACQUIRED));
    assert!(after[1..].iter().all(|e| e.flags.is_empty()));
}

#[test]
fn presence_of_a_wave_is_known_though_nothing_is_searched() {
    let (wave, flaws) = gyro(3);
    let pairs = stream(wave, flaws.clone(), 10_000, 3);
    let mut random = Random::new(1);
    let silence: Vec<_> = pairs
        .iter()
        .map(|_| [(); 2].map(|()| 1e-3 * random.draw()))
        .collect();
    for off in [0.0, 0.3] {
        let mut core = Core::new(told(10, wave.frequency, off)).unwrap();
        let is_there = off == 0.0;
        assert!(!core.has_wave());
        for (pairs, is_told) in [(&pairs, is_there), (&silence, false), (&pairs, is_there)] {
            core.extend(pairs, |_| ());
            assert_eq!(core.has_wave(), is_told, "told {off} off");
            assert!(!core.is_searching());
        }
    }
}

#[test]
fn presence_of_a_wave_is_that_of_the_last_row() {
    let (mut there, mut lost) = (0, 0);
    for seed in 0..20 {
        let (wave, flaws) = gyro(seed);
        let mut pairs = stream(wave, flaws, 6000, seed);
        let mut random = Random::new(1);
        // Silent for one window or a little more: no search begins.
        for pair in &mut pairs[2000 + 10 * seed as usize..2280] {
            *pair = [(); 2].map(|()| 1e-3 * random.draw());
        }
        let mut core = Core::new(told(5, wave.frequency, 0.0)).unwrap();
        for pair in pairs {
            if let Some(row) = core.push(pair) {
                let is_lost = row.flags.contains(Flags::LOST);
                if is_lost || row.flags.is_empty() {
                    assert_eq!(core.has_wave(), !is_lost, "seed {seed}: {row:?}");
                    *(if is_lost { &mut lost } else { &mut there }) += 1;
                }
            }
        }
    }
    assert!(lost > 20 && there > 1000, "{lost} {there}");
}

#[test]
fn a_wave_at_another_frequency_gives_no_row() {
    for seed in 0..40 {
        let (wave, flaws) = noisy(18.75, seed);
        let pairs = stream(wave, flaws, 20_000, seed);
        for off in [-0.2, -0.15, -0.1, 0.1, 0.15, 0.2, 0.3, 0.5] {
            let found = identify_parts(&[&pairs], told(10, wave.frequency, off));
            assert!(found.is_empty(), "told {off} off: {:?}", found[0]);
        }
    }
}

#[test]
fn no_row_of_a_wave_at_another_frequency_is_clean() {
    for (periods, period, samples) in [(10, 18.75, 6000), (50, 18.75, 20_000), (10, 50.0, 16_000)] {
        let mut flagged = 0;
        for (noise, seed) in [1e-6, 0.001, 0.02].into_iter().zip(0..) {
            let (wave, mut flaws) = noisy(period, seed);
            flaws.noise = noise * wave.main_amplitude;
            let pairs = stream(wave, flaws, samples, seed);
            // From a third of the known frequency to three times it.
            for hundredths in (-67..=-20).chain(20..=200) {
                let off = 0.01 * f64::from(hundredths);
                let found = identify_parts(&[&pairs], told(periods, wave.frequency, off));
                for estimate in &found {
                    assert!(
                        !estimate.flags.is_empty(),
                        "told {off:.2} off, noise {noise}: {estimate:?}"
                    );
                }
                flagged += found.len();
            }
        }
        // Mostly there is no row at all.
        println!("{periods} periods of {period}: {flagged} flagged rows");
        assert!(flagged > 0);
    }
}

#[test]
fn a_frequency_with_a_period_longer_than_a_block_is_refused() {
    let refused = |frequency: f32| Core::new(told(10, f64::from(frequency), 0.0)).err();
    let (highest, lowest) = (RATE as f32 / 2.5, RATE as f32 / 256.4);
    assert_eq!(refused(0.9999 * highest), None);
    assert_eq!(refused(1.0001 * lowest), None);
    for frequency in [
        1.0001 * highest,
        0.999 * lowest,
        // Its period is beyond f32.
        1e-34,
        0.0,
        -1e-34,
        -5332.0,
        f32::INFINITY,
    ] {
        let error = if frequency > 0.0 && frequency < lowest {
            SettingsError::FrequencyTooLow {
                frequency,
                most: 256,
            }
        } else {
            SettingsError::Frequency(frequency)
        };
        assert_eq!(refused(frequency), Some(error));
        let text = error.to_string();
        assert!(
            text.contains(&format!("frequency {frequency} Hz")),
            "{text}"
        );
    }
    assert!(refused(f32::NAN).is_some());
    // A refused change changes nothing, and a tracker alone has no limit of the period.
    let (wave, flaws) = gyro(1);
    let mut core = Core::new(windows(10)).unwrap();
    let too_low = told(20, lowest.into(), -0.1);
    assert!(core.configure(too_low).is_err() && core.change(too_low).is_err());
    let pairs = stream(wave, flaws, 10_000, 1);
    let mut found = Vec::new();
    core.extend(&pairs, |estimate| found.push(estimate.samples));
    assert!(found.len() > 40 && found.iter().all(|&samples| samples < 200));
    assert!(Front::<f32, 40>::new(told(10, 2000.0, 0.0)).is_err());
    assert!(Front::<f32, 40>::new(told(10, 2600.0, 0.0)).is_ok());
}

#[test]
fn a_wave_near_three_times_the_known_frequency_gives_no_row() {
    for (seed, off) in (0..).zip([0.0, 5e-4, 1e-3, 2e-3]) {
        for periods in [5, 10, 50] {
            let wave = random_wave(seed, 3.0 * 5332.0 * (1.0 + off), 0.3);
            let flaws = Flaws::white(1e-3 * wave.main_amplitude);
            let found = identify(wave, &flaws, told(periods, 5332.0, 0.0), 20_000, seed);
            assert!(found.is_empty(), "{off}, {periods} periods: {:?}", found[0]);
        }
    }
}

#[test]
fn a_wave_that_sinks_below_earlier_noise_is_not_searched() {
    let wave = Wave {
        main_amplitude: 1.2,
        decay_rate: 0.6,
        ..Wave::default()
    };
    let flaws = Flaws::white(0.9);
    let settings = told(200, wave.frequency, 0.0);
    let found = identify(wave, &flaws, settings, 200_000, 3);
    assert!(found.len() > 50 && wave.at(2.0).main_amplitude < 0.4);
    for pair in found.windows(2) {
        assert_eq!(pair[0].end(), pair[1].start, "{:?}", pair[1]);
        assert!(pair[1].flags.is_empty(), "{:?}", pair[1]);
    }
    assert!(found.last().is_some_and(|last| last.end() > 195_000));
}
