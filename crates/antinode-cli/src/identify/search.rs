//! What becomes of the search for a period, and why there is no row where it comes to nothing.

use super::Core;
use crate::failure::Failure;
use crate::options::{Detector, Identify};

/// An offset of so many times what is about it leaves single precision too few digits for a wave.
const LARGE_OFFSET: f64 = 300.0;

/// What became of the search for a period.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Search {
    has_found: bool,
    /// Periods whose first window was no wave.
    refused: u64,
    /// The mean of the first samples, and their rms about it, where that is much less.
    offset: Option<[f64; 2]>,
}

impl Search {
    /// Takes the first pairs, which tell the offset.
    pub fn begin(&mut self, pairs: &[[f32; 2]]) {
        self.offset = large_offset(pairs);
    }

    /// Takes a look at the core.
    pub fn see(&mut self, is_searching: bool) {
        self.refused += u64::from(self.has_found && is_searching);
        self.has_found = !is_searching;
    }

    /// Why a recording that was read to its end gave no row.
    pub fn no_rows(&self, name: &str, rate: f64, core: &Core, options: &Identify) -> Failure {
        let (pairs, seconds) = (core.index(), core.index() as f64 / rate);
        let periods = options.periods;
        let offset = self.offset.map_or(String::new(), |[mean, rms]| {
            format!(
                "; the samples lie about an offset of {mean:.4e} and only {rms:.1e} rms off it, too little for single precision: \
                 take the offset off"
            )
        });
        Failure::Recording(if self.refused > 0 {
            format!(
                "{name}: a period was found, but no window of {periods} periods in {pairs} sample pairs ({seconds:.4} s) is mostly \
                 one wave; the wave may have fewer than 4 samples a period: check the sample rate; or look for a second tone, and \
                 check the scale of the samples, --full-scale and --resolution{offset}"
            )
        } else if core.is_searching() {
            let other = match options.detector {
                Detector::Difference => "mean-return",
                Detector::MeanReturn => "difference",
            };
            format!(
                "{name}: no period found in {pairs} sample pairs ({seconds:.4} s): no wave of 4 to 200 samples a period \
                 stands out of the noise; check the sample rate, the channels and the signal, or try --detector {other}, \
                 as a second tone may hide the period{offset}"
            )
        } else {
            format!(
                "{name}: a period was found, but {pairs} sample pairs ({seconds:.4} s) hold no window of {periods} periods; \
                 record longer or give a smaller --periods"
            )
        })
    }
}

/// The mean of samples and their rms about it, both pick-offs together, where the mean is too large for a wave about it.
fn large_offset(pairs: &[[f32; 2]]) -> Option<[f64; 2]> {
    let finite = || {
        let pairs = pairs.iter().map(|pair| pair.map(f64::from));
        pairs.filter(|pair| pair.iter().all(|value| value.is_finite()))
    };
    let count = finite().count() as f64;
    let mean = [0, 1].map(|channel| finite().map(|pair| pair[channel]).sum::<f64>() / count);
    let squares = finite().map(|pair| (pair[0] - mean[0]).powi(2) + (pair[1] - mean[1]).powi(2));
    let (mean, rms) = (
        mean[0].hypot(mean[1]),
        (squares.sum::<f64>() / count).sqrt(),
    );
    // What stands still is no wave, and not for its offset.
    (rms > 0.0 && mean > LARGE_OFFSET * rms).then_some([mean, rms])
}
