//! The fields of a line, and which of them can be trusted.

use super::super::error::{Fault, Place, ROLES, TIME};
use super::super::header::Header;
use super::super::lines::{Line, Lines};
use crate::digits::counted;

/// A line cut into fields.
pub(super) struct Cut<'a> {
    /// The time and the two samples as they are written; empty if not asked for, missing, or uncertain in a broken line.
    pub texts: [&'a [u8]; 3],
    /// The number of fields.
    count: usize,
    /// Whether there are too many.
    is_long: bool,
    /// The first role whose field is missing.
    short: Option<usize>,
}

impl<'a> Cut<'a> {
    pub fn of(line: Line<'a>, header: &Header) -> Self {
        let mut found = [None; 3];
        let (mut count, mut filled) = (0, 0);
        for field in line.fields() {
            for (text, place) in found.iter_mut().zip(header.places) {
                if place == Some(count) {
                    *text = Some(field);
                }
            }
            count += 1;
            if !field.is_empty() {
                filled = count;
            }
        }
        // Separators at the end of a line, as spreadsheets pad it with, begin no fields.
        let is_long = filled > header.width;
        let mut roles = 0..ROLES.len();
        let short = roles.find(|&role| header.places[role].is_some() && found[role].is_none());
        for (text, place) in found.iter_mut().zip(header.places) {
            // In two lines run together no field is certain; in a line cut off, all are but the one that is cut.
            if is_long || short.is_some() && place.is_some_and(|place| place + 1 == count) {
                *text = None;
            }
        }
        Self {
            texts: found.map(Option::unwrap_or_default),
            count,
            is_long,
            short,
        }
    }

    /// The fault of a line of too many or too few fields, and a description of the line.
    pub fn broken(&self, lines: &Lines, header: &Header) -> Option<(Fault, String)> {
        let (count, width) = (self.count, header.width);
        let fault = if self.is_long {
            let names = if count == width + 1 {
                ", and write no row names (in R `row.names = FALSE`)"
            } else {
                ""
            };
            let told = format!(
                "found {count} fields where the first line has {width}; use another separator \
                 than the decimal mark, and the same one in every line{names}"
            );
            Fault::line(lines.number(), told)
        } else {
            let role = self.short?;
            missing(header, place(lines, header, role), role)
        };
        let fields = counted(count as u64, "field");
        let description = format!("a line of {fields} where the first has {width}");
        Some((fault, description))
    }
}

/// This line, and the column of this `role`.
pub(super) fn place(lines: &Lines, header: &Header, role: usize) -> Place {
    Place {
        line: lines.number(),
        column: header.places[role].map(|place| place + 1),
    }
}

/// The fault of a line without a field of this `role`.
pub(super) fn missing(header: &Header, place: Place, role: usize) -> Fault {
    let told = format!(
        "{} is missing here; complete or delete the line",
        ROLES[role]
    );
    let told = match role {
        TIME => header.or_ignore_time(&told),
        _ => told,
    };
    Fault::at(Some(place), told)
}
