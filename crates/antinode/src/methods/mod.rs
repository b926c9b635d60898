//! The paper's four methods, each a pure function of a window's sums, and the functions and sums that they share.
//!
//! The paper advises running all four side by side, ranked, and showing the operator all of them, as they treat noise differently. If
//! they differ by more than noise explains, something is wrong. This module serves that purpose and the study of the paper; the
//! identification itself, [`Tracker`](crate::Tracker), uses none of it.
//!
//! | sums of a window | gathered by | work per sample pair | used by algorithms |
//! |---|---|---|---|
//! | [`Moments`]: ⟨S_C²⟩, ⟨S_D²⟩, ⟨S_C S_D⟩ | [`MomentSums`] | 3 products: of f32, each with a compensated addition of 4 operations; of codes, added exactly | 1, 2, 3 |
//! | [`Delayed`]: ⟨S_C(t) S_D(t − t₃)⟩ and (17) | [`DelayedSums`] | 3 again, two of them added together, and a delay line | 2, sign of 3 |
//! | [`Products`]: CC, CS, DC, DS of (14) | the [`block`](crate::block)s of the demodulator | nothing more | phases, 4 |
//! | [`Ratio`]: ⟨S_D/S_C⟩ of (13) | itself | one division | (13) only |
//!
//! Work at sample rate is in f32; the functions of a window's sums are in f64, because ⟨S_B²⟩ of (22) is a small difference of large
//! sums. Time, and so the phase α, counts from the window's first sample. Signals must be centred, (4).
//!
//! | step | formulas | where |
//! |---|---|---|
//! | algorithm 1, no quadrature | (12), (13) | [`algorithm1`] |
//! | algorithm 2, phase shift | (16), (17), (20) | [`algorithm2`] |
//! | algorithm 3, wave axes | (21), (22) | [`algorithm3`] |
//! | algorithm 4, demodulation | (24), (25) | [`algorithm4`] |
//! | phase and its half periods | (5), (14), (18), (19) | [`phase`] |
//! | functionals | (6), (15), (23) | [`functional`] |
//! | J → min(ω) | | [`frequency`] |
//! | the exact solution, to compare with | (6) without (8) | [`exact`] |
//! | all side by side, ranked | | [`comparison`] |
//!
//! Formula numbers: R. I. Mingazov, K. V. Shishakov, 2021, DOI 10.22213/2410-9304-2021-3-12-24, with these errata: (12) takes its sign
//! from ⟨S_C S_D⟩; the arguments in (14) and (18) are τ = ωt − α; in (16) a_B = (F − E)/2; in (22) a_B has the sign of Q in
//! (24), or of −q in (16); (25) needs cos 2Φ too; every arctangent is of two sums, so that the quadrant is right.
//!
//! # Example
//!
//! ```
//! use antinode::methods::{Moments, Products, algorithm3, algorithm4, phase};
//!
//! // Four periods of 18.75 samples: 75 sample pairs, where the grid fits.
//! let omega = core::f64::consts::TAU / 18.75;
//! let pairs: Vec<[f32; 2]> = (0..75)
//!     .map(|k| {
//!         let (sine, cosine) = (omega * f64::from(k) - 0.5).sin_cos();
//!         let (s2, c2) = 0.6f64.sin_cos();
//!         [cosine * c2 - 0.1 * sine * s2, cosine * s2 + 0.1 * sine * c2].map(|x| x as f32)
//!     })
//!     .collect();
//! let products = Products::of(&pairs, omega);
//! let by_demodulation = algorithm4::wave(&products);
//! let by_axes = phase::align(&algorithm3::shape(&Moments::of(&pairs), products.q()), &products);
//! for wave in [by_demodulation, by_axes] {
//!     assert!((wave.shape.main_amplitude - 1.0).abs() < 1e-6);
//!     assert!((wave.shape.quadrature_amplitude - 0.1).abs() < 1e-6);
//!     assert!((wave.shape.angle - 0.3).abs() < 1e-6);
//!     assert!((wave.phase - 0.5).abs() < 1e-6);
//! }
//! ```

pub mod algorithm1;
pub mod algorithm2;
pub mod algorithm3;
pub mod algorithm4;
pub mod comparison;
pub mod exact;
pub mod frequency;
pub mod functional;
pub mod phase;

mod conditions;
mod delayed;
mod expected;
mod moments;
mod products;
mod ratio;
mod reference;
mod scatter;
mod wave;

pub use delayed::{Delayed, DelayedSums};
pub use moments::{MomentSums, Moments};
pub use products::Products;
pub use ratio::Ratio;
pub use wave::{Shape, Wave};
