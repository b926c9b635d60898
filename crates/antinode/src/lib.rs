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
//! use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
//!
//! use antinode::{Block, Front, Settings, Tracker};
//! use heapless::spsc::Queue;
//!
//! static WANTED: AtomicU32 = AtomicU32::new(0);
//!
//! let settings = Settings { rails: Some([-32768.0, 32767.0]), resolution: Some(1.0), ..Settings::new(100_000.0) };
//! let mut front = Front::<i16, 200>::new(settings)?;
//! let mut tracker = Tracker::<16>::new(settings)?;
//! let mut queue = Queue::<Block<i16>, 8>::new();
//! let (mut blocks, mut gathered) = queue.split();
//!
//! // Whenever the DMA has filled half of its buffer. A timer's interrupt would `Front::push` each pair.
//! let mut interrupt = |pairs: &[[i16; 2]]| {
//!     front.search_if_wanted(WANTED.load(Relaxed));
//!     front.extend(pairs, |block| {
//!         // A block that finds the queue full costs its window, no more: the tracker sees that it is missing.
//!         let _ = blocks.enqueue(*block);
//!     });
//! };
//! # let mut estimates = Vec::new();
//! let mut main_loop = || {
//!     while let Some(block) = gathered.dequeue() {
//!         if let Some(estimate) = tracker.push(&block) {
//!             estimates.push(estimate);
//!         }
//!         WANTED.store(tracker.wanted_search(), Relaxed);
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
//! Calibration and settings are changed in place: the calibration by [`Tracker::calibrate`] in the main loop alone, settings on both sides,
//! in this order:
//!
//! 1. the main loop calls [`Tracker::configure`],
//! 2. sends the settings to the interrupt, by a queue say,
//! 3. and only then stores [`Tracker::wanted_search`];
//! 4. the interrupt passes any settings received to [`Front::configure`], and only then calls [`Front::search_if_wanted`].
//!
//! Blocks of the old settings then bear an old search number, and the tracker leaves them out. In any other order some of them bear the new
//! number, and give windows with a wrong frequency or length without a flag. Report samples that the interrupt missed to [`Front::skip`].
//!
//! | bytes of RAM on a 32-bit core | `i16` | `f32` | `i32` |
//! |---|---|---|---|
//! | [`Front`], with `N` the most sample pairs of a block | 1680 + 8 `N` | 2760 + 8 `N` | 3000 + 8 `N` |
//! | [`Block`], each in the queue | 72 | 128 | 128 |
//! | [`Tracker`], with `BLOCKS` the length of its ring | 696 + 68 `BLOCKS` | the same | the same |
//!
//! [`Front::UNSET`], [`Tracker::UNSET`] and [`Identifier::UNSET`] are all zeros: statics initialised with them, for example in a
//! `ConstStaticCell` of the crate `static_cell`, take neither flash nor stack; call `configure` before use. The result of
//! [`Identifier::new`] is copied: an identifier of 5 KB takes 16 KB of stack, and 1 KB more flash.
//!
//! `opt-level = 2` is as fast as 3 and smaller. On a Cortex-M4 give rustc `-Ctarget-cpu=cortex-m4`: without it rustc mistakes three-cycle
//! multiply-accumulates for single-cycle ones. With it the core is 2 KB larger. Cargo does not take such flags from a dependency: they
//! belong in your own `.cargo/config.toml`.
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
//! | the same, \|a_B\| up to 0.9 a_A | below 10⁻⁶ of a_A, 10⁻⁶ rad, 6·10⁻⁷ of f |
//! | white noise of 0.1 to 20 % of a_A, 2 to 50 periods a window, from cold | rms 0.97 to 1.05 of the Cramér–Rao bound |
//! | turning at 6 rad/s, decaying with τ = 0.3 s, drifting 2 Hz/s, 0.2 % noise, 10 periods | rms 1.00 to 1.07 of the bound |
//!
//! Stated standard deviations are within 5 % of the scatter. They include the rounding of f32, up to 10⁻⁷ of a_A, and with f32 samples up
//! to 10⁻⁷ of the offsets: in long windows with as little noise as that, they exceed the scatter. Rounding adds up to 2·10⁻⁶ of a_A to
//! `residual_rms` at 190 samples a period. The bound is that of seven constant parameters, offsets and frequency among them. The errors and
//! deviations are asserted, with a margin, by the tests of `host-tests`.
//!
//! # Limits
//!
//! ## The signal
//!
//! - θ is known modulo π/2, and phase modulo 2π: θ is unwrapped only by continuity from window to window. If a pattern turns by a quarter
//!   turn more or less during a gap than its rate predicts, and has its old rate again after the gap, nothing shows this.
//! - A period must have 4 to 200 samples, or, with [`Settings::frequency`], 2.5 to as many as a block holds.
//! - Amplitudes must be 10⁻¹⁵ to 10¹⁷ input units, and samples of f32 within ±1.5·10¹⁷, so that sums of their squares fit in f32; in
//!   windows of more than 10⁴ pairs they must be smaller, by the root of that, as 10¹⁶ in those of 10⁶. Beyond that there may be no
//!   estimate, and no flag.
//! - Sums of f32 are rounded: at 140 samples a period or more, in noise below 2·10⁻⁴ of a_A, an offset beyond twenty times a_A in windows
//!   of hundreds of periods, or forty in shorter ones, may be flagged as a misfit. With codes it is not, nor with f32 samples whose offset
//!   is subtracted first.
//!
//! ## Waves that change
//!
//! - Within one window the pattern may turn by 0.5 rad and the wave lose 0.6 of its amplitude: that is 260 rad/s and 480 1/s in ten periods
//!   of 5332 Hz, 2.6 rad/s and 4.8 1/s in a thousand. So fast a turn leaves up to 3·10⁻⁵ of a_A unexplained in windows of ten periods,
//!   which matters in noise of 2·10⁻⁴ of a_A and less, or 5·10⁻⁴ at 150 samples a period: a_A, a_B, θ and phase are then off by up to 6 of
//!   their deviations in noise of 10⁻⁴, 16 in noise of 2·10⁻⁵, and 30 without noise, with no flag. If the pattern turns by more than about
//!   0.6 rad, or 1 rad with little quadrature, amplitudes may be up to a quarter off; in noise of up to 1 % windows of ten periods and more
//!   flag this as a misfit, but shorter ones may not, nor any in noise of 10 %.
//! - If pick-offs differ in gain, and so in noise after calibration, deviations are those of a pattern at rest. Over all angles they hold,
//!   but at the worst angle a pattern that turns by 0.1, 0.25 and 0.5 rad within a window has errors of up to 1.3, 1.9 and 2.7 of its
//!   deviations at a gain ratio of 10 or 0.1, and of up to 1.3 at 0.5 rad and a ratio of 2 or 0.5.
//! - A frequency that drifts or depends on the amplitude bends the phase within a window; splits of damping and frequency bend amplitudes
//!   and θ too. If this is well above both the noise (2 Hz/s in a window of 60 ms, say) and 2·10⁻⁴ of a_A, it is flagged as a misfit. If
//!   not, nothing is flagged, and values are off by up to 11 of their deviations in windows of up to 20 periods, by up to 15 in those of up
//!   to 100, and by up to 30 in longer ones: the phase by 6·10⁻⁵ rad in noise of 10⁻⁴ of a_A, and by 4·10⁻⁴ rad in noise of 10⁻³. Use
//!   shorter windows.
//! - A turning pattern looks like a frequency off by 2 a_A a_B θ̇/(π(a_A² + a_B²)), which is corrected with the θ̇ of the windows before.
//!   If θ̇ jumps, as splits make it do near a circle, f may be off, by 20 deviations at |a_B| of 0.94 a_A in windows of 100 periods. If the
//!   pattern vibrates, the deviations of f allow for it after some ten windows, or forty if a hop leaves gaps. Until then the pattern is
//!   taken to turn steadily. If its turn per window grows by 0.01 rad from window to window, f is off in the second and third window by up
//!   to 8 and 20 deviations at |a_B| of 0.9 a_A, or, if windows overlap, by up to 35 in the windows of that time. If a pattern swings to
//!   and fro during the gaps, f is off by up to 8, 18 and 45 deviations at 0.5, 0.75 and 0.9 a_A.
//! - Splits of 2 Hz and more make a pattern near a circle turn and slip in phase within a window or two: there one window in ninety is
//!   flagged as a phase jump though no sample is missing, and at such windows, as at misfits, the continued angle may come to be a quarter
//!   turn off.
//!
//! ## Noise
//!
//! - Mains hum is flagged as a misfit unless [`Settings::hum`] takes it out. If fewer than 13 blocks fit in a period of the hum, as at 150
//!   Hz beside a wave of 2 kHz, part of it counts as noise, and rms errors are up to 5 of their deviations. Hum of more than a hundred
//!   times the noise leaves something in any case: beside a wave of 5.3 kHz, hum of 0.3 a_A in noise of 10⁻³ of a_A makes one window of 30
//!   periods in 300 a misfit at 50 Hz, and one of 50 periods in 40 and of 100 in three at 150 Hz; in noise of 3·10⁻⁴ it is up to half of
//!   those of 50, and part of it counts as noise.
//! - Deviations and flags take noise to be white; [`Settings::coloured`] is for noise that is not. With it, errors are 0.8 to 1.1 of their
//!   deviations behind a low-pass or a high-pass, or in noise of 1/f². Behind a band-pass about the wave with a quality of 1, 3 and 10 they
//!   are 1.1, 1.5 and 2 to 3 of their deviations in windows of ten periods or more, up to 1.3, 1.9 and 4 in those of 6 to 9 periods, 1.8,
//!   3.3 and 7 in those of 3 to 5, and 2.3, 4.5 and 9 in those of two. If a hop makes blocks shorter they are 1.2, 1.8 and 3 to 3.7 in the
//!   longest and up to 2.9, 6 and 12 in the shortest. If noise grows with frequency, some windows remain misfits, as does a fifth of long
//!   windows with a hop behind a band-pass with a quality of 10.
//! - A window of a few samples estimates its noise poorly. If it has six pairs, as two periods of 2.5 to 3.2 samples do, rms errors of the
//!   first window are 2 to 5 of its deviations, and one error in ten exceeds three; rms errors of the second are 1.4, of the third 1.2;
//!   with seven pairs these three are 1.4, 1.15 and 1.1. With eight, nine and ten pairs rms errors of the first are 1.25, 1.15 and 1.15 of
//!   its deviations, and in longer windows up to 1.1, or 1.13 with hum or coloured noise. In noise alone, one wave in seventy has a step or
//!   a misfit flagged in its first windows if they have six pairs, and one in two thousand with ten; if a period has nearly six samples, so
//!   that the third harmonic is at half the sample rate, one in 400 has a misfit or clipping flagged in its first window of 25 to 60 pairs.
//! - If noise is so loud that it alone makes some windows circular, the others are a selection. If two in five are flagged, as in noise of
//!   20 % in nine pairs, a_A of the others is too large by 0.4 of its deviation, and rms errors are up to 1.2 deviations; if nine in ten
//!   are, these are 1 and 1.4.
//! - In noise of less than 0.4 of the converter's step, rounding errors repeat with the wave. If the step is known
//!   ([`Settings::resolution`]), nothing is flagged, and rms errors of a_A, a_B, θ and phase are at most 1.2 of their deviations, but may
//!   be as small as 0.7, 0.5 and 0.4 of them at noise of 0.3, 0.2 and 0.1 of a step, or 0.2 if the wave has only eight codes. These are rms
//!   over waves: those of a steady wave are nearly the same in every window, and in noise of up to 0.1 of a step one wave in 300 of 8 to 32
//!   codes is off by more than 2 deviations in all of them, by 4.8 in the worst case that a search found. If the step is not known, they
//!   are up to 1.2, 2 and hundreds of deviations if a period is a whole number of samples, and 1.1, 1.5 and 2.4 otherwise; in the first
//!   case one window in twenty is flagged as clipped or as a misfit at 0.1, and up to nine in ten without noise.
//! - Deviations and flags also assume noise that is independent and equal in both pick-offs. If one has ten times as much, about one window
//!   in ten thousand is flagged. If a share r of the variance is common to both, deviations are up to √(1 + r) times too small: at an angle
//!   of 22.5° those of a_A, f and phase, at −22.5° those of a_B and θ.
//! - White jitter of the sampling, common to both pick-offs, makes f and phase scatter by 1.8 of their deviations, but θ and a_B by only 2
//!   and 1 times |a_B|/a_A of theirs, if that is small. A sampling clock that wanders moves phase and frequency: 1/f jitter of 0.1 to 3 ns
//!   moves them by up to 78 and 37 of their deviations in windows of up to 1000 periods, and one row in twenty is flagged.
//!
//! ## What raises no flag
//!
//! - Deviations cover noise and the converter's steps, assumed equal in size. They do not cover nonlinearity of pick-offs and converter,
//!   and a third harmonic below 10⁻³ of a_A raises no flag: a cubic of that size may move a_A by 0.4 %, θ by 5·10⁻⁴ rad and, with |a_B| of
//!   0.4 a_A, a_B by 10⁻³ of a_A and phase by 7·10⁻⁴ rad. In windows of 5 periods at fewer than 5 samples a period, a third harmonic of
//!   several per cent may raise none, if noise is added after a limiter. A second harmonic of 10⁻² of a_A raises none either if a period is
//!   not a whole number of samples, and leaks up to 7·10⁻² of itself into a_A, a_B, θ and phase in windows of 10 periods, 1.6·10⁻² in those
//!   of 50. If a period is a whole number of samples, 1.6·10⁻³ of it leaks.
//! - Samples at known rails ([`Settings::rails`]) are always flagged. Where no rails are known, or a limiter lies within them, clipping is
//!   recognised by flat crests or the third harmonic: at 4.35 samples a period or more, in windows of 10 periods and noise of 10⁻³ of a_A,
//!   19 in 20 windows or more of a wave that would exceed the limit by a fifth are flagged. If by a tenth, two in three or more are, but
//!   hardly any near 5.1 samples, where other harmonics fold onto the third; if by a twentieth, as many at 6.3 to 9.5 samples and from 10.5
//!   on, and elsewhere none at some periods. The others' a_A is up to 4 %, 3.5 % and 2 % off. At fewer samples this depends on the period:
//!   at some from 2.6 to 3.2 and from 3.7 to 4.25 half of the windows are flagged or fewer, and none at 3 and 4, though a_A is up to 17 %
//!   off if the limit is exceeded by a fifth, and up to 50 % if twofold. Windows of 50 periods miss it within 0.03 of 3 and of 4 only. Shorter
//!   windows need more samples a period: those of 5 and 7 periods 5, of 4 periods 8, of 3 periods 10.5, of two 14. At fewer, nearly all may
//!   be without a flag, and a_A is up to 10, 25 and 42 % off if the limit is exceeded by a fifth, a half and twofold.
//! - A fault that repeats with the wave, such as a stuck bit of the converter, is flagged where it begins, but may soon be taken for a new
//!   noise level: with a bit worth a twelfth of a_A, two in three or more of the windows of 10 periods that follow have no flag, and a_A is
//!   up to 1.7 % off, 12 of its deviations. With a sixth of a_A it is one in three, 4.4 %, 21 deviations; with a third, one in ten, 7.5 %,
//!   36; with 0.6, every window is flagged.
//! - A tone less than one beat a window away from f, or from a multiple of the sample rate less or more f, is part of the wave: half of
//!   such windows have no flag, and values are off by as much as the tone. A tone elsewhere raises deviations or flags, but leaks a little:
//!   - Blocks of two periods, those of windows of 8 periods and more without a hop, hardly see a tone within 0.08 f of f/2 and 3f/2. Up to
//!     13 % of it leak into a_A, a_B, θ and phase, without a flag in three windows of four or more: that is up to 60 of their
//!     deviations for a tone of 2·10⁻² of a_A in noise of 10⁻⁴. With a hop, such a tone is flagged or within the deviations.
//!   - With [`Settings::coloured`], windows of 6 to 9 periods without a hop do not flag a tone between 0.2 f and 0.42 f either: up to 0.3
//!     of it leaks, up to 100 deviations.
//!   - Of a tone near 2f up to 8 % leak, 20 deviations. In windows of 5 periods one of 2·10⁻² of a_A near 3f may raise no flag, and moves
//!     values by up to 22.
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
