//! Counts of flagged rows, with remedies where many rows have one flag and no other.

use std::cmp::Reverse;

use antinode::Flags;

/// Rows from which on a remedy is named, if they are more than a tenth of all.
const MIN_OF_TENTH: u64 = 20;
/// The same if they are more than half of all: a recording may have only a few long windows.
const MIN_OF_HALF: u64 = 4;

/// Remedies for clipped rows.
const CLIPPED_REMEDY: &str = "reduce the gain if an amplifier or the converter limits the wave, or give a larger --periods if a tone near \
                              three times the frequency is taken for its third harmonic";

/// Remedies for circular rows, if these are most.
const CIRCULAR_REMEDIES: &str = "if noise hides by how much the amplitudes differ, give a larger --periods; if S_C and S_D are I and Q of a \
                                 lock-in amplifier, which are one wave a quarter period apart, give the pick-offs' own samples";

/// Whether so many of these rows have a flag that a remedy is named.
pub fn are_many(flagged: u64, rows: u64) -> bool {
    flagged >= MIN_OF_TENTH && 10 * flagged > rows || flagged >= MIN_OF_HALF && 2 * flagged > rows
}

/// Counts of rows by their flags.
#[derive(Debug, Default)]
pub struct FlagCounts {
    /// Whether these options were given.
    hum: bool,
    coloured: bool,
    rows: u64,
    flagged: u64,
    /// The name of each flag, and the rows that have it.
    counts: Vec<(&'static str, u64)>,
    misfits_alone: u64,
    clipped_alone: u64,
    circular_alone: u64,
}

impl FlagCounts {
    /// No rows yet, of an identification with or without `--hum` and `--coloured`.
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

    /// A warning in one line if any row is flagged; remedies for misfits only if their cause is not known otherwise.
    pub fn warning(&self, is_cause_known: bool) -> Option<String> {
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
        let mut warning = format!(
            "{flagged} of {rows} rows {} flagged: {}",
            if flagged == 1 { "is" } else { "are" },
            counts.join(", ")
        );
        let [misfits, clipped, circular] =
            [self.misfits_alone, self.clipped_alone, self.circular_alone];
        // A pattern may pass through a circle now and then, but does not stay.
        let stays = 2 * circular > rows;
        for (is_told, alone, flag, remedies) in [
            (!is_cause_known, misfits, "misfit", &*self.misfit_remedies()),
            (true, clipped, "clipped", CLIPPED_REMEDY),
            (stays, circular, "circular", CIRCULAR_REMEDIES),
        ] {
            if is_told && are_many(alone, rows) {
                warning += "; ";
                if alone < flagged {
                    warning += &format!("{alone} have only {flag}: ");
                }
                warning += remedies;
            }
        }
        Some(warning)
    }

    /// Remedies for misfits.
    fn misfit_remedies(&self) -> String {
        let mut warning = String::new();
        if !self.hum && !self.coloured {
            warning += "if there is mains hum or a wandering offset, give --hum; ";
        }
        if !self.coloured {
            warning +=
                "if a filter leaves less noise at three times the frequency, give --coloured; ";
        }
        let coloured = if self.coloured { "" } else { "--coloured and " };
        warning += &format!(
            "if there is a second tone, give {coloured}a --periods that holds several of its beats with the wave; "
        );
        warning
            + "if the frequency drifts or the pattern turns far within a window, give a smaller --periods; --residual FILE shows what the waves \
               leave of the samples"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The warning for rows with these flags, each this many times.
    fn warning(rows: &[(u64, Flags)]) -> Option<String> {
        let mut counts = FlagCounts::new(true, true);
        for &(count, flags) in rows {
            (0..count).for_each(|_| counts.see(flags));
        }
        counts.warning(false)
    }

    #[test]
    fn every_flag_is_counted() {
        assert_eq!(warning(&[]), None);
        assert_eq!(warning(&[(9, Flags::empty())]), None);
        let one = warning(&[(9, Flags::empty()), (1, Flags::REACQUIRED)]);
        assert_eq!(one.unwrap(), "1 of 10 rows is flagged: reacquired 1");
        let both = Flags::STEP.with(Flags::MISFIT);
        let several = warning(&[
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
    fn options_that_were_given_are_no_remedy() {
        for (hum, coloured) in [(false, false), (true, false), (false, true), (true, true)] {
            let mut counts = FlagCounts::new(hum, coloured);
            (0..4).for_each(|_| counts.see(Flags::MISFIT));
            let warning = counts.warning(false).unwrap();
            assert_eq!(
                warning.contains("give --hum"),
                !hum && !coloured,
                "{warning}"
            );
            assert_eq!(warning.contains("--coloured"), !coloured, "{warning}");
            assert!(warning.contains("a --periods that holds"), "{warning}");
            assert!(!counts.warning(true).unwrap().contains("--periods"));
        }
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
                format!("clipped 4; {CLIPPED_REMEDY}"),
            ),
            (
                vec![clean, (1, Flags::STEP), (20, Flags::CLIPPED)],
                format!("clipped 20, step 1; 20 have only clipped: {CLIPPED_REMEDY}"),
            ),
            (
                vec![(300, Flags::empty()), (20, Flags::CLIPPED)],
                "flagged: clipped 20".to_owned(),
            ),
            (
                vec![(150, Flags::empty()), (20, Flags::CLIPPED)],
                format!("clipped 20; {CLIPPED_REMEDY}"),
            ),
            (
                vec![clean, (19, Flags::CLIPPED)],
                "flagged: clipped 19".to_owned(),
            ),
            (vec![(3, Flags::CLIPPED)], "flagged: clipped 3".to_owned()),
            (
                vec![(6, Flags::empty()), (18, Flags::CIRCULAR)],
                format!("circular 18; {CIRCULAR_REMEDIES}"),
            ),
            (
                vec![(30, Flags::empty()), (29, Flags::CIRCULAR)],
                "flagged: circular 29".to_owned(),
            ),
        ] {
            let warning = warning(&rows).unwrap();
            assert!(warning.ends_with(&ends), "{warning}");
        }
    }
}
