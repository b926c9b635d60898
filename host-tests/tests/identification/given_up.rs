//! A wave that is hardly visible beside other signals is given up after eight windows and searched anew.

use antinode::{Front, Settings, Tracker};
use antinode_sim::{Flaws, random_wave};
use host_tests::{Core, RATE, stream, windows};

/// Windows of `periods` periods of 20 samples until a wave is given up, of which `left` remains beside a tone: the tone's amplitude and
/// frequency are given relative to the wave's former ones.
fn given_up_after(
    periods: u16,
    left: f64,
    [amplitude, times]: [f64; 2],
    seed: u64,
) -> Option<usize> {
    let period = 20;
    let wave = random_wave(seed, RATE / f64::from(period), 0.3);
    let a = wave.main_amplitude;
    let flaws = Flaws::white(1e-3 * a);
    let window = usize::from(periods) * period as usize;
    let at = 6 * window + 37;
    let mut core = Core::new(windows(periods)).unwrap();
    let pairs = stream(wave, flaws, at + 20 * window, seed);
    for (k, pair) in pairs.into_iter().enumerate() {
        let mut pair = pair.map(f64::from);
        if k >= at {
            let turns = times * k as f64 / f64::from(period);
            let phase = std::f64::consts::TAU * turns + seed as f64;
            for (s, phase) in pair.iter_mut().zip([phase, phase + 1.0]) {
                *s = left * *s + amplitude * a * phase.cos();
            }
        }
        let _ = core.push(pair.map(|s| s as f32));
        assert!(k >= at || k < 100 || !core.is_searching());
        if k >= at && core.is_searching() {
            return Some((k - at) / window);
        }
    }
    None
}

#[test]
fn a_wave_beside_a_tone_nearly_as_large_is_given_up() {
    for seed in 0..4 {
        for times in [0.9, 1.05, 1.1] {
            let after = given_up_after(50, 1.0, [0.8, times], seed);
            assert_eq!(after, Some(8), "seed {seed}, {times} times");
        }
    }
}

#[test]
fn a_wave_is_given_up_if_samples_of_all_blocks_lie_far_beyond_it_though_block_sums_do_not_show_it()
{
    for seed in 0..4 {
        for (times, amplitude, expected) in
            [(2.0, 1.2, Some(8)), (4.0, 1.5, Some(8)), (2.0, 0.9, None)]
        {
            let after = given_up_after(10, 1.0, [amplitude, times], seed);
            assert_eq!(after, expected, "seed {seed}, {times} times, {amplitude}");
        }
    }
}

#[test]
fn a_wave_of_which_less_than_a_quarter_remains_in_misfits_is_given_up() {
    // The second tone looks like noise in whole blocks, and would become a new level of it.
    for (periods, tone) in [(10, [0.15, 2.0]), (50, [0.1, 1.37])] {
        for seed in 0..4 {
            for (left, expected) in [(0.2, Some(8)), (0.3, None)] {
                let after = given_up_after(periods, left, tone, seed);
                assert_eq!(
                    after, expected,
                    "seed {seed}, {periods} periods, {left} is left"
                );
            }
        }
    }
}

#[test]
fn failures_of_a_wave_that_was_given_up_do_not_count_for_the_next_one() {
    let (period, window) = (20.0, 200);
    for seed in 0..4 {
        let wave = random_wave(seed, RATE / period, 0.3);
        let a = wave.main_amplitude;
        let settings = Settings {
            frequency: Some(wave.frequency as f32),
            ..windows(10)
        };
        let mut front = Front::<f32, 256>::new(settings).unwrap();
        let mut tracker = Tracker::<256>::new(settings).unwrap();
        let (lost, back) = (10 * window, 20 * window);
        let mut searches = Vec::new();
        let pairs = stream(wave, Flaws::white(1e-3 * a), back + 8 * window, seed);
        for (k, pair) in pairs.into_iter().enumerate() {
            let pair = if k < lost {
                pair
            } else if k < back {
                [0.0; 2]
            } else {
                // Blocks do not show a tone of twice the frequency, but samples do: each window has little of a wave beside it.
                let phase = std::f64::consts::TAU * 2.0 * k as f64 / period + seed as f64;
                let tone = |phase: f64| (1.2 * a * phase.cos()) as f32;
                [pair[0] + tone(phase), pair[1] + tone(phase + 1.0)]
            };
            if let Some(block) = front.push(pair) {
                let estimate = tracker.push(block);
                if k >= back && estimate.is_some() {
                    searches.push(tracker.wanted_search());
                }
                front.search_if_wanted(tracker.wanted_search());
            }
        }
        let before = searches[0];
        assert!(before > 0);
        let mut expected = [before; 8];
        expected[7] += 1;
        assert_eq!(searches, expected, "seed {seed}");
    }
}
