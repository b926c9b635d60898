//! `antinode identify` on text that a serial logger printed: with a greeting above the samples, and its own name for the time.

use crate::common::{WAVE, rows_of, same_later, text};

#[test]
fn a_greeting_above_the_samples_changes_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let plain = text(&WAVE.codes(5000));
    let expected = rows_of(here, &plain, "");
    let samples = plain.split_once('\n').unwrap().1;
    for mark in [",", "\t", ";", " "] {
        let samples = samples.replace(',', mark);
        for above in ["ready\r\n", "Booting\nTeensy ADC dump v1.3\n\n"] {
            let found = rows_of(here, &format!("{above}{samples}"), "");
            same_later(&found, &expected, 0.0);
        }
    }
}

#[test]
fn the_time_of_an_arduino_is_known_by_the_name_of_its_function() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let plain = text(&WAVE.codes(5000));
    let expected = rows_of(here, &plain, "");
    let rows = plain.lines().skip(1).enumerate().map(|(k, line)| {
        let pair = line.split_once(',').unwrap().1;
        format!("{},{pair}\n", 10 * k + 2_000_000)
    });
    let counted = "micros,adc0,adc1\n".to_owned() + &rows.collect::<String>();
    same_later(&rows_of(here, &counted, ""), &expected, 2.0);
}
