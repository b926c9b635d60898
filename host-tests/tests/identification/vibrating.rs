//! Patterns that vibrate: the deviation of their frequency allows for a rate that no window shows.

use std::f64::consts::TAU;

use antinode_sim::Wave;
use host_tests::{RATE, identify_changed, windows};

use crate::turning::{noisy, turning};

/// The angle of a vibration of this frequency, Hz, that turns by up to `rate` rad/s.
fn vibrated(rate: f64, frequency: f64, seed: u64, k: usize) -> f64 {
    let phase = TAU * frequency * k as f64 / RATE + seed as f64;
    rate / (TAU * frequency) * phase.sin()
}

/// What a further turn by `angle` adds to sample `k`.
fn turned(wave: &Wave, angle: f64, k: usize) -> [f64; 2] {
    let angle = wave.angle + angle;
    let [now, still] = [Wave { angle, ..*wave }, *wave].map(|wave| wave.pick_offs(k as f64 / RATE));
    [now[0] - still[0], now[1] - still[1]]
}

#[test]
fn the_frequency_of_a_vibrating_pattern_has_a_deviation_that_allows_for_its_unknown_rate() {
    // Periods a window, a_B in a_A, largest rate in rad/s, and frequency of the vibration in Hz.
    for (periods, share, rate, vibration) in [
        (10, 0.3, 5.0, 20.0),
        (10, 0.6, 1.0, 50.0),
        (10, 0.8, 5.0, 20.0),
        (20, 0.3, 0.3, 20.0),
        (20, 0.6, 0.3, 20.0),
        (20, 0.6, 5.0, 5.0),
        (20, 0.8, 1.0, 20.0),
    ] {
        let (mut squares, mut rows, mut worst) = (0.0, 0.0, 0f64);
        for seed in 0..6 {
            let wave = turning(seed, 5332.0, share, 0.0);
            let settings = windows(periods);
            let samples = 300 * 19 * usize::from(periods);
            let flaws = noisy(&wave, 1e-3);
            let found = identify_changed(wave, &flaws, settings, samples, seed, |k, [c, d]| {
                // A fault is no vibration, and does not hide one after it.
                let fault = if k == 100_003 { f64::NAN } else { 0.0 };
                let [more_c, more_d] = turned(&wave, vibrated(rate, vibration, seed, k), k);
                [c + more_c + fault, d + more_d]
            });
            // Until the vibration is detected.
            for estimate in found.iter().skip(30).filter(|e| e.flags.is_empty()) {
                let error =
                    (estimate.frequency - wave.frequency) / f64::from(estimate.frequency_std);
                squares += error * error;
                rows += 1.0;
                worst = worst.max(error.abs());
            }
        }
        let rms = f64::sqrt(squares / rows);
        println!(
            "{periods} periods, a_B of {share} a_A, {rate} rad/s at {vibration} Hz: error of f over stated {rms:.2}, {worst:.1} at the most"
        );
        assert!(
            rows > 1500.0 && (0.8..1.2).contains(&rms) && worst < 7.0,
            "{rows} {rms} {worst}"
        );
    }
}

#[test]
fn the_third_window_behind_a_fault_allows_for_a_vibration_too() {
    // A line through three angles is off by more than a parabola through five.
    let window = 19 * 10;
    let samples = 300 * window;
    let faults = (100..samples).step_by(8 * window);
    let (mut squares, mut rows) = (0.0, 0.0);
    for seed in 0..12 {
        let wave = turning(seed, 5332.0, 0.8, 0.0);
        let flaws = noisy(&wave, 1e-3);
        let found = identify_changed(wave, &flaws, windows(10), samples, seed, |k, [c, d]| {
            let fault = if k % (8 * window) == 100 {
                f64::NAN
            } else {
                0.0
            };
            let [more_c, more_d] = turned(&wave, vibrated(5.0, 20.0, seed, k), k);
            [c + more_c + fault, d + more_d]
        });
        // Until the vibration is detected.
        for fault in faults.clone().skip(4) {
            let mut behind = found.iter().filter(|e| e.start > fault as u64);
            let third = behind.nth(2).expect("a window");
            assert!(third.flags.is_empty(), "seed {seed}: {}", third.flags);
            let error = (third.frequency - wave.frequency) / f64::from(third.frequency_std);
            squares += error * error;
            rows += 1.0;
        }
    }
    let rms = f64::sqrt(squares / rows);
    println!("third windows behind a fault: error of f over stated {rms:.2} of {rows}");
    assert!(rows > 400.0 && (0.8..1.2).contains(&rms), "{rms}");
}

#[test]
fn a_step_of_the_angle_is_not_taken_for_a_vibration() {
    // Steps in rad; later rows know their frequency as well as before, or nearly so if nothing flags the step.
    for (step, most) in [(0.002, 1.8), (0.05, 1.15), (0.3, 1.15)] {
        for periods in [10, 50] {
            let (mut sum, mut rows) = (0.0, 0.0);
            for seed in 0..6 {
                let wave = turning(seed, 5332.0, 0.8, 0.0);
                let window = 19 * usize::from(periods);
                let at = 60 * window + 7;
                let flaws = noisy(&wave, 1e-3);
                let settings = windows(periods);
                let found =
                    identify_changed(wave, &flaws, settings, 100 * window, seed, |k, [c, d]| {
                        let angle = if k < at { 0.0 } else { step };
                        let [more_c, more_d] = turned(&wave, angle, k);
                        [c + more_c, d + more_d]
                    });
                let deviations = |from: usize, to: usize| -> f64 {
                    let rows = found.iter().skip(from).take(to - from);
                    rows.map(|e| f64::from(e.frequency_std)).sum::<f64>() / (to - from) as f64
                };
                sum += deviations(68, 85) / deviations(20, 55);
                rows += 1.0;
            }
            let wider = sum / rows;
            println!(
                "{step} rad, {periods} periods: deviations of f behind it {wider:.2} times those before"
            );
            assert!(wider < most, "{step}, {periods} periods: {wider}");
        }
    }
}
