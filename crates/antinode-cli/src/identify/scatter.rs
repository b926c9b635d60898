//! Whether rows scatter as their stated deviations say: of noise that is not white they do not.

use antinode::Estimate;

/// Triples of rows from which on their scatter is known well enough.
const MANY: u32 = 200;
/// Scatter over stated deviation that is worth a word, and what chance may add in one triple.
const MORE: f64 = 1.25;
const LESS: f64 = 0.75;
const CHANCE: f64 = 3.0;
/// Residual, as a share of a_A, below which rounding and the converter are most of it.
const LEAST: f32 = 1e-5;
/// Mean of |z| of a normal z, √(2/π).
const MEAN: f64 = 0.797_884_560_802_865_4;

const NAMES: [&str; 4] = [
    "main amplitude",
    "quadrature amplitude",
    "angle",
    "frequency",
];

/// What is compared of a row.
#[derive(Debug, Clone, Copy)]
struct Row {
    start: u64,
    end: u64,
    values: [f64; 4],
    variances: [f64; 4],
}

impl Row {
    fn of(estimate: &Estimate) -> Self {
        let e = estimate;
        let deviations = [
            e.main_amplitude_std,
            e.quadrature_amplitude_std,
            e.angle_std,
            e.frequency_std,
        ];
        Self {
            start: e.start,
            end: e.end(),
            values: [
                e.main_amplitude.into(),
                e.quadrature_amplitude.into(),
                e.angle,
                e.frequency,
            ],
            variances: deviations.map(|x| f64::from(x).powi(2)),
        }
    }
}

/// Second differences of clean rows that share no samples, over their deviations: what changes steadily is not in them.
#[derive(Debug, Default)]
pub(super) struct Scatter {
    rows: [Option<Row>; 2],
    sums: [f64; 4],
    count: u32,
}

impl Scatter {
    /// Takes a row, of samples of this resolution where it is known.
    pub fn see(&mut self, estimate: &Estimate, resolution: Option<f32>) {
        let least = (LEAST * estimate.main_amplitude).max(resolution.unwrap_or(0.0));
        if !estimate.flags.is_empty() || estimate.residual_rms < least {
            self.rows = [None; 2];
            return;
        }
        let row = Row::of(estimate);
        if self.rows[1].is_some_and(|last| row.start < last.end) {
            return;
        }
        if let [Some(first), Some(last)] = self.rows
            && row.start - last.start == last.start - first.start
        {
            for (i, sum) in self.sums.iter_mut().enumerate() {
                let bend = first.values[i] - 2.0 * last.values[i] + row.values[i];
                let variance = first.variances[i] + 4.0 * last.variances[i] + row.variances[i];
                *sum += bend.abs() / variance.sqrt();
            }
            self.count += 1;
        }
        self.rows = [self.rows[1], Some(row)];
    }

    /// What to tell of rows whose noise was taken to be white, or coloured.
    pub fn told(&self, is_coloured: bool) -> Option<String> {
        if self.count < MANY {
            return None;
        }
        let ratios = self.sums.map(|sum| sum / (MEAN * f64::from(self.count)));
        let chance = CHANCE / f64::from(self.count).sqrt();
        if ratios.iter().all(|&ratio| ratio < LESS - 0.5 * chance) {
            let most = ratios.into_iter().fold(0.0, f64::max);
            let remedy = if is_coloured {
                ""
            } else {
                ", which --hum leaves out"
            };
            return Some(format!(
                "rows scatter by only {most:.2} of their stated deviations: most of what was taken for noise is at low frequencies{remedy}"
            ));
        }
        let more: Vec<String> = NAMES
            .iter()
            .zip(ratios)
            .filter(|&(_, ratio)| ratio > MORE + chance)
            .map(|(name, ratio)| format!("{name} {ratio:.2}"))
            .collect();
        let remedy = if is_coloured {
            ""
        } else {
            ", for which there is --coloured"
        };
        (!more.is_empty()).then(|| {
            format!(
                "rows scatter by more than their stated deviations ({} times): either the wave itself moves, or the noise is not white{remedy}",
                more.join(", ")
            )
        })
    }
}
