//! Conclusions on where errors are smallest.

use antinode_sim::Wave;

use super::{Conclusion, FOUR, Verdict, error};
use crate::study::figure::{Figure, Name};
use crate::study::samples::Samples;

/// The two places at which a curve is lowest.
fn two_best(figure: &Figure, letter: char, name: Name) -> Vec<f64> {
    let mut points: Vec<(f64, f64)> = figure
        .curve(letter, name)
        .iter()
        .copied()
        .zip(figure.x.iter().copied())
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Vec<f64> = points.iter().take(2).map(|point| point.1).collect();
    best.sort_by(f64::total_cmp);
    best
}

pub fn best(figure: &Figure, claim: &'static str, places: [f64; 2]) -> Conclusion {
    let fits = |name: Name| {
        "abc"
            .chars()
            .filter(|&letter| two_best(figure, letter, name) == places)
            .count()
    };
    let found: Vec<String> = FOUR
        .iter()
        .map(|&name| format!("algorithm {}: {} of 3", &name.text()[..1], fits(name)))
        .collect();
    Conclusion {
        claim,
        verdict: Verdict::confirmed_if(fits(Name::Algorithm3) == 3 && fits(Name::Algorithm4) == 3),
        found: format!(
            "These two are the best places for a_A, a_B and angle: {}; algorithms 1 and 2 have floors of their own, see below.",
            found.join(", ")
        ),
    }
}

pub fn divides_by_four(second: &Figure) -> Conclusion {
    let points: Vec<(f64, f64)> = second
        .x
        .iter()
        .copied()
        .zip(second.curve('b', Name::Algorithm2).iter().copied())
        .collect();
    let of = |divides: bool| {
        let mut some: Vec<_> = points
            .iter()
            .filter(|(count, _)| (count % 4.0 == 0.0) == divides)
            .collect();
        some.sort_by(|a, b| a.1.total_cmp(&b.1));
        some
    };
    let (those, others) = (of(true), of(false));
    let list = |some: &[&(f64, f64)]| {
        let texts: Vec<String> = some
            .iter()
            .map(|(count, error)| format!("{error:.1e} at {count}"))
            .collect();
        texts.join(", ")
    };
    let best_elsewhere = others.first().map_or(f64::NAN, |point| point.1);
    Conclusion {
        claim: "Figure 2: the quadrature of algorithm 2 is best where the count of samples is divisible by 4.",
        verdict: Verdict::confirmed_if(those.iter().all(|point| point.1 < best_elsewhere)),
        found: format!(
            "a_B error {} samples, which are divisible by 4, and {}, which is not.\nAt the figure's points the delay is not a quarter of the \
             period, nor the window a whole period.",
            list(&those),
            list(&others[..others.len().min(1)]),
        ),
    }
}

/// |a_B| error of algorithm 2 over one period, at a rate at which the period is a whole number of samples.
fn fitted(wave: &Wave, count: u32) -> f64 {
    let samples = Samples::simulate(wave, 1, wave.frequency * f64::from(count), 0.0, 0);
    error(&samples, wave, Name::Algorithm2)[1]
}

pub fn divides_by_four_where_the_rate_fits(wave: &Wave) -> Conclusion {
    let (mut divides, mut rest) = (0f64, f64::INFINITY);
    for count in 19..=190 {
        let error = fitted(wave, count);
        if count % 4 == 0 {
            divides = divides.max(error);
        } else {
            rest = rest.min(error);
        }
    }
    Conclusion {
        claim: "The same at rates that make the period a whole number of samples.",
        verdict: Verdict::confirmed_if(divides < 0.1 * rest),
        found: format!(
            "19 to 190 samples a period: a_B error at most {divides:.1e} where the count is divisible by 4, at least {rest:.1e} elsewhere."
        ),
    }
}
