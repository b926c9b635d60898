//! The methods of a window as lines under its row.

use std::io::{self, Write};

use antinode::Estimate;
use antinode::methods::comparison::DISAGREEMENT;

use super::Methods;
use super::rows::worst;
use crate::digits::with_sigmas;

/// The warning if the methods disagree.
pub const DISAGREE: &str =
    "the methods disagree beyond noise: the signal is not one steady wave in white noise";

/// Prints what the lines mean, once a table.
pub fn legend(out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "Under each row, methods 1 to 4 of the paper: value, and its difference from the row's in standard deviations (σ) of the row;\n\
         √(J/2) as residual; rank by the paper's conditions, then by J, 1 the best; the formulas whose conditions fail."
    )
}

/// Prints one line a method, in the columns of the row above, whose time is so wide, and a warning if the methods disagree.
pub fn table(
    out: &mut impl Write,
    e: &Estimate,
    methods: &Methods,
    width: usize,
) -> io::Result<()> {
    let comparison = &methods.comparison;
    for (i, method) in comparison.methods.iter().enumerate() {
        let shape = method.wave.shape;
        let [main, quadrature, angle] = method.differences;
        let mut remarks = format!("rank {}", method.rank);
        if !method.conditions.hold() {
            remarks += &format!(", fails {}", method.conditions);
        }
        let worst = worst(method);
        if worst > DISAGREEMENT || worst.is_nan() {
            remarks += &format!(", {worst:.0} σ unexplained");
        }
        writeln!(
            out,
            "{:>width$} {} {} {} {} {:>17} {:>8.1e}  {remarks}",
            format!("method {}", i + 1),
            with_sigmas(shape.main_amplitude, e.main_amplitude_std.into(), main),
            with_sigmas(
                shape.quadrature_amplitude,
                e.quadrature_amplitude_std.into(),
                quadrature
            ),
            with_sigmas(
                shape.angle.to_degrees(),
                f64::from(e.angle_std).to_degrees(),
                angle
            ),
            with_sigmas(
                methods.frequencies[i],
                e.frequency_std.into(),
                methods.frequency_differences[i]
            ),
            "",
            (0.5 * method.j).sqrt(),
        )?;
    }
    if comparison.disagree {
        writeln!(out, "{:>width$} {DISAGREE}", "warning:")?;
    }
    Ok(())
}
