//! Check for one signal whose samples went to both pick-offs in turn: all of S_C is stored before all of S_D, or `--raw` has wrong bits.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_8};

use antinode::Estimate;

/// One row with small deviations in this many may look like something else; fewer rows are too few for a verdict.
const ONE_IN: u32 = 16;
/// Deviations by which a row that looks like one signal may be off, at most.
const MAX_OFF: f64 = 4.0;
/// Deviations beyond which a row is left out: of the angle, rad, and of the quadrature's share of a_A, relative to the share expected.
const MAX_DEVIATIONS: [f64; 2] = [2e-3, 0.05];

/// Counts rows that look like one signal, with S_D half a sample later than S_C.
#[derive(Debug, Default)]
pub(super) struct SampledInTurn {
    /// Rows with sufficiently small deviations, and those of them that look like one signal.
    count: u32,
    alike: u32,
}

impl SampledInTurn {
    /// Takes a row of a recording of this sample rate.
    pub fn see(&mut self, row: &Estimate, rate: f64) {
        if !row.flags.is_empty() {
            return;
        }
        // Equal amplitudes give 22.5°, and half a sample between them an ellipse.
        let expected = -(FRAC_PI_2 * row.frequency / rate).tan();
        let share = row.quadrature_amplitude / row.main_amplitude;
        let share_std = row
            .quadrature_amplitude_std
            .hypot(share * row.main_amplitude_std)
            / row.main_amplitude;
        let apart = (row.angle - FRAC_PI_8) / FRAC_PI_2;
        let off = [
            (apart - apart.round()) * FRAC_PI_2 / f64::from(row.angle_std),
            (f64::from(share) - expected) / f64::from(share_std),
        ];
        let vague = [
            f64::from(row.angle_std),
            f64::from(share_std) / expected.abs(),
        ];
        if vague
            .iter()
            .zip(MAX_DEVIATIONS)
            .any(|(&vague, most)| vague > most)
        {
            return;
        }
        self.count += 1;
        self.alike += u32::from(off.iter().all(|off| off.abs() < MAX_OFF));
    }

    /// A warning if nearly all rows look like one signal.
    pub fn warning(&self) -> Option<String> {
        (self.alike > self.count - self.count / ONE_IN).then(|| {
            "both pick-offs seem to be one signal, sampled in turn: the angle is 22.5°, and S_D is half a sample late; if all of S_C is \
             stored before all of S_D, store them pair by pair, or as NPY of shape (2, N); if --raw was given, check its number of bits"
                .to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use antinode_sim::{Flaws, Gyro, Wave};

    use super::*;
    use crate::identify::Core;

    const RATE: f64 = 1e5;

    /// The warning for the rows of these pairs.
    fn warning(pairs: &[[f32; 2]]) -> Option<String> {
        let mut core = Box::new(Core::new(antinode::Settings::new(RATE)).expect("good settings"));
        let mut in_turn = SampledInTurn::default();
        core.extend(pairs, |row| in_turn.see(&row, RATE));
        in_turn.warning()
    }

    fn samples(angle: f64, quadrature: f64, frequency: f64, noise: f64) -> Vec<[f32; 2]> {
        let wave = Wave {
            main_amplitude: 0.8,
            quadrature_amplitude: quadrature,
            angle,
            frequency,
            ..Wave::default()
        };
        let gyro = Gyro::new(wave, Flaws::white(noise), RATE, 7).expect("a valid gyro");
        gyro.take(40_000)
            .map(|pair| pair.map(|x| x as f32))
            .collect()
    }

    #[test]
    fn one_signal_in_turn_raises_a_warning() {
        for (frequency, noise) in [
            (1500.0, 1e-5),
            (5332.0, 1e-6),
            (5332.0, 1e-2),
            (12_000.0, 1e-3),
        ] {
            let one = samples(0.3, 0.02, 0.5 * frequency, noise);
            let in_turn: Vec<[f32; 2]> = one
                .chunks_exact(2)
                .map(|two| [two[0][0], two[1][0]])
                .collect();
            assert!(warning(&in_turn).is_some(), "{frequency} {noise}");
            assert!(warning(&one).is_none(), "{frequency} {noise}");
        }
    }

    #[test]
    fn a_pattern_at_the_same_angle_or_quadrature_raises_no_warning() {
        let half = (FRAC_PI_2 * 5332.0 / RATE).tan();
        // The angle alone, the quadrature alone, the quadrature's other sign, and noise that hides both.
        for (angle, share, noise) in [
            (FRAC_PI_8, 0.0, 1e-3),
            (FRAC_PI_8 + 0.02, -half, 1e-3),
            (FRAC_PI_8 + 5e-4, -half, 1e-3),
            (FRAC_PI_8, half, 1e-3),
            (FRAC_PI_8, -half, 0.1),
        ] {
            let pairs = samples(angle, 0.8 * share, 5332.0, noise);
            assert!(warning(&pairs).is_none(), "{angle} {share} {noise}");
        }
        let alike = samples(FRAC_PI_8, -0.8 * half, 5332.0, 1e-3);
        assert!(warning(&alike).is_some());
        // Too few rows, or too few of them.
        assert!(warning(&alike[..1500]).is_none());
        assert!(warning(&[alike, samples(0.3, 0.02, 5332.0, 1e-3)].concat()).is_none());
    }
}
