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
    let windows = (1..=10).map(|periods| Samples::simulate(wave, periods, simulated.rate, 0.0, 0));
    let x = (1..=10).map(f64::from).collect();
    figure(1, "periods in the window", x, windows, wave)
}

/// Figure 2: one period, at 1 to 10 times the rate.
pub fn against_samples(simulated: &Simulated) -> Figure {
    let wave = &simulated.wave();
    let windows: Vec<Samples> = (1..=10)
        .map(|times| Samples::simulate(wave, 1, simulated.rate * f64::from(times), 0.0, 0))
        .collect();
    let x = windows.iter().map(|window| window.count as f64).collect();
    figure(
        2,
        "samples in the window of one period",
        x,
        windows.into_iter(),
        wave,
    )
}

/// The panels of the errors, with curves that have no points yet.
fn error_panels(wave: &Wave) -> Vec<Panel> {
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
    kinds
        .map(|(letter, title, axis)| Panel {
            letter,
            title: format!("{title}, without noise (bounds: noise of 0.01 %)"),
            axis,
            logarithmic: true,
            curves: CURVES
                .into_iter()
                .chain([Name::Bound, Name::CentredBound])
                .map(|name| Curve {
                    name,
                    y: Vec::new(),
                })
                .collect(),
        })
        .into()
}

fn figure(
    number: u8,
    axis: &'static str,
    x: Vec<f64>,
    windows: impl Iterator<Item = Samples>,
    wave: &Wave,
) -> Figure {
    let mut panels = error_panels(wave);
    let (mut deviation, mut points) = (Vec::new(), Vec::new());
    for window in windows {
        let noise = BOUND_NOISE * wave.main_amplitude;
        let bounds = window.bounds(wave).map(|bound| bound.map(|x| x * noise));
        let errors = errors(&window, wave);
        for (i, panel) in panels.iter_mut().enumerate() {
            let values = errors
                .iter()
                .map(|error| error[i].abs().max(FLOOR))
                .chain(bounds.map(|bound| bound[i]));
            for (curve, value) in panel.curves.iter_mut().zip(values) {
                curve.y.push(value);
            }
        }
        deviation.push(window.deviation().abs());
        points.push(Point {
            periods: window.periods,
            rate: window.rate,
        });
    }
    for panel in &mut panels {
        // By name, as a missing value has become the floor here, like one that is too small.
        panel.curves.retain(|curve| {
            !matches!(
                (curve.name, panel.letter),
                (Name::MeanReturn | Name::Difference, 'a'..='c') | (Name::Fractional, 'd')
            )
        });
    }
    panels.push(Panel {
        letter: 'e',
        title: "relative deviation of the sampled span from whole periods".into(),
        axis: "|n/(N·P) − 1|",
        logarithmic: false,
        curves: vec![Curve {
            name: Name::Deviation,
            y: deviation,
        }],
    });
    Figure {
        number,
        axis,
        x,
        points,
        runs: None,
        panels,
    }
}
