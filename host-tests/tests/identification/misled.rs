//! A search misled by what came before the wave: its blocks are too short or too long, until the wave itself shows its period.

use antinode::{Estimate, Flags, Front, Identifier, Settings, Tracker};
use antinode_sim::{Flaws, Gyro, Wave};
use host_tests::random::Random;
use host_tests::{RATE, identify, identify_changed, windows};

/// A wave of `period` samples.
fn wave_of(period: f64) -> Wave {
    Wave {
        frequency: RATE / period,
        angle: 0.3,
        ..Wave::default()
    }
}

/// What is found in `samples` pairs of a wave of 50 samples a period, of which those from `at` on are random for up to 40 pairs; `before`
/// says what each pair before these is.
fn disturbed(
    seed: u32,
    samples: usize,
    at: usize,
    before: impl Fn(usize, [f64; 2]) -> [f64; 2],
) -> Vec<Estimate> {
    let mut random = Random::new(seed);
    let mut draw = || 3.0 * f64::from(random.draw());
    let disturbed: Vec<[f64; 2]> = (0..5 * (1 + seed % 8)).map(|_| [draw(), draw()]).collect();
    let (wave, noise) = (wave_of(50.0), Flaws::white(1e-3));
    identify_changed(
        wave,
        &noise,
        windows(10),
        samples,
        seed.into(),
        |k, pair| match k.checked_sub(at) {
            Some(behind) => disturbed.get(behind).copied().unwrap_or(pair),
            None => before(k, pair),
        },
    )
}

/// Whether the blocks of a window do not match the period.
fn is_off(estimate: &Estimate) -> bool {
    estimate.samples.abs_diff(500) > 10
}

#[test]
fn blocks_match_the_period_in_spite_of_a_disturbed_start() {
    let mut misled = 0;
    for seed in 0..100 {
        let found = disturbed(seed, 5_000, 0, |_, pair| pair);
        let off = found.iter().take_while(|e| is_off(e)).count();
        misled += off;
        // One window shows it, and the next one is flagged as all are after a search.
        assert!(off <= 1 && !found[off..].iter().any(is_off), "seed {seed}");
        for (i, estimate) in found.iter().enumerate() {
            let is_anew = off > 0 && i == off;
            let flags = if is_anew {
                Flags::REACQUIRED
            } else {
                Flags::empty()
            };
            assert_eq!(estimate.flags, flags, "seed {seed}");
        }
    }
    assert!(misled >= 10, "{misled}");
}

#[test]
fn blocks_match_the_period_again_if_a_lost_wave_comes_back_with_a_disturbed_start() {
    let (lost, back) = (5_000, 12_000);
    let mut misled = 0;
    for seed in 0..100 {
        let silent = |k, pair| if k < lost { pair } else { [0.0; 2] };
        let found = disturbed(seed, 20_000, back, silent);
        let behind = found.iter().filter(|e| e.start >= back as u64);
        let off = behind.filter(|e| is_off(e)).count();
        assert!(off <= 1, "seed {seed}: {off}");
        misled += off;
    }
    assert!(misled >= 10, "{misled}");
}

#[test]
fn blocks_that_never_match_are_searched_for_once() {
    let gyro = Gyro::new(wave_of(50.0), Flaws::white(1e-3), RATE, 1).unwrap();
    // A front that is told a period of 52 samples begins so again and again.
    let told = Settings {
        frequency: Some((RATE / 52.0) as f32),
        ..windows(10)
    };
    let mut front = Front::<f32, 200>::new(told).unwrap();
    let mut tracker = Tracker::<16>::new(windows(10)).unwrap();
    let (mut windows, mut searches) = (0, 0);
    for pair in gyro.take(20_000) {
        searches += u32::from(front.search_if_wanted(tracker.wanted_search()));
        if let Some(block) = front.push(pair.map(|x| x as f32)) {
            windows += u32::from(tracker.push(block).is_some());
        }
    }
    assert_eq!(searches, 1);
    assert!(windows > 35, "{windows}");
}

#[test]
fn blocks_as_long_as_a_front_has_room_for_are_not_searched_for_anew() {
    let gyro = Gyro::new(wave_of(38.0), Flaws::white(0.05), RATE, 1).unwrap();
    let mut core = Identifier::<f32, 40, 32>::new(windows(10)).unwrap();
    let found: Vec<_> = gyro
        .take(20_000)
        .filter_map(|pair| core.push(pair.map(|x| x as f32)))
        .collect();
    assert!(found.len() > 45, "{}", found.len());
    assert!(found.iter().all(|e| e.flags.is_empty()));
}

#[test]
fn noise_alone_makes_no_second_search() {
    for seed in 0..200 {
        let found = identify(wave_of(18.75), &Flaws::white(0.2), windows(2), 400, seed);
        let again = found.iter().filter(|e| e.flags.contains(Flags::REACQUIRED));
        assert_eq!(again.count(), 0, "seed {seed}");
    }
}
