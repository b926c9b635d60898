//! Arguments as clap takes them.

use std::ffi::OsString;

/// Writes out what clap would take for an option: `-9e-05`, as other programs print small numbers, and `-.5`.
pub(crate) fn written_out(argument: OsString) -> OsString {
    let number = argument
        .to_str()
        .filter(|text| text.starts_with("-.") || text.contains(['e', 'E']))
        .and_then(|text| text.parse::<f64>().ok())
        .filter(|number| number.is_finite() && number.is_sign_negative());
    match number {
        Some(number) => number.to_string().into(),
        None => argument,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_negative_numbers_are_written_out() {
        for (argument, wanted) in [
            ("-9e-05", "-0.00009"),
            ("-9.25E+2", "-925"),
            ("-.5", "-0.5"),
            ("-5", "-5"),
            ("9e-05", "9e-05"),
            ("-e", "-e"),
            ("-infE", "-infE"),
            ("-1e999", "-1e999"),
            ("--skew-ns=-9e-05", "--skew-ns=-9e-05"),
            ("ring.wav", "ring.wav"),
        ] {
            assert_eq!(written_out(argument.into()), wanted);
        }
    }
}
