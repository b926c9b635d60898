//! Normal deviates for tests, by the method of Box and Muller from a linear congruential generator.

/// The state of the generator: at first its seed.
pub struct Deviates(pub u64);

impl Deviates {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// The next deviate, of mean 0 and variance 1.
    pub fn draw(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
