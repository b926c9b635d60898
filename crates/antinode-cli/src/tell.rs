//! Messages to the user.

use std::fmt::Display;
use std::io::{self, Write};

/// Prints a line to standard error. If that is closed, or on a full disk, nobody reads the line: the results must not be lost with it.
pub fn tell(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}
