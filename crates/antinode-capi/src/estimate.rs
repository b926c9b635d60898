//! An estimate as a C struct.

use antinode::Flags;

// The numbers have a type suffix so that the header's constants are unsigned, and with them `flags & ~ANTINODE_FLAG_…`.

/// Samples at the converter's rail, flattened crests, or the third harmonic that a limiter leaves: amplitudes are wrong.
pub const ANTINODE_FLAG_CLIPPED: u32 = 0x001_u32;
/// No significant wave: no number of the estimate means anything, and some may be NaN or infinite.
pub const ANTINODE_FLAG_LOST: u32 = 0x002_u32;
/// The phase does not continue that of the last window without LOST, MISFIT, DEAD_CHANNEL and NOT_FINITE: samples are missing since that
/// one or within this.
pub const ANTINODE_FLAG_PHASE_JUMP: u32 = 0x004_u32;
/// Amplitude, angle or offset stepped between the previous window and this one.
pub const ANTINODE_FLAG_STEP: u32 = 0x008_u32;
/// Main and quadrature amplitude are about equal: the pattern is circular and the angle has no meaning.
pub const ANTINODE_FLAG_CIRCULAR: u32 = 0x010_u32;
/// The samples are not one wave with steady rates plus noise: there is a step, a dropout or a second tone within the window.
pub const ANTINODE_FLAG_MISFIT: u32 = 0x020_u32;
/// A pick-off gave a constant value, though before its wave was larger than `resolution`, or lost its wave while the other kept it. Half of
/// such losses are flagged if the lost wave exceeded 0.4 % of the main amplitude by 20 standard deviations of an amplitude between windows,
/// or by 30 within one, and all if by 30 or 55. After a new search a dead pick-off looks like a pattern on the other pick-off's axis, and
/// is not flagged.
pub const ANTINODE_FLAG_DEAD_CHANNEL: u32 = 0x040_u32;
/// The angle is known modulo π/2 only: set on the first window after a lost wave was searched for, or after a gap, misfits or circular
/// windows in which the pattern may have turned unseen, and on the first window after a new calibration, unless it is the first of all. The
/// flag stays set up to and including the first window without MISFIT, NOT_FINITE and DEAD_CHANNEL, whose angle later windows continue.
pub const ANTINODE_FLAG_REACQUIRED: u32 = 0x080_u32;
/// A sample is NaN or infinite, or so large that its sums are not finite.
pub const ANTINODE_FLAG_NOT_FINITE: u32 = 0x100_u32;

// The header names exactly the core's bits.
const _: () = {
    let pairs = [
        (ANTINODE_FLAG_CLIPPED, Flags::CLIPPED),
        (ANTINODE_FLAG_LOST, Flags::LOST),
        (ANTINODE_FLAG_PHASE_JUMP, Flags::PHASE_JUMP),
        (ANTINODE_FLAG_STEP, Flags::STEP),
        (ANTINODE_FLAG_CIRCULAR, Flags::CIRCULAR),
        (ANTINODE_FLAG_MISFIT, Flags::MISFIT),
        (ANTINODE_FLAG_DEAD_CHANNEL, Flags::DEAD_CHANNEL),
        (ANTINODE_FLAG_REACQUIRED, Flags::REACQUIRED),
        (ANTINODE_FLAG_NOT_FINITE, Flags::NOT_FINITE),
    ];
    let (mut i, mut all) = (0, 0);
    while i < pairs.len() {
        assert!(pairs[i].0 == pairs[i].1.bits() as u32);
        all |= pairs[i].0;
        i += 1;
    }
    assert!(all == Flags::from_bits_truncate(u16::MAX).bits() as u32);
};

/// The wave over one window, at the window's middle. Each `_std` is one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Estimate {
    /// Index in the stream of the window's first sample pair: pairs pushed and pairs skipped before it, since `_init` or `_reset`.
    pub start: u64,
    /// Time of the window's middle, s from the stream's first sample, pushed or skipped.
    pub time_s: f64,
    /// Pattern angle θ, rad: it begins near the start angle, and is continued from window to window.
    pub angle_rad: f64,
    /// Resonant frequency f, Hz.
    pub frequency_hz: f64,
    /// Sample pairs in the window.
    pub samples: u32,
    /// What is wrong with the window: a sum of ANTINODE_FLAG_… bits; 0 when clean.
    pub flags: u32,
    /// Amplitude a_A of the main standing wave, > 0, input units.
    pub main_amplitude: f32,
    /// Amplitude a_B of the quadrature wave, signed, at most a_A, input units.
    pub quadrature_amplitude: f32,
    /// Phase α, rad, −π to π: the main wave is a_A cos(2πf·(t − time_s) − α).
    pub phase_rad: f32,
    /// Precession of the pattern dθ/dt, rad/s, from this window alone.
    pub angle_rate_rad_s: f32,
    /// Decay rate −(da_A/dt)/a_A, 1/s: positive while the wave decays.
    pub decay_rate_s: f32,
    /// Offset of S_C, input units.
    pub offset_c: f32,
    /// Offset of S_D as sampled, input units: before `gain_ratio` is applied.
    pub offset_d: f32,
    /// Standard deviation of a_A, input units.
    pub main_amplitude_std: f32,
    /// Standard deviation of a_B, input units.
    pub quadrature_amplitude_std: f32,
    /// Standard deviation of θ, rad.
    pub angle_std_rad: f32,
    /// Standard deviation of α, rad.
    pub phase_std_rad: f32,
    /// Standard deviation of f, Hz.
    pub frequency_std_hz: f32,
    /// Standard deviation of dθ/dt, rad/s.
    pub angle_rate_std_rad_s: f32,
    /// Standard deviation of the decay rate, 1/s.
    pub decay_rate_std_s: f32,
    /// Rms of the residual, which is what the wave does not explain, per sample and channel, input units: it equals the noise if that is
    /// white. S_D counts as sampled: before `gain_ratio` is applied.
    pub residual_rms: f32,
    /// Always 0: the struct ends at a multiple of eight bytes on every machine.
    pub reserved: u32,
}

impl From<antinode::Estimate> for Estimate {
    fn from(e: antinode::Estimate) -> Self {
        Self {
            start: e.start,
            time_s: e.time,
            angle_rad: e.angle,
            frequency_hz: e.frequency,
            samples: e.samples,
            flags: u32::from(e.flags.bits()),
            main_amplitude: e.main_amplitude,
            quadrature_amplitude: e.quadrature_amplitude,
            phase_rad: e.phase,
            angle_rate_rad_s: e.angle_rate,
            decay_rate_s: e.decay_rate,
            offset_c: e.offsets[0],
            offset_d: e.offsets[1],
            main_amplitude_std: e.main_amplitude_std,
            quadrature_amplitude_std: e.quadrature_amplitude_std,
            angle_std_rad: e.angle_std,
            phase_std_rad: e.phase_std,
            frequency_std_hz: e.frequency_std,
            angle_rate_std_rad_s: e.angle_rate_std,
            decay_rate_std_s: e.decay_rate_std,
            residual_rms: e.residual_rms,
            reserved: 0,
        }
    }
}
