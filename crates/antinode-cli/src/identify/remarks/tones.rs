//! Tones beside the wave, by the spectrum of the samples: they are named where rows are misfits, or scatter otherwise than they state.

mod spectrum;

use std::f64::consts::FRAC_1_PI;
use std::fmt;

use antinode::{Estimate, Flags, Settings};

use super::flag_counts::are_many;
use crate::digits::significant;
use crate::identify::MAX_PERIODS;
use spectrum::{Line, Spectrum};

/// Pairs in a spectrum, and fewest of a recording that is too short for that.
const LENGTH: usize = 1 << 15;
const MIN_LENGTH: usize = 1 << 10;
/// Spectra of the first samples, and most of all: the others are of misfits.
const FIRST: u32 = 4;
const MOST: u32 = 32;
/// Lines on either side of the wave's that may be its own.
const OWN_LINES: f64 = 10.0;
/// Least power of a tone that is named, as a share of all power beside the wave.
const MIN_SHARE: f64 = 0.05;
/// Most tones named.
const MAX_NAMED: usize = 3;
/// Highest harmonic that is named as such, and how many lines off it is seen at most.
const MAX_HARMONIC: u32 = 9;
const SAME_LINES: f64 = 1.5;
/// Periods of the wave in one of hum, at least, for `--hum` to remove it: 13 blocks of two periods.
const HUM_PERIODS: f64 = 26.0;
/// Beats with the wave, and with its third harmonic, that a window holds if a tone does no harm, and its fewest periods for `--coloured`,
/// with a hop or without.
const BEATS: f64 = 3.2;
const THIRD_BEATS: f64 = 1.1;
const MIN_PERIODS: f64 = 10.0;

/// The spectrum of the first samples and of misfits, and what rows tell of the wave.
#[derive(Default)]
pub(super) struct Tones {
    /// The last pairs, up to two spectra of them.
    recent: Vec<[f32; 2]>,
    /// `None` until there are pairs for it.
    spectrum: Option<Spectrum>,
    rows: u64,
    /// Rows with a wave, the mean of their frequencies, Hz, and how fast the last pattern turned, rad/s.
    waves: u64,
    frequency: f64,
    angle_rate: f64,
    /// The least and the greatest frequency of rows about a spectrum, Hz, and the frequencies of the last two rows.
    range: Option<[f64; 2]>,
    last: [f64; 2],
    /// Rows with one of these flags alone.
    misfits: u64,
    clipped: u64,
}

impl Tones {
    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        self.recent.extend(pairs);
        if self.spectra() < FIRST {
            while self.recent.len() >= LENGTH {
                self.add(0);
                self.recent.drain(..LENGTH);
            }
        } else if self.recent.len() >= 2 * LENGTH {
            self.recent.drain(..self.recent.len() - LENGTH);
        }
    }

    /// Notes that pairs are lost before the next.
    pub fn interrupt(&mut self) {
        self.recent.clear();
    }

    /// Takes a row.
    pub fn row(&mut self, row: &Estimate) {
        self.rows += 1;
        if row.flags.contains(Flags::LOST) {
            return;
        }
        self.waves += 1;
        self.frequency += (row.frequency - self.frequency) / self.waves as f64;
        self.angle_rate = row.angle_rate.into();
        let mut is_about_spectrum = self.spectra() < FIRST;
        self.misfits += u64::from(row.flags == Flags::MISFIT);
        self.clipped += u64::from(row.flags == Flags::CLIPPED);
        if row.flags.contains(Flags::MISFIT)
            && self.spectra() < MOST
            && let Some(from) = self.recent.len().checked_sub(LENGTH)
        {
            self.add(from);
            self.recent.clear();
            is_about_spectrum = true;
        }
        if is_about_spectrum {
            self.widen(row.frequency);
        }
        self.last = [self.last[1], row.frequency];
    }

    /// Widens the range of the wave's frequency by that of a row, unless it is neither like the row before nor the one before that.
    fn widen(&mut self, frequency: f64) {
        let [one, other] = self.last;
        let usual = if self.waves < 3 {
            self.frequency
        } else {
            frequency.clamp(one.min(other), one.max(other))
        };
        let [least, greatest] = self.range.unwrap_or([usual; 2]);
        self.range = Some([least.min(usual), greatest.max(usual)]);
    }

    /// How many spectra there are.
    fn spectra(&self) -> u32 {
        self.spectrum.as_ref().map_or(0, Spectrum::count)
    }

    /// Adds the spectrum of the recent pairs from this one on.
    fn add(&mut self, from: usize) {
        let spectrum = self.spectrum.get_or_insert_with(|| Spectrum::new(LENGTH));
        spectrum.add(&self.recent[from..from + LENGTH]);
    }

    /// A warning that names the tones that stand out, if many rows are misfits, which harmonics of the wave alone do not make, or clipped,
    /// for which a tone near the third is taken.
    pub fn cause(&mut self, settings: &Settings) -> Option<String> {
        let misfits = self.are_misfits_many();
        let clipped = are_many(self.clipped, self.rows);
        if !misfits && !clipped {
            return None;
        }
        let tones = self.tones(settings.sample_rate);
        let is_cause = |tone: &Tone| {
            misfits && tone.harmonic.is_none() || clipped && self.is_near_third(tone, settings)
        };
        let is_any = tones.iter().any(is_cause);
        is_any.then(|| self.told(&tones, settings)).flatten()
    }

    /// A warning that names the tones that stand out.
    pub fn warning(&mut self, settings: &Settings) -> Option<String> {
        let tones = self.tones(settings.sample_rate);
        self.told(&tones, settings)
    }

    fn are_misfits_many(&self) -> bool {
        are_many(self.misfits, self.rows)
    }

    /// The tones that stand out of samples taken at this rate, Hz; the strongest first.
    fn tones(&mut self, rate: f64) -> Vec<Tone> {
        self.take_what_there_is();
        let Some(spectrum) = &self.spectrum else {
            return Vec::new();
        };
        let step = rate / spectrum.length() as f64;
        let [least, greatest] = self.range.unwrap_or([self.frequency; 2]);
        let drift = 0.5 * (greatest - least);
        let own = OWN_LINES + (self.angle_rate.abs() * FRAC_1_PI + drift) / step;
        let place = (least + drift) / step;
        let mut lines = spectrum.stand_out(place, own, MIN_SHARE);
        lines.truncate(MAX_NAMED);
        let tone = |line: Line| {
            let hertz = line.place * step;
            let is_this = |&order: &u32| {
                let apart = (self.harmonic(order, rate) - hertz).abs();
                apart < SAME_LINES * step + f64::from(order) * drift
            };
            Tone {
                hertz,
                step,
                amplitudes: line.amplitudes,
                harmonic: (2..=MAX_HARMONIC).find(is_this),
            }
        };
        lines.into_iter().map(tone).collect()
    }

    /// The frequency of a harmonic of the wave, Hz, as samples taken at this rate, Hz, show it.
    fn harmonic(&self, order: u32, rate: f64) -> f64 {
        let turns = f64::from(order) * self.frequency / rate;
        (turns - turns.round()).abs() * rate
    }

    /// Whether a window cannot tell a tone from the third harmonic.
    fn is_near_third(&self, tone: &Tone, settings: &Settings) -> bool {
        let apart = tone.hertz - self.harmonic(3, settings.sample_rate);
        tone.harmonic.is_none() && apart.abs() * f64::from(settings.periods) < self.frequency
    }

    /// Takes the spectrum of a recording that is too short for others.
    fn take_what_there_is(&mut self) {
        let power = self.recent.len().checked_ilog2();
        let length = power.map_or(0, |power| 1 << power);
        if self.spectra() == 0 && length >= MIN_LENGTH {
            let spectrum = self.spectrum.insert(Spectrum::new(length));
            spectrum.add(&self.recent[..length]);
        }
    }

    /// The warning about these tones, with a remedy in options beside these settings; none if there are none.
    fn told(&self, tones: &[Tone], settings: &Settings) -> Option<String> {
        let (last, others) = tones.split_last()?;
        let remedy = self.remedy(tones, settings);
        Some(if others.is_empty() {
            format!("beside the wave there is a tone of {last}: remove its cause{remedy}")
        } else {
            let others: Vec<String> = others.iter().map(Tone::to_string).collect();
            format!(
                "beside the wave there are tones of {} and of {last}: remove their causes{remedy}",
                others.join(", of ")
            )
        })
    }

    /// What else to do about these tones; empty if nothing.
    fn remedy(&self, tones: &[Tone], settings: &Settings) -> String {
        let is_hum = tones
            .iter()
            .all(|tone| tone.hertz * HUM_PERIODS < self.frequency);
        if is_hum {
            let is_removed = settings.hum || settings.coloured;
            return if is_removed { "" } else { ", or give --hum" }.to_owned();
        }
        let is_third = |tone: &Tone| self.is_near_third(tone, settings);
        let third = self.harmonic(3, settings.sample_rate);
        let wanted = tones.iter().map(|tone| {
            let (from, beats) = if is_third(tone) {
                (third, THIRD_BEATS)
            } else {
                (self.frequency, BEATS)
            };
            beats * self.frequency / (tone.hertz - from).abs()
        });
        let periods = wanted.fold(MIN_PERIODS, f64::max).ceil();
        let is_possible = periods <= f64::from(MAX_PERIODS);
        if is_possible && periods > f64::from(settings.periods) {
            let (coloured, whose) = if tones.iter().all(is_third) {
                ("", "a beat with its third harmonic")
            } else if settings.coloured {
                ("", "several beats with it")
            } else {
                ("--coloured and ", "several beats with it")
            };
            format!(", or give {coloured}--periods {periods}, so that a window holds {whose}")
        } else if is_possible && self.are_misfits_many() && !settings.coloured {
            ", or give --coloured".to_owned()
        } else {
            String::new()
        }
    }
}

/// A tone beside the wave.
struct Tone {
    /// Its frequency, and the distance between the spectrum's lines, Hz.
    hertz: f64,
    step: f64,
    /// Its amplitudes in S_C and in S_D.
    amplitudes: [f64; 2],
    /// Which harmonic of the wave it is, if any.
    harmonic: Option<u32>,
}

impl fmt::Display for Tone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A tenth of the distance between lines.
        let decimals = (1.0 - self.step.log10().floor()).clamp(0.0, 9.0) as usize;
        write!(f, "{:.decimals$} Hz (", self.hertz)?;
        if let Some(order) = self.harmonic {
            write!(f, "{order}f, ")?;
        }
        let [c, d] = self.amplitudes.map(|amplitude| significant(amplitude, 2));
        write!(f, "amplitude {c} in C, {d} in D)")
    }
}

#[cfg(test)]
mod tests;
