//! Errors of a_A, a_B, θ and f by every method in one window.

use std::f64::consts::TAU;

use antinode::methods::{
    Delayed, Moments, Products, Shape, Wave as Found, algorithm1, algorithm2, algorithm3,
    algorithm4, exact, frequency, functional, phase,
};
use antinode_sim::Wave;

use super::figure::Name;
use super::period;
use super::samples::Samples;

/// Curves that a window gives, in the order of [`errors`].
pub const CURVES: [Name; 8] = [
    Name::Algorithm1,
    Name::Algorithm2,
    Name::Algorithm3,
    Name::Algorithm4,
    Name::MeanReturn,
    Name::Difference,
    Name::Fractional,
    Name::Exact,
];

/// Errors of a_A, a_B (input units), θ (degrees) and f (Hz); NaN if a curve has none.
pub type Errors = [f64; 4];

/// Step of the paper's search for the frequency, Hz.
const STEP: f64 = 1.0;
/// Steps that the search may go from the frequency of (10), at most.
const REACH: u32 = 4000;

/// The errors of each curve. Amplitudes and angles are computed at the known frequency, so that each error is due to its method alone;
/// frequencies start from (10) and are refined by J → min(ω) in steps of 1 Hz.
pub fn errors(samples: &Samples, wave: &Wave) -> [Errors; 8] {
    let window = samples.window();
    let known = TAU * wave.frequency / samples.rate;
    let rough = period::by_difference(samples);
    let moments = Moments::of(window);
    let products = Products::of(window, known);
    let lag = algorithm2::choose_lag(
        samples.with_lead(),
        samples.lead,
        algorithm2::quarter_lag((1.0 / rough) as f32),
    );
    let delayed = Delayed::of(samples.with_lead(), samples.lead, lag);

    let first = algorithm1::shape(&moments);
    let second = algorithm2::shape(&moments, delayed.q());
    let third = algorithm3::shape(&moments, products.q());
    let fourth = algorithm4::wave(&products).shape;
    let fractional = algorithm2::shape(&moments, delayed.quarter(&moments, known));

    let refined = |at: &dyn Fn(&Products) -> Found| {
        let j = |omega: f64| {
            let products = Products::of(window, omega);
            functional::squares(&at(&products), &moments, &products)
        };
        search(samples, rough, j)
    };
    let aligned = |shape: Shape| refined(&|products: &Products| phase::align(&shape, products));
    let of_fourth = refined(&algorithm4::wave);
    let solved = exact::solve(window, of_fourth);
    let by = |shape: Shape, omega: f64| difference(&shape, omega, samples.rate, wave);
    let frequency_only = |cycles: f64| {
        [
            f64::NAN,
            f64::NAN,
            f64::NAN,
            cycles * samples.rate - wave.frequency,
        ]
    };
    [
        by(first, aligned(first)),
        by(second, aligned(second)),
        by(third, aligned(third)),
        by(fourth, of_fourth),
        frequency_only(period::by_mean_return(samples)),
        frequency_only(rough),
        by(fractional, f64::NAN),
        by(solved.wave.shape, solved.omega),
    ]
}

/// The lowest J on the grid of [`STEP`] about a `rough` frequency, in cycles a sample, as trying each of its points finds it: down the
/// valley of the lowest of those points that lie a quarter of a valley apart. The rough period may be off by a sample and a half.
fn search(samples: &Samples, rough: f64, j: impl Fn(f64) -> f64) -> f64 {
    let step = TAU * STEP / samples.rate;
    let stride = (0.25 * samples.rate / samples.count as f64 / STEP).max(1.0) as i32;
    let far = (1.5 * rough * rough * samples.rate / STEP).min(f64::from(REACH));
    let strides = far as i32 / stride;
    let starts = (-strides..=strides).map(|at| TAU * rough + f64::from(at * stride) * step);
    let tried = starts.map(|start| (start, j(start)));
    let lowest = tried.min_by(|(_, one), (_, other)| one.total_cmp(other));
    let start = lowest.map_or(TAU * rough, |(start, _)| start);
    frequency::on_grid(start, step, REACH, j)
}

fn difference(shape: &Shape, omega: f64, rate: f64, wave: &Wave) -> Errors {
    let turn = shape.angle - wave.angle;
    // θ is known modulo π/2.
    let quarter = std::f64::consts::FRAC_PI_2;
    let turn = turn - (turn / quarter).round() * quarter;
    [
        shape.main_amplitude - wave.main_amplitude,
        shape.quadrature_amplitude - wave.quadrature_amplitude,
        turn.to_degrees(),
        omega * rate / TAU - wave.frequency,
    ]
}
