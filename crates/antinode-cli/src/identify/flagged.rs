//! What may be done where many rows have one flag and no other.

use antinode::Flags;

use super::options::Identify;

/// Rows from which on a remedy is named, where they are a tenth of all.
const MANY: u64 = 20;
/// The same where they are most of all: a recording may have but a few long windows.
const SOME: u64 = 4;

/// What may be done about clipped rows.
const OF_CLIPPED: &str = "give the wave less gain where an amplifier or the converter limits it, or a larger --periods where a tone near \
                          three times the frequency is taken for its third harmonic";

/// Rows with one flag and no other.
#[derive(Debug, Default)]
pub(super) struct Flagged {
    misfits: u64,
    clipped: u64,
}

impl Flagged {
    /// Takes a row's flags.
    pub fn see(&mut self, flags: Flags) {
        self.misfits += u64::from(flags == Flags::MISFIT);
        self.clipped += u64::from(flags == Flags::CLIPPED);
    }

    /// What to tell, of so many rows.
    pub fn told(&self, rows: u64, options: &Identify) -> [Option<String>; 2] {
        let told = |count: u64, flag: &str, remedies: &str| {
            let is_many = count >= MANY && 10 * count > rows || count >= SOME && 2 * count > rows;
            is_many.then(|| format!("{count} of {rows} rows are flagged {flag} alone; {remedies}"))
        };
        [
            told(self.misfits, "misfit", &of_misfits(options)),
            told(self.clipped, "clipped", OF_CLIPPED),
        ]
    }
}

/// What may be done about misfits.
fn of_misfits(options: &Identify) -> String {
    let mut told = String::new();
    if !options.hum && !options.coloured {
        told += "if that is mains hum or an offset that wanders, --hum takes it out; ";
    }
    if !options.coloured {
        told += "if a filter leaves less noise at three times the frequency, give --coloured; ";
    }
    let coloured = if options.coloured {
        ""
    } else {
        "--coloured and "
    };
    told += &format!(
        "if there is a second tone, give {coloured}a --periods that holds several of its beats with the wave; "
    );
    told + "if the frequency drifts or the pattern turns far within a window, give a smaller --periods"
}
