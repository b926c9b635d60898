//! How many rows are flagged and by what, and what may be done where many of them have one flag and no other.

use std::cmp::Reverse;

use antinode::Flags;

/// Rows from which on a remedy is named, where they are a tenth of all.
const MANY: u64 = 20;
/// The same where they are most of all: a recording may have but a few long windows.
const SOME: u64 = 4;

/// What may be done about clipped rows.
const OF_CLIPPED: &str = "give the wave less gain where an amplifier or the converter limits it, or a larger --periods where a tone near \
                          three times the frequency is taken for its third harmonic";

/// What may be wrong where most rows are circular.
const OF_CIRCULAR: &str = "S_C and S_D are one wave a quarter period apart, as I and Q of a lock-in amplifier are: give the pick-offs' own \
                           samples, not demodulated ones";

/// Rows with flags.
#[derive(Debug, Default)]
pub struct FlagCounts {
    /// What is taken for no fault.
    hum: bool,
    coloured: bool,
    rows: u64,
    flagged: u64,
    /// Of each flag.
    counts: Vec<(&'static str, u64)>,
    misfits_alone: u64,
    clipped_alone: u64,
    circular_alone: u64,
}

impl FlagCounts {
    /// None yet, of an identification with `--hum` and `--coloured` or without.
    pub fn new(hum: bool, coloured: bool) -> Self {
        Self {
            hum,
            coloured,
            ..Self::default()
        }
    }

    /// Takes a row's flags.
    pub fn see(&mut self, flags: Flags) {
        self.rows += 1;
        self.flagged += u64::from(!flags.is_empty());
        self.misfits_alone += u64::from(flags == Flags::MISFIT);
        self.clipped_alone += u64::from(flags == Flags::CLIPPED);
        self.circular_alone += u64::from(flags == Flags::CIRCULAR);
        for name in flags.names() {
            match self.counts.iter_mut().find(|(known, _)| *known == name) {
                Some((_, count)) => *count += 1,
                None => self.counts.push((name, 1)),
            }
        }
    }

    /// What to tell in one line where there are any; what may be done about misfits only where nothing else tells why.
    pub fn told(&self, knows_why: bool) -> Option<String> {
        if self.flagged == 0 {
            return None;
        }
        let (flagged, rows) = (self.flagged, self.rows);
        let mut counts = self.counts.clone();
        counts.sort_by_key(|&(_, count)| Reverse(count));
        let counts: Vec<String> = counts
            .iter()
            .map(|(name, count)| format!("{name} {count}"))
            .collect();
        let mut told = format!(
            "{flagged} of {rows} rows {} flagged: {}",
            if flagged == 1 { "is" } else { "are" },
            counts.join(", ")
        );
        // A pattern goes through a circle now and then, but does not stay.
        let circular = if 2 * self.circular_alone > rows {
            self.circular_alone
        } else {
            0
        };
        let misfits = if knows_why { 0 } else { self.misfits_alone };
        for (alone, flag, remedies) in [
            (misfits, "misfit", self.of_misfits()),
            (self.clipped_alone, "clipped", OF_CLIPPED.to_owned()),
            (circular, "circular", OF_CIRCULAR.to_owned()),
        ] {
            if alone >= MANY && 10 * alone > rows || alone >= SOME && 2 * alone > rows {
                told += "; ";
                if alone < flagged {
                    told += &format!("{alone} have {flag} alone: ");
                }
                told += &remedies;
            }
        }
        Some(told)
    }

    /// What may be done about misfits.
    fn of_misfits(&self) -> String {
        let mut told = String::new();
        if !self.hum && !self.coloured {
            told += "if that is mains hum or an offset that wanders, --hum takes it out; ";
        }
        if !self.coloured {
            told += "if a filter leaves less noise at three times the frequency, give --coloured; ";
        }
        let coloured = if self.coloured { "" } else { "--coloured and " };
        told += &format!(
            "if there is a second tone, give {coloured}a --periods that holds several of its beats with the wave; "
        );
        told + "if the frequency drifts or the pattern turns far within a window, give a smaller --periods"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told of rows with these flags, so many times each.
    fn told(rows: &[(u64, Flags)]) -> Option<String> {
        let mut counts = FlagCounts::new(true, true);
        for &(count, flags) in rows {
            (0..count).for_each(|_| counts.see(flags));
        }
        counts.told(false)
    }

    #[test]
    fn every_flag_is_counted() {
        assert_eq!(told(&[]), None);
        assert_eq!(told(&[(9, Flags::empty())]), None);
        let one = told(&[(9, Flags::empty()), (1, Flags::REACQUIRED)]);
        assert_eq!(one.unwrap(), "1 of 10 rows is flagged: reacquired 1");
        let both = Flags::STEP.with(Flags::MISFIT);
        let several = told(&[
            (90, Flags::empty()),
            (1, Flags::STEP),
            (3, both),
            (1, Flags::MISFIT),
        ]);
        // The first of equals comes first.
        assert_eq!(
            several.unwrap(),
            "5 of 95 rows are flagged: step 4, misfit 4"
        );
    }

    #[test]
    fn a_remedy_is_named_for_many() {
        let clean = (30, Flags::empty());
        for (rows, ends) in [
            (
                vec![clean, (3, Flags::CLIPPED)],
                "flagged: clipped 3".to_owned(),
            ),
            (
                vec![(2, Flags::empty()), (4, Flags::CLIPPED)],
                format!("clipped 4; {OF_CLIPPED}"),
            ),
            (
                vec![clean, (1, Flags::STEP), (20, Flags::CLIPPED)],
                format!("clipped 20, step 1; 20 have clipped alone: {OF_CLIPPED}"),
            ),
            (
                vec![(300, Flags::empty()), (20, Flags::CLIPPED)],
                "flagged: clipped 20".to_owned(),
            ),
            (
                vec![(6, Flags::empty()), (18, Flags::CIRCULAR)],
                format!("circular 18; {OF_CIRCULAR}"),
            ),
            (
                vec![(30, Flags::empty()), (29, Flags::CIRCULAR)],
                "flagged: circular 29".to_owned(),
            ),
        ] {
            let told = told(&rows).unwrap();
            assert!(told.ends_with(&ends), "{told}");
        }
    }
}
