//! Windows of a simulated gyro, with samples before and after them for delays and for the search for the period.

use std::f64::consts::TAU;

use antinode_sim::{Bound, Flaws, Gyro, Wave};

/// A window that starts at t = 0.
#[derive(Debug, Clone)]
pub struct Samples {
    /// All sample pairs.
    pub pairs: Vec<[f32; 2]>,
    /// Sample pairs before t = 0.
    pub lead: usize,
    /// Sample pairs in the window.
    pub count: usize,
    /// Samples a period.
    pub period: f64,
    /// Sample rate, Hz.
    pub rate: f64,
    /// Periods that the window is meant to have.
    pub periods: u32,
}

impl Samples {
    /// `periods` of a wave that does not change, to the nearest sample, in white noise of `noise` rms a sample and channel.
    pub fn simulate(wave: &Wave, periods: u32, rate: f64, noise: f64, seed: u64) -> Self {
        let period = rate / wave.frequency;
        let lead = (1.5 * period).ceil() as usize;
        let count = (f64::from(periods) * period).round() as usize;
        let after = (0.25 * period).ceil() as usize + 1;
        let early = Wave {
            phase: wave.phase + TAU * wave.frequency * lead as f64 / rate,
            ..*wave
        };
        let gyro = Gyro::new(early, Flaws::white(noise), rate, seed);
        let pairs = gyro.map_or(Vec::new(), |gyro| {
            gyro.take(lead + count + after)
                .map(|pair| pair.map(|x| x as f32))
                .collect()
        });
        Self {
            pairs,
            lead,
            count,
            period,
            rate,
            periods,
        }
    }

    /// The window.
    pub fn window(&self) -> &[[f32; 2]] {
        &self.pairs[self.lead..self.lead + self.count]
    }

    /// The window with all samples before it.
    pub fn with_lead(&self) -> &[[f32; 2]] {
        &self.pairs[..self.lead + self.count]
    }

    /// The Cramér–Rao bounds of a_A, a_B (in units of the noise), θ (degrees) and f (Hz) for noise of 1, with unknown offsets and
    /// for centred signals; NaN if the window does not determine the wave.
    pub fn bounds(&self, wave: &Wave) -> [[f64; 4]; 2] {
        let middle = 0.5 * (self.count as f64 - 1.0) / self.rate;
        [Bound::new, Bound::centred].map(|bound| {
            bound(wave, self.count as u32, middle, self.rate).map_or([f64::NAN; 4], |bound| {
                [
                    bound.main_amplitude,
                    bound.quadrature_amplitude,
                    bound.angle.to_degrees(),
                    bound.frequency,
                ]
            })
        })
    }

    /// Excess of the window's length over its whole periods, as a share of these.
    pub fn deviation(&self) -> f64 {
        self.count as f64 / (f64::from(self.periods) * self.period) - 1.0
    }
}
