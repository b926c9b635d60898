//! Straight lines through values at times, by least squares.

/// Weighted times.
pub struct Times {
    /// Weights, and times relative to their mean.
    about: Vec<[f64; 2]>,
    weight: f64,
    /// Weighted sum of the squares of these times.
    pub along: f64,
}

impl Times {
    /// Takes weights and times.
    pub fn new(weighted: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut about: Vec<_> = weighted.collect();
        let (weight, sum) = about.iter().fold((0.0, 0.0), |(all, sum), [weight, time]| {
            (all + weight, sum + weight * time)
        });
        for [_, time] in &mut about {
            *time -= sum / weight;
        }
        let along = about
            .iter()
            .map(|[weight, time]| weight * time * time)
            .sum();
        Self {
            about,
            weight,
            along,
        }
    }

    /// The line through values at these times: its slope, and the weighted sum of the squares that it leaves.
    pub fn line(&self, values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
        let about = self.about.iter().zip(values);
        let (sum, product) =
            about
                .clone()
                .fold((0.0, 0.0), |(sum, product), ([weight, time], value)| {
                    (sum + weight * value, product + weight * time * value)
                });
        let (mean, slope) = (sum / self.weight, product / self.along);
        let left =
            about.map(|([weight, time], value)| weight * (value - mean - slope * time).powi(2));
        (slope, left.sum())
    }
}
