//! Random numbers of tests whose streams are not those of a simulated gyro.

/// Uniform numbers, the same for the same seed.
pub struct Random(u32);

impl Random {
    /// Begins with a seed.
    pub fn new(seed: u32) -> Self {
        Self(seed)
    }

    /// The next number, −1 to below 1.
    pub fn draw(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / 8_388_608.0 - 1.0
    }
}
