//! Where `antinode resonator` and `antinode calibrate` write their result, and in which format.

use std::fs;

use crate::common::ring_downs::four_seconds;
use crate::common::run;

#[test]
fn the_result_goes_to_a_file_in_the_format_of_its_name() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let rows = four_seconds(here, "--decay-rate 0.08 --angle-rate 0.4");
    fs::write(here.join("rows.csv"), rows).unwrap();
    for command in ["resonator", "calibrate"] {
        let written = |name: &str, option: &str| {
            let found = run(here, &format!("{command} rows.csv -o {name} {option}"));
            assert_eq!((found.code, found.out.as_str()), (0, ""), "{}", found.err);
            fs::read_to_string(here.join(name)).unwrap()
        };
        for (name, option) in [("it.csv", "--output csv"), ("it.jsonl", "--output jsonl")] {
            let printed = run(here, &format!("{command} rows.csv {option}")).out;
            assert!(!printed.is_empty());
            assert_eq!(written(name, ""), printed, "{command} {name}");
            // With a format the name may end as it likes.
            assert_eq!(written("it.dat", option), printed, "{command} {option}");
        }
        #[cfg(unix)]
        for command in [
            format!("{command} rows.csv -o /dev/null"),
            format!("{command} rows.csv -o /dev/stderr --output csv"),
        ] {
            let found = run(here, &command);
            assert_eq!((found.code, found.out.as_str()), (0, ""), "{}", found.err);
            let is_shown = found.err.contains("gain_ratio") || found.err.contains("decay_time_s");
            assert_eq!(is_shown, command.contains("stderr"), "{}", found.err);
        }
        // The rows are not overwritten, and nothing is read in vain.
        for (name, told) in [
            ("rows.csv", "has rows to be read"),
            ("./rows.csv", "has rows to be read"),
            ("it.tsv", "end the name in .csv"),
            ("none/it.csv", "there is no directory"),
        ] {
            let found = run(here, &format!("{command} rows.csv -o {name}"));
            assert!(
                found.code > 0 && found.err.contains(told),
                "{name}: {}",
                found.err
            );
        }
    }
}
