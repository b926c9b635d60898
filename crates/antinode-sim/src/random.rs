//! Random waves.

use crate::noise::{Stream, Uniform};
use crate::wave::Wave;
use std::f64::consts::{FRAC_PI_2, PI};

/// A random constant wave, the same for the same arguments.
///
/// a_A is uniform in 0.5 to 2, a_B in -`max_ratio` a_A to `max_ratio` a_A (`max_ratio`: 0 to 1), theta in 0 to pi/2, alpha
/// in -pi to pi. `frequency` is in Hz, and rates and splits are 0.
pub fn random_wave(seed: u64, frequency: f64, max_ratio: f64) -> Wave {
    let mut uniform = Uniform::new(seed, Stream::Wave);
    let main_amplitude = uniform.between(0.5, 2.0);
    Wave {
        main_amplitude,
        quadrature_amplitude: main_amplitude * uniform.between(-max_ratio, max_ratio),
        angle: uniform.between(0.0, FRAC_PI_2),
        phase: uniform.between(-PI, PI),
        frequency,
        ..Wave::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_waves_fill_their_ranges() {
        let waves: Vec<Wave> = (0..2000)
            .map(|seed| random_wave(seed, 5332.0, 0.3))
            .collect();
        assert_eq!(waves[7], random_wave(7, 5332.0, 0.3));
        let range = |get: fn(&Wave) -> f64| {
            let values = waves.iter().map(get);
            values.fold((f64::MAX, f64::MIN), |(low, high), x| {
                (low.min(x), high.max(x))
            })
        };
        let filled = |(low, high): (f64, f64), from: f64, to: f64| {
            let slack = 0.01 * (to - from);
            low >= from && high <= to && low < from + slack && high > to - slack
        };
        assert!(filled(range(|w| w.main_amplitude), 0.5, 2.0));
        assert!(filled(
            range(|w| w.quadrature_amplitude / w.main_amplitude),
            -0.3,
            0.3
        ));
        assert!(filled(range(|w| w.angle), 0.0, FRAC_PI_2));
        assert!(filled(range(|w| w.phase), -PI, PI));
        assert!(
            waves
                .iter()
                .all(|w| w.check().is_ok() && w.frequency == 5332.0)
        );
    }
}
