//! Rows that no ring-down has: whatever they are, there is a result or none, and no panic.

use antinode::Flags;
use antinode_ringdown::calibration::{Calibration, PickOffs};
use antinode_ringdown::resonator::Resonance;
use antinode_ringdown::{MIN_ROWS, Recording, Row, Run, Window};
use antinode_sim::Deviates;

fn window(time: f64, deviates: &mut Deviates) -> Window {
    let mut near = |value: f64| value + 1e-4 * deviates.draw();
    Window {
        time,
        main_amplitude: near((-0.1 * time).exp()),
        quadrature_amplitude: near(0.02),
        angle: near(0.3 * time),
        phase: None,
        frequency: near(5332.0),
        main_amplitude_std: 1e-4,
        quadrature_amplitude_std: 1e-4,
        angle_std: 1e-4,
        phase_std: f64::INFINITY,
        frequency_std: 1e-4,
        decay_rate_std: f64::INFINITY,
    }
}

/// 120 windows, 0.1 s apart, some of them changed.
fn windows(change: impl Fn(usize, &mut Window)) -> Vec<Window> {
    let mut deviates = Deviates::new(1);
    let windows = (0..120).map(|k| {
        let mut window = window(0.1 * k as f64, &mut deviates);
        change(k, &mut window);
        window
    });
    windows.collect()
}

/// Whether a resonator and a calibration are found.
fn found(runs: &[Run]) -> [bool; 2] {
    [
        Resonance::of(runs).is_some(),
        Calibration::of(runs, PickOffs::IDEAL).is_ok(),
    ]
}

#[test]
fn no_rows_make_a_fit_panic() {
    type Change = fn(&mut Window, f64);
    let changes: [Change; 12] = [
        |window, to| window.time = to,
        |window, to| window.main_amplitude = to,
        |window, to| window.quadrature_amplitude = to,
        |window, to| window.angle = to,
        |window, to| window.phase = Some(to),
        |window, to| window.frequency = to,
        |window, to| window.main_amplitude_std = to,
        |window, to| window.quadrature_amplitude_std = to,
        |window, to| window.angle_std = to,
        |window, to| window.phase_std = to,
        |window, to| window.frequency_std = to,
        |window, to| window.decay_rate_std = to,
    ];
    for change in changes {
        for to in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300, 1e-300] {
            for every in [1, 50] {
                let windows = windows(|k, window| {
                    if k % every == every / 2 {
                        change(window, to);
                    }
                });
                let mut recording = Recording::new("a", 0.1, Flags::REACQUIRED);
                windows.iter().for_each(|window| recording.take(window));
                found(&recording.end().runs);
                let rows = windows.iter().map(Row::from).collect();
                let file = String::new();
                found(&[Run { rows, file }]);
            }
        }
    }
}

#[test]
fn runs_of_a_few_rows_are_ignored() {
    let rows: Vec<_> = windows(|_, _| {}).iter().map(Row::from).collect();
    let run = |rows: &[Row]| Run {
        rows: rows.to_vec(),
        file: String::new(),
    };
    let none = run(&[]);
    let few = run(&rows[..MIN_ROWS - 1]);
    assert_eq!(found(&[]), [false; 2]);
    assert_eq!(found(&[none.clone(), few.clone()]), [false; 2]);
    let runs = [none, run(&rows), few];
    assert_eq!(found(&runs), [true; 2]);
    let resonance = Resonance::of(&runs).unwrap();
    assert_eq!((resonance.runs.len(), resonance.informing()), (1, vec![0]));
    assert_eq!(resonance.rests(0).len(), rows.len());
}
