//! The paper's conclusions, each held against the curves computed here.

use antinode::methods::{Moments, Ratio, algorithm1};
use antinode_sim::Wave;

use super::evaluate::{CURVES, errors};
use super::figure::{Figure, Name};
use super::samples::Samples;
use super::{RATE, Study, noisy};

/// A conclusion of the paper.
pub struct Conclusion {
    pub claim: &'static str,
    pub confirmed: bool,
    /// The numbers that say so.
    pub found: String,
}

const FOUR: [Name; 4] = [
    Name::Algorithm1,
    Name::Algorithm2,
    Name::Algorithm3,
    Name::Algorithm4,
];

/// Checks them all.
pub fn check(
    wave: &Wave,
    first: &Figure,
    second: &Figure,
    third: &Figure,
    options: &Study,
) -> Vec<Conclusion> {
    vec![
        best(
            first,
            "Figure 1: errors are least at 4 and 8 periods, where the grid fits the period.",
            [4.0, 8.0],
        ),
        best(
            second,
            "Figure 2: errors are least at 75 and 150 samples a period.",
            [75.0, 150.0],
        ),
        divides_by_four(wave),
        floor(wave, first),
        longer(first),
        rougher(wave),
        alike(first),
        grid(first),
        noise(wave, third, options),
        long(first, false),
        long(first, true),
    ]
}

/// Where a curve is lowest: its two best places.
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

fn best(figure: &Figure, claim: &'static str, places: [f64; 2]) -> Conclusion {
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
        confirmed: fits(Name::Algorithm3) == 3 && fits(Name::Algorithm4) == 3,
        found: format!(
            "Both places are the best two for a_A, a_B, angle: {}; 1 and 2 have floors of their own, below.",
            found.join(", ")
        ),
    }
}

/// |a_B| error of algorithm 2 over one period at a rate that makes it a whole number of samples.
fn fitted(wave: &Wave, count: u32) -> f64 {
    let samples = Samples::simulate(wave, 1, wave.frequency * f64::from(count), 0.0, 0);
    error(&samples, wave, Name::Algorithm2)[1]
}

fn error(samples: &Samples, wave: &Wave, name: Name) -> [f64; 4] {
    let all = errors(samples, wave);
    let place = CURVES.iter().position(|&curve| curve == name).unwrap_or(0);
    all[place].map(f64::abs)
}

fn divides_by_four(wave: &Wave) -> Conclusion {
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
        claim: "Figure 2: the quadrature of algorithm 2 is best where the count of samples divides by 4.",
        confirmed: divides < 0.1 * rest,
        found: format!(
            "Rates that fit 19 to 190 samples into a period: a_B error at most {divides:.1e} where the count divides by 4, at \
             least {rest:.1e} elsewhere."
        ),
    }
}

fn floor(wave: &Wave, first: &Figure) -> Conclusion {
    let place = 3;
    let [a, angle] = ['a', 'c'].map(|letter| {
        first
            .curve(letter, Name::Algorithm1)
            .get(place)
            .copied()
            .unwrap_or(f64::NAN)
    });
    let third = first
        .curve('a', Name::Algorithm3)
        .get(place)
        .copied()
        .unwrap_or(f64::NAN);
    let pure = Wave {
        quadrature_amplitude: 0.0,
        ..*wave
    };
    let without = error(
        &Samples::simulate(&pure, 4, RATE, 0.0, 0),
        &pure,
        Name::Algorithm1,
    );
    Conclusion {
        claim: "Algorithm 1's errors have a floor, from neglecting quadrature.",
        confirmed: a > 10.0 * without[0] && a > 10.0 * third && angle > 10.0 * without[2],
        found: format!(
            "4 periods: a_A error {a:.1e} (a_B²/2a_A = {:.1e}), angle {angle:.1e}°; with a_B = 0: {:.1e} and {:.1e}°.",
            wave.quadrature_amplitude.powi(2) / (2.0 * wave.main_amplitude),
            without[0],
            without[2],
        ),
    }
}

fn longer(first: &Figure) -> Conclusion {
    let at = |periods: usize| {
        let curve = first.curve('c', Name::Algorithm1);
        curve.get(periods - 1).copied().unwrap_or(f64::NAN)
    };
    Conclusion {
        claim: "Algorithm 1's angle gets worse as windows get longer, from neglecting quadrature.",
        confirmed: at(8) > 1.1 * at(4),
        found: format!(
            "Angle error {:.3}° on one period, {:.3}° on four, {:.3}° on eight: it settles at the floor.",
            at(1),
            at(4),
            at(8)
        ),
    }
}

fn rougher(wave: &Wave) -> Conclusion {
    let least = 0.1 * wave.main_amplitude;
    let (mut low, mut high) = (f64::INFINITY, 0f64);
    for periods in 1..=10 {
        let samples = Samples::simulate(wave, periods, RATE, 0.0, 0);
        let window = samples.window();
        let [ratio, roots] = [
            algorithm1::rough_angle(&Ratio::of(window, least as f32)),
            algorithm1::shape(&Moments::of(window)).angle,
        ]
        .map(|angle| (angle - wave.angle).abs());
        low = low.min(ratio / roots);
        high = high.max(ratio / roots);
    }
    Conclusion {
        claim: "Formula (13) for the angle is rougher than (12).",
        confirmed: low > 2.0,
        found: format!(
            "{low:.1} to {high:.1} times over 1 to 10 periods, samples of S_C below 0.1 a_A left out."
        ),
    }
}

fn alike(first: &Figure) -> Conclusion {
    let mut widest = 1f64;
    for i in 0..first.x.len() {
        // What lies below the search's own step of 1 Hz is alike.
        let values = FOUR.map(|name| {
            first
                .curve('d', name)
                .get(i)
                .copied()
                .unwrap_or(f64::NAN)
                .max(0.5)
        });
        let [low, high] = [f64::min, f64::max].map(|pick| values.into_iter().fold(values[0], pick));
        widest = widest.max(high / low);
    }
    Conclusion {
        claim: "Figure 1: the four algorithms' errors of frequency behave alike.",
        confirmed: widest < 3.0,
        found: format!(
            "Largest over least of the four, at any count of periods, in units of half the search's step or more: {widest:.1}."
        ),
    }
}

fn grid(first: &Figure) -> Conclusion {
    let ninth = first.curve('d', Name::MeanReturn);
    let tenth = first.curve('d', Name::Difference);
    let at = |curve: &[f64], i: usize| curve.get(i).copied().unwrap_or(f64::NAN);
    Conclusion {
        claim: "Formulas (9) and (10) are limited by the sample grid; (9) improves over several periods where the grid fits.",
        confirmed: at(tenth, 0) > 50.0 && at(ninth, 3) < 0.1 * at(ninth, 0),
        found: format!(
            "(10): {:.0} Hz; (9): {:.0} Hz on one period, {:.1} Hz on four, {:.1} Hz on eight.",
            at(tenth, 0),
            at(ninth, 0),
            at(ninth, 3),
            at(ninth, 7)
        ),
    }
}

fn noise(wave: &Wave, third: &Figure, options: &Study) -> Conclusion {
    let level = 10;
    let one = |letter, name| {
        third
            .curve(letter, name)
            .get(level)
            .copied()
            .unwrap_or(f64::NAN)
    };
    let ten = noisy::rms(
        wave,
        10,
        &[level as u32],
        (options.runs / 5).max(1),
        options.seed,
    );
    let place = |name| CURVES.iter().position(|&curve| curve == name).unwrap_or(0);
    let ratio = |name| one('c', name) / ten[0][place(name)][2];
    let [third, fourth] = [ratio(Name::Algorithm3), ratio(Name::Algorithm4)];
    Conclusion {
        claim: "Figure 3: noise weighs heavily on one period; more periods are advised.",
        confirmed: third > 2.0 && fourth > 2.0,
        found: format!(
            "10 % noise: rms angle of algorithms 3 and 4 {:.2}° and {:.2}° on one period, {third:.1} and {fourth:.1} times less on ten.",
            one('c', Name::Algorithm3),
            one('c', Name::Algorithm4)
        ),
    }
}

fn long(first: &Figure, quadrature_of_two: bool) -> Conclusion {
    let last = |letter, name| {
        first
            .curve(letter, name)
            .last()
            .copied()
            .unwrap_or(f64::NAN)
    };
    if quadrature_of_two {
        let (whole, fractional) = (last('b', Name::Algorithm2), last('b', Name::Fractional));
        return Conclusion {
            claim: "The same of algorithm 2's quadrature with a whole-sample delay (within 10 % of a_B).",
            confirmed: whole < 0.01,
            found: format!(
                "a_B error {whole:.1e} of 0.1 at 10 periods: the delay's grid error does not average; fractional delay: {fractional:.1e}."
            ),
        };
    }
    let worst = |letter| {
        FOUR.iter()
            .map(|&name| last(letter, name))
            .fold(0.0, f64::max)
    };
    let fine = worst('a') < 0.01 && worst('c') < 0.1 && worst('d') < 2.0;
    Conclusion {
        claim: "All four work well from 10 periods on (a_A within 0.5 %, angle within 0.1°, frequency within 2 Hz).",
        confirmed: fine,
        found: format!(
            "Worst of the four at 10 periods: a_A {:.1e}, angle {:.1e}°, frequency {:.1e} Hz.",
            worst('a'),
            worst('c'),
            worst('d')
        ),
    }
}
