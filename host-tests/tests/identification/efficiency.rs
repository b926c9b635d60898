//! Accuracy in noise, from cold: rms error over the Cramér–Rao bound, and stated standard deviations over the error.

use std::ops::Range;

use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::score::{Score, StatedRatio, errors, stated};
use host_tests::{RATE, identify, windows};

/// Period of the paper's gyro, samples.
const PAPER: f64 = RATE / 5332.0;

/// Scores `runs` cold starts of `each` windows.
fn score(
    period: f64,
    periods: u16,
    noise: f64,
    runs: u64,
    each: usize,
    wave: impl Fn(u64) -> Wave,
) -> Score {
    let mut score = Score::default();
    for seed in 0..runs {
        let wave = wave(seed);
        let a = wave.main_amplitude;
        let flaws = Flaws {
            noise: noise * a,
            offset_c: 0.3 * a,
            offset_d: -0.1 * a,
            ..Flaws::default()
        };
        let samples = (period * (f64::from(periods) * (each as f64 + 0.6) + 12.0)) as usize;
        // Every row has its own noise.
        let row = 1000 * (u64::from(periods) * 1000 + (1e3 * noise) as u64);
        for estimate in identify(wave, &flaws, windows(periods), samples, seed + row)
            .iter()
            .take(each)
        {
            score.add(estimate, &wave, noise * a);
        }
    }
    score
}

/// Stated deviations over errors; seeds are fixed, so that these do not scatter from run to run.
const STATED: Range<f64> = 0.96..1.06;

#[test]
fn more_quadrature_raises_the_error_of_the_frequency_only() {
    for (share, limits) in [(0.65, 1.0..1.4), (0.75, 1.1..1.8), (0.85, 1.5..3.0)] {
        for periods in [2, 10, 50] {
            let score = score(PAPER, periods, 0.02, 500, 8, |seed| {
                let wave = random_wave(seed, 5332.0, 0.5);
                let size = share * wave.main_amplitude;
                Wave {
                    quadrature_amplitude: size.copysign(wave.quadrature_amplitude),
                    ..wave
                }
            });
            let (error, stated) = (score.error(), score.stated());
            println!(
                "a_B of {share} a_A, {periods:2} periods: rms error/bound {error:.3?}, stated/bound {stated:.3?}"
            );
            let [others @ .., frequency] = error;
            assert!(
                others.iter().all(|ratio| (0.95..1.06).contains(ratio)),
                "{share}, {periods} periods: {error:?}"
            );
            assert!(
                limits.contains(&frequency),
                "{share}, {periods} periods: {frequency}"
            );
            assert!(stated[3] > 0.94 * frequency);
        }
    }
}

#[test]
fn estimates_from_cold_reach_the_bound() {
    for (periods, runs) in [(2, 700), (4, 700), (10, 700), (50, 500)] {
        for noise in [0.001, 0.02, 0.2] {
            let score = score(PAPER, periods, noise, runs, 8, |seed| {
                random_wave(seed, 5332.0, 0.5)
            });
            score.check(
                &format!("{periods:2} periods, noise {:4.1} %", 100.0 * noise),
                0.96..1.055,
                STATED,
            );
        }
    }
}

#[test]
fn estimates_at_any_sample_rate_reach_the_bound() {
    for period in [4.3, 7.7, 43.0, 190.0] {
        for periods in [4, 10] {
            let runs = if period > 100.0 { 250 } else { 500 };
            let score = score(period, periods, 0.02, runs, 8, |seed| {
                random_wave(seed, RATE / period, 0.5)
            });
            score.check(
                &format!("{period} samples a period, {periods} periods"),
                0.955..1.06,
                STATED,
            );
        }
    }
}

#[test]
fn a_turning_decaying_drifting_wave_reaches_the_bound() {
    for (rate, tau, drift) in [
        (6.0, 0.3, 2.0),
        (-6.0, 0.3, -2.0),
        (6.0, 1e6, 0.0),
        (0.0, 0.3, 0.0),
    ] {
        let score = score(PAPER, 10, 0.002, 400, 10, |seed| Wave {
            angle_rate: rate,
            decay_rate: 1.0 / tau,
            frequency_rate: drift,
            ..random_wave(seed, 5332.0, 0.5)
        });
        score.check(
            &format!("{rate} rad/s, τ {tau} s, {drift} Hz/s"),
            0.99..1.07,
            STATED,
        );
    }
}

#[test]
fn rates_scatter_as_stated() {
    let mut squares = [0f64; 2];
    let mut count = 0.0;
    for seed in 0..400 {
        let wave = Wave {
            angle_rate: 2.0,
            decay_rate: 1.0,
            ..random_wave(seed, 5332.0, 0.5)
        };
        let flaws = Flaws::white(0.01 * wave.main_amplitude);
        for estimate in identify(wave, &flaws, windows(10), 2500, seed) {
            let truth = wave.at(estimate.time);
            let turn = f64::from(estimate.angle_rate) - truth.angle_rate;
            let decay = f64::from(estimate.decay_rate) - truth.decay_rate;
            squares[0] += (turn / f64::from(estimate.angle_rate_std)).powi(2);
            squares[1] += (decay / f64::from(estimate.decay_rate_std)).powi(2);
            count += 1.0;
        }
    }
    for square in squares {
        let ratio = (square / count).sqrt();
        assert!(
            (0.93..1.07).contains(&ratio),
            "{ratio:.3} of the stated scatter"
        );
    }
}

#[test]
fn a_window_in_which_the_pattern_turns_far_reaches_the_bound() {
    // A turn of 0.5 rad in each window, or a loss of 0.6 of the amplitude.
    for periods in [2, 10, 50] {
        let window = f64::from(periods) / 5332.0;
        for (turn, loss) in [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.9), (0.4, 0.5)] {
            let mut honesty = StatedRatio::default();
            for seed in 0..100 {
                let wave = Wave {
                    angle_rate: turn / window,
                    decay_rate: loss / window,
                    ..random_wave(seed, 5332.0, 0.3)
                };
                let flaws = Flaws::white(1e-3 * wave.main_amplitude);
                let samples = (4.5 * window * RATE) as usize + 100;
                // The first window assumes a pattern at rest.
                for estimate in identify(wave, &flaws, windows(periods), samples, seed)
                    .iter()
                    .skip(1)
                {
                    honesty.add(estimate, &wave);
                }
            }
            let ratios = honesty.ratios();
            println!("{periods} periods, turning by {turn} rad, decaying by {loss}: {ratios:.2?}");
            assert!(
                ratios.iter().all(|ratio| (0.88..1.2).contains(ratio)),
                "{periods} periods, {turn} rad, {loss}: {ratios:.2?}"
            );
        }
    }
}

#[test]
fn the_first_window_of_a_turning_wave_states_its_frequencys_deviation_rightly() {
    // With quadrature a turn looks like another frequency, and no window before tells how fast the pattern turns.
    for (quadrature, turning, most, most_of_all) in [
        (0.2, 0.5, 1.9, 8.0),
        (0.5, 0.0, 1.9, 8.0),
        (0.5, 0.5, 1.9, 8.0),
        (0.7, 0.3, 1.9, 8.0),
        (0.7, 1.0, 1.9, 8.0),
        (0.95, 5.0, 6.0, 60.0),
    ] {
        let (mut squares, mut worst) = (0.0, 0f64);
        for seed in 0..400 {
            let wave = Wave {
                quadrature_amplitude: quadrature,
                main_amplitude: 1.0,
                angle_rate: turning,
                angle: 0.01 * seed as f64,
                ..Wave::default()
            };
            let flaws = Flaws::white(2e-3);
            let first = identify(wave, &flaws, windows(10), 300, seed)[0];
            let error = (first.frequency - wave.frequency) / f64::from(first.frequency_std);
            squares += error * error;
            worst = worst.max(error.abs());
        }
        let ratio = f64::sqrt(squares / 400.0);
        println!(
            "a_B of {quadrature} a_A, {turning} rad/s, first window: error over stated {ratio:.2}, worst {worst:.1}"
        );
        // A turn that noise hides is not counted; without the correction the ratio is 2.6 in the third case.
        assert!(ratio < most && worst < most_of_all, "{ratio} {worst}");
    }
}

#[test]
fn a_long_window_in_much_noise_does_not_slip_a_turn_from_cold() {
    for periods in [100u16, 250] {
        for seed in 0..40 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let flaws = Flaws::white(0.2 * wave.main_amplitude);
            let samples = 19 * usize::from(periods) + 400;
            let first = identify(wave, &flaws, windows(periods), samples, seed)[0];
            let error = errors(&first, &wave)[3] / stated(&first)[3];
            assert!(
                first.flags.is_empty() && error.abs() < 6.0,
                "{periods} periods, seed {seed}: {error:.1}, {first:?}"
            );
        }
    }
}
