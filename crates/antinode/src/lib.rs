//! Streaming identification of the standing wave of a hemispherical resonator gyro, or any two-mode Coriolis vibratory gyro.
//!
//! A resonator rings down freely. Two pick-offs 45° apart give two signals, sampled together:
//!
//! ```text
//! τ = ωt − α,   A = a_A cos τ,   B = a_B sin τ                                (1), (11)
//! S_C = A cos 2θ − B sin 2θ + noise,   S_D = A sin 2θ + B cos 2θ + noise      (2), (3)
//! ```
//!
//! Window by window this crate finds a_A, a_B, θ, ω and α, with their rates, standard deviations, and flags for whatever the
//! model does not explain. Numbers in parentheses are formulas of R. I. Mingazov, K. V. Shishakov, DOI
//! 10.22213/2410-9304-2021-3-12-24, whose four algorithms are in [`methods`]; the identification itself is the exact counterpart of the fourth.
//!
//! Data flows one way:
//!
//! | step | at | module |
//! |---|---|---|
//! | samples become a period, then block sums | sample rate | [`Front`]: [`period`], [`block`] |
//! | block sums become a window's waves | window rate | [`Tracker`]: an exact least-squares fit over the blocks |
//! | waves become a tracked wave with flags | window rate | [`Tracker`]: [`Estimate`], [`Flags`] |
//!
//! [`Identifier`] is all of it in one thread. In firmware a [`Front`] gathers blocks in the interrupt, hands each [`Block`] over a
//! queue, and a [`Tracker`] solves them in thread context; when [`Tracker::has_lost`] says so, call [`Front::search`] and
//! [`Tracker::forget`].
//!
//! # Example
//!
//! ```
//! use antinode::{Identifier, Settings};
//!
//! // Blocks of up to 200 sample pairs, and so periods of up to 200; a ring of 16 blocks, enough for 10 periods.
//! let mut identifier = Identifier::<f32, 200, 16>::new(Settings::new(100_000.0))?;
//! let (mut windows, omega) = (0, core::f32::consts::TAU * 5_332.0 / 100_000.0);
//! for k in 0..2_000 {
//!     // A main wave of 1 at θ = 0.3 rad, a quadrature wave of 0.1.
//!     let (sine, cosine) = (omega * k as f32).sin_cos();
//!     let (s2, c2) = 0.6f32.sin_cos();
//!     let pair = [cosine * c2 - 0.1 * sine * s2, cosine * s2 + 0.1 * sine * c2];
//!     if let Some(estimate) = identifier.push(pair) {
//!         assert!(estimate.flags.is_empty());
//!         assert!((estimate.main_amplitude - 1.0).abs() < 1e-3);
//!         assert!((estimate.quadrature_amplitude - 0.1).abs() < 1e-3);
//!         assert!((estimate.angle - 0.3).abs() < 1e-3);
//!         windows += 1;
//!     }
//! }
//! assert_eq!(windows, 10);
//! # Ok::<(), antinode::SettingsError>(())
//! ```
//!
//! # Accuracy
//!
//! | wave | error |
//! |---|---|
//! | noise-free, constant, 2 to 100 periods a window, 4.3 to 190 samples a period, any offset up to a_A | below 10⁻⁶ of a_A, 10⁻⁶ rad, 2·10⁻⁷ of f |
//! | white noise of 0.1 to 20 % of a_A, 2 to 50 periods a window, from cold | rms 0.98 to 1.05 of the Cramér–Rao bound |
//! | turning at 6 rad/s, decaying with τ = 0.3 s, drifting 2 Hz/s, 0.2 % noise, 10 periods | rms 1.00 to 1.06 of the bound |
//!
//! Standard deviations are stated within 4 % of the scatter. The bound is that of seven constant parameters, offsets and frequency
//! among them. All of this is asserted, with a margin, by the tests of `host-tests`.
//!
//! # Limits
//!
//! Phase wraps at 2π and θ is known modulo π/2: only continuity makes θ run on. A frequency that drifts so fast that it bends the
//! phase within one window beyond the noise (2 Hz/s in a window of 60 ms, say) is flagged as a misfit, and so is mains hum unless
//! [`Settings::hum`] takes it out. Periods are 4 to 200 samples. Deviations and flags take noise to be white, independent, and as large
//! in both pick-offs: of ten times as much in one of them a window in some ten thousand is flagged, of noise that both share
//! deviations are a tenth too small, and of noise without low frequencies windows are misfits.
//!
//! Within one window the pattern may turn by 0.5 rad and the wave lose 0.6 of its amplitude: 260 rad/s and 480 1/s in ten periods of 5332 Hz,
//! 2.6 rad/s and 4.8 1/s in a thousand. Beyond about 0.6 rad amplitudes are some per cent off, which windows of more than ten periods flag
//! as a misfit and shorter ones may not. Amplitudes are 10⁻¹⁵ to 10¹⁷ input units, so that their squares are numbers of f32.
#![no_std]

#[cfg(test)]
extern crate std;

mod arch;
pub mod block;
pub mod methods;
pub mod period;
pub mod phase;
pub mod regrid;

mod calibration;
mod double;
mod estimate;
mod exponential;
mod front;
mod identifier;
mod order;
mod sample;
mod settings;
mod sum;
mod tracker;
mod wave;
mod window;

pub use block::{Block, Pair};
pub use calibration::Calibration;
pub use estimate::{Estimate, Flags};
pub use front::Front;
pub use identifier::Identifier;
// The image `check_arch` compiles `arch` by itself, and needs the name.
#[doc(hidden)]
pub use sample::Form;
pub use sample::{Packed, Sample, SamplePair};
pub use settings::{Detection, Settings, SettingsError};
pub use tracker::Tracker;

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
