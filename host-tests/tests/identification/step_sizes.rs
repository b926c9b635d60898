//! Size of the smallest steps that are flagged, in the stated deviations, beyond the floors of 0.2 % of a_A, 2 mrad
//! of the angle and 20 mrad of the phase.

use antinode::{Estimate, Settings};
use antinode_sim::{Flaws, Wave};
use host_tests::{Core, RATE, stream};

/// Windows before the step, of blocks of 38 pairs.
const BEFORE: usize = 30;
const WINDOW: usize = 190;
const TRIALS: u64 = 60;

/// Quantity that steps: a_A, a_B, θ, or α, as samples that are lost make it do.
#[derive(Debug, Clone, Copy)]
enum Of {
    Main,
    Quadrature,
    Angle,
    Phase,
}

impl Of {
    /// Size of a step of so many deviations beyond the floor.
    fn step(self, deviations: f64, estimate: &Estimate) -> f64 {
        let (floor, std) = match self {
            Of::Main => (2e-3, estimate.main_amplitude_std),
            Of::Quadrature => (2e-3, estimate.quadrature_amplitude_std),
            Of::Angle => (2e-3, estimate.angle_std),
            Of::Phase => (0.02, estimate.phase_std),
        };
        floor + deviations * f64::from(std)
    }
}

/// Share of waves with a flag, after a step of `deviations` deviations `depth` pairs after the start of a window, or, with `gap` pairs
/// between windows, in the gap before it.
fn flagged(of: Of, deviations: f64, depth: usize, gap: usize) -> f64 {
    let interval = WINDOW + gap;
    let settings = Settings {
        frequency: Some(5332.0),
        // With a hop, a window has ten blocks.
        hop: (gap > 0).then_some((interval / (WINDOW / 10)) as u16),
        ..Settings::new(RATE)
    };
    let at = BEFORE * interval + depth - gap / 2;
    let mut count = 0;
    for seed in 0..TRIALS {
        let wave = Wave {
            main_amplitude: 1.0,
            quadrature_amplitude: 0.1,
            angle: 0.3,
            phase: 0.1 * seed as f64,
            ..Wave::default()
        };
        let flaws = Flaws {
            noise: 0.02,
            ..Flaws::default()
        };
        let identified = |to: Wave| {
            let total = (BEFORE + 4) * interval;
            let [one, two] = [wave, to].map(|wave| stream(wave, flaws.clone(), total, seed));
            let mut core = Core::new(settings).unwrap();
            let mut found: Vec<Estimate> = Vec::new();
            core.extend(&one[..at], |estimate| found.push(estimate));
            core.extend(&two[at..], |estimate| found.push(estimate));
            found
        };
        let still = identified(wave);
        assert!(still.iter().all(|estimate| estimate.flags.is_empty()));
        assert_eq!(still[BEFORE].start as usize, BEFORE * interval);
        let step = of.step(deviations, &still[BEFORE]);
        let mut to = wave;
        match of {
            Of::Main => to.main_amplitude += step,
            Of::Quadrature => to.quadrature_amplitude += step,
            Of::Angle => to.angle += step,
            Of::Phase => to.phase += step,
        }
        count += usize::from(identified(to).iter().any(|found| !found.flags.is_empty()));
    }
    count as f64 / TRIALS as f64
}

#[test]
fn steps_are_flagged_from_the_stated_sizes_on() {
    // Between two windows, in the middle of one, and near its ends: sizes at which half of them are flagged, and all.
    for (of, depth, half, all) in [
        (Of::Main, 0, 20.0, 30.0),
        (Of::Quadrature, 0, 20.0, 30.0),
        (Of::Angle, 0, 20.0, 30.0),
        (Of::Phase, 0, 20.0, 30.0),
        (Of::Main, WINDOW / 2, 25.0, 35.0),
        (Of::Quadrature, WINDOW / 2, 25.0, 35.0),
        (Of::Angle, WINDOW / 2, 60.0, 85.0),
        (Of::Phase, WINDOW / 2, 50.0, 70.0),
        (Of::Main, WINDOW / 10, 35.0, 55.0),
        (Of::Quadrature, 9 * WINDOW / 10, 35.0, 55.0),
        (Of::Angle, 9 * WINDOW / 10, 35.0, 55.0),
    ] {
        let [some, most] = [half, all].map(|size| flagged(of, size, depth, 0));
        println!("{of:?} at {depth}: {some:.2} of {half} deviations, {most:.2} of {all}");
        assert!(
            (0.25..0.85).contains(&some) && most > 0.98,
            "{of:?} at {depth}"
        );
    }
}

#[test]
fn steps_in_a_gap_are_flagged_in_proportion_to_its_length() {
    for of in [Of::Main, Of::Quadrature, Of::Angle] {
        for (gap, half, all) in [(WINDOW, 36.0, 54.0), (3 * WINDOW, 70.0, 105.0)] {
            let [some, most] = [half, all].map(|size| flagged(of, size, 0, gap));
            println!("{of:?} over {gap}: {some:.2} of {half} deviations, {most:.2} of {all}");
            assert!(
                (0.25..0.85).contains(&some) && most > 0.98,
                "{of:?} over {gap}"
            );
        }
    }
}
