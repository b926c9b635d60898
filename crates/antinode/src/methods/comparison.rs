//! All four methods beside the exact solution: their differences, their ranks, and whether a fault shows.
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
pub use super::reference::{Noise, Reference};
use super::scatter::{Scatter, changing, difference};
use super::wave::{Shape, Wave};
use super::{algorithm1, algorithm2, algorithm3, algorithm4, functional, phase};

/// Limit of a method's unexplained differences, in deviations: beyond it a method shows a fault of the signal.
///
/// In white noise of up to 20 % of a_A none of 176 000 windows of 2 to 50 periods reached it, with |a_B| up to 0.9 a_A.
pub const DISAGREEMENT: f64 = 6.0;

/// Index of algorithm 1.
pub(super) const NO_QUADRATURE: usize = 0;
/// Index of algorithm 2.
pub(super) const DELAY: usize = 1;
/// Index of algorithm 3.
const AXES: usize = 2;

/// Sums over one window of centred samples, (4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sums {
    /// Second moments.
    pub moments: Moments,
    /// Delayed products, as many as the window has pairs: the first of them reach back to the pairs before the window. With products of
    /// other pairs, the conditions (17) and (20) fail without reason.
    pub delayed: Delayed,
    /// Products with the reference, at the wave's frequency.
    pub products: Products,
}

/// Result of one method in a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// The wave it found, its angle near that of the exact solution.
    pub wave: Wave,
    /// J of (6) at the frequency of the sums' products, input units squared.
    pub j: f64,
    /// a_A, a_B and θ less those of the exact solution, in the latter's standard deviations.
    pub differences: [f64; 3],
    /// a_A, a_B and θ less what leakage and noise predict, in deviations: beyond [`DISAGREEMENT`] the model does not fit the signal.
    pub unexplained: [f64; 3],
    /// Which of the paper's conditions hold within the noise.
    pub conditions: Conditions,
    /// Rank from 1, to be trusted most, to 4. Methods whose own conditions hold, (8) not counted, come first; then the smaller J decides.
    pub rank: u8,
}

/// Results of all methods in a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Algorithms 1 to 4; algorithm 2 with the fractional delay.
    pub methods: [Method; 4],
    /// Condition (8): |⟨e^{2jωt}⟩| over the window, 0 if the window fits the period.
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
    /// True if a method differs beyond [`DISAGREEMENT`] from what is expected of it.
    pub disagree: bool,
}

/// The waves of algorithms 1 to 4.
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

/// a_A, a_B and θ of `a` less those of `b`, in multiples of `unit`; angles modulo π/2.
fn apart(a: &Shape, b: &Shape, unit: &[f64; 3]) -> [f64; 3] {
    let turn = a.angle - b.angle;
    let quarter = core::f64::consts::FRAC_PI_2;
    [
        (a.main_amplitude - b.main_amplitude) / unit[0],
        (a.quadrature_amplitude - b.quadrature_amplitude) / unit[1],
        (turn - libm::round(turn / quarter) * quarter) / unit[2],
    ]
}

/// Compares the methods over one window, at a cost of some thousand f64 operations.
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
    // Fitted to these very samples: if blocks do not fit the period, the estimate is less exact.
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
        // NaN fails.
        delay: i != DELAY || imbalance_excess.abs() <= CONDITION,
        monitor: i != DELAY || phase_excess.abs() <= CONDITION,
    };

    let scatter = Scatter {
        reference,
        count,
        changing,
        q_deviation,
    };
    let found = waves(sums);
    let mut methods = core::array::from_fn(|i| {
        let wave = found.get(i).copied().unwrap_or(*exact);
        let explained = expected.get(i).copied().unwrap_or(*exact);
        let mut seen = wave.shape;
        if i == AXES {
            // (22) gives |a_B|: near zero, noise may invert the sign that it borrows.
            let own = explained.shape.quadrature_amplitude;
            seen.quadrature_amplitude = libm::copysign(seen.quadrature_amplitude, own);
        }
        if i == NO_QUADRATURE {
            // Noise may also invert the sign of the angle of (12), which is that of ⟨S_C S_D⟩.
            seen.angle = libm::copysign(seen.angle, explained.shape.angle);
        }
        // Algorithm 2 has its angle from the same sums as algorithm 3.
        let angle_of = expected.get(i.max(AXES)).copied().unwrap_or(*exact).shape;
        let unit = scatter.of(i, &explained.shape, difference(&angle_of));
        Method {
            wave: wave.near(exact.shape.angle),
            j: functional::above_zero(functional::squares(&wave, &sums.moments, &sums.products)),
            differences: apart(&wave.shape, &exact.shape, &reference.deviations),
            unexplained: apart(&seen, &explained.shape, &unit),
            conditions: conditions(i),
            rank: 0,
        }
    });
    rank(&mut methods);
    let is_faulty = |method: &Method| {
        let within = |x: &f64| x.abs() <= DISAGREEMENT;
        // NaN is beyond it.
        !method.unexplained.iter().all(within)
    };
    Comparison {
        disagree: methods.iter().any(is_faulty),
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

/// Ranks methods: those whose own conditions hold come first, then the smaller J, then the lower number.
fn rank(methods: &mut [Method; 4]) {
    let keys = methods.map(|method| {
        // A method that found nothing comes last.
        let j = if method.j.is_nan() {
            f64::INFINITY
        } else {
            method.j
        };
        (!method.conditions.of_the_method_hold(), j)
    });
    for (i, (method, own)) in methods.iter_mut().zip(keys).enumerate() {
        let before = |&(place, key): &(usize, (bool, f64))| key < own || key == own && place < i;
        method.rank = 1 + keys.iter().copied().enumerate().filter(before).count() as u8;
    }
}
