//! Quantities as CSV and JSON lines.

use std::io::{self, Write};

use serde::Serialize;

/// Writes rows as comma-separated values with a header.
pub fn csv(out: &mut impl Write, rows: impl Iterator<Item = impl Serialize>) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()
}

/// Writes rows as JSON objects, one a line.
pub fn jsonl(out: &mut impl Write, rows: impl Iterator<Item = impl Serialize>) -> io::Result<()> {
    for row in rows {
        serde_json::to_writer(&mut *out, &row)?;
        writeln!(out)?;
    }
    Ok(())
}
