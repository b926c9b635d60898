//! The values of a row that fits use.

use std::f64::consts::TAU;

use antinode::Estimate;

use super::turn;

/// Curves that make up an unsteady turn.
pub const BOWS: usize = 3;

/// What is known of a window's wave: the columns of `antinode identify` that fits use, or the fields of an [`Estimate`].
///
/// Amplitudes are in the samples' unit; deviations are standard deviations, above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Time of the window's middle, s.
    pub time: f64,
    /// a_A, above 0.
    pub main_amplitude: f64,
    /// a_B, at most a_A in size.
    pub quadrature_amplitude: f64,
    /// θ_A, rad; it may be reduced modulo π/2.
    pub angle: f64,
    /// Phase of the main wave at this time, rad, if it is known.
    pub phase: Option<f64>,
    /// Frequency, Hz.
    pub frequency: f64,
    /// One standard deviation of a_A.
    pub main_amplitude_std: f64,
    /// The same of a_B.
    pub quadrature_amplitude_std: f64,
    /// The same of θ_A, rad.
    pub angle_std: f64,
    /// The same of the phase, rad; infinite if it is not known.
    pub phase_std: f64,
    /// The same of the frequency, Hz; infinite if it is not known.
    pub frequency_std: f64,
    /// The same of the decay rate, 1/s; infinite if it is not known.
    pub decay_rate_std: f64,
}

impl From<&Estimate> for Window {
    fn from(estimate: &Estimate) -> Self {
        Self {
            time: estimate.time,
            main_amplitude: estimate.main_amplitude.into(),
            quadrature_amplitude: estimate.quadrature_amplitude.into(),
            angle: estimate.angle,
            phase: Some(estimate.phase.into()),
            frequency: estimate.frequency,
            main_amplitude_std: estimate.main_amplitude_std.into(),
            quadrature_amplitude_std: estimate.quadrature_amplitude_std.into(),
            angle_std: estimate.angle_std.into(),
            phase_std: estimate.phase_std.into(),
            frequency_std: estimate.frequency_std.into(),
            decay_rate_std: estimate.decay_rate_std.into(),
        }
    }
}

/// A clean window as fits take it, its amplitudes free of the bias of noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Time of the window's middle, s.
    pub time: f64,
    /// a_A and a_B, in the samples' unit.
    pub(crate) main: f64,
    pub(crate) quadrature: f64,
    /// θ_A, rad.
    pub angle: f64,
    /// Phase of the main wave, rad, if the rows have it.
    pub(crate) phase: Option<f64>,
    /// One standard deviation of it at this time; infinite if the rows lack it.
    pub(crate) phase_deviation: f64,
    /// Frequency, Hz, and one standard deviation of it; infinite if the rows lack it.
    pub(crate) frequency: f64,
    pub(crate) frequency_deviation: f64,
    /// One standard deviation each of a_A, a_B and θ_A.
    pub(crate) deviations: [f64; 3],
    /// Length of the window, s, from the deviations of an amplitude and of its rate; 0 if the rows lack the latter.
    pub(crate) seconds: f64,
    /// Departure of the pattern from a steady turn since the row before, rad, as coefficients of the curves of [`Row::curves`]; 0 if it is
    /// taken to turn steadily.
    pub(crate) bow: [f64; BOWS],
}

impl From<&Window> for Row {
    fn from(window: &Window) -> Self {
        let Window {
            time,
            main_amplitude: main,
            quadrature_amplitude: quadrature,
            main_amplitude_std: of_main,
            ..
        } = *window;
        // The phase belongs to the time before rounding: doubles as large as a date, in s since 1970, are 0.2 µs apart.
        let apart = time.abs().next_up() - time.abs();
        let rounded = TAU * window.frequency * apart / 12f64.sqrt();
        let [more, less] =
            [1.0, -1.0].map(|sign| increase_by_noise(main + sign * quadrature, of_main));
        Self {
            time,
            main: main - 0.5 * (more + less),
            quadrature: quadrature - 0.5 * (more - less),
            angle: window.angle,
            phase: window.phase,
            phase_deviation: window.phase_std.hypot(rounded),
            frequency: window.frequency,
            frequency_deviation: window.frequency_std,
            deviations: [of_main, window.quadrature_amplitude_std, window.angle_std],
            // For a straight line through evenly spread samples, this is the ratio of the deviations of middle and slope.
            seconds: 12f64.sqrt() * of_main / main / window.decay_rate_std,
            bow: [0.0; BOWS],
        }
    }
}

/// Mean increase of a travelling wave's amplitude by noise, which lengthens any vector: its components have twice the variance
/// of a_A. The increase is a small part of a deviation, but the same in all rows.
fn increase_by_noise(travelling: f64, of_main: f64) -> f64 {
    let variance = 2.0 * of_main * of_main;
    // Nearer to zero the row is circular, and the series does not hold.
    if travelling.powi(2) > 16.0 * variance {
        0.5 * variance / travelling
    } else {
        0.0
    }
}

#[cfg(test)]
impl Window {
    /// A window at a time, s, with these a_A, a_B and θ and one deviation of all.
    pub fn of(time: f64, [main, quadrature, angle]: [f64; 3], std: f64) -> Self {
        Self {
            time,
            main_amplitude: main,
            quadrature_amplitude: quadrature,
            angle,
            phase: None,
            frequency: 5332.0,
            main_amplitude_std: std,
            quadrature_amplitude_std: std,
            angle_std: std,
            phase_std: f64::INFINITY,
            frequency_std: f64::INFINITY,
            decay_rate_std: f64::INFINITY,
        }
    }
}

#[cfg(test)]
impl Row {
    /// A row with these a_A, a_B and θ and their deviations; its other values do not matter.
    pub fn of(time: f64, [main, quadrature, angle]: [f64; 3], deviations: [f64; 3]) -> Self {
        Self {
            time,
            main,
            quadrature,
            angle,
            phase: None,
            phase_deviation: f64::INFINITY,
            frequency: 5332.0,
            frequency_deviation: 1e-3,
            deviations,
            seconds: 0.0,
            bow: [0.0; BOWS],
        }
    }
}

impl Row {
    /// Turn of the pattern since the row before, rad, when this share of the time from that row has passed.
    pub(crate) fn turned(&self, before: &Self, share: f64) -> f64 {
        let beside = Self::curves(share).into_iter().zip(self.bow);
        let beside: f64 = beside.map(|(by, bow)| by * bow).sum();
        share * turn(self.angle - before.angle) + beside
    }

    /// The curves that make up an unsteady turn, at this share of the time between two rows.
    pub(crate) fn curves(share: f64) -> [f64; BOWS] {
        let middle = 2.0 * share - 1.0;
        [1.0, middle, middle * middle].map(|curve| curve * share * (1.0 - share))
    }

    /// The logarithm of a_A over that of another row, and its deviation: a decay alone does not bend it.
    pub(crate) fn log_beside(&self, other: &Self) -> (f64, f64) {
        (
            (self.main / other.main).ln(),
            self.deviations[0] / self.main,
        )
    }

    /// a_B over a_A, and its deviation: a decay alone does not change it.
    pub(crate) fn ratio(&self) -> (f64, f64) {
        let [of_main, of_quadrature, _] = self.deviations;
        let ratio = self.quadrature / self.main;
        (ratio, of_quadrature.hypot(ratio * of_main) / self.main)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use antinode_sim::Deviates;

    #[test]
    fn amplitudes_are_free_of_the_bias_of_noise() {
        // a_A, a_B and their deviation: a_A of 8 or 20 deviations.
        for (main, quadrature, std) in [(1.0, 0.0, 0.125), (1.0, 0.3, 0.05), (1.0, -0.4, 0.05)] {
            let mut random = Deviates::new(7);
            let count = 100_000;
            let mut sums = [0.0; 3];
            for _ in 0..count {
                let mut travelling = |size: f64| {
                    let mut part = || 2f64.sqrt() * std * random.draw();
                    (size + part()).hypot(part())
                };
                let (plus, minus) = (travelling(main + quadrature), travelling(main - quadrature));
                let wave = [0.5 * (plus + minus), 0.5 * (plus - minus), 0.0];
                let window = Window::of(0.0, wave, std);
                let row = Row::from(&window);
                let values = [
                    row.main - main,
                    row.quadrature - quadrature,
                    window.main_amplitude - main,
                ];
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value / std / f64::from(count);
                }
            }
            // In deviations; that of the mean is 0.003. What is left is of the next order.
            let [main, quadrature, as_seen] = sums;
            assert!(main.abs() < 0.013 && quadrature.abs() < 0.013, "{sums:?}");
            assert!(as_seen > 0.04, "{sums:?}");
        }
    }
}
