//! What the images share: realistic codes, the marks that measurements run between, the way out.
#![no_std]
// Marks must have the names that the counting tool looks for, and the panic handler is the image's own.
#![allow(unsafe_code, reason = "`no_mangle` is an unsafe attribute")]

use cortex_m_semihosting::debug;

/// Sample pairs that a bench works through.
pub const PAIRS: usize = 16_384;

/// Period of the simulated wave in `RING` pairs: 75 periods in 1406 pairs are 18.747 samples a period, close to 5332 Hz at 100 kS/s.
const RING: usize = 1406;

/// Codes of a 12-bit converter: a wave with quadrature, both offsets, and noise of two codes.
pub struct Codes {
    ring: [[i16; 2]; RING],
}

impl Codes {
    /// Computes the codes; slow, before the marks.
    pub fn new() -> Self {
        let mut ring = [[0; 2]; RING];
        let mut seed = 1u32;
        let mut noise = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((seed >> 29) as i16) - 4
        };
        for (k, pair) in ring.iter_mut().enumerate() {
            let phase = antinode::phase::Phase(((k as u64 * 75 * (1 << 32)) / RING as u64) as u32);
            let wave = phase.unit();
            let (main, quadrature) = (1600.0 * wave.re, 80.0 * wave.im);
            *pair = [
                (main * 0.5 - quadrature * 0.866) as i16 + 20 + noise(),
                (main * 0.866 + quadrature * 0.5) as i16 - 15 + noise(),
            ];
        }
        Self { ring }
    }

    /// A slice of `length` pairs that begins at pair `from` of the endless stream, as far as the ring's end.
    pub fn slice(&self, from: usize, length: usize) -> &[[i16; 2]] {
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

/// Pairs of a half-buffer.
const HALF_BUFFER: usize = 128;

/// A half-buffer of sample pairs in f32.
pub struct Floats {
    pairs: [[f32; 2]; HALF_BUFFER],
}

impl Floats {
    /// An empty half-buffer.
    pub const fn new() -> Self {
        Self {
            pairs: [[0.0; 2]; HALF_BUFFER],
        }
    }

    /// The first codes of a slice, as many as a half-buffer holds, in f32.
    pub fn of(&mut self, codes: &[[i16; 2]]) -> &[[f32; 2]] {
        for (pair, code) in self.pairs.iter_mut().zip(codes) {
            *pair = [f32::from(code[0]), f32::from(code[1])];
        }
        let count = codes.len().min(HALF_BUFFER);
        self.pairs.get(..count).unwrap_or(&[])
    }
}

impl Default for Floats {
    fn default() -> Self {
        Self::new()
    }
}

/// The measurement begins with the return from here.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn mark_begin() {
    core::hint::black_box(1);
}

/// The measurement ends with the call of this.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn mark_end() {
    core::hint::black_box(2);
}

/// Leaves the emulator.
pub fn leave() -> ! {
    loop {
        debug::exit(debug::EXIT_SUCCESS);
    }
}
