//! `antinode identify` on text whose two signals have different units.

use std::fs;

use crate::common::{Row, WAVE, done, no_rows, printed, rows, rows_of, run, same_later, text};

/// A recording under a header, with its times and signals multiplied by these.
fn scaled(header: &str, time: f64, scales: [f64; 2]) -> String {
    let mut text = header.to_owned();
    for (k, pair) in WAVE.codes(5000).iter().enumerate() {
        let [c, d] = [0, 1].map(|i| scales[i] * f64::from(pair[i]) / 32_768.0);
        text += &format!("{:.5},{c},{d}\n", time * k as f64 * 1e-5);
    }
    text
}

#[test]
fn signals_are_brought_to_the_larger_unit() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.csv"), text(&WAVE.codes(5000))).unwrap();
    let expected = rows(here, "a.csv");
    for (header, time, scales, told) in [
        (
            "Time (s),Channel A (mV),Channel B (V)\n",
            1.0,
            [1e3, 1.0],
            "S_C is in mV and S_D in V: both are converted to V",
        ),
        (
            "Time,Channel A,Channel B\n(us),(V),(mV)\n\n",
            1e6,
            [1.0, 1e3],
            "S_C is in V and S_D in mV: both are converted to V",
        ),
        (
            "time,c [µV],d [mV]\n",
            1.0,
            [1e3, 1.0],
            "S_C is in µV and S_D in mV: both are converted to mV",
        ),
        (
            "microseconds,V,mV\n",
            1e6,
            [1.0, 1e3],
            "both are converted to V",
        ),
        (
            "x-axis,1,2\nsecond,Volt,millivolt\n",
            1.0,
            [1.0, 1e3],
            "S_C is in Volt and S_D in millivolt: both are converted to Volt",
        ),
        // As R and MATLAB write names.
        (
            "Time..s.,Channel.A..mV.,Channel.B..V.\n",
            1.0,
            [1e3, 1.0],
            "S_C is in mV and S_D in V: both are converted to V",
        ),
        (
            "time_ms_since_boot,ChannelA_mV_,ChannelB_V_\n",
            1e3,
            [1e3, 1.0],
            "S_C is in mV and S_D in V: both are converted to V",
        ),
        // The units of settings.
        (
            "Model,X\nSample Interval,1e-5\nVertical Units,mV,V\nLabel,,\nTIME,CH1,CH2\n",
            1.0,
            [1e3, 1.0],
            "S_C is in mV and S_D in V: both are converted to V",
        ),
        // Names in brackets count for more.
        (
            "Model,X\nSample Interval,1e-5\nVertical Units,V,V\nTime (s),CH1 (mV),CH2 (V)\n",
            1.0,
            [1e3, 1.0],
            "S_C is in mV and S_D in V: both are converted to V",
        ),
        (
            "Model,X\nVertical Units,CH1:V,CH2:mV\nTime,CH1,CH2\n",
            1.0,
            [1.0, 1e3],
            "S_C is in V and S_D in mV: both are converted to V",
        ),
    ] {
        fs::write(here.join("a.csv"), scaled(header, time, scales)).unwrap();
        let run = run(here, "identify a.csv --output csv");
        assert_eq!((run.code, run.err.lines().count()), (0, 1), "{}", run.err);
        assert!(run.err.starts_with("warning: a.csv: "), "{}", run.err);
        assert!(run.err.contains(told), "{}", run.err);
        let found = Row::all(&run.out);
        assert_eq!(found.len(), expected.len(), "{header}");
        for (found, expected) in found.iter().zip(&expected) {
            for name in ["main_amplitude", "quadrature_amplitude", "angle_rad"] {
                let apart = found.number(name) - expected.number(name);
                assert!(apart.abs() < 1e-5, "{header} {name}: {apart}");
            }
        }
    }
}

#[test]
fn units_of_different_quantities_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (header, line) in [
        ("Time (s),Channel A (V),Channel B (A)\n", 1),
        ("Time,Channel A,Channel B\n(s),(mV),(A)\n\n", 2),
        ("Time,Channel A,Channel B\ns,mV,LSB\n", 2),
    ] {
        fs::write(here.join("a.csv"), scaled(header, 1.0, [1.0, 1.0])).unwrap();
        let run = run(here, "identify a.csv");
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
        let told = format!("error: a.csv:{line}: S_C is in ");
        assert!(run.err.starts_with(&told), "{}", run.err);
        assert!(run.err.contains("no common unit; "), "{}", run.err);
        assert_eq!(run.err.lines().count(), 1);
    }
}

#[test]
fn equal_units_and_mere_names_give_no_warning() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for header in [
        "Time (s),Channel A (mV),Channel B (mV)\n",
        "Time (s),Channel (A),Channel (B)\n",
        "Time (s),S_A,S_B\n",
        "Time (s),A,B\n",
        "time,c,d\ns,V,volts\n",
        "time,c,d\ns,V,\n",
        "time,c,d\ns,A,B\n",
        "time,S_C,S_D\n",
    ] {
        fs::write(here.join("a.csv"), scaled(header, 1.0, [1.0, 1.0])).unwrap();
        assert!(rows(here, "a.csv").len() > 20, "{header}");
    }
}

#[test]
fn an_unknown_unit_beside_a_known_one_is_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let text = scaled("time,c,d\ns,V,MV\n", 1.0, [1.0, 1.0]);
    fs::write(here.join("a.csv"), text).unwrap();
    let run = done(here, "identify a.csv");
    let told = "warning: a.csv: S_C is in V and S_D in MV: one of these units is not known, and both signals are read without conversion";
    assert!(run.err.starts_with(told), "{}", run.err);
}

#[test]
fn units_of_settings_count_though_that_of_another_column_is_unknown() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let three = |units: &str| {
        let above = format!(
            "LabVIEW Measurement\t\nSeparator\tTab\n\nY_Unit_Label\t{units}\nX_Value\tc\tforce\td\n"
        );
        printed(&above, &WAVE.codes(5000), |k, [c, d]| {
            format!("{:.5}\t{c}\t0.3\t{}", k as f64 * 1e-5, 1e3 * d)
        })
    };
    fs::write(here.join("a.lvm"), three("V\tPounds\tmV")).unwrap();
    let found = done(here, "identify a.lvm --columns 1,2,4 --output csv");
    let told = "warning: a.lvm: S_C is in V and S_D in mV: both are converted to V\n";
    assert_eq!(found.err, told);
    for (found, expected) in Row::all(&found.out).iter().zip(&expected) {
        let apart = found.number("angle_rad") - expected.number("angle_rad");
        assert!(apart.abs() < 1e-5, "{apart}");
    }
    let run = run(here, "identify a.lvm --columns 1,2,3");
    let told = "warning: a.lvm: S_C is in V and S_D in Pounds: one of these units is not known";
    assert!(run.err.starts_with(told), "{}", run.err);
    let refused = "input:4: S_C is in Volts and S_D in g, which have no common unit";
    let other = three("Volts\tPounds\tg");
    no_rows(here, "- --columns 1,2,4", other.into(), &[refused]);
    // The label of the line is no unit.
    let above = "Model,X\nVertical Units,V\nc,d\n";
    let two = printed(above, &WAVE.codes(5000), |_, [c, d]| format!("{c},{d}"));
    same_later(&rows_of(here, &two, "--rate 1e5"), &expected, 0.0);
}

#[test]
fn units_are_known_in_russian_too() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::write(here.join("a.csv"), text(&WAVE.codes(5000))).unwrap();
    let expected = rows(here, "a.csv");
    for (header, time, c) in [
        ("Время;Канал A;Канал B\n(мс);(мВ);(В)\n\n", 1e3, 1e3),
        ("Время [мкс];Канал A [мВ];Канал B [В]\n", 1e6, 1e3),
    ] {
        let semicolons = scaled("", time, [c, 1.0]).replace(',', ";");
        fs::write(here.join("a.csv"), format!("{header}{semicolons}")).unwrap();
        let run = run(here, "identify a.csv --output csv");
        let told = "warning: a.csv: S_C is in мВ and S_D in В: both are converted to В\n";
        assert_eq!((run.code, run.err.as_str()), (0, told), "{header}");
        let found = Row::all(&run.out);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            for name in ["main_amplitude", "frequency_hz", "time_s"] {
                let apart = found.number(name) / expected.number(name) - 1.0;
                assert!(apart.abs() < 1e-4, "{header} {name}: {apart}");
            }
        }
    }
}

#[test]
fn an_unknown_unit_of_time_in_brackets_is_not_taken_for_seconds() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for units in [
        "(ミリ秒),(V),(V)",
        "[Millisekunden],[V],[V]",
        "(\u{3bc}s!),,",
    ] {
        let header = format!("Time,Channel A,Channel B\n{units}\n");
        fs::write(here.join("a.csv"), scaled(&header, 1e3, [1.0, 1.0])).unwrap();
        let fault = run(here, "identify a.csv --output csv");
        assert_eq!((fault.code, fault.out.as_str()), (1, ""), "{units}");
        let told = "error: a.csv:2: the time column `";
        assert!(fault.err.starts_with(told), "{}", fault.err);
        let told = "` is not in s, ms, us or ns; convert it to seconds, or ignore the time column with --columns 2,3 --rate HZ\n";
        assert!(fault.err.ends_with(told), "{}", fault.err);
        assert!(rows(here, "a.csv --columns 2,3 --rate 1e5").len() > 20);
    }
}

#[test]
fn a_time_too_slow_for_seconds_must_tell_its_unit() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let other =
        "if its times are in us, in ms or really in s, the header must say so, as in `time (us)`";
    for header in ["", "time,c,d\n"] {
        // As a microcontroller counts microseconds.
        fs::write(here.join("a.csv"), scaled(header, 1e6, [1.0, 1.0])).unwrap();
        let told = format!(
            "a.csv: the time column gives an absurd sample rate of 0.1 Hz; {other}, or ignore the time column with --columns 2,3 --rate HZ"
        );
        no_rows(here, "a.csv", Vec::new(), &[&told]);
        let run = done(here, "identify a.csv --rate 1e5");
        let told = format!("which takes precedence; {other}, or if the column is wrong, ignore it");
        assert!(run.err.contains(&told), "{}", run.err);
    }
    // Seconds may be as long, if the header says so.
    for (header, frequency) in [
        ("time (us),c,d\n", 5321.7),
        ("time (s),c,d\n", 5321.7e-6),
        ("time,c,d\ns,V,V\n", 5321.7e-6),
        ("Model,X\nHorizontal Units,s\ntime,c,d\n", 5321.7e-6),
    ] {
        fs::write(here.join("a.csv"), scaled(header, 1e6, [1.0, 1.0])).unwrap();
        let found = rows(here, "a.csv");
        let apart = found[0].number("frequency_hz") / frequency - 1.0;
        assert!(found.len() > 20 && apart.abs() < 1e-2, "{header}: {apart}");
    }
    // A rate that is absurd in any case is not recommended.
    let text = scaled("time (s),c,d\n", 1e9, [1.0, 1.0]);
    fs::write(here.join("a.csv"), text).unwrap();
    let run = done(here, "identify a.csv --rate 1e5");
    let told = "which takes precedence; correct the column's unit, or if";
    assert!(run.err.contains(told), "{}", run.err);
}

#[test]
fn a_time_with_an_unknown_unit_in_its_name_is_read_as_seconds_with_a_warning() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (name, units) in [
        ("Time (weeks)", ""),
        ("t [ticks]", ""),
        ("time [relative]", ",mV,mV\n"),
    ] {
        let text = scaled(&format!("{name},c,d\n{units}"), 1.0, [1.0, 1.0]);
        fs::write(here.join("a.csv"), text).unwrap();
        let run = run(here, "identify a.csv --output csv");
        assert_eq!((run.code, run.err.lines().count()), (0, 1), "{}", run.err);
        let told = format!("warning: a.csv: the unit of the time column `{name}` is not known, ");
        assert!(run.err.starts_with(&told), "{}", run.err);
        assert!(
            run.err
                .ends_with("ignore the column with --columns 2,3 --rate HZ\n")
        );
        assert!(Row::all(&run.out).len() > 20);
    }
    // A line of units, or the settings above, name the unit.
    for header in ["Zeit [Sekunden],c,d\n", "time [relative],c,d\ns,V,V\n"] {
        fs::write(here.join("a.csv"), scaled(header, 1.0, [1.0, 1.0])).unwrap();
        assert!(rows(here, "a.csv").len() > 20, "{header}");
    }
}
