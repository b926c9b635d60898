//! Check whether all samples show another converter step than the first ones did.

/// Residual, in steps, from which on noise breaks up all rounding, and the step adds nothing to deviations.
const DITHERED: f32 = 0.6;
/// Ratio to the assumed step from which on a coarser one is reported: a few codes may all be even by chance.
const MIN_COARSER: f32 = 4.0;

/// The step that the deviations of rows allow for.
#[derive(Debug)]
pub(super) struct ConverterStep {
    /// `None` if it is unknown, or was given and is therefore right.
    assumed: Option<f32>,
    has_warned: bool,
}

impl ConverterStep {
    /// `assumed` is the step found in the first samples, if any, unless it was given.
    pub fn new(assumed: Option<f32>) -> Self {
        Self {
            assumed,
            has_warned: false,
        }
    }

    /// A warning, once, if the step of all samples so far is another; `residual` is the smallest of any row.
    pub fn warning(&mut self, step: Option<f32>, residual: f32) -> Option<String> {
        let (assumed, step) = (self.assumed?, step?);
        let (fine, coarse) = (assumed.min(step), assumed.max(step));
        let is_other = if step > assumed {
            step >= MIN_COARSER * assumed
        } else {
            // Of a step that is no power of two, all samples together show only a power-of-two part.
            step < assumed && (coarse / fine).log2().fract() == 0.0
        };
        if self.has_warned || !is_other || residual >= DITHERED * coarse {
            return None;
        }
        self.has_warned = true;
        Some(if step > assumed {
            format!(
                "all samples are multiples of {step:?}, but deviations allow for a converter's step of only {assumed:?}: if the converter has \
                 the coarser step, give --resolution {step:?}"
            )
        } else {
            format!(
                "the first samples are multiples of {assumed:?}, taken for the converter's step, but later ones are multiples of only \
                 {step:?}: deviations are too large; give --resolution {step:?}"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The warning for these steps, and this smallest residual.
    fn warning(assumed: Option<f32>, step: Option<f32>, residual: f32) -> Option<String> {
        ConverterStep::new(assumed).warning(step, residual)
    }

    #[test]
    fn a_step_that_shows_late_is_reported_with_its_option() {
        let (fine, coarse) = (1.0 / 32_768.0, 1.0 / 2048.0);
        let late = warning(Some(fine), Some(coarse), 0.3 * coarse).unwrap();
        assert!(late.ends_with("give --resolution 0.00048828125"), "{late}");
        let early = warning(Some(coarse), Some(fine), 0.3 * coarse).unwrap();
        assert!(early.starts_with("the first samples are multiples of 0.00048828125, "));
        assert!(early.ends_with("too large; give --resolution 3.0517578e-5"));
        // Noise, steps that agree, and a step of which samples show only a part.
        assert_eq!(warning(Some(fine), Some(coarse), 0.7 * coarse), None);
        assert_eq!(warning(Some(fine), Some(fine), 0.0), None);
        assert_eq!(warning(Some(fine), Some(2.0 * fine), 0.0), None);
        assert!(warning(Some(2.0 * fine), Some(fine), 0.0).is_some());
        assert_eq!(warning(Some(10.0 * fine), Some(2.0 * fine), 0.0), None);
        assert_eq!(warning(None, Some(coarse), 0.0), None);
        assert_eq!(warning(Some(fine), None, 0.0), None);
        // Rows without a wave have no residual, and nothing is reported twice.
        let mut step = ConverterStep::new(Some(fine));
        assert_eq!(step.warning(Some(1.0), f32::INFINITY), None);
        assert!(step.warning(Some(0.5), 0.0).is_some() && step.warning(Some(0.5), 0.0).is_none());
    }
}
