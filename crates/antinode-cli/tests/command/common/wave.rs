//! A wave made without the project's own code, and its recordings.

use std::f64::consts::TAU;

/// Sample rate of every recording made here, Hz.
pub const RATE: f64 = 100_000.0;

/// A wave by formulas (1) to (3), turning and decaying, in white noise.
#[derive(Debug, Clone, Copy)]
pub struct Wave {
    pub main: f64,
    pub quadrature: f64,
    pub angle: f64,
    pub phase: f64,
    pub frequency: f64,
    pub angle_rate: f64,
    pub decay_rate: f64,
    pub noise: f64,
}

/// A wave that differs from every default of the command.
pub const WAVE: Wave = Wave {
    main: 0.6,
    quadrature: -0.04,
    angle: 0.3,
    phase: 1.1,
    frequency: 5321.7,
    angle_rate: 0.4,
    decay_rate: 0.3,
    noise: 0.005,
};

/// Noise alone, of this rms.
pub const fn silence(noise: f64) -> Wave {
    Wave {
        main: 0.0,
        quadrature: 0.0,
        noise,
        ..WAVE
    }
}

impl Wave {
    /// Both amplitudes' decay until a time.
    pub fn decay(&self, time: f64) -> f64 {
        (-self.decay_rate * time).exp()
    }

    /// S_C and S_D as codes of a 16-bit converter whose full scale is 1.
    pub fn codes(&self, pairs: usize) -> Vec<[i16; 2]> {
        self.codes_as(pairs, |time| {
            (self.angle + self.angle_rate * time, self.decay(time))
        })
    }

    /// The same with another course: of the angle, and of both amplitudes as shares of what they are.
    pub fn codes_as(&self, pairs: usize, course: impl Fn(f64) -> (f64, f64)) -> Vec<[i16; 2]> {
        let mut random = Random(1);
        (0..pairs)
            .map(|k| {
                let time = k as f64 / RATE;
                let (sin, cos) = (TAU * self.frequency * time - self.phase).sin_cos();
                let (angle, share) = course(time);
                let (sin2, cos2) = (2.0 * angle).sin_cos();
                let (a, b) = (self.main * share * cos, self.quadrature * share * sin);
                let pair = [a * cos2 - b * sin2, a * sin2 + b * cos2];
                pair.map(|s| ((s + self.noise * random.normal()) * 32_768.0).round() as i16)
            })
            .collect()
    }
}

/// A generator of its own: SplitMix64.
struct Random(u64);

impl Random {
    /// Uniform in 0 to 1, both excluded.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        ((z >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// Standard normal, by Box and Muller.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}

/// A 16-bit WAV file of two channels, byte by byte.
pub fn wav(codes: &[[i16; 2]]) -> Vec<u8> {
    let data = 4 * codes.len() as u32;
    let mut bytes = Vec::with_capacity(44 + data as usize);
    bytes.extend(b"RIFF");
    bytes.extend((36 + data).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16u32.to_le_bytes());
    // PCM, two channels.
    bytes.extend([1, 0, 2, 0]);
    bytes.extend((RATE as u32).to_le_bytes());
    bytes.extend((4 * RATE as u32).to_le_bytes());
    // Four bytes a pair, 16 bits a sample.
    bytes.extend([4, 0, 16, 0]);
    bytes.extend(b"data");
    bytes.extend(data.to_le_bytes());
    bytes.extend(raw(codes));
    bytes
}

/// Codes as they come from a converter: little-endian, S_C and S_D in turn.
pub fn raw(codes: &[[i16; 2]]) -> Vec<u8> {
    codes
        .as_flattened()
        .iter()
        .flat_map(|code| code.to_le_bytes())
        .collect()
}

/// An NPY file of 16-bit integers of shape (N, 2), byte by byte.
pub fn npy(codes: &[[i16; 2]]) -> Vec<u8> {
    let mut header = format!(
        "{{'descr': '<i2', 'fortran_order': False, 'shape': ({}, 2), }}",
        codes.len()
    );
    // The header with its ten bytes before it fills 128.
    header = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(raw(codes));
    bytes
}

/// Text with a header, the time in seconds and the two signals, full scale 1.
pub fn text(codes: &[[i16; 2]]) -> String {
    printed("time,C,D\n", codes, |k, [c, d]| {
        format!("{:.5},{c},{d}", k as f64 / RATE)
    })
}

/// Text with a header, each line as `print` has its number and its samples, full scale 1.
pub fn printed(
    header: &str,
    codes: &[[i16; 2]],
    print: impl Fn(usize, [f64; 2]) -> String,
) -> String {
    let mut text = header.to_owned();
    for (k, pair) in codes.iter().enumerate() {
        // A power of two: every digit is exact.
        text += &print(k, pair.map(|code| f64::from(code) / 32_768.0));
        text += "\n";
    }
    text
}
