//! Conclusions on the accuracy of the frequency.

use std::f64::consts::TAU;

use antinode::methods::{Moments, Products, algorithm1, algorithm4, functional, phase};
use antinode_sim::Wave;

use super::{Conclusion, FOUR, Verdict, at, pure};
use crate::median::ends;
use crate::study::RATE;
use crate::study::figure::{Figure, Name};
use crate::study::period;
use crate::study::samples::Samples;

pub fn alike(first: &Figure) -> Conclusion {
    let mut widest = 1f64;
    for i in 0..first.x.len() {
        // Errors below half of the search's own step of 1 Hz count as equal.
        let values = FOUR.map(|name| at(first, 'd', name, i).max(0.5));
        let [low, high] = ends(values);
        widest = widest.max(high / low);
    }
    Conclusion {
        claim: "Figure 1: the four algorithms' errors of frequency behave alike.",
        verdict: Verdict::confirmed_if(widest < 3.0),
        found: format!(
            "Largest ratio of two of the four errors at any count of periods, errors below half the search's step taken as half a step: \
             {widest:.1}."
        ),
    }
}

/// a_A of algorithm 4 at the unrefined frequency of (10).
fn unrefined(wave: &Wave, periods: u32) -> f64 {
    let samples = Samples::simulate(wave, periods, RATE, 0.0, 0);
    let omega = TAU * period::by_difference(&samples);
    let found = algorithm4::wave(&Products::of(samples.window(), omega));
    found.shape.main_amplitude
}

pub fn grid(wave: &Wave, first: &Figure) -> Conclusion {
    let ninth = |place| at(first, 'd', Name::MeanReturn, place);
    let tenth = at(first, 'd', Name::Difference, 0);
    Conclusion {
        claim: "Formulas (9) and (10) are limited by the sample grid; (9) improves over several periods where the grid fits.",
        verdict: Verdict::confirmed_if(tenth > 50.0 && ninth(3) < 0.1 * ninth(0)),
        found: format!(
            "(10): {tenth:.0} Hz; (9): {:.0} Hz on one period, {:.1} Hz on four, {:.1} Hz on eight.\nWith the unrefined frequency of (10), \
             algorithm 4's a_A is {:.3} on four periods and {:.3} on ten.",
            ninth(0),
            ninth(3),
            ninth(7),
            unrefined(wave, 4),
            unrefined(wave, 10),
        ),
    }
}

/// The minimum of a functional over the frequency.
struct Minimum {
    /// Residual beside it, by 100 Hz over the count of periods, divided by that in it: on the flatter side.
    flat: f64,
    /// The same on the steeper side.
    steep: f64,
    /// Distance from the wave's frequency, Hz.
    off: f64,
}

/// The minima of (14) and of (15).
fn minima(wave: &Wave, periods: u32) -> [Minimum; 2] {
    let samples = Samples::simulate(wave, periods, RATE, 0.0, 0);
    let window = samples.window();
    let moments = Moments::of(window);
    let shape = algorithm1::shape(&moments);
    let residuals = |hertz: f64| {
        let omega = TAU * hertz / RATE;
        let products = Products::of(window, omega);
        let found = phase::align(&shape, &products);
        let squares = functional::squares(&found, &moments, &products);
        [squares.sqrt(), functional::absolutes(&found, window, omega)]
    };
    let grid: Vec<(f64, [f64; 2])> = (-150..=150)
        .map(|step| wave.frequency + f64::from(step))
        .map(|hertz| (hertz, residuals(hertz)))
        .collect();
    [0, 1].map(|which| {
        let lowest = grid.iter().min_by(|a, b| a.1[which].total_cmp(&b.1[which]));
        let (hertz, min) = lowest.map_or((f64::NAN, f64::NAN), |(hertz, all)| (*hertz, all[which]));
        let aside = 100.0 / f64::from(periods);
        let [below, above] = [-aside, aside].map(|aside| residuals(hertz + aside)[which] / min);
        Minimum {
            flat: below.min(above),
            steep: below.max(above),
            off: (hertz - wave.frequency).abs(),
        }
    })
}

pub fn absolutes(wave: &Wave) -> Conclusion {
    let [all, without] =
        [wave, &pure(wave)].map(|wave| [1, 4, 10].map(|periods| minima(wave, periods)));
    let list = |all: &[[Minimum; 2]; 3], get: fn(&Minimum) -> f64, which: usize, places: usize| {
        all.each_ref()
            .map(|minima| format!("{:.places$}", get(&minima[which])))
            .join(", ")
    };
    Conclusion {
        claim: "Algorithm 1's functional (15), of absolute values, has a more pronounced minimum over the frequency than (14).",
        verdict: Verdict::confirmed_if(all.iter().all(|[of_14, of_15]| of_15.flat > of_14.flat)),
        found: format!(
            "Windows of N = 1, 4, 10 periods: 100 Hz/N from its minimum, (15) grows {} times on the flatter side and {} times on the other, \
             and the root of (14) {} and {} times.\nThe minimum of (15) is off by {} Hz, that of (14) by {} Hz: neglected quadrature fills \
             it.\nWith a_B = 0 they grow {} and {} times on the flatter side.",
            list(&all, |minimum| minimum.flat, 1, 2),
            list(&all, |minimum| minimum.steep, 1, 2),
            list(&all, |minimum| minimum.flat, 0, 2),
            list(&all, |minimum| minimum.steep, 0, 2),
            list(&all, |minimum| minimum.off, 1, 0),
            list(&all, |minimum| minimum.off, 0, 0),
            list(&without, |minimum| minimum.flat, 1, 1),
            list(&without, |minimum| minimum.flat, 0, 1),
        ),
    }
}
