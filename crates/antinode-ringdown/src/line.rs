//! Weighted means, and straight lines through values at times, by least squares.

/// The mean of values, each behind its weight, and the sum of the weights.
pub fn weighted_mean(weighted: impl Iterator<Item = [f64; 2]>) -> (f64, f64) {
    let add = |[weights, sum]: [f64; 2], [weight, value]: [f64; 2]| {
        [weights + weight, sum + weight * value]
    };
    let [weights, sum] = weighted.fold([0.0; 2], add);
    (sum / weights, weights)
}

/// Weighted times.
pub struct Times<T> {
    /// Weights and times.
    weighted: T,
    weight: f64,
    mean: f64,
    /// Weighted sum of the squares of the times, relative to their mean.
    pub along: f64,
}

impl<T: Iterator<Item = [f64; 2]> + Clone> Times<T> {
    /// Takes weights and times.
    pub fn new(weighted: T) -> Self {
        let (mean, weight) = weighted_mean(weighted.clone());
        let squares = weighted
            .clone()
            .map(|[weight, time]| weight * (time - mean) * (time - mean));
        Self {
            along: squares.sum(),
            weighted,
            weight,
            mean,
        }
    }

    /// The line through values at these times: its slope, and the weighted sum of the squares that it leaves.
    pub fn line(&self, values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
        let about = self.weighted.clone().zip(values);
        let about = about.map(|([weight, time], value)| (weight, time - self.mean, value));
        let (sum, product) =
            about
                .clone()
                .fold((0.0, 0.0), |(sum, product), (weight, time, value)| {
                    (sum + weight * value, product + weight * time * value)
                });
        let (mean, slope) = (sum / self.weight, product / self.along);
        let left =
            about.map(|(weight, time, value)| weight * (value - mean - slope * time).powi(2));
        (slope, left.sum())
    }
}
