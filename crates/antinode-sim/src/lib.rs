//! Synthetic two-mode Coriolis vibratory gyros (hemispherical resonators and their kin), for tests and for trying out
//! identification on signals of a known wave.
//!
//! A freely ringing resonator carries a standing wave. Two pick-offs 45° apart sense it as
//!
//! ```text
//! tau = omega t - alpha,   A = a_A cos tau,   B = a_B sin tau              (1)
//! S_C = C + noise,   S_D = D + noise                                       (2)
//! C = A cos 2 theta - B sin 2 theta,   D = A sin 2 theta + B cos 2 theta   (3)
//! ```
//!
//! The numbers are those of Mingazov & Shishakov 2021, DOI 10.22213/2410-9304-2021-3-12-24; they are used throughout.
//!
//! * [`Wave`] is the truth: the five parameters of (1)-(3), their rates, and the resonator's splits of damping and frequency.
//! * [`Flaws`] is everything between the resonator and the file: noise, offset, gain, skew, clipping, quantisation, lost
//!   samples and so on. Its documentation gives the order in which they act.
//! * [`Gyro`] is the stream of samples, an endless iterator of pairs [S_C, S_D]; [`Gyro::codes`] gives the ADC's integers.
//! * [`Deviates`] is noise alone: independent normal numbers, for what is simulated elsewhere.
//! * [`Bound`] is the Cramér-Rao bound: how well a window of the wave can be identified at all.
//!
//! # Reproducible
//! The same wave, flaws, rate and seed give the same bits on every platform: the generator is PCG64-DXSM, every
//! transcendental function is `libm`'s (the standard library's differ between platforms), and sample `k` is a function of
//! `k` alone, so skipping or losing samples changes none of the others.
//!
//! # Example
//! ```
//! use antinode_sim::{Flaws, Gyro, Wave};
//!
//! # fn main() -> Result<(), antinode_sim::Error> {
//! let flaws = Flaws { noise: 0.02, bits: Some(16), full_scale: 2.5, ..Flaws::default() };
//! let gyro = Gyro::new(Wave::default(), flaws, 100_000.0, 1)?;
//! let mean_square: f64 = gyro.take(150).map(|[c, d]| c * c + d * d).sum::<f64>() / 150.0;
//! // The sum of (22) in the paper: a_A^2 + a_B^2 = 2 <S_C^2 + S_D^2>
//! assert!((2.0 * mean_square - (2.0 * 2.0 + 0.1 * 0.1)).abs() < 0.05);
//! # Ok(())
//! # }
//! ```

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod adc;
mod bound;
mod carrier;
mod complex;
mod dropouts;
mod error;
mod flaws;
mod front;
mod gyro;
mod noise;
mod random;
mod spans;
mod split;
mod time;
mod timed;
mod wave;

pub use bound::Bound;
pub use error::Error;
pub use flaws::Flaws;
pub use gyro::{Codes, Gyro};
pub use noise::Deviates;
pub use random::random_wave;
pub use timed::{Channel, ClipSpan, Dropout, DropoutKind, Loss};
pub use wave::{Truth, Wave};
