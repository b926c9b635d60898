//! A converter's step that all samples show, and the first of them did not, or otherwise.

/// Residual, in steps, from which on noise breaks up all rounding, and a step adds nothing to deviations.
const NOISY: f32 = 0.6;
/// A step that shows late is told from so many times the assumed one on: a few codes may all be even by chance.
const COARSER: f32 = 4.0;

/// What the deviations of rows take for the step.
#[derive(Debug)]
pub(super) struct ConverterStep {
    /// None where it was given: then it is right.
    assumed: Option<f32>,
    is_told: bool,
}

impl ConverterStep {
    /// Of samples of this resolution, where it is known, and not given.
    pub fn new(assumed: Option<f32>) -> Self {
        Self {
            assumed,
            is_told: false,
        }
    }

    /// What to tell, once, where this is the step of all samples so far, and this the least residual of a row.
    pub fn told(&mut self, step: Option<f32>, residual: f32) -> Option<String> {
        let (assumed, step) = (self.assumed?, step?);
        let (fine, coarse) = (assumed.min(step), assumed.max(step));
        let is_other = if step > assumed {
            step >= COARSER * assumed
        } else {
            // Of a step that is no power of two, samples have only a part in common.
            step < assumed && is_power_of_two(coarse / fine)
        };
        if self.is_told || !is_other || residual >= NOISY * coarse {
            return None;
        }
        self.is_told = true;
        Some(if step > assumed {
            format!(
                "all samples are multiples of {step:?}, and deviations allow for a converter's step of {assumed:?} only: if the converter has the coarser \
                 one, give --resolution {step:?}"
            )
        } else {
            format!(
                "the first samples are multiples of {assumed:?}, which is taken for the converter's step, and later ones of {step:?} only: deviations are \
                 too large; give --resolution {step:?}"
            )
        })
    }
}

fn is_power_of_two(ratio: f32) -> bool {
    ratio.log2().fract() == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told of steps, where the least residual is this.
    fn told(assumed: Option<f32>, step: Option<f32>, residual: f32) -> Option<String> {
        ConverterStep::new(assumed).told(step, residual)
    }

    #[test]
    fn a_step_that_shows_late_is_told_with_its_option() {
        let (fine, coarse) = (1.0 / 32_768.0, 1.0 / 2048.0);
        let late = told(Some(fine), Some(coarse), 0.3 * coarse).unwrap();
        assert!(late.ends_with("give --resolution 0.00048828125"), "{late}");
        let early = told(Some(coarse), Some(fine), 0.3 * coarse).unwrap();
        assert!(early.starts_with("the first samples are multiples of 0.00048828125, "));
        assert!(early.ends_with("too large; give --resolution 3.0517578e-5"));
        // Noise, steps that agree, and a step that samples have only a part of.
        assert_eq!(told(Some(fine), Some(coarse), 0.7 * coarse), None);
        assert_eq!(told(Some(fine), Some(fine), 0.0), None);
        assert_eq!(told(Some(fine), Some(2.0 * fine), 0.0), None);
        assert!(told(Some(2.0 * fine), Some(fine), 0.0).is_some());
        assert_eq!(told(Some(10.0 * fine), Some(2.0 * fine), 0.0), None);
        assert_eq!(told(None, Some(coarse), 0.0), None);
        assert_eq!(told(Some(fine), None, 0.0), None);
        // Rows without a wave have no residual, and nothing is told twice.
        let mut step = ConverterStep::new(Some(fine));
        assert_eq!(step.told(Some(1.0), f32::INFINITY), None);
        assert!(step.told(Some(0.5), 0.0).is_some() && step.told(Some(0.5), 0.0).is_none());
    }
}
