//! First windows with only a part of the wave, at a known frequency: no search has shown that the wave is there.

use antinode::Settings;
use antinode_sim::{Flaws, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{RATE, identify_changed, windows};

/// Of 400 first windows in which a wave of known frequency begins, or else ends: how many have no flag, and of these how many are wrong.
fn of_parts(base: Settings, begins: bool) -> [usize; 2] {
    let (mut clean, mut wrong) = (0, 0);
    for seed in 0..400u64 {
        let period = 5.0 + 0.137 * seed as f64;
        let wave = random_wave(seed, RATE / period, 0.5);
        let flaws = Flaws::white(0.002 * wave.main_amplitude);
        let settings = Settings {
            frequency: Some((RATE / period) as f32),
            ..base
        };
        let length = period * f64::from(settings.periods);
        let part = 0.15 + 0.45 * (0.618 * seed as f64).fract();
        let at = (length * if begins { part } else { 1.0 - part }) as usize;
        let samples = (1.1 * length) as usize + 2;
        let found = identify_changed(wave, &flaws, settings, samples, seed, |k, pair| {
            pair.map(|value| if begins == (k < at) { 0.0 } else { value })
        });
        for estimate in found.iter().filter(|e| e.flags.is_empty()) {
            clean += 1;
            wrong += usize::from(errors(estimate, &wave)[0].abs() > 5.0 * stated(estimate)[0]);
        }
    }
    [clean, wrong]
}

#[test]
fn a_first_window_with_a_part_of_the_wave_is_flagged_or_within_its_deviations() {
    for (name, watch, coloured) in [
        ("watched", true, false),
        ("unwatched", false, false),
        ("coloured", true, true),
    ] {
        for (periods, begins) in [2, 5, 10].into_iter().flat_map(|n| [(n, true), (n, false)]) {
            let base = Settings {
                watch,
                coloured,
                ..windows(periods)
            };
            let [clean, wrong] = of_parts(base, begins);
            println!(
                "{name}, {periods} periods, begins: {begins}: {clean} of 400 without a flag, {wrong} wrong"
            );
            assert!(wrong < 4, "{name}, {periods} periods: {wrong}");
            // In longer windows hardly any part is as good as a wave.
            assert!(clean > 20 || periods > 2, "{name}: {clean}");
        }
    }
}
