//! Errors that repeat with the wave are hardly distinguished from it: a second harmonic, a stuck bit, and the steps of a quiet converter.

use std::f64::consts::TAU;

use antinode::{Estimate, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::codes::{codes, converted, identify, settings};
use host_tests::methods::list;
use host_tests::score::{errors, stated};
use host_tests::{RATE, identify_changed, phase_error, windows};

/// The `i`-th number of a sequence that fills 0 to 1 evenly.
fn even(i: u64, step: f64) -> f64 {
    (i as f64 * step).fract()
}

/// The largest errors of a_A, a_B, θ and phase, relative to a second harmonic of 1 % of a_A, and the counts of flagged and of all windows.
fn of_second_harmonic(periods: u16, is_whole: bool, on_both: bool) -> ([f64; 4], [usize; 2]) {
    let (mut worst, mut flagged, mut rows) = ([0f64; 4], 0, 0);
    for seed in 0..120 {
        // 4.3 to 60 samples a period.
        let period = 4.3 * (60.0f64 / 4.3).powf(even(seed, 0.618_034));
        let period = if is_whole { period.round() } else { period };
        let wave = random_wave(seed, RATE / period, 0.5);
        let main = wave.main_amplitude;
        let phases = [0.754_878, 0.569_840].map(|step| TAU * even(seed, step));
        let samples = (12.0 * f64::from(periods) * period) as usize + 400;
        let found = identify_changed(
            wave,
            &Flaws::default(),
            windows(periods),
            samples,
            seed,
            |k, [c, d]| {
                let [of_c, of_d] =
                    phases.map(|phase| 0.01 * main * (2.0 * TAU * k as f64 / period - phase).cos());
                [c + of_c, if on_both { d + of_d } else { d }]
            },
        );
        for estimate in found.iter().skip(1) {
            rows += 1;
            flagged += usize::from(!estimate.flags.is_empty());
            let [a, b, angle, _] = errors(estimate, &wave);
            let truth = wave.at(estimate.time).phase;
            let phase = phase_error(f64::from(estimate.phase), truth);
            for (worst, error) in worst.iter_mut().zip([a / main, b / main, angle, phase]) {
                *worst = worst.max((error / 0.01).abs());
            }
        }
    }
    (worst, [flagged, rows])
}

#[test]
fn a_second_harmonic_leaks_as_the_documentation_states() {
    for (periods, is_whole, most) in [
        (10, false, 0.07),
        (50, false, 0.016),
        (10, true, 0.0016),
        (50, true, 0.0016),
    ] {
        let mut largest = 0f64;
        for on_both in [false, true] {
            let (worst, [flagged, rows]) = of_second_harmonic(periods, is_whole, on_both);
            println!(
                "{periods} periods, whole samples {is_whole}, both pick-offs {on_both}: a_A, a_B, angle, phase {}; {flagged} of {rows} flagged",
                list(&worst)
            );
            assert!(rows > 1000);
            // With a period of five samples it looks like the third harmonic.
            assert!(is_whole || flagged == 0, "{flagged} of {rows} flagged");
            largest = worst.into_iter().fold(largest, f64::max);
        }
        assert!(largest < most && largest > 0.9 * most, "{largest} {most}");
    }
}

/// Windows after a bit of S_C begins to stick, in a converter of 12 bits of which a_A takes 0.8 of full scale.
#[derive(Default)]
struct Behind {
    windows: f64,
    without_flag: f64,
    /// Largest errors of a_A in those without a flag: relative to a_A, and in deviations.
    largest_error: [f64; 2],
}

impl Behind {
    fn add(&mut self, estimate: &Estimate, wave: &Wave) {
        self.windows += 1.0;
        if estimate.flags.is_empty() {
            self.without_flag += 1.0;
            let error = errors(estimate, wave)[0].abs();
            let sizes = [error / wave.main_amplitude, error / stated(estimate)[0]];
            for (largest, size) in self.largest_error.iter_mut().zip(sizes) {
                *largest = largest.max(size);
            }
        }
    }
}

/// A wave in codes of 12 bits, and its stream.
type Codes = (Wave, Vec<[i32; 2]>);

/// Streams of several waves in this noise.
fn in_noise(noise: f64) -> Vec<Codes> {
    let of = |seed| {
        let wave = Wave {
            decay_rate: 0.05,
            angle_rate: 0.3,
            ..random_wave(seed, 5332.0, 0.2)
        };
        let flaws = Flaws::white(noise * wave.main_amplitude);
        let (wave, flaws) = converted(&wave, &flaws, 12, 0.8);
        (wave, codes(wave, &flaws, 60_000, seed))
    };
    (0..20).map(of).collect()
}

fn stuck(bit: u32, is_one: bool, streams: &[Codes]) -> Behind {
    let mut behind = Behind::default();
    for (wave, codes) in streams {
        let mut codes = codes.clone();
        let mask = 1 << bit;
        for [c, _] in &mut codes[30_000..] {
            *c = if is_one { *c | mask } else { *c & !mask };
        }
        for estimate in identify(&codes, settings(12, 10), |code| code as f32) {
            if estimate.start >= 30_000 {
                behind.add(&estimate, wave);
            } else if estimate.end() > 30_000 + 19 {
                assert!(!estimate.flags.is_empty(), "bit {bit}, {wave:?}");
            }
        }
    }
    behind
}

#[test]
fn a_stuck_bit_is_flagged_where_it_begins_and_later_as_the_documentation_states() {
    let streams = [0.0, 1e-3, 1e-2].map(|noise| (noise, in_noise(noise)));
    // Bits worth a twelfth, a sixth, a third and 0.6 of a_A.
    for (bit, shares, off, deviations) in [
        (7, 0.6..0.85, 0.017, 12.0),
        (8, 0.3..0.45, 0.044, 21.0),
        (9, 0.06..0.15, 0.075, 36.0),
        (10, 0.0..1e-3, 0.0, 0.0),
    ] {
        let mut largest = [0f64; 2];
        for (noise, streams) in &streams {
            for is_one in [false, true] {
                let behind = stuck(bit, is_one, streams);
                let share = behind.without_flag / behind.windows;
                println!(
                    "bit {bit} at {}, noise {noise}: {share:.2} of {} windows without a flag, a_A off by {}",
                    u8::from(is_one),
                    behind.windows,
                    list(&behind.largest_error)
                );
                assert!(
                    behind.windows > 3000.0 && shares.contains(&share),
                    "{share}"
                );
                for (largest, error) in largest.iter_mut().zip(behind.largest_error) {
                    *largest = largest.max(error);
                }
            }
        }
        for (largest, told) in largest.into_iter().zip([off, deviations]) {
            let rounded = 0.95 * told..=1.05 * told;
            assert!(
                rounded.contains(&largest),
                "bit {bit}: {largest}, {told} is told"
            );
        }
    }
}

#[test]
fn errors_of_a_steady_wave_behind_a_quiet_converter_repeat() {
    // The worst wave that a search found: its errors are the same in every window.
    let amplitude = 1.0 / 0.12;
    let wave = Wave {
        main_amplitude: amplitude,
        quadrature_amplitude: 0.040_985_616 * amplitude,
        angle: 0.545_434_34,
        phase: 0.7,
        frequency: RATE / 44.165_015_224,
        ..Wave::default()
    };
    let flaws = Flaws {
        noise: 0.054,
        offset_c: -0.049_185_05 * amplitude,
        offset_d: -0.120_051_88 * amplitude,
        ..Flaws::default()
    };
    let settings = Settings {
        resolution: Some(1.0),
        frequency: Some(wave.frequency as f32),
        ..windows(17)
    };
    let found = identify_changed(wave, &flaws, settings, 40_000, 4, |_, pair| {
        pair.map(f64::round)
    });
    assert!(found.len() > 45);
    let ratios = found.iter().map(|estimate| {
        assert!(estimate.flags.is_empty(), "{estimate:?}");
        errors(estimate, &wave)[0].abs() / stated(estimate)[0]
    });
    let ratios: Vec<f64> = ratios.collect();
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    println!("a_A off by {mean:.2} deviations");
    assert!((4.0..5.5).contains(&mean), "{mean}");
    assert!(ratios.iter().all(|ratio| (3.5..6.5).contains(ratio)));
}
