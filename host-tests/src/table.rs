//! Costs of the bench images, as a Markdown table that is committed for comparison.

use std::fmt;

/// Share by which costs may grow before a comparison fails.
const TOLERANCE: f64 = 0.03;
/// The image without a kernel, the flash of which is subtracted from that of the others.
pub const NOTHING: &str = "nothing";
/// The image to which instructions are compared.
pub const PEER: &str = "idsp_sums";
/// Cell without a number.
const NONE: &str = "–";
/// Mark of cycles of an earlier run.
const EARLIER: &str = "*";

/// Costs of one kernel.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Name of the image without `bench_`.
    pub kernel: String,
    /// Unit of work: `pair` or `window`.
    pub unit: String,
    /// Instructions per unit.
    pub instructions: f64,
    /// Cycles per unit, if an estimator or hardware counted them.
    pub cycles: Option<f64>,
    /// True if the cycles are those of an earlier run.
    pub earlier: bool,
    /// Bytes of flash in excess of [`NOTHING`]; for that image itself, all bytes.
    pub flash: u32,
    /// Bytes kept from call to call.
    pub state: u32,
    /// Bytes of the deepest stack below the caller.
    pub stack: u32,
}

impl Row {
    fn parse(line: &str) -> Option<Self> {
        let mut cells = line.strip_prefix('|')?.split('|').map(str::trim);
        let mut next = || cells.next();
        let (kernel, unit, instructions) = (next()?, next()?, next()?.parse().ok()?);
        next()?;
        let cycles = next()?;
        Some(Self {
            kernel: kernel.into(),
            unit: unit.into(),
            instructions,
            cycles: cycles.trim_end_matches(EARLIER).parse().ok(),
            earlier: cycles.ends_with(EARLIER),
            flash: next()?.parse().ok()?,
            state: next()?.parse().ok()?,
            stack: next()?.parse().ok()?,
        })
    }

    /// Costs that may not grow: name of the column, and the number as printed.
    fn costs(&self) -> [(&'static str, f64); 4] {
        [
            ("instructions", hundredths(self.instructions)),
            ("flash", self.flash.into()),
            ("state", self.state.into()),
            ("stack", self.stack.into()),
        ]
    }
}

/// Rounds to the printed digits.
fn hundredths(x: f64) -> f64 {
    (x * 100.0).round() / 100.0
}

/// The rows of all images.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table(pub Vec<Row>);

impl Table {
    /// Parses the table within a text: every line that is a row.
    pub fn parse(text: &str) -> Self {
        Self(text.lines().filter_map(Row::parse).collect())
    }

    /// The row of a kernel.
    pub fn row(&self, kernel: &str) -> Option<&Row> {
        self.0.iter().find(|row| row.kernel == kernel)
    }

    /// Takes missing cycles from an earlier table, for kernels with the same instructions.
    pub fn fill_cycles(&mut self, earlier: &Table) {
        for row in self.0.iter_mut().filter(|row| row.cycles.is_none()) {
            let same = earlier
                .row(&row.kernel)
                .filter(|was| was.instructions == hundredths(row.instructions));
            row.cycles = same.and_then(|was| was.cycles);
            row.earlier = row.cycles.is_some();
        }
    }

    /// Every cost more than 3 % above the one in `committed`, and every kernel that is in one table only.
    pub fn worse_than(&self, committed: &Table) -> Vec<String> {
        let mut faults = Vec::new();
        for row in &self.0 {
            let Some(was) = committed.row(&row.kernel) else {
                faults.push(format!("{}: not in the committed table", row.kernel));
                continue;
            };
            for ((column, is), (_, was)) in row.costs().into_iter().zip(was.costs()) {
                if is > was * (1.0 + TOLERANCE) {
                    faults.push(format!("{}: {column} was {was}, is {is}", row.kernel));
                }
            }
        }
        for was in &committed.0 {
            if self.row(&was.kernel).is_none() {
                faults.push(format!("{}: its image is gone", was.kernel));
            }
        }
        faults
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "| kernel | unit | instructions | of idsp's | cycles | flash | state | stack |\n|---|---|--:|--:|--:|--:|--:|--:|"
        )?;
        let peer = self.row(PEER);
        for row in &self.0 {
            let ratio = peer
                .filter(|peer| peer.unit == row.unit)
                .map_or(NONE.into(), |peer| {
                    format!("{:.2}", row.instructions / peer.instructions)
                });
            let cycles = row.cycles.map_or(NONE.into(), |cycles| {
                format!("{cycles:.2}{}", if row.earlier { EARLIER } else { "" })
            });
            writeln!(
                f,
                "| {} | {} | {:.2} | {ratio} | {cycles} | {} | {} | {} |",
                row.kernel, row.unit, row.instructions, row.flash, row.state, row.stack
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let row = |kernel: &str, instructions, cycles| Row {
            kernel: kernel.into(),
            unit: "pair".into(),
            instructions,
            cycles,
            earlier: false,
            flash: 1000,
            state: 100,
            stack: 0,
        };
        Table(vec![row(PEER, 50.0, None), row("block", 12.50, Some(18.5))])
    }

    #[test]
    fn a_printed_table_parses_to_the_same_table() {
        let printed = format!("words before\n\n{}\nwords after", table());
        assert!(printed.contains("| block | pair | 12.50 | 0.25 | 18.50 | 1000 | 100 | 0 |"));
        assert_eq!(Table::parse(&printed), table());
    }

    #[test]
    fn growth_beyond_the_tolerance_is_reported() {
        let mut now = table();
        now.0[1].instructions = 12.87;
        now.0[1].flash = 1030;
        assert!(now.worse_than(&table()).is_empty());
        now.0[1].instructions = 12.88;
        now.0[1].flash = 1031;
        now.0[0].stack = 1;
        assert_eq!(
            now.worse_than(&table()),
            [
                "idsp_sums: stack was 0, is 1",
                "block: instructions was 12.5, is 12.88",
                "block: flash was 1000, is 1031",
            ]
        );
        assert!(table().worse_than(&now).is_empty());
    }

    #[test]
    fn kernels_in_one_table_only_are_reported() {
        let mut now = table();
        now.0[1].kernel = "push".into();
        assert_eq!(
            now.worse_than(&table()),
            [
                "push: not in the committed table",
                "block: its image is gone"
            ]
        );
    }

    #[test]
    fn cycles_are_kept_only_if_instructions_are_the_same() {
        let mut now = table();
        now.0[1].cycles = None;
        let uncounted = now.clone();
        now.fill_cycles(&table());
        assert!(now.to_string().contains("18.50*"));
        let mut faster = uncounted;
        faster.0[1].instructions = 12.0;
        faster.fill_cycles(&table());
        assert_eq!(faster.0[1].cycles, None);
    }
}
