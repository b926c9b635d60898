//! The description of flaws of limited duration.

use serde::{Deserialize, Serialize};

/// Samples that never reach the record, in both channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Loss {
    /// Index of the first sample lost, counted in true time (lost samples included).
    pub at: u64,
    /// Number of samples lost, any (0 = none); `at + count` must not exceed 2^53.
    ///
    /// One sample lost is a phase jump of omega / sample rate: 0.335 rad at 5332 Hz and 100 kS/s.
    pub count: u64,
}

/// A span of time without a signal: the samples `k` with `from` <= k / sample rate < `to`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dropout {
    /// Beginning, s from the first sample; finite.
    pub from: f64,
    /// End, s, after `from`; finite.
    pub to: f64,
    /// What is recorded meanwhile.
    pub kind: DropoutKind,
    /// The channel that drops out; `None` = both.
    #[serde(default)]
    pub channel: Option<Channel>,
}

/// What a channel records in a dropout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DropoutKind {
    /// Zero: a dead link.
    Zero,
    /// The value of the sample before the dropout (0 if there is none), over and over: a stuck converter.
    Hold,
    /// Offset and noise, without the wave: a broken pick-off.
    NoiseOnly,
}

/// One of the two channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// S_C of (2).
    C,
    /// S_D of (2).
    D,
}

/// Clipping for a span of time: the samples `k` with `from` <= k / sample rate < `to`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClipSpan {
    /// Beginning, s from the first sample; finite.
    pub from: f64,
    /// End, s, after `from`; finite.
    pub to: f64,
    /// Both channels are limited to plus or minus this, input units, above 0.
    pub level: f64,
}
