//! Size of the smallest steps that are flagged, in the stated deviations, beyond the floors of 0.2 % of a_A, 2 mrad
//! of the angle and 20 mrad of the phase.

use std::ops::Range;

use antinode::{Estimate, Settings};
use antinode_sim::{Flaws, Wave};
use host_tests::{RATE, identify_parts, stream_part};

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

/// A wave, its stream, and its windows, none of which is flagged.
struct Still {
    wave: Wave,
    pairs: Vec<[f32; 2]>,
    found: Vec<Estimate>,
}

/// Still waves, to let each of them step; with `gap` pairs between windows.
struct Trials {
    gap: usize,
    settings: Settings,
    still: Vec<Still>,
}

impl Trials {
    fn new(gap: usize) -> Self {
        let settings = Settings {
            frequency: Some(5332.0),
            // With a hop, a window has ten blocks.
            hop: (gap > 0).then_some(((WINDOW + gap) / (WINDOW / 10)) as u16),
            ..Settings::new(RATE)
        };
        let still = (0..TRIALS).map(|seed| {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.1,
                angle: 0.3,
                phase: 0.1 * seed as f64,
                ..Wave::default()
            };
            let pairs = in_noise(wave, seed, 0..(BEFORE + 4) * (WINDOW + gap));
            let found = identify_parts(&[&pairs], settings);
            assert!(found.iter().all(|estimate| estimate.flags.is_empty()));
            assert_eq!(found[BEFORE].start as usize, BEFORE * (WINDOW + gap));
            Still { wave, pairs, found }
        });
        Self {
            gap,
            settings,
            still: still.collect(),
        }
    }

    /// Share of waves with a flag, after a step of `deviations` deviations `depth` pairs after the start of a window, or, with a gap, in the
    /// gap before it.
    fn flagged(&self, of: Of, deviations: f64, depth: usize) -> f64 {
        let at = BEFORE * (WINDOW + self.gap) + depth - self.gap / 2;
        let mut count = 0;
        for (seed, still) in (0..).zip(&self.still) {
            let step = of.step(deviations, &still.found[BEFORE]);
            let mut to = still.wave;
            match of {
                Of::Main => to.main_amplitude += step,
                Of::Quadrature => to.quadrature_amplitude += step,
                Of::Angle => to.angle += step,
                Of::Phase => to.phase += step,
            }
            let stepped = in_noise(to, seed, at..still.pairs.len());
            let found = identify_parts(&[&still.pairs[..at], &stepped], self.settings);
            let is_flagged = found.iter().any(|estimate| !estimate.flags.is_empty());
            count += usize::from(is_flagged);
        }
        count as f64 / TRIALS as f64
    }
}

/// These pairs of a wave in noise.
fn in_noise(wave: Wave, seed: u64, range: Range<usize>) -> Vec<[f32; 2]> {
    stream_part(wave, Flaws::white(0.02), range, seed)
}

#[test]
fn steps_are_flagged_from_the_stated_sizes_on() {
    let trials = Trials::new(0);
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
        let [some, most] = [half, all].map(|size| trials.flagged(of, size, depth));
        println!("{of:?} at {depth}: {some:.2} of {half} deviations, {most:.2} of {all}");
        assert!(
            (0.25..0.85).contains(&some) && most > 0.98,
            "{of:?} at {depth}"
        );
    }
}

#[test]
fn steps_in_a_gap_are_flagged_in_proportion_to_its_length() {
    for (gap, half, all) in [(WINDOW, 36.0, 54.0), (3 * WINDOW, 70.0, 105.0)] {
        let trials = Trials::new(gap);
        for of in [Of::Main, Of::Quadrature, Of::Angle] {
            let [some, most] = [half, all].map(|size| trials.flagged(of, size, 0));
            println!("{of:?} over {gap}: {some:.2} of {half} deviations, {most:.2} of {all}");
            assert!(
                (0.25..0.85).contains(&some) && most > 0.98,
                "{of:?} over {gap}"
            );
        }
    }
}
