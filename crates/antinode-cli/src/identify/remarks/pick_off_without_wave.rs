//! Check for a pick-off that never shows the wave: rows then look like a pattern on the other's axis.

use antinode::Estimate;

/// Clean rows needed for a verdict.
const MIN_ROWS: u32 = 16;
/// Rms of a pick-off's wave, as a share of the other's, below which it has none: no pattern stands that exactly on an axis by chance.
const MAX_SHARE: f64 = 1e-3;

/// The wave that clean rows show on each pick-off.
#[derive(Debug, Default)]
pub(super) struct PickOffWithoutWave {
    rows: u32,
    /// Σ of the squared amplitudes of S_C and of S_D, less what noise adds.
    powers: [f64; 2],
    /// Σ of the variances that these squares have in noise alone.
    chance: f64,
}

impl PickOffWithoutWave {
    /// Takes a row.
    pub fn see(&mut self, row: &Estimate) {
        if !row.flags.is_empty() {
            return;
        }
        let (sine, cosine) = (2.0 * row.angle).sin_cos();
        let (a, b) = (
            f64::from(row.main_amplitude),
            f64::from(row.quadrature_amplitude),
        );
        // Both parts of a phasor carry noise.
        let noise = f64::from(row.main_amplitude_std).powi(2)
            + f64::from(row.quadrature_amplitude_std).powi(2);
        self.rows += 1;
        self.powers[0] += (a * cosine).powi(2) + (b * sine).powi(2) - noise;
        self.powers[1] += (a * sine).powi(2) + (b * cosine).powi(2) - noise;
        self.chance += noise * noise;
    }

    /// A warning that names a pick-off without a wave.
    pub fn warning(&self) -> Option<String> {
        let [c, d] = self.powers;
        let (less, more, who) = if c < d { (c, d, "S_C") } else { (d, c, "S_D") };
        let least = MAX_SHARE * MAX_SHARE * more;
        // Noise must be low enough for so small a wave to be seen.
        let is_told = self.rows >= MIN_ROWS && less < least && 3.0 * self.chance.sqrt() < least;
        is_told.then(|| {
            format!(
                "{who} shows no wave in any row: unless the pattern stands on the other pick-off's axis, rows show one signal; check the wiring, \
                 and which channels were recorded"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use antinode::Flags;

    use super::super::row_scatter::tests::row;
    use super::*;
    use antinode_sim::Deviates;

    /// The warning for this many rows of a pattern at this angle, rad, with these amplitudes and their deviation.
    fn warning(
        rows: u64,
        angle: f64,
        [main, quadrature]: [f64; 2],
        deviation: f64,
    ) -> Option<String> {
        let (mut without_wave, mut deviates) = (PickOffWithoutWave::default(), Deviates::new(1));
        for index in 0..rows {
            let mut near = |value: f64, by: f64| value + by * deviates.draw();
            without_wave.see(&Estimate {
                main_amplitude: near(main, deviation) as f32,
                quadrature_amplitude: near(quadrature, deviation) as f32,
                angle: near(angle, 0.5 * deviation / main),
                main_amplitude_std: deviation as f32,
                quadrature_amplitude_std: deviation as f32,
                angle_std: (0.5 * deviation / main) as f32,
                ..row(index, 0.0, &mut Deviates::new(0))
            });
        }
        without_wave.warning()
    }

    #[test]
    fn the_pick_off_without_a_wave_is_named() {
        use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
        for (angle, who) in [(0.0, "S_D"), (FRAC_PI_2, "S_D"), (FRAC_PI_4, "S_C")] {
            let warning = warning(1000, angle, [0.5, 0.0], 1e-3).expect("one has no wave");
            assert!(
                warning.starts_with(&format!("{who} shows no wave")),
                "{warning}"
            );
        }
    }

    #[test]
    fn a_wave_on_both_raises_no_warning() {
        assert_eq!(warning(1000, 1e-3, [0.5, 0.0], 1e-3), None);
        assert_eq!(warning(1000, 0.0, [0.5, 1e-3], 1e-3), None);
        assert_eq!(warning(1000, 0.4, [0.5, 0.3], 1e-3), None);
        // Too few rows, or too much noise.
        assert_eq!(warning(15, 0.0, [0.5, 0.0], 1e-6), None);
        for deviation in [3e-3, 4e-3, 6e-3, 1e-2, 3e-2] {
            assert_eq!(warning(1000, 0.0, [0.5, 0.0], deviation), None);
        }
    }

    #[test]
    fn rows_of_a_lost_wave_say_nothing() {
        let mut without_wave = PickOffWithoutWave::default();
        for index in 0..40 {
            let is_lost = index < 20;
            without_wave.see(&Estimate {
                flags: if is_lost { Flags::LOST } else { Flags::empty() },
                main_amplitude: if is_lost { f32::NAN } else { 0.5 },
                quadrature_amplitude: 0.0,
                angle: 0.0,
                ..row(index, 0.0, &mut Deviates::new(0))
            });
        }
        assert!(without_wave.warning().is_some());
    }
}
