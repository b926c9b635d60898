//! Preparation of the arguments for clap: wildcards are expanded, negative numbers written out.

use std::ffi::OsString;
use std::path::PathBuf;

use glob::{MatchOptions, glob_with};

/// The files that match a pattern with `*` or `?`, which may be quoted, as names with spaces are; the argument itself if none does.
pub(crate) fn matches(argument: OsString) -> Vec<OsString> {
    let files = argument.to_str().map_or_else(Vec::new, files);
    if files.is_empty() {
        return vec![argument];
    }
    files.into_iter().map(PathBuf::into_os_string).collect()
}

fn files(pattern: &str) -> Vec<PathBuf> {
    if !pattern.contains(['*', '?']) {
        return Vec::new();
    }
    // Brackets are literal: `ring[1].wav` does not match `ring1.wav`.
    let literal = |letter| match letter {
        '[' | ']' => format!("[{letter}]"),
        _ => String::from(letter),
    };
    let pattern: String = pattern.chars().map(literal).collect();
    let options = MatchOptions {
        case_sensitive: false,
        require_literal_leading_dot: true,
        ..MatchOptions::new()
    };
    glob_with(&pattern, options).map_or_else(|_| Vec::new(), |found| found.flatten().collect())
}

/// Writes out in plain decimals a negative number that clap would take for an option: `-9e-05`, as other programs print it, or `-.5`.
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
    use std::fs;

    use super::*;

    #[test]
    fn a_pattern_becomes_the_files_that_match_it() {
        let directory = tempfile::tempdir().unwrap();
        let here = directory.path().join("both ways [2]");
        fs::create_dir(&here).unwrap();
        for name in ["b.WAV", "a.wav", "ring1.wav", "ring[1].wav", ".c.wav"] {
            fs::write(here.join(name), "").unwrap();
        }
        for (pattern, wanted) in [
            ("*.wav", &["a.wav", "b.WAV", "ring1.wav", "ring[1].wav"][..]),
            ("?.wav", &["a.wav", "b.WAV"]),
            ("ring[1].w*", &["ring[1].wav"]),
            ("ring[1].wav", &["ring[1].wav"]),
            ("ring[2].wav", &["ring[2].wav"]),
            ("*.npy", &["*.npy"]),
            ("a**.wav", &["a**.wav"]),
        ] {
            let found = matches(here.join(pattern).into_os_string());
            let wanted: Vec<_> = wanted
                .iter()
                .map(|name| here.join(name).into_os_string())
                .collect();
            assert_eq!(found, wanted, "{pattern}");
        }
    }

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
