//! All four methods beside the exact solution: their differences, whom to trust, and whether something is wrong.
//!
//! # Example
//!
//! ```
//! use antinode::methods::comparison::{Reference, Sums, compare};
//! use antinode::methods::{DelayedSums, Moments, Products, algorithm2};
//! use antinode::{Identifier, Settings};
//!
//! # let omega = core::f64::consts::TAU * 0.05332;
//! # let signal = |k: u32| {
//! #     let (sine, cosine) = (omega * f64::from(k)).sin_cos();
//! #     let (s2, c2) = 0.6f64.sin_cos();
//! #     // Noise of 0.3 %, rms.
//! #     let noise = |seed: u32| 1e-2 * (f64::from((k ^ seed).wrapping_mul(0x9e37_79b9).rotate_left(9).wrapping_mul(0x85eb_ca6b)) / 2f64.powi(32) - 0.5);
//! #     [cosine * c2 - 0.1 * sine * s2 + noise(1 << 20), cosine * s2 + 0.1 * sine * c2 + noise(1 << 24)].map(|x| x as f32)
//! # };
//! let sample_rate = 100_000.0;
//! let pairs: Vec<[f32; 2]> = (0..1000).map(signal).collect();
//! let mut identifier = Identifier::<f32, 200, 16>::new(Settings::new(sample_rate))?;
//! let mut estimates = Vec::new();
//! identifier.extend(&pairs, |estimate| estimates.push(estimate));
//! let estimate = estimates[1];
//!
//! // The window's samples, and as many before it as the delay is long.
//! let omega = core::f64::consts::TAU * estimate.frequency / sample_rate;
//! let lag = algorithm2::quarter_lag((sample_rate / estimate.frequency) as f32);
//! let (start, end) = (estimate.start as usize, estimate.end() as usize);
//! let mut delayed = DelayedSums::<50>::new(lag, estimate.offsets);
//! delayed.extend(&pairs[start - usize::from(lag)..end]);
//!
//! let centred: Vec<[f32; 2]> =
//!     pairs[start..end].iter().map(|[c, d]| [c - estimate.offsets[0], d - estimate.offsets[1]]).collect();
//! let sums = Sums {
//!     moments: Moments::of(&centred),
//!     delayed: delayed.take(),
//!     products: Products::of(&centred, omega),
//! };
//! assert_eq!(sums.delayed.count, estimate.samples);
//! let comparison = compare(&sums, &Reference::of(&estimate, sample_rate));
//! assert!(!comparison.disagree);
//! assert!(comparison.methods[1].conditions.of_the_method_hold());
//! # Ok::<(), antinode::SettingsError>(())
//! ```

use super::conditions::{self, OfDelay};
pub use super::conditions::{CONDITION, Conditions};
use super::delayed::Delayed;
use super::moments::Moments;
use super::products::{Products, mean_harmonic};
use super::wave::{Shape, Wave};
use super::{algorithm1, algorithm2, algorithm3, algorithm4, functional, phase};
use crate::estimate::Estimate;

/// Beyond this many deviations from what its own leakage and bias explain, a method tells of a fault.
///
/// In white noise of up to 20 % of a_A none of 176 000 windows of 2 to 50 periods reached it, with |a_B| up to 0.9 a_A.
pub const DISAGREEMENT: f64 = 6.0;

/// The place of algorithm 1.
const NO_QUADRATURE: usize = 0;
/// The place of algorithm 2.
const DELAY: usize = 1;
/// The place of algorithm 3.
const AXES: usize = 2;

/// The sums of one window, all of it centred, (4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sums {
    /// Second moments.
    pub moments: Moments,
    /// Delayed products, as many as the window has pairs: the first of them reach back to the pairs before it. The conditions (17) and
    /// (20) fail without reason where they are of other pairs.
    pub delayed: Delayed,
    /// Products with the reference, at the wave's frequency.
    pub products: Products,
}

/// White noise as a window's sums see it, input units squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// ⟨n_C²⟩, ⟨n_D²⟩ and ⟨n_C n_D⟩.
    pub moments: [f64; 3],
    /// ⟨n_D(t) n_D(t − t₃)⟩: 0, but where S_D was made from samples that lie t₃ apart.
    pub delayed: f64,
}

impl Noise {
    /// Noise of one variance on both pick-offs, independent from sample to sample: what a converter gives.
    pub fn alike(variance: f64) -> Self {
        Self {
            moments: [variance, variance, 0.0],
            delayed: 0.0,
        }
    }
}

/// The exact solution that the methods are held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The wave, its phase about the window's first sample.
    pub wave: Wave,
    /// Standard deviations of a_A and a_B, input units, and θ, rad; all > 0.
    pub deviations: [f64; 3],
    /// Noise of the samples that the sums were taken of.
    pub noise: Noise,
    /// Standard deviation of a noise variance, as a share of it.
    pub noise_uncertainty: f64,
    /// How far the pattern turns in the window, rad.
    pub turn: f64,
    /// The share of its amplitude that the wave loses in the window.
    pub decay: f64,
    /// Standard deviations of `turn` and `decay`: both are 0 where they are lost in these.
    pub change_deviations: [f64; 2],
}

impl Reference {
    /// The reference of an estimate at a sample rate in Hz, for sums of the samples as they came: a calibration that mixes or scales
    /// samples changes [`Noise`] too.
    pub fn of(estimate: &Estimate, sample_rate: f64) -> Self {
        let omega = core::f64::consts::TAU * estimate.frequency / sample_rate;
        let samples = f64::from(estimate.samples);
        let seconds = samples / sample_rate;
        // A rate that is lost in noise is none.
        let change = |rate: f32, deviation: f32| {
            let significant = rate.abs() > 3.0 * deviation;
            f64::from(if significant { rate } else { 0.0 }) * seconds
        };
        let deviations = [
            estimate.main_amplitude_std,
            estimate.quadrature_amplitude_std,
            estimate.angle_std,
        ];
        let noise = f64::from(estimate.residual_rms);
        // The core sees noise in three sums a block of each pick-off, less ten unknowns: blocks of two periods, five at the least.
        let blocks = (0.5 * samples * omega / core::f64::consts::TAU).max(5.0);
        Self {
            wave: Wave {
                shape: Shape {
                    main_amplitude: estimate.main_amplitude.into(),
                    quadrature_amplitude: estimate.quadrature_amplitude.into(),
                    angle: estimate.angle,
                },
                // The estimate's phase stands at the middle of the window.
                phase: f64::from(estimate.phase) + 0.5 * omega * (samples - 1.0),
            },
            deviations: deviations.map(|x| f64::from(x.max(f32::MIN_POSITIVE))),
            noise: Noise::alike(noise * noise),
            noise_uncertainty: libm::sqrt(2.0 / (6.0 * blocks - 10.0)),
            turn: change(estimate.angle_rate, estimate.angle_rate_std),
            decay: change(estimate.decay_rate, estimate.decay_rate_std),
            change_deviations: [estimate.angle_rate_std, estimate.decay_rate_std]
                .map(|deviation| f64::from(deviation) * seconds),
        }
    }
}

/// One method in a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// What it found.
    pub wave: Wave,
    /// J of (6) at the frequency of the sums' products, input units squared.
    pub j: f64,
    /// a_A, a_B and θ less those of the exact solution, in its standard deviations.
    pub differences: [f64; 3],
    /// What is left of them after what leakage and noise explain, in units of what may be left: beyond [`DISAGREEMENT`] the signal is not what the model says.
    pub unexplained: [f64; 3],
    /// Which of the paper's conditions hold to within the noise.
    pub conditions: Conditions,
    /// 1: to be trusted most. Methods whose own conditions hold come first, (8) being one for all; among equals the smaller J.
    pub rank: u8,
}

/// All methods of a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Algorithms 1 to 4; 2 with the fractional delay.
    pub methods: [Method; 4],
    /// Condition (8): |⟨e^{2jωt}⟩| over the window, 0 where it fits the period.
    pub leakage: f64,
    /// (17) at the whole-sample delay, as a share of ⟨S_C² + S_D²⟩: about cos ωt₃.
    pub imbalance: f64,
    /// (17) at the fractional delay of a quarter period, less what the exact solution expects, in its own deviations.
    pub imbalance_excess: f64,
    /// The monitor (20): Δφ_CD, rad.
    ///
    /// It is near 0 or π between the pick-offs' axes, passes ±π/2 on them, and tells of quadrature elsewhere.
    pub phase_difference: f64,
    /// (20) less the phase difference of the exact solution, in its own deviations.
    pub phase_excess: f64,
    /// True where methods part company beyond noise.
    pub disagree: bool,
}

fn waves(sums: &Sums) -> [Wave; 4] {
    let Sums {
        moments,
        delayed,
        products,
    } = sums;
    let q = delayed.quarter(moments, products.omega);
    [
        phase::align(&algorithm1::shape(moments), products),
        phase::align(&algorithm2::shape(moments, q), products),
        phase::align(&algorithm3::shape(moments, products.q()), products),
        algorithm4::wave(products),
    ]
}

/// What turning by `turn` rad, a loss of `decay`, and f32 rounding leave in a window's sums, as a share of them.
pub(super) fn slow(turn: f64, decay: f64, changing: f64) -> f64 {
    let (turn, decay) = (2.0 * turn, decay);
    // What leaks changes over the window at first order.
    (turn * turn + decay * decay) / 12.0 + changing * (turn.abs() + decay.abs()) + 1e-6
}

/// How much of a steady change leaks: as much as of what is constant, or |⟨t e^{2jωt}⟩| with t in windows from the middle, which does
/// not vanish where a window fits the period.
fn changing(leakage: f64, omega: f64, count: u32) -> f64 {
    let x = omega * f64::from(count);
    let (sine, cosine) = libm::sincos(x);
    leakage.max(0.5 * (cosine - sine / x).abs() / x)
}

/// By how much of itself a noise variance may be above what was found, in parts of [`DISAGREEMENT`]: the quantile that a chi-square of
/// such an uncertainty, 0.3 and less, is below in 1 of 300 000 windows, by Wilson and Hilferty.
fn above(uncertainty: f64) -> f64 {
    let third = uncertainty / 3.0;
    let least = (1.0 - third * (third + 4.5)).max(0.1);
    (1.0 / (least * least * least) - 1.0) / DISAGREEMENT
}

/// What `square` may be off by in its root, by `deviation` of its own, in parts of [`DISAGREEMENT`].
fn of_root(square: f64, deviation: f64) -> f64 {
    let most = DISAGREEMENT * deviation;
    let root = libm::sqrt(square);
    let below = root - libm::sqrt((square - most).max(0.0));
    below.max(libm::sqrt(square + most) - root) / DISAGREEMENT
}

/// What the method of this place may differ by without a fault, beside `explained`: the exact solution's own deviations, how little
/// the noise and its mean square over the window are known, and what turning, decay and f32 rounding leave.
///
/// `seen` is the a_A² − a_B² that the method has its angle from.
fn scatter(
    place: usize,
    explained: &Shape,
    seen: f64,
    reference: &Reference,
    count: u32,
    changing: f64,
    q_deviation: f64,
) -> [f64; 3] {
    let [of_c, of_d, _] = reference.noise.moments;
    let mean_square = libm::sqrt(2.0 / f64::from(count));
    let noise = of_c.max(of_d) * libm::hypot(above(reference.noise_uncertainty), mean_square);
    let size = reference.wave.shape.main_amplitude;
    let rest = slow(reference.turn, reference.decay, changing);
    let [a, b, angle] = reference.deviations;
    let quadrature = explained.quadrature_amplitude.abs().max(b);
    let sum = |x: f64, y: f64, z: f64| libm::sqrt(x * x + y * y + z * z);
    // What leaks of the exact solution's deviations.
    let leaks = 4.0 * changing * size * a;
    let of_angle = if place == NO_QUADRATURE {
        // (12) takes the angle from roots of mean squares, and one is all noise where a pick-off sees nothing else.
        let (sine, cosine) = libm::sincos(2.0 * explained.angle);
        let whole = core::f64::consts::FRAC_1_SQRT_2 * explained.main_amplitude;
        let root = |share: f64| of_root((share * whole) * (share * whole), noise);
        let roots = libm::hypot(cosine * root(sine), sine * root(cosine));
        sum(angle, 0.5 * roots / whole, rest)
    } else {
        let own = angle * difference(&reference.wave.shape);
        let deviation = libm::hypot(own, rest * size * size + leaks);
        // An angle that rests on less than that means nothing.
        deviation / (seen - DISAGREEMENT * deviation).max(0.0)
    };
    // (16) takes a_A − |a_B| from the root of a difference, which is small where the pattern is near a circle.
    let of_amplitudes = if place == DELAY {
        let root = explained.main_amplitude - explained.quadrature_amplitude.abs();
        let exact = size - reference.wave.shape.quadrature_amplitude.abs();
        let of_exact = 2.0 * exact * (a + b) + leaks;
        let deviation = sum(4.0 * noise, 4.0 * q_deviation, of_exact);
        0.5 * of_root(root * root, deviation)
    } else {
        0.0
    };
    // (22) adds the noise's square to a_B's: a small quadrature and a little excess make a large difference.
    [
        sum(libm::hypot(a, of_amplitudes), noise / size, rest * size),
        sum(
            libm::hypot(b, of_amplitudes),
            noise / quadrature,
            rest * size * (1.0 + rest * size / quadrature),
        ),
        of_angle,
    ]
}

/// a_A² − a_B², which the angle rests on.
fn difference(shape: &Shape) -> f64 {
    let (a, b) = (shape.main_amplitude, shape.quadrature_amplitude);
    a * a - b * b
}

fn apart(a: &Shape, b: &Shape, unit: &[f64; 3]) -> [f64; 3] {
    let turn = a.angle - b.angle;
    let quarter = core::f64::consts::FRAC_PI_2;
    [
        (a.main_amplitude - b.main_amplitude) / unit[0],
        (a.quadrature_amplitude - b.quadrature_amplitude) / unit[1],
        (turn - libm::round(turn / quarter) * quarter) / unit[2],
    ]
}

/// Compares the methods over one window. It costs some thousand f64 operations, at window rate.
pub fn compare(sums: &Sums, reference: &Reference) -> Comparison {
    let (omega, count) = (sums.products.omega, sums.products.count);
    let exact = &reference.wave;
    let noise = &reference.noise;
    let moments_of = |wave| Moments::expected(wave, omega, count, noise, reference.turn);
    let delayed_of = |wave| Delayed::expected(wave, omega, count, noise, sums.delayed.lag);
    let expected = waves(&Sums {
        moments: moments_of(exact),
        delayed: delayed_of(exact),
        products: Products::expected(exact, omega, count),
    });
    let [of_a, of_b, of_angle] = reference.deviations;
    let leakage = libm::sqrt(mean_harmonic(2, omega, count).norm_sqr());
    let imbalance = sums.delayed.imbalance(&sums.moments);
    let Shape {
        main_amplitude: a,
        quadrature_amplitude: b,
        ..
    } = exact.shape;
    let window = 0.5 * a * leakage < of_a.max(0.5 * a * of_angle);
    let changing = changing(leakage, omega, count);
    // Of the very samples: blocks that do not fit the period leave the estimate less exact.
    let fitted = super::exact::at(&sums.products, &sums.moments).wave;
    let OfDelay {
        excesses: [imbalance_excess, phase_excess],
        q_deviation,
    } = conditions::of_delay(
        sums,
        &moments_of(&fitted),
        &delayed_of(&fitted),
        reference,
        changing,
    );
    let conditions = |i: usize| Conditions {
        window,
        no_quadrature: i != NO_QUADRATURE || b.abs() < 2.0 * of_b,
        // Not a number fails.
        delay: i != DELAY || imbalance_excess.abs() <= CONDITION,
        monitor: i != DELAY || phase_excess.abs() <= CONDITION,
    };

    let found = waves(sums);
    let mut methods = core::array::from_fn(|i| {
        let wave = found.get(i).copied().unwrap_or(*exact);
        let explained = expected.get(i).copied().unwrap_or(*exact);
        let mut seen = wave.shape;
        if i == AXES {
            // (22) gives |a_B|: near zero its borrowed sign may be the other one in noise.
            let own = explained.shape.quadrature_amplitude;
            seen.quadrature_amplitude = libm::copysign(seen.quadrature_amplitude, own);
        }
        if i == NO_QUADRATURE {
            // So is the side of the pick-off's axis on which (12) sees the wave.
            seen.angle = libm::copysign(seen.angle, explained.shape.angle);
        }
        // 2 has its angle from the same sums as 3.
        let angle_of = expected.get(i.max(AXES)).copied().unwrap_or(*exact).shape;
        let unit = scatter(
            i,
            &explained.shape,
            difference(&angle_of),
            reference,
            count,
            changing,
            q_deviation,
        );
        Method {
            wave: wave.near(exact.shape.angle),
            j: functional::above_zero(functional::squares(&wave, &sums.moments, &sums.products)),
            differences: apart(&wave.shape, &exact.shape, &reference.deviations),
            unexplained: apart(&seen, &explained.shape, &unit),
            conditions: conditions(i),
            rank: 0,
        }
    });
    // A method that found nothing comes last.
    let j = |method: &Method| {
        if method.j.is_nan() {
            f64::INFINITY
        } else {
            method.j
        }
    };
    let key = |method: &Method| (!method.conditions.of_the_method_hold(), j(method));
    let keys = methods.map(|method| key(&method));
    for (i, method) in methods.iter_mut().enumerate() {
        let own = key(method);
        let before = |(j, key): &(usize, (bool, f64))| *key < own || *key == own && *j < i;
        method.rank = 1 + keys.iter().copied().enumerate().filter(before).count() as u8;
    }
    let beyond = |method: &Method| {
        let within = |x: &f64| x.abs() <= DISAGREEMENT;
        // Not a number is beyond.
        !method.unexplained.iter().all(within)
    };
    Comparison {
        disagree: methods.iter().any(beyond),
        methods,
        leakage,
        imbalance,
        imbalance_excess,
        phase_excess,
        phase_difference: algorithm2::phase_difference(
            &sums.moments,
            sums.delayed.quarter(&sums.moments, omega),
        ),
    }
}
