//! Realistic codes for the benches: what a 12-bit dual converter's DMA leaves of a ringing gyro.

use antinode::Packed;

/// Length of the ring, in pairs: 75 periods in 1406 pairs are 18.747 samples a period, close to 5332 Hz at 100 kS/s.
const RING: usize = 1406;
/// Periods in the ring.
const PERIODS: u64 = 75;

/// Period of the wave, in samples.
pub const PERIOD: f32 = RING as f32 / PERIODS as f32;

/// A wave with quadrature, both offsets, and noise of two codes, repeated without end.
pub struct Codes {
    ring: [Packed; RING],
}

impl Codes {
    /// Computes the codes; slow, before the marks.
    pub fn new() -> Self {
        let mut ring = [Packed(0); RING];
        let mut seed = 1u32;
        let mut noise = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((seed >> 29) as i16) - 4
        };
        for (k, pair) in ring.iter_mut().enumerate() {
            let phase =
                antinode::phase::Phase(((k as u64 * PERIODS * (1 << 32)) / RING as u64) as u32);
            let wave = phase.unit();
            let (main, quadrature) = (1600.0 * wave.re, 80.0 * wave.im);
            let c = (main * 0.5 - quadrature * 0.866) as i16 + 20 + noise();
            let d = (main * 0.866 + quadrature * 0.5) as i16 - 15 + noise();
            *pair = Packed(u32::from(c as u16) | u32::from(d as u16) << 16);
        }
        Self { ring }
    }

    /// A slice of `length` pairs that begins at pair `from` of the endless stream, as far as the ring's end.
    pub fn slice(&self, from: usize, length: usize) -> &[Packed] {
        let from = from % RING;
        let to = (from + length).min(RING);
        self.ring.get(from..to).unwrap_or(&[])
    }
}

impl Default for Codes {
    fn default() -> Self {
        Self::new()
    }
}
