//! The units of the two signals, and their conversion to a common one.

/// Units of signals, each with its spellings; lower case is one of them unless it is another unit.
const BASES: [(&str, &[&str]); 10] = [
    (
        "V",
        &[
            "V", "v", "volt", "volts", "Volt", "Volts", "VOLT", "VOLTS", "В",
        ],
    ),
    (
        "A",
        &[
            "A", "amp", "amps", "Amp", "Amps", "ampere", "amperes", "Ampere", "Amperes", "А",
        ],
    ),
    ("m", &["m", "metre", "metres", "meter", "meters"]),
    ("m/s", &["m/s"]),
    ("rad", &["rad"]),
    ("°", &["°", "deg"]),
    ("°/s", &["°/s", "deg/s", "dps"]),
    ("Pa", &["Pa"]),
    ("g", &["g"]),
    (
        "LSB",
        &["LSB", "lsb", "count", "counts", "Counts", "code", "codes"],
    ),
];

/// Prefixes and their powers of ten. None is beyond kilo: by `MV`, `mV` is meant.
const PREFIXES: [(&str, i32); 18] = [
    ("", 0),
    ("k", 3),
    ("m", -3),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("\u{fffd}", -6),
    ("n", -9),
    ("p", -12),
    ("kilo", 3),
    ("milli", -3),
    ("Milli", -3),
    ("micro", -6),
    ("nano", -9),
    ("к", 3),
    ("м", -3),
    ("мк", -6),
    ("н", -9),
];

/// What to do about the units of two signals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Together {
    /// Nothing: they are the same, or not known.
    Same,
    /// Divide each signal by its number, which brings both to the larger unit.
    Divided([f32; 2]),
    /// Warn: one is known, and the other may be the same.
    Unsure,
    /// Refuse: they measure different things.
    Never,
}

/// What to do about these units; `are_sure` if they are surely units and not labels.
pub(super) fn together(units: [&str; 2], are_sure: bool) -> Together {
    let [c, d] = units.map(known);
    match (c, d) {
        (Some((c, _)), Some((d, _))) if c != d => Together::Never,
        (Some((_, c)), Some((_, d))) if c == d => Together::Same,
        (Some((_, c)), Some((_, d))) => {
            let largest = c.max(d);
            Together::Divided([c, d].map(|power| 10f64.powi(largest - power) as f32))
        }
        (None, None) => Together::Same,
        // `A` and `B` are labels.
        _ if units.iter().all(|unit| unit.chars().count() <= 1) => Together::Same,
        _ if are_sure && !units.contains(&"") => Together::Unsure,
        _ => Together::Same,
    }
}

/// Whether a unit is one of a signal.
pub(super) fn is_known(unit: &str) -> bool {
    known(unit).is_some()
}

/// What a unit measures, and its power of ten.
fn known(unit: &str) -> Option<(&'static str, i32)> {
    PREFIXES.iter().find_map(|&(prefix, power)| {
        let rest = unit.strip_prefix(prefix)?;
        let (base, _) = BASES.iter().find(|(_, names)| names.contains(&rest))?;
        Some((*base, power))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_brought_to_the_larger() {
        for (units, expected) in [
            (["mV", "V"], Together::Divided([1e3, 1.0])),
            (["V", "mV"], Together::Divided([1.0, 1e3])),
            (["µV", "mV"], Together::Divided([1e3, 1.0])),
            (["Volt", "millivolts"], Together::Divided([1.0, 1e3])),
            (["mm", "m"], Together::Divided([1e3, 1.0])),
            (["V", "volts"], Together::Same),
            (["mV", "mV"], Together::Same),
            (["", ""], Together::Same),
            (["V", ""], Together::Same),
            (["mV", ""], Together::Same),
            (["A", "B"], Together::Same),
            (["left", "right"], Together::Same),
            (["V", "MV"], Together::Unsure),
            (["V", "A"], Together::Never),
            (["mV", "mA"], Together::Never),
            (["V", "LSB"], Together::Never),
        ] {
            assert_eq!(together(units, true), expected, "{units:?}");
        }
        assert_eq!(together(["V", "MV"], false), Together::Same);
    }
}
