//! Figures 1 and 2: absolute errors without noise, over the periods of a window and over the samples of a period.

use antinode_sim::Wave;

use super::evaluate::{CURVES, errors};
use super::figure::{Curve, Figure, Name, Panel, Point};
use super::samples::Samples;
use super::simulated::Simulated;

/// Noise of the bound that is drawn beside errors without noise, as a share of a_A: −80 dB.
const BOUND_NOISE: f64 = 1e-4;
/// Smaller errors are drawn at this value: rounding of samples to f32 is about as large.
const FLOOR: f64 = 1e-9;

/// Figure 1: windows of 1 to 10 periods.
pub fn against_periods(simulated: &Simulated) -> Figure {
    let wave = &simulated.wave();
    let windows: Vec<Samples> = (1..=10)
        .map(|periods| Samples::simulate(wave, periods, simulated.rate, 0.0, 0))
        .collect();
    let x = (1..=10).map(f64::from).collect();
    figure(1, "periods in the window", x, &windows, wave)
}

/// Figure 2: one period, at 1 to 10 times the rate.
pub fn against_samples(simulated: &Simulated) -> Figure {
    let wave = &simulated.wave();
    let windows: Vec<Samples> = (1..=10)
        .map(|times| Samples::simulate(wave, 1, simulated.rate * f64::from(times), 0.0, 0))
        .collect();
    let x = windows.iter().map(|window| window.count as f64).collect();
    figure(2, "samples in the window of one period", x, &windows, wave)
}

fn figure(number: u8, axis: &'static str, x: Vec<f64>, windows: &[Samples], wave: &Wave) -> Figure {
    let (a, b) = (wave.main_amplitude, wave.quadrature_amplitude);
    let units = "absolute error, input units";
    let kinds = [
        ('a', format!("main amplitude a_A = {a}"), units),
        ('b', format!("quadrature amplitude a_B = {b}"), units),
        (
            'c',
            "angle of the standing wave".into(),
            "absolute error, degrees",
        ),
        ('d', "frequency".into(), "absolute error, Hz"),
    ];
    let errors: Vec<_> = windows.iter().map(|window| errors(window, wave)).collect();
    let bounds: Vec<_> = windows.iter().map(|window| window.bounds(wave)).collect();
    let noise = BOUND_NOISE * wave.main_amplitude;
    let panels = kinds.into_iter().enumerate();
    let panels = panels.map(|(i, (letter, title, axis))| {
        let found = CURVES.into_iter().enumerate().map(|(c, name)| Curve {
            name,
            y: errors
                .iter()
                .map(|all| all[c][i].abs().max(FLOOR))
                .collect(),
        });
        let found = found.filter(|curve| has_error(curve.name, letter));
        let names = [Name::Bound, Name::CentredBound].into_iter().enumerate();
        let bounds = names.map(|(c, name)| Curve {
            name,
            y: bounds.iter().map(|both| both[c][i] * noise).collect(),
        });
        Panel {
            letter,
            title: format!("{title}, without noise (bounds: noise of 0.01 %)"),
            axis,
            logarithmic: true,
            curves: found.chain(bounds).collect(),
        }
    });
    let points = windows.iter().map(|window| Point {
        periods: window.periods,
        rate: window.rate,
    });
    Figure {
        number,
        axis,
        x,
        points: points.collect(),
        runs: None,
        panels: panels.chain([deviations(windows)]).collect(),
    }
}

/// The panel of the windows' own deviations from whole periods.
fn deviations(windows: &[Samples]) -> Panel {
    let deviations = windows.iter().map(|window| window.deviation().abs());
    Panel {
        letter: 'e',
        title: "relative deviation of the sampled span from whole periods".into(),
        axis: "|n/(N·P) − 1|",
        logarithmic: false,
        curves: vec![Curve {
            name: Name::Deviation,
            y: deviations.collect(),
        }],
    }
}

/// True if a method gives the quantity of this panel.
fn has_error(name: Name, letter: char) -> bool {
    match name {
        Name::MeanReturn | Name::Difference => letter == 'd',
        Name::Fractional => letter != 'd',
        _ => true,
    }
}
