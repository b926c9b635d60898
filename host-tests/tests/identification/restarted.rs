//! What begins anew keeps nothing of the samples before.

use antinode::period::{DifferenceDetector, MeanReturnDetector};
use antinode::{Detection, Front, Settings};
use antinode_sim::Flaws;
use host_tests::{Core, gyro, stream, windows};

use crate::detector::wave;

/// Samples that leave a search in any state: part of a wave, of two tones or of noise.
fn before(seed: u64) -> Vec<[f32; 2]> {
    let length = (seed as usize * 389) % 2500 + 1;
    let flaws = |noise| Flaws::white(noise);
    let (one, _) = wave(seed);
    let (other, _) = wave(seed + 7);
    match seed % 3 {
        0 => stream(one, flaws(0.02), length, seed),
        1 => {
            let tones = [one, other].map(|wave| stream(wave, flaws(0.0), length, seed));
            let [one, other] = &tones;
            let pairs = one.iter().zip(other);
            pairs.map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect()
        }
        _ => stream(one, flaws(20.0), length, seed),
    }
}

/// The wave that follows, of 4 to 200 samples a period, in some noise.
fn after(seed: u64) -> Vec<[f32; 2]> {
    let (wave, period) = wave(seed + 1000);
    let flaws = Flaws::white(0.05);
    stream(wave, flaws, (12.0 * period) as usize, seed)
}

/// Asserts that what `restart` leaves finds the waves that follow as early as a new one, and gives the same periods.
fn are_as_new<D: Default>(restart: fn(&mut D), push: fn(&mut D, [f32; 2]) -> Option<f32>) {
    let mut found = 0;
    for seed in 0..600 {
        let mut used = D::default();
        for pair in before(seed) {
            let _ = push(&mut used, pair);
        }
        restart(&mut used);
        let mut new = D::default();
        for (k, pair) in after(seed).into_iter().enumerate() {
            let wanted = push(&mut new, pair);
            assert_eq!(push(&mut used, pair), wanted, "{seed}, pair {k}");
            found += usize::from(wanted.is_some());
        }
    }
    assert!(found > 500, "{found}");
}

#[test]
fn a_detector_that_is_restarted_is_as_new() {
    are_as_new(DifferenceDetector::<f32>::restart, DifferenceDetector::push);
    are_as_new(MeanReturnDetector::restart, MeanReturnDetector::push);
}

#[test]
fn a_front_with_another_detector_is_as_new() {
    let detections = [Detection::Difference, Detection::MeanReturn];
    let with = |detection| Settings {
        detection,
        ..windows(10)
    };
    let searched = |front: &mut Front<f32, 200>, pairs: &[[f32; 2]]| {
        let searching = pairs.iter().take_while(|&&pair| {
            let _ = front.push(pair);
            front.is_searching()
        });
        searching.count()
    };
    let mut totals = [0; 2];
    for seed in 0..100 {
        let pairs = after(seed);
        for (i, total) in totals.iter_mut().enumerate() {
            let wanted = with(detections[i]);
            let mut new = Front::new(wanted).unwrap();
            let mut used = Front::new(with(detections[1 - i])).unwrap();
            let _ = used.push_slice(&before(seed));
            used.configure(wanted).unwrap();
            let count = searched(&mut new, &pairs);
            assert_eq!(searched(&mut used, &pairs), count, "{seed}");
            *total += count;
        }
    }
    // They are two detectors.
    assert_ne!(totals[0], totals[1]);
}

#[test]
fn behind_missing_samples_a_window_begins_at_once_though_a_hop_would_leave_a_gap() {
    let settings = Settings {
        hop: Some(100),
        ..windows(10)
    };
    let (wave, flaws) = gyro(3);
    // Anywhere in a window or in the gap behind it: a hundred blocks have 1875 pairs.
    for lost_at in (4000..5900).step_by(130) {
        let mut core = Core::new(settings).unwrap();
        let mut found = Vec::new();
        for (k, pair) in (0u64..).zip(stream(wave, flaws.clone(), 7000, 3)) {
            match k {
                k if k < lost_at || k >= lost_at + 40 => found.extend(core.push(pair)),
                k if k == lost_at => core.skip(40),
                _ => {}
            }
        }
        let next = found.iter().find(|estimate| estimate.start >= lost_at);
        let late = next.expect("a window").start - (lost_at + 40);
        assert!(late < 19, "lost at {lost_at}: {late} pairs late");
    }
}
