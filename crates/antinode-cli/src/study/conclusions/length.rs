//! Conclusions on the length of windows.

use std::f64::consts::TAU;

use antinode::methods::{Moments, Products, algorithm3, algorithm4};
use antinode_sim::Wave;

use super::{Conclusion, FOUR, Verdict, at, phases, place};
use crate::study::figure::{Figure, Name};
use crate::study::samples::Samples;
use crate::study::simulated::Simulated;
use crate::study::{RATE, Study, noisy};

/// Lengths of windows, in periods, that are then varied by up to half a period.
const PERIODS: [u32; 6] = [1, 2, 5, 10, 50, 100];

pub fn noise(third: &Figure, options: &Study) -> Conclusion {
    let level = 10;
    let one = |name| at(third, 'c', name, level);
    let ten = noisy::rms(
        &Simulated {
            periods: 10,
            ..options.simulated
        },
        &[level as u32],
        (options.runs / 5).max(1),
        options.seed,
    );
    let ratio = |name| one(name) / ten[0][place(name)][2];
    let [third, fourth] = [ratio(Name::Algorithm3), ratio(Name::Algorithm4)];
    Conclusion {
        claim: "Figure 3: noise weighs heavily on one period; more periods are advised.",
        verdict: Verdict::confirmed_if(third > 2.0 && fourth > 2.0),
        found: format!(
            "10 % noise: rms angle of algorithms 3 and 4 {:.2}° and {:.2}° on one period, {third:.1} and {fourth:.1} times less on ten.",
            one(Name::Algorithm3),
            one(Name::Algorithm4)
        ),
    }
}

/// A curve's last value in figure 1, at ten periods.
fn last(first: &Figure, letter: char, name: Name) -> f64 {
    at(first, letter, name, first.x.len() - 1)
}

pub fn long(first: &Figure) -> Conclusion {
    let worst = |letter| {
        FOUR.iter()
            .map(|&name| last(first, letter, name))
            .fold(0.0, f64::max)
    };
    let fine = worst('a') < 0.01 && worst('c') < 0.1 && worst('d') < 2.0;
    Conclusion {
        claim: "All four work well from 10 periods on (a_A within 0.5 %, angle within 0.1°, frequency within 2 Hz).",
        verdict: Verdict::confirmed_if(fine),
        found: format!(
            "Worst of the four at 10 periods: a_A {:.1e}, angle {:.1e}°, frequency {:.1e} Hz.",
            worst('a'),
            worst('c'),
            worst('d')
        ),
    }
}

pub fn long_with_a_whole_delay(first: &Figure) -> Conclusion {
    let [whole, fractional] =
        [Name::Algorithm2, Name::Fractional].map(|name| last(first, 'b', name));
    Conclusion {
        claim: "So does algorithm 2's quadrature with a whole-sample delay (within 10 % of a_B).",
        verdict: Verdict::confirmed_if(whole < 0.01),
        found: format!(
            "a_B error {whole:.1e} of 0.1 at 10 periods: the delay's grid error does not average out; with a fractional delay \
             {fractional:.1e}."
        ),
    }
}

/// Relative errors of a_A by algorithms 3 and 4: the worst over all start phases and these counts of samples.
pub fn worst_leakage(
    wave: &Wave,
    periods: u32,
    counts: impl Iterator<Item = usize> + Clone,
) -> [f64; 2] {
    let omega = TAU * wave.frequency / RATE;
    let mut worst = [0f64; 2];
    for wave in phases(wave) {
        let mut samples = Samples::simulate(&wave, periods + 1, RATE, 0.0, 0);
        for count in counts.clone() {
            samples.count = count;
            let products = Products::of(samples.window(), omega);
            let shapes = [
                algorithm3::shape(&Moments::of(samples.window()), products.q()),
                algorithm4::wave(&products).shape,
            ];
            for (worst, shape) in worst.iter_mut().zip(shapes) {
                *worst = worst.max((shape.main_amplitude / wave.main_amplitude - 1.0).abs());
            }
        }
    }
    worst
}

/// A number above 0.01 with two digits.
fn two_digits(x: f64) -> String {
    let places = (1.0 - x.log10().floor()).clamp(0.0, 3.0) as usize;
    format!("{x:.places$}")
}

pub fn whole_periods(wave: &Wave) -> Conclusion {
    let period = RATE / wave.frequency;
    let nearest = |periods: u32| (f64::from(periods) * period).round() as usize;
    let half = (0.5 * period) as usize;
    let any = PERIODS.map(|periods| {
        let middle = nearest(periods);
        worst_leakage(wave, periods, middle - half..=middle + half)
    });
    let fitting = PERIODS.map(|periods| {
        let count = nearest(periods);
        worst_leakage(wave, periods, count..=count)
    });
    let list = |worst: [[f64; 2]; 6], which: usize| {
        worst
            .map(|worst| two_digits(100.0 * worst[which]))
            .join(", ")
    };
    // In proportion to one over the count of periods.
    let falls = any.iter().zip(PERIODS).all(|(worst, periods)| {
        worst
            .iter()
            .zip(any[0])
            .all(|(worst, first)| *worst < 1.3 * first / f64::from(periods))
    });
    Conclusion {
        claim: "Short windows must be whole periods; the longer they are, the less it matters.",
        verdict: Verdict::confirmed_if(falls),
        found: format!(
            "Largest error of a_A, %, over all phases, in windows of 1, 2, 5, 10, 50, 100 periods, up to half a period longer or \
             shorter:\nalgorithm 4 {}; 3 {}.\nIn whole periods, to the nearest sample: algorithm 4 {}; 3 {}.",
            list(any, 1),
            list(any, 0),
            list(fitting, 1),
            list(fitting, 0),
        ),
    }
}
