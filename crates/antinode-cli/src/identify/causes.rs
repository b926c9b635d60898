//! What rows beside their flags tell of the recording: the first cause that is sure goes before the others.

use antinode::{Estimate, Settings};

use super::options::Identify;
use super::ripple::Ripple;
use super::rounded::Rounded;
use super::scatter::Scatter;

/// The causes looked for.
#[derive(Debug)]
pub(super) struct Causes {
    rate: f64,
    /// Whether noise was taken not to be white.
    has_option: bool,
    rounded: Rounded,
    ripple: Ripple,
    scatter: Scatter,
}

impl Causes {
    /// Of a recording that is identified so, with this sample rate, Hz.
    pub fn new(options: &Identify, settings: &Settings, rate: f64) -> Self {
        Self {
            rate,
            has_option: options.hum || options.coloured,
            rounded: Rounded::default(),
            ripple: Ripple::new(options.hum),
            scatter: Scatter::new(settings.resolution),
        }
    }

    /// Takes a row.
    pub fn see(&mut self, estimate: &Estimate) {
        self.rounded.see(estimate, self.rate);
        self.ripple.see(estimate);
        self.scatter.see(estimate);
    }

    /// What to tell.
    pub fn told(&mut self) -> Option<String> {
        let sure = self.rounded.told().or_else(|| self.ripple.told());
        sure.or_else(|| self.scatter.told(self.has_option))
    }
}
