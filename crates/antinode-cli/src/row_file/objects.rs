//! Rows as JSON lines: each an object, whose names are the columns.

use std::io::{self, BufRead};

use csv::StringRecord;
use serde_json::{Map, Value};

use super::lines::Lines;

/// The names in an object, which are the columns.
pub(super) fn names(line: &[u8]) -> serde_json::Result<StringRecord> {
    let object: Map<String, Value> = serde_json::from_slice(line)?;
    Ok(object.keys().map(String::as_str).collect())
}

/// Reads the next object's fields in the order of the names; false at the end.
pub(super) fn read(
    lines: &mut Lines<impl BufRead>,
    names: &StringRecord,
    record: &mut StringRecord,
) -> io::Result<bool> {
    let line = lines.next()?;
    if line.is_empty() {
        return Ok(false);
    }
    let object: Map<String, Value> = serde_json::from_slice(line)?;
    record.clear();
    for name in names {
        match object.get(name) {
            None => record.push_field(""),
            // JSON has `null` in place of NaN and infinities.
            Some(Value::Null) => record.push_field("NaN"),
            Some(Value::String(text)) => record.push_field(text),
            Some(other) => record.push_field(&other.to_string()),
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn null_is_not_a_number() {
        let first = b"{\"time_s\":0.1,\"flags\":\"lost\"}\n";
        let names = names(first).unwrap();
        let text = [&first[..], b"{\"flags\":\"\",\"time_s\":null}\n"].concat();
        let mut lines = Lines::new(text.as_slice());
        let mut record = StringRecord::new();
        for expected in [["lost", "0.1"], ["", "NaN"]] {
            assert!(read(&mut lines, &names, &mut record).unwrap());
            assert_eq!(record, expected.to_vec());
        }
        assert!(!read(&mut lines, &names, &mut record).unwrap());
    }
}
