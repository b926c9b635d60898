//! The paper's conclusions, each checked against the curves computed here.

mod frequency;
mod length;
mod neglect;
mod places;

use antinode_sim::Wave;

use super::Study;
use super::evaluate::{CURVES, errors};
use super::figure::{Figure, Name};
use super::samples::Samples;

/// A conclusion of the paper.
pub struct Conclusion {
    pub claim: &'static str,
    pub verdict: Verdict,
    /// The numbers behind the verdict, in one or several lines.
    pub found: String,
}

/// How far a conclusion holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    Confirmed,
    /// Under conditions, which `found` states.
    InPart,
    NotConfirmed,
}

impl Verdict {
    fn confirmed_if(holds: bool) -> Self {
        if holds {
            Self::Confirmed
        } else {
            Self::NotConfirmed
        }
    }

    /// The verdict as printed.
    pub fn text(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::InPart => "in part",
            Self::NotConfirmed => "NOT CONFIRMED",
        }
    }
}

const FOUR: [Name; 4] = [
    Name::Algorithm1,
    Name::Algorithm2,
    Name::Algorithm3,
    Name::Algorithm4,
];

/// Start phases over half a period, after which squares of the signals, and so leakage, repeat.
const PHASES: u32 = 100;

/// Checks all conclusions.
pub fn check(
    wave: &Wave,
    [first, second, third]: &[Figure; 3],
    options: &Study,
) -> Vec<Conclusion> {
    vec![
        places::best(
            first,
            "Figure 1: errors are least at 4 and 8 periods, where the grid fits the period.",
            [4.0, 8.0],
        ),
        places::best(
            second,
            "Figure 2: errors are least at 75 and 150 samples a period.",
            [75.0, 150.0],
        ),
        places::divides_by_four(second),
        places::divides_by_four_where_the_rate_fits(wave),
        neglect::floor(wave, first),
        neglect::longer(wave),
        neglect::rougher(wave),
        frequency::alike(first),
        frequency::grid(wave, first),
        frequency::absolutes(wave),
        length::noise(third, options),
        length::long(first),
        length::long_with_a_whole_delay(first),
        length::whole_periods(wave),
    ]
}

/// A curve's value at a place of its figure; NaN if it has none.
fn at(figure: &Figure, letter: char, name: Name, place: usize) -> f64 {
    let curve = figure.curve(letter, name);
    curve.get(place).copied().unwrap_or(f64::NAN)
}

/// Absolute errors of a curve in a window.
fn error(samples: &Samples, wave: &Wave, name: Name) -> [f64; 4] {
    errors(samples, wave)[place(name)].map(f64::abs)
}

/// Index of a curve among those that a window gives.
fn place(name: Name) -> usize {
    CURVES.iter().position(|&curve| curve == name).unwrap_or(0)
}

/// The wave at start phases spread over half a period.
fn phases(wave: &Wave) -> impl Iterator<Item = Wave> + use<'_> {
    (0..PHASES).map(|i| Wave {
        phase: std::f64::consts::PI * f64::from(i) / f64::from(PHASES),
        ..*wave
    })
}

/// The wave without quadrature.
fn pure(wave: &Wave) -> Wave {
    Wave {
        quadrature_amplitude: 0.0,
        ..*wave
    }
}
