//! Checks of a recording's samples and rows, as they pass, for faults that the rows do not show; each gives a warning.

mod converter_step;
mod cut_off;
pub(super) mod equal_samples;
mod few_values;
pub(super) mod flag_counts;
mod mains_ripple;
mod pick_off_without_wave;
mod rounded_offset;
mod row_scatter;
mod sampled_in_turn;
mod silence;
mod tones;

use antinode::{Estimate, Flags, Settings};

use super::options::Identify;
use super::span::Span;
use crate::recording::Recording;
use converter_step::ConverterStep;
use cut_off::CutOff;
use equal_samples::EqualSamples;
use few_values::FewValues;
use mains_ripple::MainsRipple;
use pick_off_without_wave::PickOffWithoutWave;
use rounded_offset::RoundedOffset;
use row_scatter::RowScatter;
use sampled_in_turn::SampledInTurn;
use silence::Silence;
use tones::Tones;

/// All checks of a recording.
pub(super) struct Remarks {
    settings: Settings,
    converter_step: ConverterStep,
    cut_off: CutOff,
    pub equal_samples: EqualSamples,
    few_values: FewValues,
    mains_ripple: MainsRipple,
    pick_off_without_wave: PickOffWithoutWave,
    rounded_offset: RoundedOffset,
    row_scatter: RowScatter,
    sampled_in_turn: SampledInTurn,
    silence: Silence,
    tones: Tones,
    has_rows: bool,
    /// The smallest residual of the rows with a wave, and the frequency of the last one, Hz.
    residual: f32,
    frequency: f64,
    has_warned_early: bool,
}

impl Remarks {
    /// The checks of a recording that is identified with these settings.
    pub fn new(options: &Identify, recording: &Recording, settings: Settings) -> Self {
        let found = recording.resolution();
        Self {
            settings,
            converter_step: ConverterStep::new(found.filter(|_| options.resolution.is_none())),
            cut_off: CutOff::new(settings.resolution),
            equal_samples: EqualSamples::default(),
            few_values: FewValues::new(settings.resolution),
            mains_ripple: MainsRipple::new(settings.hum),
            pick_off_without_wave: PickOffWithoutWave::default(),
            rounded_offset: RoundedOffset::default(),
            row_scatter: RowScatter::new(settings.resolution),
            sampled_in_turn: SampledInTurn::default(),
            silence: Silence::default(),
            tones: Tones::default(),
            has_rows: false,
            residual: f32::INFINITY,
            frequency: 0.0,
            has_warned_early: false,
        }
    }

    /// Takes the next pairs.
    pub fn see(&mut self, pairs: &[[f32; 2]]) {
        self.equal_samples.see(pairs);
        self.few_values.see(pairs);
        self.cut_off.see(pairs);
        self.tones.see(pairs);
    }

    /// Notes that pairs are lost before the next.
    pub fn interrupt(&mut self) {
        self.tones.interrupt();
    }

    /// Takes a row.
    pub fn row(&mut self, row: &Estimate) {
        let rate = self.settings.sample_rate;
        self.silence.see(row, rate, self.settings.hop);
        self.rounded_offset.see(row, rate);
        self.mains_ripple.see(row);
        self.row_scatter.see(row);
        self.sampled_in_turn.see(row, rate);
        self.pick_off_without_wave.see(row);
        self.cut_off.row(row.flags);
        self.tones.row(row);
        self.has_rows = true;
        if !row.flags.contains(Flags::LOST) {
            self.residual = self.residual.min(row.residual_rms);
            self.frequency = row.frequency;
        }
    }

    /// Whether the cause of misfits is told by a warning.
    pub fn is_cause_known(&mut self) -> bool {
        self.cause().is_some() || self.tones.cause(&self.settings).is_some()
    }

    /// The cause of misfits and scatter, where it is certain.
    fn cause(&mut self) -> Option<String> {
        self.rounded_offset
            .warning()
            .or_else(|| self.mains_ripple.warning())
    }

    /// Warnings for a recording that may never end, before its end; `step` is the converter's step in all samples so far.
    pub fn early_warnings(&mut self, step: Option<f32>) -> impl Iterator<Item = String> {
        self.has_warned_early = true;
        // If there are rows, their flags show a constant pick-off.
        let constant = self.equal_samples.constant().filter(|_| !self.has_rows);
        let early = constant.or_else(|| self.equal_samples.same_twice());
        let step = self.converter_step.warning(step, self.residual);
        early.into_iter().chain(step)
    }

    /// Warnings at the end of a recording of this length, s; `step` is the converter's step in all samples.
    pub fn warnings(
        &mut self,
        step: Option<f32>,
        span: &Span,
        seconds: f64,
    ) -> impl Iterator<Item = String> {
        let has_option = self.settings.hum || self.settings.coloured;
        let constant = self.equal_samples.constant().filter(|_| self.has_rows);
        let cause = self.cause();
        let (scatter, tones) = if cause.is_some() {
            (None, None)
        } else {
            let scatter = self.row_scatter.warning(has_option);
            let tones = match scatter {
                Some(_) => self.tones.warning(&self.settings),
                None => self.tones.cause(&self.settings),
            };
            (scatter, tones)
        };
        let is_same_known = self.has_warned_early || self.equal_samples.are_both_constant();
        [
            span.coarse_time(self.frequency),
            self.silence.warning(seconds, span.offset()),
            self.converter_step.warning(step, self.residual),
            self.few_values.warning().filter(|_| self.has_rows),
            self.cut_off.warning(self.residual),
            cause,
            scatter,
            tones,
            self.sampled_in_turn.warning(),
            constant.or_else(|| self.pick_off_without_wave.warning()),
            self.equal_samples.same_twice().filter(|_| !is_same_known),
        ]
        .into_iter()
        .flatten()
    }
}
