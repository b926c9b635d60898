//! A wave's first window, which has no noise of others to be compared with.

use antinode::{Flags, Settings};
use antinode_sim::{Flaws, random_wave};
use host_tests::{identify_changed, windows};

#[test]
fn a_spike_or_a_small_step_in_the_first_window_is_flagged() {
    // What is out of line is not counted to the noise that it is held against: of fifty or a hundred numbers it would hide itself.
    for (periods, spike, step, least) in [
        (20, 0.16, 0.0, 98),
        (50, 0.08, 0.0, 88),
        (20, 0.0, 0.016, 90),
    ] {
        let mut told = 0;
        for seed in 0..100 {
            let wave = random_wave(seed, 5332.0, 0.3);
            let a = wave.main_amplitude;
            let flaws = Flaws {
                noise: 0.002 * a,
                ..Flaws::default()
            };
            let settings = Settings {
                frequency: Some(5332.0),
                ..windows(periods)
            };
            let window = 19 * usize::from(periods);
            // Anywhere but in the first and the last block.
            let at = window / 5 + (0.6 * window as f64 * (0.618 * seed as f64).fract()) as usize;
            let found = identify_changed(wave, &flaws, settings, window + 30, seed, |k, [c, d]| {
                let gain = if k < at { 1.0 } else { 1.0 + step };
                [gain * c + if k == at { spike * a } else { 0.0 }, gain * d]
            });
            told += usize::from(found[0].flags.contains(Flags::MISFIT));
        }
        println!("{periods} periods, spike of {spike}, step of {step}: {told} of 100 told");
        assert!(told >= least, "{periods} periods, {spike}, {step}: {told}");
    }
}
