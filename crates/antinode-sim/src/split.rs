//! A wave on a resonator with two modes that differ, in closed form.
//!
//! Its two waves that travel in opposite directions are F and G here:
//!
//! ```text
//! S_C + j S_D = exp(2j theta) (F E + conj(G E)) / 2,   E = exp(j tau)
//! ```
//!
//! with theta as it is at t = 0, and tau as it would be without splits. F starts as a_A + a_B, G as a_A - a_B; averaged over the
//! period, the splits couple them:
//!
//! ```text
//! d/dt (F, G) = (N - decay_rate) (F, G),   N = M + K + j ((KM - MK) / 2 + decay_rate P) / omega
//! M = (2j angle_rate, p; p*, -2j angle_rate),   p = -delta / 2 exp(4j (theta_delta - theta))
//! K = (0, k; -k*, 0),                           k = j pi Delta f exp(4j (theta_f - theta))
//! P = M with p = 0
//! ```
//!
//! delta being the damping split, Delta f the frequency split, theta_delta and theta_f their angles. This is exact to the second order
//! in rates over omega = 2 pi f: what is left out is rates^2 / omega^2 of the wave, and rates^3 / omega^2 of it per second. Other terms
//! of the second order are parts of f and of Delta f, which are those that the wave shows. The square of N is s^2 times
//! unity, so that exp(N t) = cosh(s t) + N sinh(s t) / s at any t. If splits and rotation cancel, s is 0 and N has only one eigenvector;
//! sinh(s t) / s then becomes t, and nothing else is special.

use crate::carrier::Carried;
use crate::complex::{Complex, angle, polar, root, size};
use crate::time::Instant;
use crate::wave::{Truth, Wave, reduced};
use libm::{copysign, exp, expm1, fabs, log, sincos};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::{PI, TAU};

/// Limit of x up to which sinh(x) / x is 1 + x^2 / 6 to the last bit.
const SMALL: f64 = 1e-4;

/// A wave with splits, and the matrix of its motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SplitWave {
    wave: Wave,
    /// N.
    matrix: Matrix2<Complex>,
    /// s, with a real part of 0 or more.
    root: Complex,
    /// F and G at t = 0.
    start: Vector2<Complex>,
}

impl SplitWave {
    /// `None` for a wave without splits.
    pub fn of(wave: &Wave) -> Option<SplitWave> {
        let is_split = wave.damping_split != 0.0 || wave.frequency_split != 0.0;
        is_split.then(|| SplitWave::new(wave))
    }

    /// Never inlined: a wave without splits must not pay for it.
    #[inline(never)]
    fn new(wave: &Wave) -> SplitWave {
        let damping = Complex::new(-0.5 * wave.damping_split, 0.0);
        let frequency = Complex::new(0.0, PI * wave.frequency_split);
        let [damped, fast] = [wave.damping_angle, wave.frequency_angle]
            .map(|at| polar(1.0, 4.0 * (at - wave.angle)));
        let zero = Complex::from(0.0);
        let turn = Complex::new(0.0, 2.0 * wave.angle_rate);
        let turning = Matrix2::new(turn, zero, zero, -turn);
        let damping = Matrix2::new(zero, damped * damping, damped.conj() * damping, zero);
        let frequency = Matrix2::new(zero, fast * frequency, fast.conj() * frequency, zero);
        let first = turning + damping;
        let within_period = (frequency * first - first * frequency) * Complex::from(0.5)
            + turning * Complex::from(wave.decay_rate);
        let by_omega = Complex::new(0.0, 1.0 / (TAU * wave.frequency));
        let matrix = first + frequency + within_period * by_omega;
        let (a, b) = (wave.main_amplitude, wave.quadrature_amplitude);
        SplitWave {
            wave: *wave,
            matrix,
            root: root(matrix.m11 * matrix.m11 + matrix.m12 * matrix.m21),
            start: Vector2::new(Complex::from(a + b), Complex::from(a - b)),
        }
    }

    /// Factor of F and G over `time` s, as a positive number and a matrix of moderate size.
    fn moved(&self, time: f64) -> (f64, Matrix2<Complex>) {
        let x = self.root * time;
        let grown = fabs(x.re);
        // cosh and sinh of the real part over exp(grown), which might overflow although the decay compensates it.
        let cosh = 0.5 * (1.0 + exp(-2.0 * grown));
        let sinh = copysign(-0.5 * expm1(-2.0 * grown), x.re);
        let (sin, cos) = sincos(x.im);
        let even = Complex::new(cosh * cos, sinh * sin);
        let odd = if size(x) <= SMALL {
            (x * x / 6.0 + 1.0) * exp(-grown)
        } else {
            Complex::new(sinh * cos, cosh * sin) / x
        };
        let matrix = self.matrix * (odd * time) + Matrix2::from_diagonal_element(even);
        (exp(grown - self.wave.decay_rate * time), matrix)
    }

    /// E after `turns` turns of the frequency.
    fn carrier(turns: f64, phase: f64) -> Complex {
        polar(1.0, TAU * turns - phase)
    }

    pub fn at_instant(&self, instant: Instant) -> Truth {
        let (wave, time) = (&self.wave, instant.seconds());
        let (scale, matrix) = self.moved(time);
        let waves = matrix * self.start;
        let sizes = waves.map(size);
        let [of_f, of_g] = [0, 1].map(|i| self.turned(i, time, angle(waves[i])));
        // Growth and turn of F and G, 1/s; if one is 0, its diagonal element of N.
        let slopes = self.matrix * waves;
        let [f, g] = [0, 1].map(|i| {
            if sizes[i] > 0.0 {
                slopes[i] / waves[i]
            } else {
                self.matrix[(i, i)]
            }
        });
        let turns = instant.turns(wave.frequency, wave.frequency_rate);
        let grown = (sizes[0] * f.re + sizes[1] * g.re) / (sizes[0] + sizes[1]);
        Truth {
            time,
            main_amplitude: 0.5 * scale * (sizes[0] + sizes[1]),
            quadrature_amplitude: 0.5 * scale * (sizes[0] - sizes[1]),
            angle: wave.angle + 0.25 * (of_f - of_g),
            phase: reduced(wave.phase - TAU * turns - 0.5 * (of_f + of_g)),
            frequency: wave.frequency + wave.frequency_rate * time + (f.im + g.im) / (2.0 * TAU),
            angle_rate: 0.25 * (f.im - g.im),
            decay_rate: wave.decay_rate - grown,
        }
    }

    /// The turn of F (0) or G (1) since t = 0, rad: its angle `now` plus whole turns.
    ///
    /// F and G have the form a exp(s t) + b exp(-s t). The larger term leads, and the smaller one adds no more than a quarter turn to it;
    /// the lead changes at most once, when both are equally large.
    fn turned(&self, i: usize, time: f64, now: f64) -> f64 {
        let s = self.root;
        if size(s * time) <= SMALL {
            return now; // along a straight line, which begins on the positive real axis
        }
        let rest = (self.matrix * self.start)[i] / s;
        let (a, b) = (self.start[i] + rest, self.start[i] - rest);
        // The value of s.re * t at which both are equally large.
        let even = 0.5 * log(size(b) / size(a));
        let angles = |t: f64| (angle(a) + s.im * t, angle(b) - s.im * t);
        let a_leads = |t: f64| s.re * t >= even;
        let angle_at = |t: f64| {
            let (a, b) = angles(t);
            let (lead, other) = if a_leads(t) { (a, b) } else { (b, a) };
            let share = exp(-2.0 * fabs(s.re * t - even));
            lead + angle(polar(share, other - lead) + 1.0)
        };
        let mut turns = libm::rint((angle_at(time) - now) / TAU);
        if a_leads(time) != a_leads(0.0) {
            let (a, b) = angles(even / s.re);
            let jump = libm::rint((a - b) / TAU);
            turns += if a_leads(time) { -jump } else { jump };
        }
        now + TAU * turns
    }

    #[inline(never)]
    pub fn pick_offs_at(&self, instant: Instant) -> [f64; 2] {
        let wave = &self.wave;
        let turns = instant.turns(wave.frequency, wave.frequency_rate);
        let (scale, matrix) = self.moved(instant.seconds());
        let [f, g] = (matrix * self.start * Self::carrier(turns, wave.phase)).into();
        let seen = (f + g.conj()) * polar(0.5 * scale, 2.0 * wave.angle);
        [seen.re, seen.im]
    }
}

impl Carried for SplitWave {
    /// F E / 2 and G E / 2.
    type Waves = Vector2<Complex>;
    /// Factors of F E / 2 and G E / 2: S_C is the real part of the first sum of products, S_D the imaginary part of the second.
    type Step = [Vector2<Complex>; 2];

    fn waves(&self, instant: Instant) -> Self::Waves {
        let turns = instant.turns(self.wave.frequency, 0.0);
        let (scale, matrix) = self.moved(instant.seconds());
        matrix * self.start * (Self::carrier(turns, self.wave.phase) * (0.5 * scale))
    }

    fn step(&self, instant: Instant) -> Self::Step {
        let turns = instant.turns(self.wave.frequency, 0.0);
        let (scale, matrix) = self.moved(instant.seconds());
        let to_axes = polar(1.0, 2.0 * self.wave.angle);
        let carrier = Self::carrier(turns, 0.0) * scale;
        // conj(G E) exp(2j theta) is the conjugate of G E exp(-2j theta): the same real part, and the opposite imaginary one.
        let f = matrix.row(0).transpose() * (carrier * to_axes);
        let g = matrix.row(1).transpose() * (carrier * to_axes.conj());
        [f + g, f - g]
    }

    fn pick_offs(waves: &Self::Waves, [c, d]: &Self::Step) -> [f64; 2] {
        [
            c.x.re * waves.x.re - c.x.im * waves.x.im + c.y.re * waves.y.re - c.y.im * waves.y.im,
            d.x.re * waves.x.im + d.x.im * waves.x.re + d.y.re * waves.y.im + d.y.im * waves.y.re,
        ]
    }
}
