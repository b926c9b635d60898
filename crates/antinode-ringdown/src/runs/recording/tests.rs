use super::super::row::BOWS;
use super::*;

/// The recording of these windows and their flags.
fn read(windows: impl IntoIterator<Item = (Window, Flags)>, max_turn: f64) -> Runs {
    let mut recording = Recording::new("a", max_turn, Flags::REACQUIRED);
    for (window, flags) in windows {
        if flags.is_empty() {
            recording.take(&window);
        } else {
            recording.leave_out(flags, Some([window.time, window.angle]));
        }
    }
    recording.end()
}

/// Number of rows of each run.
fn lengths(recording: &Runs) -> Vec<usize> {
    recording.runs.iter().map(|run| run.rows.len()).collect()
}

#[test]
fn estimates_are_taken_or_left_out_by_their_flags() {
    let estimate = |k: u32| Estimate {
        start: 0,
        samples: 100,
        time: 0.01 * f64::from(k),
        main_amplitude: 0.5,
        quadrature_amplitude: 0.02,
        angle: 0.02 * f64::from(k),
        phase: 0.3,
        frequency: 5332.0,
        angle_rate: 2.0,
        decay_rate: 0.0,
        offsets: [0.0; 2],
        main_amplitude_std: 1e-3,
        quadrature_amplitude_std: 1e-3,
        angle_std: 1e-3,
        phase_std: 1e-3,
        frequency_std: 1e-3,
        angle_rate_std: 1e-3,
        decay_rate_std: 1.0,
        residual_rms: 1e-3,
        flags: match k {
            5 => Flags::MISFIT,
            20 => Flags::REACQUIRED,
            _ => Flags::empty(),
        },
    };
    let mut recording = Recording::new("a", 0.1, Flags::REACQUIRED);
    (0..40).for_each(|k| recording.see(&estimate(k)));
    let recording = recording.end();
    assert_eq!(lengths(&recording), [19, 19]);
    let [run, _] = &recording.runs[..] else {
        panic!("two runs")
    };
    assert_eq!((run.file.as_str(), recording.name.as_str()), ("a", "a"));
    assert!((run.turned() - 19.0 * 0.02).abs() < 1e-9 && (run.seconds() - 0.19).abs() < 1e-9);
    assert!(
        run.rows[3]
            .phase
            .is_some_and(|phase| (phase - 0.3).abs() < 1e-6)
    );
}

#[test]
fn a_wave_that_jumps_across_rows_left_out_begins_another_run() {
    // Lengths of the runs if a_A jumps by a share, or a_B or θ by this much, at a row with these flags.
    let jump = |main: f64, quadrature: f64, angle: f64, flags: Flags| {
        let windows = (0..40).map(|k| {
            let moved = f64::from(u8::from(k >= 20));
            let time = 0.01 * f64::from(k);
            let noise = 0.001 * (7.3 * f64::from(k)).sin();
            let wave = [
                0.5 * (1.0 + moved * main) * (1.0 - 0.1 * time) + noise,
                0.02 + moved * quadrature - noise,
                0.002 * f64::from(k) + moved * angle + noise,
            ];
            let flags = if k == 20 { flags } else { Flags::empty() };
            (Window::of(time, wave, 0.001), flags)
        });
        lengths(&read(windows, 0.1))
    };
    assert_eq!(jump(0.0, 0.0, 0.0, Flags::MISFIT), [39]);
    for (main, quadrature, angle) in [
        (0.06, 0.0, 0.0),
        (-0.06, 0.0, 0.0),
        (0.0, 0.03, 0.0),
        (0.0, 0.0, 0.06),
    ] {
        assert_eq!(jump(main, quadrature, angle, Flags::MISFIT), [20, 19]);
    }
    // A jump between clean rows is seen too, and its row left out; not at a circle, where amplitudes change places.
    assert_eq!(jump(0.06, 0.0, 0.0, Flags::empty()), [19, 20]);
    assert_eq!(jump(0.06, 0.0, 0.0, Flags::CIRCULAR), [39]);
}

#[test]
fn a_wave_that_jumps_across_missing_rows_begins_another_run() {
    // Reports that a line has lost, at a jump of a_A.
    let read = |missing: std::ops::Range<usize>, jump: f64| {
        let windows = (0..60).filter(|k| !missing.contains(k)).map(|k| {
            let moved = if k < 30 { 0.0 } else { jump };
            let main = (1.0 + moved) * (-1e-3 * k as f64).exp();
            let noise = 1e-5 * (7.3 * k as f64).sin();
            let wave = [main + noise, 0.02, 0.3];
            (Window::of(0.01 * k as f64, wave, 1e-5), Flags::empty())
        });
        lengths(&read(windows, 0.1))
    };
    for missing in [30..31, 29..31, 28..31, 27..33, 25..32] {
        let [before, after] = [missing.start, 60 - missing.end];
        assert_eq!(read(missing.clone(), 0.05), [before, after]);
        assert_eq!(read(missing, 0.0), [before + after]);
    }
}

#[test]
fn a_jump_is_also_seen_after_rows_with_large_deviations() {
    let read = |jump: f64| {
        let windows = (0..60).map(|k| {
            let (moved, flags) = match k {
                0..25 => (0.0, Flags::empty()),
                25 => (0.0, Flags::MISFIT),
                _ => (jump, Flags::empty()),
            };
            // A burst that goes on counts as noise.
            let std = if (26..29).contains(&k) { 5e-4 } else { 1e-5 };
            let main = 0.5 * (-1e-3 * f64::from(k)).exp() * (1.0 + moved);
            let wave = [main + std * (7.3 * f64::from(k)).sin(), 0.02, 0.3];
            (Window::of(0.01 * f64::from(k), wave, std), flags)
        });
        lengths(&read(windows, 0.1))
    };
    assert_eq!(read(0.0), [59]);
    // The rows that may belong to either side are left out.
    assert_eq!(read(0.003), [25, 31]);
}

#[test]
fn rows_that_are_kept_do_not_overlap() {
    // Windows of 1 s, by their deviations.
    let of_rate = 12f64.sqrt() * 0.001 / 0.5;
    for (step, kept_every) in [(0.101, 10), (0.1, 10), (0.31, 4), (0.95, 2), (0.99, 1)] {
        let windows = (0..400).map(|k| {
            let window = Window {
                decay_rate_std: of_rate,
                ..Window::of(step * f64::from(k), [0.5, 0.02, 0.1], 0.001)
            };
            (window, Flags::empty())
        });
        let recording = read(windows, 0.1);
        let kept = 400usize.div_ceil(kept_every);
        assert_eq!(
            (lengths(&recording), recording.overlapping),
            (vec![kept], 400 - kept),
            "{step}"
        );
    }
}

#[test]
fn a_pattern_that_turns_to_and_fro_turns_both_ways() {
    let turns = |angles: &[f64]| {
        let windows = (0..).zip(angles).map(|(k, &angle)| {
            let wave = [0.5, 0.02, angle];
            (Window::of(f64::from(k), wave, 0.001), Flags::empty())
        });
        let [back, forth] = read(windows, 1.0).runs[0].turns();
        [back, forth].map(|turn| (turn * 10.0).round() / 10.0)
    };
    let forth: Vec<f64> = (0..20).map(|k| 0.5 * f64::from(k)).collect();
    assert_eq!(turns(&forth), [0.0, 9.5]);
    let back: Vec<f64> = forth.iter().rev().copied().collect();
    assert_eq!(turns(&back), [-9.5, 0.0]);
    // Further forth after it came back half of the way.
    let both: Vec<f64> = [&forth[..], &back[1..10], &forth[10..]].concat();
    assert_eq!(turns(&both), [-4.5, 9.5]);
}

#[test]
fn rows_flagged_misfit_alone_show_the_way_of_the_pattern() {
    let bow = |flags: Flags| {
        let windows = (0..40).map(|k| {
            let begun = f64::from(k) - 14.0;
            let angle = 1e-3 * begun.clamp(0.0, 7.0).powi(2) + 0.014 * (begun - 7.0).max(0.0);
            let flags = match k {
                15..18 => Flags::MISFIT,
                18..21 => flags,
                _ => Flags::empty(),
            };
            let window = Window {
                angle_std: 0.01,
                ..Window::of(0.01 * f64::from(k), [0.5, 0.02, angle], 0.001)
            };
            (window, flags)
        });
        let recording = read(windows, 0.1);
        assert_eq!(lengths(&recording), [34]);
        let [others, next] = [14, 15].map(|index| recording.runs[0].rows[index].bow);
        assert_eq!(others, [0.0; BOWS]);
        next
    };
    let [first, ..] = bow(Flags::MISFIT);
    // −θ̈ T²/2.
    assert!((first + 0.049).abs() < 1e-3, "{first}");
    assert_eq!(bow(Flags::CIRCULAR), [0.0; BOWS]);
    assert_eq!(bow(Flags::CIRCULAR.with(Flags::MISFIT)), [0.0; BOWS]);
}
