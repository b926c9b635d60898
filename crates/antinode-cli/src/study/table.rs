//! A figure as CSV: one row a point of a curve.

use std::path::Path;

use super::figure::Figure;

/// Writes all panels of a figure.
pub fn write(path: &Path, figure: &Figure) -> Result<(), csv::Error> {
    let mut out = csv::Writer::from_path(path)?;
    out.write_record([
        "figure", "panel", "quantity", "value_is", "curve", "x_is", "x", "value",
    ])?;
    for panel in &figure.panels {
        for curve in &panel.curves {
            for (x, y) in figure.x.iter().zip(&curve.y) {
                out.write_record([
                    &figure.number.to_string(),
                    &panel.letter.to_string(),
                    panel.title.as_str(),
                    panel.axis,
                    curve.name.text(),
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
