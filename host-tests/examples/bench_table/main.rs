//! Builds the bench images of `firmware`, runs each in QEMU, prints a table of their costs, and compares it with
//! `firmware/BENCHES.md`: `cargo bench-table`, or `cargo bench-table --bless` to rewrite that file.
//!
//! Cycles come from a program that the environment variable `ANTINODE_CYCLES` names. It is called with `ELF --units N --json` and
//! prints a JSON object whose member `cycles` is a number: cycles a unit between the calls of `mark_begin` and `mark_end`, N units
//! in all. Without it the committed cycles are printed with a star, if the instructions are still the same.

mod image;

use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use host_tests::table::{NOTHING, Row, Table};

use image::Image;

/// Text before the table in the file.
const HEAD: &str = "\
# What the core costs on a Cortex-M4F

Written by `cargo bench-table --bless`; `cargo bench-table` fails where a cost is more than 3 % above this table.
`application`, the whole instrument, is compiled as it is flashed, the others in the profile `release`.

| column | meaning |
|---|---|
| unit | what instructions and cycles are counted for: one sample pair, one window of 10 periods, or the longest call that takes one pair |
| of idsp's | instructions, divided by those of the same four sums of the same codes with the crate idsp |
| cycles | by the core's timing table, without the flash's wait states; a star marks those of an earlier run |
| flash | bytes of the image beyond those of `nothing`, which has only the codes, the marks and the report |
| state | bytes kept from call to call |
| stack | the most bytes below the caller, from the first sample on, without the state |

";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(faults) => {
            for fault in faults {
                eprintln!("error: {fault}");
            }
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Vec<String>> {
    let bless = match env::args().skip(1).collect::<Vec<_>>().as_slice() {
        [] => false,
        [option] if option == "--bless" => true,
        _ => return Err(vec!["usage: cargo bench-table [--bless]".into()]),
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let file = root.join("firmware/BENCHES.md");
    let committed = Table::parse(&fs::read_to_string(&file).unwrap_or_default());
    let mut table = measure(&root).map_err(|fault| vec![fault])?;
    table.fill_cycles(&committed);
    print!("{table}");
    for kind in ["fixed", "f32"] {
        let row = |kernel| table.row(&format!("{kernel}_{kind}"));
        let (Some(beside), Some(alone)) = (row("methods"), row("block")) else {
            continue;
        };
        print!(
            "\nThe demodulator with the sums of all four methods beside it, {kind}: {:.2} times the instructions of the demodulator alone",
            beside.instructions / alone.instructions
        );
        if let (Some(beside), Some(alone)) = (beside.cycles, alone.cycles) {
            print!(", {:.2} times its cycles", beside / alone);
        }
        println!(".");
    }
    if bless {
        return fs::write(&file, format!("{HEAD}{table}"))
            .map_err(|fault| vec![format!("{}: {fault}", file.display())]);
    }
    let mut faults = table.worse_than(&committed);
    if faults.is_empty() {
        return Ok(());
    }
    faults.push("where this is meant to be so: cargo bench-table --bless".into());
    Err(faults)
}

/// Measures all images.
fn measure(root: &Path) -> Result<Table, String> {
    let images = image::build(root)?;
    let nothing = images
        .iter()
        .find(|image| image.kernel == NOTHING)
        .ok_or("there is no image bench_nothing")?
        .flash()?;
    let row = |image: &Image| {
        let flash = image.flash()?;
        let report = image.run()?;
        Ok(Row {
            kernel: image.kernel.clone(),
            unit: match report.units {
                1 if image.kernel.starts_with("longest") => "call",
                1 => "window",
                _ => "pair",
            }
            .into(),
            instructions: f64::from(report.instructions) / f64::from(report.units),
            cycles: image.cycles(report.units)?,
            earlier: false,
            flash: if image.kernel == NOTHING {
                flash
            } else {
                flash.saturating_sub(nothing)
            },
            state: report.state,
            stack: report.stack,
        })
    };
    images.iter().map(row).collect::<Result<_, _>>().map(Table)
}
