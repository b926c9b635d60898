//! Straight lines through values at times, by least squares.

/// Weighted times.
pub struct Times {
    /// Weights, and times relative to their mean.
    about: Vec<[f64; 2]>,
    /// Weighted sum of the squares of these times.
    pub along: f64,
}

impl Times {
    /// Takes weights and times.
    pub fn new(weighted: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut about: Vec<_> = weighted.collect();
        let (weights, sum) = about.iter().fold((0.0, 0.0), |(all, sum), [weight, time]| {
            (all + weight, sum + weight * time)
        });
        for [_, time] in &mut about {
            *time -= sum / weights;
        }
        let along = about
            .iter()
            .map(|[weight, time]| weight * time * time)
            .sum();
        Self { about, along }
    }

    /// The slope of the line through values at these times.
    pub fn slope(&self, values: impl Iterator<Item = f64>) -> f64 {
        let products = self.about.iter().zip(values);
        let products = products.map(|([weight, time], value)| weight * time * value);
        products.sum::<f64>() / self.along
    }
}
