//! Realistic codes for the benches: a ringing gyro as a 12-bit dual converter's DMA stores it.

use antinode::Packed;

/// Length of the ring, in pairs: 75 periods in 1406 pairs are 18.747 samples a period, close to 5332 Hz at 100 kS/s.
pub const RING: usize = 1406;
/// Periods in the ring.
pub const PERIODS: u64 = 75;

/// Pairs of a half-buffer.
pub const HALF_BUFFER: usize = 128;

/// Period of the wave, in samples.
pub const PERIOD: f32 = RING as f32 / PERIODS as f32;

/// Flaw of a wave.
#[derive(Clone, Copy)]
pub enum Flaw {
    /// No flaw.
    None,
    /// Clipped crests.
    Clipped,
    /// Every pair twice.
    Held,
    /// A second tone, about as large as the wave.
    Tone,
    /// No wave, but noise as large as one.
    Noise,
}

/// A wave with quadrature, both offsets, and noise of two codes, repeated without end.
pub struct Codes {
    ring: [Packed; RING],
}

impl Codes {
    /// Computes the codes; slow, before the marks.
    pub fn new() -> Self {
        let mut codes = Self {
            ring: [Packed(0); RING],
        };
        codes.make(PERIODS, Flaw::None);
        codes
    }

    /// Computes the codes of a wave of `periods` periods in the ring of 1406 pairs.
    pub fn make(&mut self, periods: u64, flaw: Flaw) {
        let mut seed = 1u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            seed >> 21
        };
        let unit =
            |turns: u64| antinode::phase::Phase((turns * (1 << 32) / RING as u64) as u32).unit();
        let mut last = Packed(0);
        for (k, pair) in self.ring.iter_mut().enumerate() {
            let wave = unit(k as u64 * periods);
            let (main, quadrature) = (1600.0 * wave.re, 80.0 * wave.im);
            let noise = [random(), random()].map(|bits| bits as i16);
            let small = noise.map(|bits| (bits >> 8) - 4);
            let mut c = (main * 0.5 - quadrature * 0.866) as i16 + 20 + small[0];
            let mut d = (main * 0.866 + quadrature * 0.5) as i16 - 15 + small[1];
            match flaw {
                Flaw::None | Flaw::Held => {}
                Flaw::Clipped => (c, d) = (c.clamp(-400, 400), d.clamp(-700, 700)),
                Flaw::Tone => {
                    let tone = unit(k as u64 * (periods * 7 / 5 + 1));
                    c += (500.0 * tone.re) as i16;
                    d += (900.0 * tone.im) as i16;
                }
                Flaw::Noise => (c, d) = (noise[0] - 1024, noise[1] - 1024),
            }
            if !matches!(flaw, Flaw::Held) || k % 2 == 0 {
                last = Packed::from([c, d]);
            }
            *pair = last;
        }
    }

    /// The slice of `length` pairs from pair `from` of the endless stream, or fewer if the ring ends before.
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
