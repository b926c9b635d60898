//! A front and a tracker apart, with a queue between them, as firmware has them.

use std::collections::VecDeque;

use antinode::{Flags, Front, Settings, Tracker};
use antinode_sim::{Flaws, random_wave};
use host_tests::{RATE, stream, windows};

#[test]
fn settings_changed_in_the_documented_order_show_in_no_block_of_the_old_ones() {
    let wave = random_wave(3, 5332.0, 0.4);
    let flaws = Flaws::white(0.01 * wave.main_amplitude);
    let pairs = stream(wave, flaws, 128 * 200, 3);
    let mut settings = windows(10);
    let mut front = Front::<f32, 200>::new(settings).unwrap();
    let mut tracker = Tracker::<40>::new(settings).unwrap();
    let (mut blocks, mut changes, mut wanted) = (VecDeque::new(), VecDeque::new(), 0);
    let mut estimates = Vec::new();
    for (half, pairs) in pairs.chunks(128).enumerate() {
        let phase = half % 50;
        if phase == 25 {
            settings.periods += 5;
            tracker.change(settings).unwrap();
            tracker.search();
            changes.push_back(settings);
        }
        // The interrupt: at a change it comes between sending and storing.
        while let Some(settings) = changes.pop_front() {
            front.configure(settings).unwrap();
        }
        front.search_if_wanted(wanted);
        front.extend(pairs, |block| blocks.push_back(*block));
        if phase == 25 {
            wanted = tracker.wanted_search();
        } else if !(22..25).contains(&phase) {
            // Before a change the main loop is behind.
            while let Some(block) = blocks.pop_front() {
                estimates.extend(tracker.push(&block));
                wanted = tracker.wanted_search();
            }
        }
    }
    let mut reacquired = 0;
    for pair in estimates.windows(2) {
        let [before, now] = pair else { unreachable!() };
        let is_first = now.flags == Flags::REACQUIRED;
        reacquired += u32::from(is_first);
        assert!(is_first || now.flags.is_empty(), "{}", now.flags);
        assert!(is_first || now.samples.abs_diff(before.samples) < 5);
        let off = (now.frequency - wave.frequency).abs();
        assert!(off < 6.0 * f64::from(now.frequency_std), "{off}");
        assert!((now.angle - before.angle).abs() < 0.1);
    }
    assert_eq!(reacquired, 4);
}

#[test]
fn a_half_buffer_ends_as_many_blocks_as_documented() {
    for (periods, hop, most) in [
        (10, None, 4),
        (4, None, 9),
        (2, None, 22),
        (10, Some(1), 7),
        (4, Some(1), 16),
        (2, Some(1), 32),
    ] {
        let settings = Settings {
            hop,
            frequency: Some((RATE / 18.75) as f32),
            ..windows(periods)
        };
        let mut front = Front::<i16, 200>::new(settings).unwrap();
        let counts = (0..200).map(|half| {
            let mut count = 0;
            front.extend(&[[half, -half]; 128], |_| count += 1);
            count
        });
        assert_eq!(counts.max(), Some(most), "{periods} periods, {hop:?}");
    }
}
