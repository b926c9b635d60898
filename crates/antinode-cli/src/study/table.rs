//! A figure as CSV: one row for each point of a curve, with the conditions that were simulated.

use std::path::Path;

use antinode_sim::Wave;

use super::figure::Figure;

/// The columns, with which the file explains itself.
const COLUMNS: [&str; 17] = [
    "figure",
    "panel",
    "quantity",
    "value_is",
    "curve",
    "main_amplitude",
    "quadrature_amplitude",
    "angle_rad",
    "phase_rad",
    "frequency_hz",
    "sample_rate_hz",
    "periods",
    "runs",
    "seed",
    "x_is",
    "x",
    "value",
];

/// Writes all panels of a figure of this wave.
pub fn write(path: &Path, figure: &Figure, wave: &Wave) -> Result<(), csv::Error> {
    let of_wave = [
        wave.main_amplitude,
        wave.quadrature_amplitude,
        wave.angle,
        wave.phase,
        wave.frequency,
    ];
    let of_wave = of_wave.map(|number| number.to_string());
    let [runs, seed] = figure
        .runs
        .map_or([String::new(), String::new()], |(runs, seed)| {
            [runs.to_string(), seed.to_string()]
        });
    let mut out = csv::Writer::from_path(path)?;
    out.write_record(COLUMNS)?;
    for panel in &figure.panels {
        for curve in &panel.curves {
            for ((x, point), y) in figure.x.iter().zip(&figure.points).zip(&curve.y) {
                let [main, quadrature, angle, phase, frequency] = &of_wave;
                out.write_record([
                    &figure.number.to_string(),
                    &panel.letter.to_string(),
                    panel.title.as_str(),
                    panel.axis,
                    curve.name.text(),
                    main,
                    quadrature,
                    angle,
                    phase,
                    frequency,
                    &point.rate.to_string(),
                    &point.periods.to_string(),
                    &runs,
                    &seed,
                    figure.axis,
                    &x.to_string(),
                    &format!("{y:.6e}"),
                ])?;
            }
        }
    }
    out.flush()?;
    Ok(())
}
