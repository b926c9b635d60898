//! Recordings of converters that have fewer bits than the integers they are stored in.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use crate::common::{RATE, Row, WAVE, Wave, done, npy, rms, rows, run, run_with, silence};

/// The rows of a simulated recording.
fn identified(here: &Path, name: &str, simulate: &str, identify: &str) -> Vec<Row> {
    done(here, &format!("simulate -o {name} {simulate}"));
    rows(here, &format!("{name} {identify}"))
}

#[test]
fn steps_of_few_bits_count_in_the_deviations() {
    let directory = tempfile::tempdir().unwrap();
    // Almost 20 samples a period, so that 12-bit codes repeat; noise of a tenth of a code is too little to prevent that.
    let simulate = "--seconds 1 --bits 12 --frequency 5000.01 --noise 5e-5";
    for (name, sample, rate) in [
        ("a.wav", "--sample i16", ""),
        ("b.wav", "--sample i24", ""),
        ("c.npy", "", "--rate 100000"),
    ] {
        let rows = identified(
            directory.path(),
            name,
            &format!("{simulate} {sample}"),
            rate,
        );
        assert!(rows.len() > 400);
        let squares = rows.iter().map(|row| {
            let off = row.number("main_amplitude") - 0.5;
            (off / row.number("main_amplitude_std")).powi(2)
        });
        let rms = (squares.sum::<f64>() / rows.len() as f64).sqrt();
        assert!((0.3..1.3).contains(&rms), "{name}: {rms}");
    }
}

#[test]
fn the_largest_code_of_few_bits_is_the_rail_unless_rails_are_given() {
    let directory = tempfile::tempdir().unwrap();
    for (amplitude, option, is_clipped) in [
        (0.99, "", false),
        (0.9999, "", true),
        (0.9999, "--full-scale -1.1,1.1", false),
    ] {
        let rows = identified(
            directory.path(),
            "a.wav",
            &format!(
                "--seconds 0.1 --bits 12 --noise 1e-4 --angle 0 --quadrature-amplitude 0.01 --main-amplitude {amplitude}"
            ),
            option,
        );
        let clipped = rows
            .iter()
            .filter(|row| row.text("flags").contains("clipped"));
        let share = clipped.count() as f64 / rows.len() as f64;
        // Not every window has a sample close to a crest.
        let expected = if is_clipped { 0.9..=1.0 } else { 0.0..=0.0 };
        assert!(expected.contains(&share), "{amplitude} {option}: {share}");
    }
}

#[test]
fn an_unsigned_converter_is_clipped_only_if_both_rails_are_given() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut codes = "c,d\n".to_owned();
    for k in 0..20_000 {
        // Codes of 12 bits, whose lowest in a crest is 0; nothing is cut off.
        let s = (TAU * 0.0532 * f64::from(k)).cos();
        codes += &format!("{:.0},{:.0}\n", 1200.0 + 1200.0 * s, 1200.0 - 300.0 * s);
    }
    fs::write(here.join("codes.csv"), codes).unwrap();
    for (option, is_clipped) in [
        ("", false),
        ("--full-scale 4095", false),
        ("--full-scale -1,4095", false),
        ("--full-scale 0,4095", true),
        ("--full-scale -4095,2400", true),
    ] {
        let rows = rows(here, &format!("codes.csv --rate 1e5 {option}"));
        assert!(rows.len() > 90);
        let clipped = rows.iter().filter(|row| row.text("flags") == "clipped");
        let share = clipped.count() as f64 / rows.len() as f64;
        // Not every window has a sample close to a crest.
        let expected = if is_clipped { 0.9..=1.0 } else { 0.0..=0.0 };
        assert!(expected.contains(&share), "{option}: {share}");
    }
}

#[test]
fn rails_given_as_codes_are_warned_of_with_their_scaled_values() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // 12-bit codes from 0 to 4095 that are cut off, in unsigned integers of 16 bits.
    let bytes = (0..20_000u32).flat_map(|k| {
        let s = (TAU * 0.0532 * f64::from(k)).cos();
        [2048.0 + 2200.0 * s, 2048.0 + 500.0 * s].map(|code| code.round().clamp(0.0, 4095.0) as u16)
    });
    let bytes: Vec<u8> = bytes.flat_map(u16::to_le_bytes).collect();
    fs::write(here.join("codes.raw"), bytes).unwrap();
    let identify = |rails: &str| {
        let found = done(
            here,
            &format!("identify --output csv --raw u16 --rate 1e5 --full-scale {rails} codes.raw"),
        );
        let rows = Row::all(&found.out);
        let clipped = rows
            .iter()
            .filter(|row| row.text("flags") == "clipped")
            .count();
        (found.err, clipped as f64 / rows.len() as f64)
    };
    let (told, _) = identify("0,4095");
    assert!(
        told.contains(
            "codes.raw: --full-scale: 0 and 4095 are not rails of 16-bit unsigned integers, which are scaled to lie within ±1; \
             if these are codes, give --full-scale -1,-0.875030517578125\n"
        ),
        "{told}"
    );
    let (told, share) = identify("-1,-0.875030517578125");
    assert!(
        !told.contains("--full-scale") && share > 0.9,
        "{told} {share}"
    );
    for rails in ["2.5", "-5,1"] {
        let (told, _) = identify(rails);
        assert!(told.contains("within ±1\n"), "{told}");
    }
}

#[test]
fn a_wave_cut_off_without_a_known_rail_is_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (level, is_told) in [(2090.0, true), (1e9, false)] {
        let mut codes = "c,d\n".to_owned();
        let mut seed = 1u32;
        for k in 0..50_000 {
            let (s, c) = (TAU * 0.053_217 * f64::from(k)).sin_cos();
            let mut noisy = |code: f64| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (code + 4.0 * f64::from(seed) / 4_294_967_296.0)
                    .round()
                    .min(level)
            };
            codes += &format!("{},{}\n", noisy(300.0 * s), noisy(100.0 + 2000.0 * c));
        }
        fs::write(here.join("codes.csv"), codes).unwrap();
        let found = run(here, "identify --rate 1e5 --output csv codes.csv");
        let told = "warning: codes.csv: S_D is at its highest value, 2090, ";
        assert_eq!(found.err.contains(told), is_told, "{}", found.err);
    }
}

#[test]
fn a_step_coarser_than_the_noise_is_named_if_rows_scatter() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let step = "(angle 1.45 times): the converter's step of 3.9e-3 is coarser than the noise";
    for (noise, is_told) in [("0", true), ("0.004", false)] {
        let simulate =
            format!("simulate -o a.wav --seconds 4 --bits 9 --frequency 5321.7 --noise {noise}");
        done(here, &simulate);
        let found = done(here, "identify --output csv a.wav");
        assert_eq!(found.err.contains(step), is_told, "{noise}: {}", found.err);
        assert_eq!(found.err.is_empty(), !is_told, "{noise}: {}", found.err);
    }
}

/// An NPY file of unsigned integers, whose header is as long as that of signed ones.
fn unsigned(codes: &[[i16; 2]]) -> Vec<u8> {
    let mut bytes = npy(codes);
    let place = bytes.windows(3).position(|bytes| bytes == b"<i2").unwrap();
    bytes[place + 1] = b'u';
    bytes
}

/// A wave with an amplitude of `codes` codes about the middle of a 12-bit converter that counts from 0 and saturates.
fn counted(codes: f64) -> Vec<[i16; 2]> {
    let wave = Wave {
        main: codes / 32_768.0,
        quadrature: -0.07 * codes / 32_768.0,
        noise: 1.0 / 32_768.0,
        ..WAVE
    };
    let pairs = wave.codes(20_000).into_iter();
    pairs
        .map(|pair| pair.map(|code| (code + 2048).clamp(0, 4095)))
        .collect()
}

#[test]
fn codes_from_0_are_one_wave_in_signed_and_in_unsigned_integers() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let numbers = |name: &str, codes: &[[i16; 2]], bytes: Vec<u8>| {
        fs::write(here.join(name), bytes).unwrap();
        let found = rows(here, &format!("{name} --rate {RATE}"));
        assert!(found.len() * 200 > codes.len(), "{name}: {}", found.len());
        found
    };
    for amplitude in [1500.0, 150.0] {
        let codes = counted(amplitude);
        let signed = numbers("signed.npy", &codes, npy(&codes));
        let found = numbers("unsigned.npy", &codes, unsigned(&codes));
        assert_eq!(found.len(), signed.len());
        for (found, signed) in found.iter().zip(&signed) {
            assert_eq!(found.text("flags"), "");
            for name in ["main_amplitude", "quadrature_amplitude", "angle_rad"] {
                let off = found.number(name) - signed.number(name);
                assert!(
                    off.abs() < 0.1 * signed.number("angle_std_rad"),
                    "{name}: {off}"
                );
            }
            // 0 stands for mid-scale of all 16 bits.
            assert!((found.number("offset_c") - (2048.0 / 32_768.0 - 1.0)).abs() < 1e-4);
        }
    }
    let codes = counted(3000.0);
    let found = numbers("unsigned.npy", &codes, unsigned(&codes));
    assert!(
        found
            .iter()
            .all(|row| row.text("flags").contains("clipped"))
    );
}

#[test]
fn a_few_codes_show_the_step_if_sampling_is_locked_to_the_wave() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for (samples, sample) in [(4, "i16"), (5, "i16"), (4, "i24"), (5, "i24"), (8, "i16")] {
        let mut errors = [Vec::new(), Vec::new(), Vec::new()];
        for k in 0..24 {
            let (main, angle) = (0.4 + 0.0137 * f64::from(k), 0.05 + 0.06 * f64::from(k));
            let phase = 0.11 * f64::from(k);
            let simulate = format!(
                "--seconds 0.2 --bits 12 --sample {sample} --rate {} --main-amplitude {main} --quadrature-amplitude 0.03 \
                 --angle {angle} --phase {phase}",
                5332 * samples
            );
            let rows = identified(here, "a.wav", &simulate, "--frequency 5332");
            assert!(rows.len() > 90);
            for row in &rows {
                let turn = TAU / 4.0;
                let off = row.number("angle_rad") - angle;
                for (errors, (error, std)) in errors.iter_mut().zip([
                    (row.number("main_amplitude") - main, "main_amplitude_std"),
                    (
                        row.number("quadrature_amplitude") - 0.03,
                        "quadrature_amplitude_std",
                    ),
                    (off - turn * (off / turn).round(), "angle_std_rad"),
                ]) {
                    errors.push(error / row.number(std));
                }
            }
        }
        for errors in errors {
            let rms = rms(&errors);
            assert!((0.7..1.5).contains(&rms), "{samples} {sample}: {rms}");
        }
    }
}

#[test]
fn a_step_that_shows_only_at_the_end_is_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Six codes with two unused bits: too few to show the step at once.
    let simulate = "simulate -o a.wav --seconds 1 --bits 14 --rate 21328";
    done(here, simulate);
    let raw = fs::read(here.join("a.wav")).unwrap()[44..].to_vec();
    let silent = done(here, "identify --frequency 5332 a.wav");
    for option in [
        "give --resolution 0.00012207031\n",
        "warning: a.wav: all samples are multiples of 0.00012207031, ",
    ] {
        assert!(silent.err.contains(option), "{}", silent.err);
    }
    assert_eq!(
        run(
            here,
            "identify --frequency 5332 --resolution 0.00012207031 a.wav"
        )
        .err,
        ""
    );
    // In a pipe the warning comes after a second, and only once.
    let piped = run_with(
        here,
        "identify --frequency 5332 --raw i16 --rate 21328 -",
        [&raw[..], &raw[..]].concat(),
    );
    assert_eq!(
        (piped.code, piped.err.lines().count()),
        (0, 1),
        "{}",
        piped.err
    );
    let start = "warning: standard input: so far all samples are multiples of 0.00012207031, ";
    assert!(piped.err.starts_with(start), "{}", piped.err);
    // Noise of several steps makes the rounding random: no warning.
    let noisy = format!("{simulate} --noise 0.0005");
    done(here, &noisy);
    let raw = fs::read(here.join("a.wav")).unwrap()[44..].to_vec();
    let piped = run_with(
        here,
        "identify --frequency 5332 --raw i16 --rate 21328 -",
        raw,
    );
    assert_eq!((piped.code, piped.err.as_str()), (0, ""));
}

#[test]
fn a_few_values_of_text_without_a_known_step_are_warned_of() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let simulate = "simulate -o a.csv --seconds 0.2 --bits 12 --rate 26660";
    done(here, simulate);
    let told = run(here, "identify --frequency 5332 a.csv");
    let start = "warning: a.csv: the first samples have only 10 distinct values: ";
    assert!(
        told.code == 0 && told.err.starts_with(start),
        "{}",
        told.err
    );
    let given = "identify --frequency 5332 --resolution 0.00048828125 a.csv";
    assert_eq!(run(here, given).err, "");
    // Without a wave there are no deviations.
    let noise = silence(0.005).codes(2000);
    let value = |code: i16| f64::from(code.rem_euclid(13)).sqrt();
    let few = noise
        .iter()
        .map(|&[c, d]| format!("{:.6},{:.6}\n", value(c), value(d)));
    fs::write(here.join("none.csv"), few.collect::<String>()).unwrap();
    let told = run(here, "identify --rate 26660 none.csv");
    assert!(
        told.code == 1 && !told.err.contains("distinct"),
        "{}",
        told.err
    );
    // Whole numbers show their step.
    let text = fs::read_to_string(here.join("a.csv")).unwrap();
    let whole = text.lines().skip(1).map(|line| {
        let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
        let mut code = || 2048.0 * fields.next_back().unwrap();
        let (d, c) = (code(), code());
        format!("{c},{d}\n")
    });
    fs::write(here.join("whole.csv"), whole.collect::<String>()).unwrap();
    let rows = rows(here, "whole.csv --rate 26660 --frequency 5332");
    let std = rows[0].number("main_amplitude_std");
    assert!((0.1..0.4).contains(&std), "{std}");
}
