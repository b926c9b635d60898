//! All four methods beside the exact solution: their differences, whom to trust, and whether something is wrong.

use super::delayed::Delayed;
use super::moments::Moments;
use super::products::{Products, mean_harmonic};
use super::wave::{Shape, Wave};
use super::{algorithm1, algorithm2, algorithm3, algorithm4, functional, phase};
use crate::estimate::Estimate;

/// Beyond this many deviations from what its own leakage and bias explain, a method tells of a fault.
///
/// In white noise of up to 20 % of a_A none of 76 000 windows of 2 to 50 periods reached it.
pub const DISAGREEMENT: f64 = 6.0;

/// The place of algorithm 1.
const NO_QUADRATURE: usize = 0;
/// The place of algorithm 3.
const AXES: usize = 2;

/// The sums of one window, all of it centred, (4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sums {
    /// Second moments.
    pub moments: Moments,
    /// Delayed products.
    pub delayed: Delayed,
    /// Products with the reference, at the wave's frequency.
    pub products: Products,
}

/// The exact solution that the methods are held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The wave, its phase about the window's first sample.
    pub wave: Wave,
    /// Standard deviations of a_A and a_B, input units, and θ, rad; all > 0.
    pub deviations: [f64; 3],
    /// Noise variance a sample and channel, input units squared.
    pub noise: f64,
    /// Standard deviation of `noise`, as a share of it.
    pub noise_uncertainty: f64,
    /// How far the pattern turns in the window, rad.
    pub turn: f64,
    /// The share of its amplitude that the wave loses in the window.
    pub decay: f64,
}

impl Reference {
    /// The reference of an estimate at a sample rate in Hz.
    pub fn of(estimate: &Estimate, sample_rate: f64) -> Self {
        let omega = core::f64::consts::TAU * estimate.frequency / sample_rate;
        let samples = f64::from(estimate.samples);
        // A rate that is lost in noise is none.
        let change = |rate: f32, deviation: f32| {
            if rate.abs() > 3.0 * deviation {
                f64::from(rate) * samples / sample_rate
            } else {
                0.0
            }
        };
        let deviations = [
            estimate.main_amplitude_std,
            estimate.quadrature_amplitude_std,
            estimate.angle_std,
        ];
        let noise = f64::from(estimate.residual_rms);
        // The core sees noise in three sums a block, ten blocks a window at the least, less ten unknowns.
        let blocks = (samples * omega / core::f64::consts::TAU).max(10.0);
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
            noise: noise * noise,
            noise_uncertainty: libm::sqrt(2.0 / (6.0 * blocks - 10.0)),
            turn: change(estimate.angle_rate, estimate.angle_rate_std),
            decay: change(estimate.decay_rate, estimate.decay_rate_std),
        }
    }
}

/// One method in a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// What it found.
    pub wave: Wave,
    /// J of (6), input units squared.
    pub j: f64,
    /// a_A, a_B and θ less those of the exact solution, in its standard deviations.
    pub differences: [f64; 3],
    /// What is left of them after what leakage and noise explain, in units of what may be left: beyond [`DISAGREEMENT`] the signal is not what the model says.
    pub unexplained: [f64; 3],
    /// False where a condition of the paper for this method does not hold to within the noise.
    pub conditions_hold: bool,
    /// 1: to be trusted most. Methods whose conditions hold come first, and among equals the smaller J.
    pub rank: u8,
}

/// All methods of a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Algorithms 1 to 4; 2 with the fractional delay.
    pub methods: [Method; 4],
    /// Condition (8): |⟨e^{2jωt}⟩| over the window, 0 where it fits the period.
    pub leakage: f64,
    /// (17): how far the whole-sample delay is from a quarter period, about cos ωt₃.
    pub imbalance: f64,
    /// The monitor (20): Δφ_CD, rad.
    pub phase_difference: f64,
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

/// What the methods may differ by without a fault, beside `explained`: the exact solution's own deviations, how little the noise and
/// its mean square over the window are known, and what turning, decay and f32 rounding leave.
fn scatter(explained: &Shape, reference: &Reference, count: u32, leakage: f64) -> [f64; 3] {
    let square = reference.noise_uncertainty * reference.noise_uncertainty + 2.0 / f64::from(count);
    let noise = reference.noise * libm::sqrt(square);
    let size = reference.wave.shape.main_amplitude;
    let slow = (4.0 * reference.turn * reference.turn + reference.decay * reference.decay) / 12.0;
    // What leaks changes over the window at first order.
    let leaking = leakage * (2.0 * reference.turn.abs() + reference.decay.abs());
    let rest = slow + leaking + 1e-6;
    let [a, b, angle] = reference.deviations;
    let quadrature = explained.quadrature_amplitude.abs().max(b);
    let sum = |x: f64, y: f64, z: f64| libm::sqrt(x * x + y * y + z * z);
    // (22) adds the noise's square to a_B's: a small quadrature and a little excess make a large difference.
    [
        sum(a, noise / size, rest * size),
        sum(
            b,
            noise / quadrature,
            rest * size * (1.0 + rest * size / quadrature),
        ),
        sum(angle, 0.0, rest),
    ]
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
    let expected = waves(&Sums {
        moments: Moments::expected(exact, omega, count, reference.noise, reference.turn),
        delayed: Delayed::expected(exact, omega, count, sums.delayed.lag),
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
    // (8) for all; (12) leaves quadrature out.
    let fits = 0.5 * a * leakage < of_a.max(0.5 * a * of_angle);
    let pure = b.abs() < 2.0 * of_b;
    let holds = [fits && pure, fits, fits, fits];

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
        let unit = scatter(&explained.shape, reference, count, leakage);
        Method {
            wave: wave.near(exact.shape.angle),
            j: functional::squares(&wave, &sums.moments, &sums.products).max(0.0),
            differences: apart(&wave.shape, &exact.shape, &reference.deviations),
            unexplained: apart(&seen, &explained.shape, &unit),
            conditions_hold: holds.get(i).copied().unwrap_or(false),
            rank: 0,
        }
    });
    let keys = methods.map(|method: Method| (!method.conditions_hold, method.j));
    for (i, method) in methods.iter_mut().enumerate() {
        let own = (!method.conditions_hold, method.j);
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
        phase_difference: algorithm2::phase_difference(
            &sums.moments,
            sums.delayed.quarter(&sums.moments, omega),
        ),
    }
}
