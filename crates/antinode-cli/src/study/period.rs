//! The period by formulas (9) and (10) as printed, on the sample grid: unlike the core's detectors, these do not interpolate.

use super::samples::Samples;

/// (9): the periods of the window over the count of samples whose means of S_C and S_D are nearest to zero, in cycles a sample.
///
/// The search covers a quarter of a period on either side of the window's end, which skips the inner zeros.
pub fn by_mean_return(samples: &Samples) -> f64 {
    let whole = f64::from(samples.periods) * samples.period;
    let (min, max) = (whole - 0.25 * samples.period, whole + 0.25 * samples.period);
    let mut sums = [0f64; 2];
    let mut best = (f64::INFINITY, 1.0);
    for (k, pair) in samples.pairs[samples.lead..].iter().enumerate() {
        sums[0] += f64::from(pair[0]);
        sums[1] += f64::from(pair[1]);
        let m = (k + 1) as f64;
        if m >= min && m <= max {
            let size = (sums[0] * sums[0] + sums[1] * sums[1]) / (m * m);
            if size < best.0 {
                best = (size, m);
            }
        }
    }
    f64::from(samples.periods) / best.1
}

/// (10) with n = 1: one over the delay in samples at which the window differs least from itself, in cycles a sample.
///
/// The search covers half to one and a half periods.
pub fn by_difference(samples: &Samples) -> f64 {
    let (min, max) = (
        (0.5 * samples.period).ceil() as usize,
        (1.5 * samples.period) as usize,
    );
    let mut best = (f64::INFINITY, 1);
    for lag in min..=max {
        let before = &samples.pairs[samples.lead - lag..];
        let sum: f64 = samples
            .window()
            .iter()
            .zip(before)
            .map(|(now, then)| f64::from((now[0] - then[0]).powi(2) + (now[1] - then[1]).powi(2)))
            .sum();
        if sum < best.0 {
            best = (sum, lag);
        }
    }
    1.0 / best.1 as f64
}
