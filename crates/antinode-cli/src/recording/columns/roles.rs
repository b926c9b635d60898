//! What a column holds by its name.

use super::super::error::TIME;

/// A name's letters and digits, in lower case, without what follows in brackets.
pub(super) fn bare_name(name: &str) -> String {
    let bare = name.split(['[', '(', '/']).next().unwrap_or_default();
    let bare = bare.to_lowercase();
    bare.chars()
        .filter(|letter| letter.is_alphanumeric())
        .collect()
}

/// What a column holds by its name, as its place in [`ROLES`].
pub(super) fn role(name: &str) -> Option<usize> {
    match bare_name(name).as_str() {
        "t" | "time" | "times" | "ts" | "s" | "sec" | "second" | "seconds" | "timestamp"
        | "xvalue" | "timems" | "timeus" | "timens" | "tms" | "tus" | "tns" | "millis"
        | "micros" => Some(TIME),
        "c" | "sc" | "left" => Some(1),
        "d" | "sd" | "right" => Some(2),
        _ => None,
    }
}

/// Whether a name says what its column holds.
pub(in crate::recording) fn is_known(name: &str) -> bool {
    role(name).is_some()
}

/// Whether these names are those of S_D and S_C, in this order.
pub(in crate::recording) fn are_swapped(names: [&str; 2]) -> bool {
    names.map(role) == [Some(2), Some(1)]
}

/// Whether a name says that its column holds the time.
pub(in crate::recording) fn is_time(name: &str) -> bool {
    role(name) == Some(TIME)
}

/// Whether a name is that of a mere count of lines, or one of the letters that may be a current if there is a time too.
pub(super) fn is_index(name: &str) -> bool {
    is_count(name) || ["i", "k"].contains(&name.to_lowercase().as_str())
}

/// Whether a name is that of a count of lines, whatever the other columns are.
pub(super) fn is_count(name: &str) -> bool {
    let names = [
        "", "#", "n", "nr", "no", "index", "idx", "sample", "samples", "point", "points",
        "counter", "seq",
    ];
    names.contains(&name.to_lowercase().trim_end_matches('.'))
}
