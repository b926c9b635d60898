//! What becomes of the search for a period, and why there is no row where it comes to nothing.

pub(super) mod unsearched_wave;

use super::first_pairs::{amplitude_beyond, large_offset};
use super::options::{Detector, Identify};
use super::remarks::constant_pick_off::ConstantPickOff;
use super::{Core, LONGEST, SHORTEST};
use unsearched_wave::UnsearchedWave;

/// Three of the longest periods that are searched: with fewer pairs none may be found for want of them.
const FEW_PAIRS: u64 = 600;

/// What became of the search for a period.
#[derive(Debug, Default)]
pub(super) struct Search {
    has_found: bool,
    /// Periods whose first window was no wave.
    refused: u64,
    /// The mean of the first samples, and their rms about it, where that is much less.
    offset: Option<[f64; 2]>,
    /// How far the first samples swing, where that is no amplitude that can be identified.
    beyond: Option<f64>,
    unsearched: UnsearchedWave,
}

impl Search {
    /// Takes the first pairs, which tell the offset and the scale.
    pub fn begin(&mut self, pairs: &[[f32; 2]]) {
        self.offset = large_offset(pairs);
        self.beyond = amplitude_beyond(pairs);
    }

    /// What to tell of a scale that is not identified.
    pub fn scale(&self) -> Option<String> {
        self.beyond.map(|swing| {
            format!(
                "the first samples swing by {swing:.0e}, and amplitudes are identified from 1e-15 to 1e17: give the samples in another unit"
            )
        })
    }

    /// Takes a look at the core.
    pub fn see(&mut self, is_searching: bool) {
        self.refused += u64::from(self.has_found && is_searching);
        self.has_found = !is_searching;
    }

    /// Takes pairs in which no period has been found yet.
    pub fn look(&mut self, pairs: &[[f32; 2]]) {
        self.unsearched.see(pairs);
    }

    /// Why a recording that was read to its end gave no row.
    pub fn no_rows(
        &self,
        rate: f64,
        core: &Core,
        options: &Identify,
        constant: &ConstantPickOff,
    ) -> String {
        let pairs = core.index();
        let all = format!("{pairs} sample pairs ({:.4} s)", pairs as f64 / rate);
        let periods = options.periods;
        if let Some(told) = constant.told().filter(|_| constant.are_both()) {
            let what = if core.is_searching() {
                "period"
            } else {
                "wave"
            };
            return format!("no {what} found in {all}: {told}");
        }
        // A window may be so much longer than asked.
        let longest = |frequency: f32| 1.1 * f64::from(periods) * rate / f64::from(frequency);
        let known = options.frequency;
        let why = if let Some(frequency) = known.filter(|&known| pairs as f64 > longest(known)) {
            format!(
                "no window of {periods} periods in {all} is mostly one wave within 5 % of {frequency} Hz: check --frequency and the \
                 sample rate, or leave --frequency out, and the period is searched; a wave that changes fast wants shorter windows, \
                 --periods"
            )
        } else if self.refused > 0 {
            let hum = if options.hum {
                ""
            } else {
                "; or hum is as large as the wave: give --hum"
            };
            format!(
                "a period was found, but no window of {periods} periods in {all} is mostly one wave; the wave may have fewer than 4 \
                 samples a period: check the sample rate; or look for a second tone{hum}; or the wave changes too fast: give a smaller \
                 --periods; and check the scale of the samples, --full-scale and --resolution"
            )
        } else if !core.is_searching() {
            let found = known.map_or("a period was found, but ", |_| "");
            return format!(
                "{found}{all} hold no window of {periods} periods; record longer or give a smaller --periods"
            );
        } else if pairs < FEW_PAIRS {
            format!(
                "no period found in only {all}: a search takes 3 periods, in noise 7; record longer, or give --frequency where it is \
                 known"
            )
        } else if let Some(told) = self.unsearched.told(rate) {
            format!("no period found in {all}: {told}")
        } else {
            let other = match options.detector {
                Detector::Difference => "mean-return",
                Detector::MeanReturn => "difference",
            };
            format!(
                "no period found in {all}: no wave of 4 to 200 samples a period stands out of the noise; check the sample rate, the \
                 channels and the signal; try --detector {other}, as a second tone may hide the period, or give --frequency where it is \
                 known, from {SHORTEST} to {LONGEST} samples a period"
            )
        };
        why + &self.amiss(constant)
    }

    /// What is wrong with the samples themselves, after a semicolon; nothing where they look well.
    fn amiss(&self, constant: &ConstantPickOff) -> String {
        let offset = || {
            let [mean, rms] = self.offset?;
            Some(format!(
                "the samples lie about an offset of {mean:.4e} and only {rms:.1e} rms off it, too little for single precision: \
                 take the offset off"
            ))
        };
        let told = self.scale().or_else(|| constant.told()).or_else(offset);
        told.map_or(String::new(), |told| format!("; {told}"))
    }
}
