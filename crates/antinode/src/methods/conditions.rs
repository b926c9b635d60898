//! The paper's conditions for its methods, each tested against the effect of white noise in a window.

use core::fmt;

use super::comparison::Sums;
use super::delayed::Delayed;
use super::moments::Moments;
use super::reference::Reference;
use super::scatter::slow;

/// Limit of (17) and (20), in their own deviations: beyond it they fail.
pub const CONDITION: f64 = 3.0;

/// Which conditions hold for a method; those that the paper does not demand of the method hold.
///
/// [`Display`](fmt::Display) gives the formulas of those that fail, joined by `+`: `(8)+(17)`; nothing if all hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Conditions {
    /// (8), demanded of all: the window fits the period so well that the leakage |⟨e^{2jωt}⟩| is below two deviations of a_A, as a share of
    /// a_A, or below one of θ, rad. Half of it leaks into the a_A of algorithms 1 to 3, as a share of a_A, and all of it into that of 4;
    /// a_B/a_A times as much leaks into θ, rad.
    pub window: bool,
    /// (12), demanded of algorithm 1: |a_B| is below two of its deviations.
    pub no_quadrature: bool,
    /// (17), demanded of algorithm 2: ⟨S(t) S(t − t₃)⟩ vanishes at a quarter period.
    pub delay: bool,
    /// (20), demanded of algorithm 2: the phase difference of the pick-offs is that of the exact solution.
    pub monitor: bool,
}

impl Conditions {
    /// True if all hold.
    pub fn hold(self) -> bool {
        self.window && self.of_the_method_hold()
    }

    /// True if all but (8), which all methods share, hold: these decide the rank before J does.
    pub fn of_the_method_hold(self) -> bool {
        self.no_quadrature && self.delay && self.monitor
    }
}

impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut join = "";
        for (holds, formula) in [
            (self.window, "(8)"),
            (self.no_quadrature, "(12)"),
            (self.delay, "(17)"),
            (self.monitor, "(20)"),
        ] {
            if !holds {
                f.write_str(join)?;
                f.write_str(formula)?;
                join = "+";
            }
        }
        Ok(())
    }
}

/// Conditions of the delayed sums.
pub(super) struct OfDelay {
    /// (17) and (20) less what the exact solution expects of them, each in its own deviations.
    pub excesses: [f64; 2],
    /// Deviation of q of (16) at the quarter, input units squared.
    pub q_deviation: f64,
}

/// (17), (20) and q compared with what the exact solution predicts for them.
///
/// Both conditions use the delayed sums and assume noise that is independent after a quarter period. Hum, a second tone or coloured
/// noise shows in (17) within a pick-off, in (20) between the two. The known error of the whole-sample delay is removed.
pub(super) fn of_delay(
    found: &Sums,
    expected_moments: &Moments,
    expected_delayed: &Delayed,
    reference: &Reference,
    changing: f64,
) -> OfDelay {
    let Sums {
        moments,
        delayed,
        products,
        ..
    } = found;
    let (count, lag) = (f64::from(delayed.count), f64::from(delayed.lag));
    let (sine, cosine) = libm::sincos(products.omega * lag);
    let [noise_c, noise_d, _] = reference.noise.moments;
    // The residual of the exact fit is orthogonal to the wave, except where the delay reaches over the window's ends.
    let (cc, dd, _) = expected_moments.means();
    let ends = 2.0 * lag / (count * count);
    let (c, d) = ((cc - noise_c).max(0.0), (dd - noise_d).max(0.0));
    let squares = (noise_c * noise_c + noise_d * noise_d) / count;
    let level = reference.noise_uncertainty * (noise_c + noise_d);
    let of_power = level * level + 2.0 * squares;
    let own = ends * (noise_c * c + noise_d * d) + squares + cosine * cosine * of_power;
    let between = ends * noise_d * c + (1.0 + cosine * cosine) * noise_c * noise_d / count;
    // A rate below the noise may be as large as its deviation. Turning and decay go on during the delay.
    let [of_turn, of_decay] = reference.change_deviations;
    let (turn, decay) = (
        libm::hypot(reference.turn, of_turn),
        libm::hypot(reference.decay, of_decay),
    );
    let during = (2.0 * turn + decay) * lag / count * cosine.abs();
    let rest = (c + d) * (slow(turn, decay, changing) + during);
    let deviation = |variance: f64| libm::sqrt(variance + rest * rest) / sine.abs();

    let at_quarter = |moments: &Moments, delayed: &Delayed| {
        let sum = delayed.own / f64::from(delayed.count);
        (sum - moments.power() * cosine) / sine
    };
    let delay = (at_quarter(moments, delayed) - at_quarter(expected_moments, expected_delayed))
        / deviation(own);

    let vector = |moments: &Moments, delayed: &Delayed| {
        let (_, _, cd) = moments.means();
        (cd, delayed.quarter(moments, products.omega))
    };
    let (x, y) = vector(moments, delayed);
    let (u, v) = vector(expected_moments, expected_delayed);
    // The angle between both vectors times their length: on a pick-off's axis without quadrature Δφ itself has no meaning.
    let turn = libm::atan2(y * u - x * v, x * u + y * v);
    let across = deviation(between);
    OfDelay {
        excesses: [delay, turn * libm::sqrt(u * u + v * v) / across],
        q_deviation: libm::hypot(across, (c + d) * decay * lag / count / sine),
    }
}
