#![doc = include_str!("../README.md")]
//!
//! # The wave
//!
//! ```text
//! τ = ωt − α,   A = a_A cos τ,   B = a_B sin τ                                (1), (11)
//! S_C = A cos 2θ − B sin 2θ + noise,   S_D = A sin 2θ + B cos 2θ + noise      (2), (3)
//! ```
//!
//! An [`Estimate`] has a_A, a_B, θ, ω and α of one window, the rates of θ and a_A, a standard deviation of each, and [`Flags`] for whatever
//! the model does not explain. Numbers in parentheses are formulas of R. I. Mingazov, K. V. Shishakov, DOI 10.22213/2410-9304-2021-3-12-24,
//! whose four algorithms are in [`methods`]; the identification itself is the exact counterpart of the fourth.
//!
//! | step | runs at | done by |
//! |---|---|---|
//! | the period is searched for, then samples are summed in blocks of up to two periods | sample rate | [`Front`], with [`period`] and [`block`] |
//! | a window of blocks is solved for its waves by exact least squares, and joined to those before | window rate | [`Tracker`] |
//! | both, with a new search when the wave is lost | | [`Identifier`] |
//!
//! [`Settings`] shows how a known frequency, overlapping windows, hum and pick-offs that differ are set; [`Identifier`] shows what to do
//! when samples are lost.
//!
//! # On a microcontroller
//!
//! Run a [`Front`] in the interrupt and a [`Tracker`] in the main loop, both with the same [`Settings`], and a queue of [`Block`]s between
//! them, here that of `heapless`. The number of the search whose blocks the tracker accepts goes the other way; it is incremented when the
//! wave is lost:
//!
//! ```
//! use core::sync::atomic::{AtomicU32, Ordering::{Acquire, Release}};
//!
//! use antinode::{Block, Front, Settings, Tracker};
//! use heapless::spsc::Queue;
//!
//! static WANTED: AtomicU32 = AtomicU32::new(0);
//!
//! let settings = Settings {
//!     rails: Some([-32768.0, 32767.0]),
//!     resolution: Some(1.0),
//!     ..Settings::new(100_000.0)
//! };
//! let mut front = Front::<i16, 200>::new(settings)?;
//! let mut tracker = Tracker::<16>::new(settings)?;
//! let mut queue = Queue::<Block<i16>, 8>::new();
//! let (mut blocks, mut gathered) = queue.split();
//!
//! // Whenever the DMA has filled half of its buffer.
//! // A timer's interrupt would `Front::push` each pair.
//! let mut interrupt = |pairs: &[[i16; 2]]| {
//!     front.search_if_wanted(WANTED.load(Acquire));
//!     front.extend(pairs, |block| {
//!         // A block that finds the queue full costs its window, no more:
//!         // the tracker sees that it is missing.
//!         let _ = blocks.enqueue(*block);
//!     });
//! };
//! # let mut estimates = Vec::new();
//! let mut main_loop = || {
//!     while let Some(block) = gathered.dequeue() {
//!         if let Some(estimate) = tracker.push(&block) {
//!             estimates.push(estimate);
//!         }
//!         WANTED.store(tracker.wanted_search(), Release);
//!     }
//! };
//!
//! # let signal = |k: usize| {
//! #     let (sine, cosine) = (core::f64::consts::TAU * 0.05332 * k as f64).sin_cos();
//! #     let (s2, c2) = 0.6f64.sin_cos();
//! #     [cosine * c2 - 0.1 * sine * s2, cosine * s2 + 0.1 * sine * c2].map(|x| (20_000.0 * x) as i16)
//! # };
//! for half in 0..10 {
//!     let codes: Vec<[i16; 2]> = (0..128).map(|i| signal(128 * half + i)).collect();
//!     interrupt(&codes);
//!     main_loop();
//! }
//! assert_eq!(estimates.len(), 6);
//! for estimate in estimates {
//!     assert!(estimate.flags.is_empty() && (estimate.main_amplitude - 20_000.0).abs() < 2.0);
//! }
//! # Ok::<(), antinode::SettingsError>(())
//! ```
//!
//! The queue must have room for all blocks of a slice, and for those that end while the main loop is busy; `Queue<_, 8>` holds seven. If it
//! has not, windows are missing without a flag: count the blocks that are dropped. At 18.75 samples a period 128 pairs end up to
//!
//! | periods a window | 10 | 4 | 2 |
//! |---|--:|--:|--:|
//! | blocks | 4 | 9 | 22 |
//! | blocks, with a hop | 7 | 16 | 32 |
//!
//! Report samples that the interrupt missed to [`Front::skip`], before the pairs that follow them. The calibration is changed by
//! [`Tracker::calibrate`] in the main loop alone, `hum` and `coloured` by [`Tracker::change`] there, other settings on both sides, in place
//! and in this order:
//!
//! 1. the main loop sees that there is room for step 3, and calls [`Tracker::change`],
//! 2. then [`Tracker::search`],
//! 3. sends the settings to the interrupt, by a queue say,
//! 4. and only then stores [`Tracker::wanted_search`], with `Release`;
//! 5. the interrupt loads that number, with `Acquire`, passes any settings received to [`Front::configure`], and only then calls
//!    [`Front::search_if_wanted`] with the number loaded. To load it later is safe only where the main loop cannot run between: not if the
//!    two are threads, or on two cores.
//!
//! The angle goes on; to begin anew with the start angle, call [`Tracker::configure`] instead of the first two. Blocks of the old settings
//! then bear an old search number, and the tracker leaves them out. In any other order some of them bear the new number, and give windows
//! with a wrong frequency or length without a flag.
//!
//! | bytes of RAM on a 32-bit core | `i16` | `f32` | `i32` |
//! |---|---|---|---|
//! | [`Front`], with `N` the most sample pairs of a block | 1680 + 8 `N` | 2760 + 8 `N` | 3000 + 8 `N` |
//! | [`Block`], each in the queue | 72 | 128 | 128 |
//! | [`Tracker`], with `BLOCKS` the length of its ring | 696 + 68 `BLOCKS` | the same | the same |
//!
//! On a Cortex-M4F [`Tracker::push`] takes 1.1 KB of stack, and 11 000 cycles where it completes a window of 10 periods of 18.75 samples:
//! five times as many for the first window of a wave, and seven times for each window of noise if the frequency is known. At 190 samples a
//! period it takes 2.5 times as many, and up to 15 and 50 times in these cases. [`Front::extend`] takes 0.4 KB of
//! stack. The repository's `firmware` is a whole program, with RTIC.
//!
//! Without a floating-point unit the search and the solution are many times dearer. On a Cortex-M0, in `i16`, a pair takes 3000 to 3900
//! instructions of the search in noise, and 230 once the period is known; a window of 10 periods takes 310 000. At 100 kS/s an RP2040 then
//! needs a known [frequency](Settings::frequency), and a [hop](Settings::hop) of 200 blocks or more, which leaves out most of the windows. The
//! C library's README lists the costs of the search for all cores.
//!
//! [`Front::UNSET`], [`Tracker::UNSET`] and [`Identifier::UNSET`] are all zeros: statics initialised with them, for example in a
//! `ConstStaticCell` of the crate `static_cell`, take neither flash nor stack; call `configure` before use. The result of
//! [`Identifier::new`] is copied: an identifier of 5 KB takes 16 KB of stack, and 1 KB more flash. On a Cortex-M0 `static_cell` needs the
//! feature `critical-section` of the crate `portable-atomic`.
//!
//! Settings checked in a constant, as [`Settings::check`] and [`Front::check`] show, are not refused later. Do not `unwrap` the result all
//! the same: the message of a [`SettingsError`] has numbers, and what prints them takes 30 KB of flash.
//!
//! `opt-level = 2` is as fast as 3 and smaller; if flash is short, `"z"` for the package `antinode` alone, in the profile of the program, takes
//! a seventh off an image for a Cortex-M0, and leaves the front, which is compiled in your crate, 15 % slower. On a Cortex-M4 give rustc
//! `-Ctarget-cpu=cortex-m4`: without it rustc mistakes three-cycle multiply-accumulates for single-cycle ones. With it the core is 2 KB larger.
//! Cargo does not take such flags from a dependency: they belong in your own `.cargo/config.toml`.
//!
//! # Features
//!
//! | feature | on by default | what it adds |
//! |---|---|---|
//! | `mean-return` | yes | the period detector of formula (9): `Detection::MeanReturn`, `period::MeanReturnDetector` |
//! | `fixed` | no | pairs of `I1F15` and `I1F31` of the crate `fixed`: [`SamplePair`] |
//! | `defmt` | no | `defmt::Format` of [`Estimate`], [`Flags`], [`Settings`], [`Calibration`], [`Detection`] and [`SettingsError`] |
//! | `serde` | no | `Serialize` and `Deserialize` of the same; flags as names in human-readable formats, as bits in others. JSON has no NaN: it is written as `null`, which is not read back |
//!
//! Firmware that needs none sets `default-features = false`. To send estimates and settings over a serial line use the crate
//! `antinode-telemetry`.
//!
//! # Accuracy
//!
//! | wave | error |
//! |---|---|
//! | noise-free, constant, \|a_B\| up to 0.5 a_A, 2 to 100 periods a window, 4.3 to 190 samples a period, any offset up to a_A | below 10⁻⁶ of a_A, 10⁻⁶ rad, 2·10⁻⁷ of f |
//! | the same, \|a_B\| up to 0.9 a_A | below 10⁻⁶ of a_A, 3·10⁻⁶ rad of θ, 6·10⁻⁶ rad of α, 6·10⁻⁷ of f |
//! | white noise of 0.1 to 20 % of a_A, 2 to 50 periods a window, from cold | rms 0.97 to 1.05 of the Cramér–Rao bound |
//! | turning at 6 rad/s, decaying with τ = 0.3 s, drifting 2 Hz/s, 0.2 % noise, 10 periods | rms 1.00 to 1.07 of the bound |
//!
//! Stated standard deviations are within 5 % of the scatter. They include the rounding of f32, up to 1.1·10⁻⁶ of a_A, and with f32 samples
//! up to 4·10⁻⁷ of larger offsets: with as little noise as that, they exceed the scatter, except where a period of many samples is a whole
//! number of them: rounding then repeats, and moves θ and α by up to 4 deviations. Rounding adds up to 1.3·10⁻⁵ of a_A, or 5·10⁻⁶ of a
//! larger offset, to `residual_rms`. The bound is that of seven constant parameters, offsets and frequency among them.
//!
//! In 60 000 streams of 3.0 million windows, whose waves, rates, noise, offsets, pick-offs, converters and settings were drawn at random, rms
//! errors were 0.99 of the deviations, no clean row was off by more than 6.3 of them, and four rows were flagged without a fault, all in
//! windows of 18 pairs in noise of 10 % and more. In 60 000 more with a fault halfway, clean rows that contain it were off by up to 20
//! deviations, those before and after by up to 6.3. Windows were of 3 to 250 periods of 5 to 100 samples, turns of up to 0.1 rad a window;
//! `coloured`, splits and drifts of the frequency were not drawn. f of a turning pattern counts from its fifth window on, and in streams
//! with a fault not at all. These numbers are asserted, with a margin, by the tests of `host-tests`: the last ones for 1500 streams each, in
//! `survey.rs`.
//!
//! # Limits
//!
//! θ is known modulo π/2, and continued from window to window. Deviations cover white noise, equal and independent in both pick-offs, and
//! the converter's steps; [`Settings::coloured`], [`Settings::hum`] and [`Settings::resolution`] are for what is otherwise. Within a window
//! the pattern may turn by 0.5 rad and the wave lose 0.6 of its amplitude. Nonlinear pick-offs, a limiter that leaves less than 10⁻³ of a_A
//! at the third harmonic, and tones within a beat a window of the frequency raise no flag.
//!
//! [`limits`] has the numbers: what each of these costs, in which windows, and where flags fail.
#![no_std]

#[cfg(test)]
extern crate std;

mod arch;
pub mod block;
/// What no flag shows, and what fast turns, hum, filters, coarse steps, clipping and tones cost, in numbers.
#[doc = ""]
#[doc = include_str!("../docs/limits.md")]
pub mod limits {}
pub mod methods;
pub mod period;
pub mod phase;
pub mod regrid;

mod calibration;
mod cut;
mod double;
mod estimate;
mod exponential;
mod front;
mod identifier;
mod sample;
mod scalar;
#[cfg(feature = "serde")]
mod serial;
mod settings;
mod sum;
mod tracker;
mod window;

#[doc(inline)]
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

// The sizes of the table above: to the byte on the cores that it is for, within 64 bytes where words are longer or aligned otherwise.
#[cfg(any(target_arch = "arm", test))]
const _: () = {
    const fn check<T>(stated: usize) {
        let difference = size_of::<T>().abs_diff(stated);
        assert!(difference < if cfg!(target_arch = "arm") { 1 } else { 64 });
    }
    check::<Front<i16, 200>>(1680 + 8 * 200);
    check::<Front<f32, 200>>(2760 + 8 * 200);
    check::<Front<i32, 200>>(3000 + 8 * 200);
    check::<Tracker<64>>(696 + 68 * 64);
    check::<Block<i16>>(72);
    check::<Block<f32>>(128);
    check::<Block<i32>>(128);
};
