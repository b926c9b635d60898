//! First lines without a value, as where an instrument writes the time before its signals come.
//!
//! They are sample pairs that are missing if samples follow at once, and padding above names or settings.

use super::{Line, is_sample};

/// The number of first lines that hold a number at most, their first, in as many fields as the line below them; 0 if that has others.
pub(super) fn count(lines: &[Line], separator: u8) -> usize {
    let is_silent = |line: &&Line| {
        let mut fields = line.fields.iter();
        let is_time = |first: &&[u8]| first.is_empty() || is_sample(first, separator);
        fields.next().is_none_or(is_time) && fields.all(|field| field.is_empty())
    };
    let silent = lines.iter().take_while(is_silent).count();
    let marks = |line: &Line| line.text.iter().filter(|&&b| b == separator).count();
    let below = lines.get(silent).map(marks);
    let has_as_many = |line: &Line| below.is_none_or(|below| marks(line) == below);
    let are_of_samples = separator != b' ' && lines[..silent].iter().all(has_as_many);
    if are_of_samples { silent } else { 0 }
}
