//! What a line of settings tells of the columns below it.

use super::Line;
use crate::recording::header::lossy;
use crate::recording::signal_units::is_known;
use crate::recording::units::bare;

/// The unit of time that a line of settings names, and the number of lines before it.
pub(super) fn unit_of_time(line: &Line) -> Option<(String, usize)> {
    let text = |field: &[u8]| lossy(field).trim_matches([':', ' ']).to_owned();
    let label = text(line.fields.first()?)
        .to_lowercase()
        .replace(['_', ' '], "");
    let is_told = ["horizontalunit", "horzunit", "hunit", "xunit", "timeunit"]
        .iter()
        .any(|name| label.starts_with(name));
    let unit = line.fields[1..].iter().find(|field| !field.is_empty());
    unit.filter(|_| is_told)
        .map(|unit| (text(unit), line.before))
}

/// The fields of a line of settings that has a unit over one of these columns, and the number of lines before it: `Vertical Units,mV,V`, or
/// `Vertical Units,CH1:mV,CH2:V`.
pub(super) fn units_over(line: &Line, columns: &[usize]) -> Option<(Vec<String>, usize)> {
    let label = lossy(line.fields.first()?).to_lowercase();
    let is_told = ["unit", "einheit", "unidad"]
        .iter()
        .any(|word| label.contains(word));
    let unit = |field: &&[u8]| {
        let text = lossy(field);
        bare(text.rsplit(':').next().unwrap_or_default()).to_owned()
    };
    let mut units: Vec<String> = line.fields.iter().map(unit).collect();
    // The label is none.
    units[0].clear();
    let is_unit = |&place: &usize| units.get(place).is_some_and(|unit| is_known(unit));
    (is_told && columns.iter().any(is_unit)).then_some((units, line.before))
}
