//! Size of the smallest steps that are flagged, in the stated deviations, beyond the floors of 0.2 % of a_A and 2 mrad.

use antinode::{Estimate, Settings};
use antinode_sim::{Flaws, Wave};
use host_tests::score::stated;
use host_tests::{Core, RATE, stream};

/// Windows before the step, of blocks of 38 pairs.
const BEFORE: usize = 30;
const WINDOW: usize = 190;
const TRIALS: u64 = 60;

/// Quantity that steps: a_A, a_B or θ, by the index of its deviation.
#[derive(Debug, Clone, Copy)]
enum Of {
    Main,
    Quadrature,
    Angle,
}

/// Share of waves with a flag, after a step of `deviations` deviations `depth` pairs after the start of a window.
fn flagged(of: Of, deviations: f64, depth: usize) -> f64 {
    let settings = Settings {
        frequency: Some(5332.0),
        ..Settings::new(RATE)
    };
    let at = BEFORE * WINDOW + depth;
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
            let total = (BEFORE + 4) * WINDOW;
            let [one, two] = [wave, to].map(|wave| stream(wave, flaws.clone(), total, seed));
            let mut core = Core::new(settings).unwrap();
            let mut found: Vec<Estimate> = Vec::new();
            core.extend(&one[..at], |estimate| found.push(estimate));
            core.extend(&two[at..], |estimate| found.push(estimate));
            found
        };
        let still = identified(wave);
        assert!(still.iter().all(|estimate| estimate.flags.is_empty()));
        assert_eq!(still[BEFORE].start as usize, BEFORE * WINDOW);
        let step = 2e-3 + deviations * stated(&still[BEFORE])[of as usize];
        let mut to = wave;
        match of {
            Of::Main => to.main_amplitude += step,
            Of::Quadrature => to.quadrature_amplitude += step,
            Of::Angle => to.angle += step,
        }
        count += usize::from(identified(to).iter().any(|found| !found.flags.is_empty()));
    }
    count as f64 / TRIALS as f64
}

#[test]
fn steps_are_flagged_from_the_stated_sizes_on() {
    // Between two windows, and in the middle of one: sizes at which half of them are flagged, and all.
    for (of, depth, half, all) in [
        (Of::Main, 0, 20.0, 30.0),
        (Of::Quadrature, 0, 20.0, 30.0),
        (Of::Angle, 0, 20.0, 30.0),
        (Of::Main, WINDOW / 2, 25.0, 35.0),
        (Of::Quadrature, WINDOW / 2, 25.0, 35.0),
        (Of::Angle, WINDOW / 2, 60.0, 85.0),
    ] {
        let [some, most] = [half, all].map(|size| flagged(of, size, depth));
        println!("{of:?} at {depth}: {some:.2} of {half} deviations, {most:.2} of {all}");
        assert!(
            (0.25..0.85).contains(&some) && most > 0.98,
            "{of:?} at {depth}"
        );
    }
}
