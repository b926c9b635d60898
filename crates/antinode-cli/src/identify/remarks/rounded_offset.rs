//! Check whether the residual is rounding of a large offset in single precision, not noise: it raises σ, and may cause misfits.

use antinode::{Estimate, Flags};

/// Offset, in amplitudes, below which it adds hardly more rounding than the wave itself.
const MIN_OFFSET: f64 = 3.0;
/// Residual that rounded sums of blocks leave, at most, as a share of the offset and per sample of a period: short blocks leave half of it,
/// and those of two periods up to 1.4·10⁻⁸.
const ROUNDING: f64 = 1.8e-8;
/// Residual, as a share of the wave, below which rounding does not matter.
const MIN_RESIDUAL: f64 = 1e-5;
/// Rows needed for a verdict.
const MIN_ROWS: u64 = 4;

/// Counts rows whose residual is no larger than such rounding.
#[derive(Debug, Default)]
pub(super) struct RoundedOffset {
    rows: u64,
    rounded: u64,
    /// The offset of the last such row, in amplitudes.
    offset: f64,
}

impl RoundedOffset {
    /// Takes a row of a recording of this sample rate, Hz.
    pub fn see(&mut self, estimate: &Estimate, rate: f64) {
        if estimate.flags.contains(Flags::LOST) {
            return;
        }
        self.rows += 1;
        let [c, d] = estimate.offsets.map(f64::from);
        let (offset, main) = (c.hypot(d), f64::from(estimate.main_amplitude));
        let rounding = ROUNDING * rate / estimate.frequency * offset;
        let residual = f64::from(estimate.residual_rms);
        if offset > MIN_OFFSET * main && (MIN_RESIDUAL * main..rounding).contains(&residual) {
            self.rounded += 1;
            self.offset = offset / main;
        }
    }

    /// A warning if the residual of most rows is rounding.
    pub fn warning(&self) -> Option<String> {
        (self.rows >= MIN_ROWS && 2 * self.rounded > self.rows).then(|| {
            format!(
                "the offset is {:.0} times the wave, and its rounding in single precision is much of the residual: deviations are larger, and \
                 rows may be flagged misfit; subtract each pick-off's mean first, in double precision",
                self.offset
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::row_scatter::tests::row;
    use super::*;
    use antinode_sim::Deviates;

    /// The warning for this many rows beside an amplitude of 0.6, one in `every` of them with this residual, the others with noise.
    fn warning(
        samples_a_period: f64,
        offset: f32,
        residual: f32,
        rows: u64,
        every: u64,
    ) -> Option<String> {
        let (mut rounded, mut deviates) = (RoundedOffset::default(), Deviates::new(1));
        for index in 0..rows {
            let mut row = row(index, 1.0, &mut deviates);
            row.residual_rms = if index % every == 0 { residual } else { 1.0 };
            row.offsets = [offset, 0.0];
            let rate = samples_a_period * row.frequency;
            rounded.see(&row, rate);
            row.flags = Flags::LOST;
            rounded.see(&row, rate);
        }
        rounded.warning()
    }

    #[test]
    fn a_residual_of_rounding_is_told_from_noise() {
        for (samples, offset, residual, is_told) in [
            (18.75, 60.0, 1.6e-5, true),
            (18.75, 60.0, 3e-5, false),
            (18.75, 60.0, 5e-6, false),
            (18.75, 1.0, 1e-8, false),
            (18.75, 0.0, 0.0, false),
            (18.75, f32::NAN, 1e-5, false),
            // The wave itself is rounded as much.
            (1000.0, 1.2, 1.3e-5, false),
        ] {
            let warning = warning(samples, offset, residual, 9, 2);
            assert_eq!(warning.is_some(), is_told, "{samples} {offset} {residual}");
            assert!(warning.is_none_or(|warning| warning.starts_with("the offset is 100 times")));
        }
        // Too few rows, or too few of them.
        assert_eq!(warning(18.75, 60.0, 1.6e-5, 3, 1), None);
        assert_eq!(warning(18.75, 60.0, 1.6e-5, 9, 3), None);
    }
}
