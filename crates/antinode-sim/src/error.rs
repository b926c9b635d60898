//! Errors in the description of a gyro.

/// Why a [`Gyro`](crate::Gyro) cannot be constructed; the message also says what would be right.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside its range.
    #[error("{what} is {value}: it must be {need}")]
    OutOfRange {
        /// The field, as it is spelt in [`Wave`](crate::Wave) or [`Flaws`](crate::Flaws), or `sample_rate`.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The values that would be right.
        need: &'static str,
    },
    /// The quadrature wave is larger than the main wave, so it would be the main wave itself.
    #[error(
        "quadrature_amplitude {quadrature} exceeds main_amplitude {main} in size: exchange their sizes, decrease the angle by 45 degrees \
         (increase it if quadrature_amplitude is negative), and decrease the phase by 90"
    )]
    QuadratureAboveMain {
        /// `main_amplitude` as given, input units.
        main: f64,
        /// `quadrature_amplitude` as given, input units.
        quadrature: f64,
    },
    /// A time span that does not end after it begins, or whose ends are not finite.
    #[error(
        "one of {what} goes from {from} s to {to} s: it must end after it begins, and both ends must be finite"
    )]
    EmptySpan {
        /// The list with the span: `dropouts` or `clip_spans`.
        what: &'static str,
        /// Its beginning as given, s.
        from: f64,
        /// Its end as given, s.
        to: f64,
    },
    /// Two time spans of one list share a sample of one channel.
    #[error(
        "two {what} overlap at sample {index} of one channel: each must end before the next begins"
    )]
    Overlap {
        /// The list: `dropouts` or `clip_spans`.
        what: &'static str,
        /// The index, in true time, of the first sample they share.
        index: u64,
    },
    /// A loss that reaches beyond sample 2^53, from which on an index is not always an exact `f64`.
    #[error("{count} samples are lost from sample {at} on: a loss must end before sample 2^53")]
    EndlessLoss {
        /// The index of the first sample lost.
        at: u64,
        /// The number of samples lost.
        count: u64,
    },
    /// ADC codes were requested from a gyro without an ADC.
    #[error("there are no ADC codes without an ADC: set bits and full_scale")]
    NoBits,
}

/// An error for `value` unless `holds`.
pub(crate) fn require(
    what: &'static str,
    value: f64,
    holds: bool,
    need: &'static str,
) -> Result<(), Error> {
    if holds {
        Ok(())
    } else {
        Err(Error::OutOfRange { what, value, need })
    }
}

pub(crate) fn finite(what: &'static str, value: f64) -> Result<(), Error> {
    require(what, value, value.is_finite(), "finite")
}

pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), Error> {
    let holds = value > 0.0 && value.is_finite();
    require(what, value, holds, "finite and above 0")
}
