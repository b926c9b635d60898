//! The outcome of the search for a period, and the reason why a recording gave no row.

pub(super) mod unsearched_wave;

use super::first_pairs::{amplitude_beyond, large_offset};
use super::options::{Detector, Identify};
use super::remarks::equal_samples::EqualSamples;
use super::{Core, LONGEST_PERIOD, SHORTEST_PERIOD};
use crate::digits::{seconds, significant};
use unsearched_wave::UnsearchedWave;

/// Three of the longest periods that are searched: fewer pairs may be too few to find a period.
const FEW_PAIRS: u64 = 600;

/// Likely causes if no window is a wave of the frequency given.
const OTHER_FREQUENCY: &str = "check --frequency and the sample rate, or omit --frequency to search for the period; if the wave changes fast, \
                               give a smaller --periods";

/// The outcome of the search for a period.
#[derive(Debug, Default)]
pub(super) struct Search {
    has_found: bool,
    /// Periods found whose first window was no wave.
    refused: u64,
    /// The mean of the first samples, and their rms about it, if that is much smaller.
    offset: Option<[f64; 2]>,
    /// The amplitude of the first samples, if it lies outside the range that can be identified.
    amplitude_beyond: Option<f64>,
    unsearched: UnsearchedWave,
}

impl Search {
    /// Checks the offset and the amplitude of the first pairs.
    pub fn begin(&mut self, pairs: &[[f32; 2]]) {
        self.offset = large_offset(pairs);
        self.amplitude_beyond = amplitude_beyond(pairs);
    }

    /// A warning if the amplitude lies outside the range that can be identified.
    pub fn scale_warning(&self) -> Option<String> {
        self.amplitude_beyond.map(|swing| {
            format!(
                "the first samples have an amplitude of {swing:.0e}, beyond the range of 1e-15 to 1e17: give the samples in another unit"
            )
        })
    }

    /// Notes whether the core is searching.
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
        equal: &EqualSamples,
    ) -> String {
        let pairs = core.index();
        let length = pairs as f64 / rate;
        let all = format!("{pairs} sample pairs ({} s)", seconds(length, length));
        let periods = options.periods;
        if let Some(warning) = equal.constant().filter(|_| equal.are_both_constant()) {
            let sought = if core.is_searching() {
                "period"
            } else {
                "wave"
            };
            return format!("no {sought} found in {all}: {warning}");
        }
        let known = options.frequency;
        let fits = |period: f64| pairs as f64 > longest(periods, period);
        // A scale or an offset that is beyond single precision is the cause; otherwise some likely ones are listed.
        let cause = self.scale_warning().or_else(|| self.offset_warning());
        let also = |warning: Option<String>| {
            warning.map_or(String::new(), |warning| format!("; {warning}"))
        };
        let why = if let Some(frequency) = known.filter(|&known| fits(rate / f64::from(known))) {
            let cause = cause.unwrap_or(OTHER_FREQUENCY.to_owned());
            format!(
                "no window of {periods} periods in {all} is mostly one wave within 5 % of {frequency} Hz: {cause}"
            )
        } else if self.refused > 0 {
            let cause = cause.unwrap_or_else(|| causes_of_refusal(options.hum));
            format!(
                "a period was found, but no window of {periods} periods in {all} is mostly one wave: {cause}"
            )
        } else if !core.is_searching() {
            let found = known.map_or("a period was found, but ", |_| "");
            let searched = core.period().filter(|_| known.is_none());
            let wave = searched.map_or(String::new(), |period| {
                let period = f64::from(period);
                let frequency = significant(rate / period, 3);
                if fits(period) {
                    format!(
                        "; or, as the wave has about {frequency} Hz, give --frequency {frequency}, so that no search precedes the window"
                    )
                } else {
                    format!("; the wave has about {frequency} Hz")
                }
            });
            return format!(
                "{found}{all} hold no window of {periods} periods; record longer or give a smaller --periods{wave}"
            );
        } else if pairs < FEW_PAIRS {
            format!(
                "no period found in only {all}: a search takes 3 periods, or 7 in noise; record longer, or give --frequency if it is known{}",
                also(cause)
            )
        } else if let Some(warning) = self.unsearched.warning(rate, pairs, periods) {
            format!("no period found in {all}: {warning}{}", also(cause))
        } else {
            let cause = cause.unwrap_or_else(|| causes_without_period(options.detector));
            format!("no period found in {all}: {cause}")
        };
        why + &also(equal.constant())
    }

    /// A warning if the offset is too large for single precision.
    fn offset_warning(&self) -> Option<String> {
        self.offset.map(|[mean, rms]| {
            format!(
                "the samples vary by only {rms:.1e} rms about an offset of {mean:.4e}, too little for single precision: subtract the offset"
            )
        })
    }
}

/// The most pairs that a window of so many periods may take: it may be up to a tenth longer than asked.
fn longest(periods: u16, period: f64) -> f64 {
    1.1 * f64::from(periods) * period
}

/// Likely causes if a period was found, but no window was a wave; without the remedy for hum if `hum` was given.
fn causes_of_refusal(hum: bool) -> String {
    let hum = if hum {
        ""
    } else {
        "; if hum is as large as the wave, give --hum"
    };
    format!(
        "check the sample rate, as the wave may have fewer than 4 samples a period; look for a second tone{hum}; if the wave changes fast, \
         give a smaller --periods; check --full-scale and --resolution"
    )
}

/// Likely causes if this detector found no period.
fn causes_without_period(detector: Detector) -> String {
    let other = match detector {
        Detector::Difference => {
            "try --detector mean-return, as a second tone may hide the period, or"
        }
        // It may have been tried because the other found none.
        Detector::MeanReturn => "try --detector difference; if that finds none either,",
    };
    format!(
        "no wave of 4 to 200 samples a period stands out from the noise; check the sample rate, the channels and the signal; {other} give \
         --frequency if it is known and a period has {SHORTEST_PERIOD} to {LONGEST_PERIOD} samples"
    )
}
