use super::*;

const HEADER: &str = "file,time_s,main_amplitude,quadrature_amplitude,angle_rad,frequency_hz,main_amplitude_std,quadrature_amplitude_std,angle_std_rad,flags\n";

/// Rows of one file, 10 ms apart, that turn by `turn` rad each.
fn rows(file: &str, count: usize, turn: f64, flags: impl Fn(usize) -> &'static str) -> String {
    (0..count)
        .map(|k| {
            let (time, angle) = (0.01 * k as f64, turn * k as f64);
            format!(
                "{file},{time},0.5,0.02,{angle},5332,0.001,0.001,0.001,{}\n",
                flags(k)
            )
        })
        .collect()
}

/// No runs yet, of rows at all times.
fn runs(max_turn: f64) -> Runs {
    Runs::new(
        f64::NEG_INFINITY..f64::INFINITY,
        max_turn,
        Flags::REACQUIRED,
    )
}

fn read(rows: &str) -> Runs {
    let mut all = runs(0.1);
    add(&mut all, &(HEADER.to_owned() + rows)).unwrap();
    all
}

fn add(all: &mut Runs, text: &str) -> Result<(), Failure> {
    all.read(RowFile::new("it", std::io::Cursor::new(text.to_owned()))?)
}

/// Number of rows of each run.
fn lengths(all: &Runs) -> Vec<usize> {
    all.runs.iter().map(|run| run.rows.len()).collect()
}

#[test]
fn a_run_ends_with_its_file() {
    let all = read(&(rows("a", 20, 0.05, |_| "") + &rows("b", 30, -0.04, |_| "")));
    assert_eq!(lengths(&all), [20, 30]);
    assert_eq!(all.rows, 50);
    assert!((all.runs[0].turned() - 19.0 * 0.05).abs() < 1e-9);
    assert!((all.runs[1].turned() + 29.0 * 0.04).abs() < 1e-9);
    // A file that goes on where the last one ended is another recording.
    let one = rows("a", 40, 0.01, |_| "");
    let (first, rest) = one.split_at(one.match_indices("a,0.2,").next().unwrap().0);
    let all = read(&(first.to_owned() + &rest.replace("a,", "b,")));
    assert_eq!(lengths(&all), [20, 20]);
    let mut all = runs(0.1);
    for turn in [0.05, -0.05] {
        let text = HEADER.to_owned() + &rows("a", 20, turn, |_| "");
        add(&mut all, &text).unwrap();
    }
    assert_eq!((lengths(&all), all.rows), (vec![20, 20], 40));
    // Time that goes back is another recording too, whatever it is called.
    let all = read(&(rows("a", 20, 0.0, |_| "") + &rows("a", 30, 0.0, |_| "")));
    assert_eq!(lengths(&all), [20, 30]);
}

#[test]
fn rows_of_several_recordings_may_stand_in_the_order_of_their_time() {
    let late = |k: usize| if k == 17 { "reacquired" } else { "" };
    let one = rows("a", 40, 0.05, |_| "");
    let other = rows("b", 40, -0.04, late);
    let pairs = one.lines().zip(other.lines());
    let mixed: String = pairs.map(|(a, b)| format!("{a}\n{b}\n")).collect();
    let [mixed, apart] = [read(&mixed), read(&(one + &other))];
    assert_eq!(lengths(&mixed), [40, 17, 22]);
    assert_eq!((mixed.backward, mixed.rows), (0, 80));
    for (mixed, apart) in mixed.runs.iter().zip(&apart.runs) {
        assert!(mixed.is_copy(apart) && mixed.file == apart.file);
    }
}

#[test]
fn flagged_rows_are_left_out() {
    let all = read(&rows("a", 40, 0.02, |k| if k == 5 { "misfit" } else { "" }));
    assert_eq!(lengths(&all), [39]);
    // How far the pattern turned meanwhile is not known.
    let lost = |k| match k {
        15..20 => "lost",
        20 => "reacquired",
        _ => "",
    };
    let all = read(&rows("a", 40, 0.002, lost));
    assert_eq!(lengths(&all), [15, 19]);
    assert!((all.runs[1].turned() - 18.0 * 0.002).abs() < 1e-9);
}

#[test]
fn a_wave_that_jumps_across_rows_left_out_begins_another_run() {
    let torn = |k| if k == 20 { "misfit" } else { "" };
    // Lengths of the runs if a_A jumps by a share, or a_B or θ by this much.
    let jump = |main: f64, quadrature: f64, angle: f64, flags: fn(usize) -> &'static str| {
        let text: String = (0..40)
            .map(|k| {
                let moved = f64::from(u8::from(k >= 20));
                let time = 0.01 * f64::from(k);
                let noise = 0.001 * (7.3 * f64::from(k)).sin();
                format!(
                    "a,{time},{},{},{},5332,0.001,0.001,0.001,{}\n",
                    0.5 * (1.0 + moved * main) * (1.0 - 0.1 * time) + noise,
                    0.02 + moved * quadrature - noise,
                    0.002 * f64::from(k) + moved * angle + noise,
                    flags(k as usize)
                )
            })
            .collect();
        lengths(&read(&text))
    };
    assert_eq!(jump(0.0, 0.0, 0.0, torn), [39]);
    for (main, quadrature, angle) in [
        (0.06, 0.0, 0.0),
        (-0.06, 0.0, 0.0),
        (0.0, 0.03, 0.0),
        (0.0, 0.0, 0.06),
    ] {
        assert_eq!(jump(main, quadrature, angle, torn), [20, 19]);
    }
    // A jump between clean rows is seen too, and its row left out; not at a circle, where amplitudes change places.
    assert_eq!(jump(0.06, 0.0, 0.0, |_| ""), [19, 20]);
    let circle = |k| if k == 20 { "circular" } else { "" };
    assert_eq!(jump(0.06, 0.0, 0.0, circle), [39]);
}

#[test]
fn a_wave_that_jumps_across_missing_rows_begins_another_run() {
    // Reports that a line has lost, at a jump of a_A.
    let read = |missing: std::ops::Range<usize>, jump: f64| {
        let rows = (0..60).filter(|k| !missing.contains(k)).map(|k| {
            let moved = if k < 30 { 0.0 } else { jump };
            let main = (1.0 + moved) * (-1e-3 * k as f64).exp();
            let noise = 1e-5 * (7.3 * k as f64).sin();
            format!(
                "a,{},{},0.02,0.3,5332,1e-5,1e-5,1e-5,\n",
                0.01 * k as f64,
                main + noise
            )
        });
        lengths(&read(&rows.collect::<String>()))
    };
    for missing in [30..31, 29..31, 28..31, 27..33, 25..32] {
        let [before, after] = [missing.start, 60 - missing.end];
        assert_eq!(read(missing.clone(), 0.05), [before, after]);
        assert_eq!(read(missing, 0.0), [before + after]);
    }
}

#[test]
fn a_jump_is_also_seen_after_rows_with_large_deviations() {
    let read = |jump: f64| {
        let text: String = (0..60)
            .map(|k| {
                let (moved, flag) = match k {
                    0..25 => (0.0, ""),
                    25 => (0.0, "misfit"),
                    _ => (jump, ""),
                };
                // A burst that goes on counts as noise.
                let noise = if (26..29).contains(&k) { 50.0 } else { 1.0 };
                let main = 0.5 * (-1e-3 * f64::from(k)).exp() * (1.0 + moved);
                let [main, std] = [
                    main + 1e-5 * noise * (7.3 * f64::from(k)).sin(),
                    1e-5 * noise,
                ];
                format!(
                    "a,{},{main},0.02,0.3,5332,{std},{std},{std},{flag}\n",
                    0.01 * f64::from(k)
                )
            })
            .collect();
        lengths(&read(&text))
    };
    assert_eq!(read(0.0), [59]);
    // The rows that may belong to either side are left out.
    assert_eq!(read(0.003), [25, 31]);
}

#[test]
fn an_angle_is_known_modulo_a_quarter_turn() {
    let wrapped = |text: &str| text.replace(",1.6,", ",0.029203673205103,");
    let text = rows("a", 41, 0.08, |_| "");
    assert_ne!(wrapped(&text), text);
    for text in [wrapped(&text), text] {
        let all = read(&text);
        assert_eq!(lengths(&all), [41]);
        assert!((all.runs[0].turned() - 3.2).abs() < 1e-9);
    }
}

#[test]
fn too_fast_a_turn_and_too_few_rows_are_no_run() {
    assert!(read(&rows("a", 40, 0.11, |_| "")).runs.is_empty());
    assert!(read(&rows("a", 11, 0.01, |_| "")).runs.is_empty());
    assert_eq!(lengths(&read(&rows("a", 12, 0.01, |_| ""))), [12]);
}

#[test]
fn a_faulty_row_is_reported_with_its_line() {
    let text = HEADER.to_owned() + &rows("a", 3, 0.01, |_| "").replace("0.01,0.5", "0.01,x");
    let fault = add(&mut runs(0.1), &text).unwrap_err();
    assert!(fault.to_string().contains("it, line 3: "), "{fault}");
    for (before, after, message) in [
        ("frequency_hz", "f", "no column frequency_hz"),
        ("flags", "state", "no column flags"),
    ] {
        let text = HEADER.replace(before, after);
        let fault = add(&mut runs(0.1), &text).unwrap_err();
        assert!(fault.to_string().contains(message), "{fault}");
    }
}

#[test]
fn a_row_with_a_flag_need_not_have_numbers() {
    let text = rows("a", 40, 0.0, |k| if k == 5 { "lost" } else { "" });
    let text = text.replace("a,0.05,0.5,0.02,0,5332,", "a,0.05,0,NaN,NaN,inf,");
    assert!(text.contains("inf"));
    assert_eq!(lengths(&read(&text)), [39]);
}

#[test]
fn a_circle_whose_digits_are_rounded_is_read() {
    let circle = |quadrature: &str| {
        let text = rows("a", 20, 0.01, |_| "").replace(",0.02,", quadrature);
        add(&mut runs(0.1), &(HEADER.to_owned() + &text))
    };
    assert!(circle(",-0.5025,").is_ok());
    let fault = circle(",-0.51,").unwrap_err().to_string();
    assert!(fault.contains("not within ±main_amplitude"), "{fault}");
}

#[test]
fn headers_of_joined_files_are_skipped() {
    let text = rows("a", 20, 0.01, |_| "") + HEADER + &rows("b", 30, 0.01, |_| "");
    let all = read(&text);
    assert_eq!((lengths(&all), all.rows), (vec![20, 30], 50));
}

#[test]
fn the_reason_for_no_run_is_reported() {
    let message = |text: &str| read(text).fault("it").map(|fault| fault.to_string());
    let few = rows("a", 11, 0.01, |_| "");
    let fault = message(&few).unwrap();
    assert!(
        fault.contains("no run of 12 clean rows, as there are only 11 rows; shorten"),
        "{fault}"
    );
    let flagged = message(&rows("a", 40, 0.01, |_| "misfit")).unwrap();
    assert!(flagged.contains("see the rows' flags"), "{flagged}");
    let backwards: String = rows("a", 40, 0.01, |_| "")
        .lines()
        .rev()
        .map(|line| format!("{line}\n"))
        .collect();
    let fault = message(&backwards).unwrap();
    assert!(
        fault.contains("time does not increase from row to row, 39 times in 40 rows"),
        "{fault}"
    );
    // One recording under two names.
    let copies = rows("a", 40, 0.01, |_| "") + &rows("b", 40, 0.01, |_| "");
    let fault = message(&copies).unwrap();
    let twice = "it: a run of a and of b, 0.4 s with 40 rows from 0 s on, is given twice, which would make deviations too small";
    assert!(fault.starts_with(twice), "{fault}");
    for (count, reason) in [(0, "as there are no rows;"), (1, "as there is only 1 row;")] {
        let fault = message(&rows("a", count, 0.01, |_| "")).unwrap();
        assert!(fault.contains(reason), "{fault}");
    }
    assert_eq!(message(&rows("a", 40, 0.01, |_| "")), None);
}

#[test]
fn the_times_of_rows_are_told_if_none_is_asked_for() {
    let mut all = Runs::new(7.0..8.0, 0.1, Flags::REACQUIRED);
    let later = rows("a", 40, 0.01, |_| "");
    let earlier = rows("b", 20, 0.01, |_| "");
    add(&mut all, &(HEADER.to_owned() + &later + &earlier)).unwrap();
    let told = all.fault("it").unwrap().to_string();
    assert!(told.ends_with("the rows' times go from 0 s to 0.39 s"));
}

/// What is noted of these rows.
fn notes(all: &Runs) -> String {
    let mut notes = Vec::new();
    all.write_notes(&mut notes).unwrap();
    String::from_utf8(notes).unwrap()
}

#[test]
fn further_steps_are_counted() {
    let mut all = read(&rows("a", 40, 0.01, |_| ""));
    assert_eq!(notes(&all), "");
    for (time, told) in [
        (1.0, "1.00 s of a: "),
        (2.0, "1.00 s of a, and at 1 place more: "),
    ] {
        all.steps.push(("a".to_owned(), time));
        let notes = notes(&all);
        assert!(
            notes.starts_with(&format!("a gain or the wave steps at {told}")),
            "{notes}"
        );
    }
}

#[test]
fn a_short_part_of_a_recording_repeats_it() {
    let whole = rows("a", 400, 0.0, |_| "");
    // Between the rows of the whole that are compared.
    let part: String = (0..20)
        .map(|k| {
            let time = 1.045 + 0.01 * f64::from(k);
            format!("a,{time},0.5,0.02,0,5332,0.001,0.001,0.001,\n")
        })
        .collect();
    let all = read(&(part + &whole));
    assert_eq!(lengths(&all), [20, 400]);
    assert!(notes(&all).contains("rows of a cover the same time twice"));
}

#[test]
fn rows_that_are_kept_do_not_overlap() {
    let header = HEADER.replace("flags", "decay_rate_std_s,flags");
    // Windows of 1 s, by their deviations.
    let of_rate = 12f64.sqrt() * 0.001 / 0.5;
    for (step, kept_every) in [(0.101, 10), (0.1, 10), (0.31, 4), (0.95, 2), (0.99, 1)] {
        let text: String = (0..400)
            .map(|k| {
                let time = step * f64::from(k);
                format!("a,{time},0.5,0.02,0.1,5332,0.001,0.001,0.001,{of_rate},\n")
            })
            .collect();
        let mut all = runs(0.1);
        add(&mut all, &(header.clone() + &text)).unwrap();
        let kept = 400usize.div_ceil(kept_every);
        assert_eq!(
            (lengths(&all), all.overlapping),
            (vec![kept], 400 - kept),
            "{step}"
        );
    }
}

#[test]
fn a_pattern_that_turns_to_and_fro_turns_both_ways() {
    let turns = |angles: &[f64]| {
        let rows = angles
            .iter()
            .enumerate()
            .map(|(k, angle)| format!("a,{k},0.5,0.02,{angle},5332,0.001,0.001,0.001,\n"));
        let mut all = runs(1.0);
        add(&mut all, &(HEADER.to_owned() + &rows.collect::<String>())).unwrap();
        let [back, forth] = all.runs[0].turns();
        [back, forth].map(|turn| (turn * 10.0).round() / 10.0)
    };
    let forth: Vec<f64> = (0..20).map(|k| 0.5 * f64::from(k)).collect();
    assert_eq!(turns(&forth), [0.0, 9.5]);
    let back: Vec<f64> = forth.iter().rev().copied().collect();
    assert_eq!(turns(&back), [-9.5, 0.0]);
    // Further forth after it came back half of the way.
    let both: Vec<f64> = [&forth[..], &back[1..10], &forth[10..]].concat();
    assert_eq!(turns(&both), [-4.5, 9.5]);
}

#[test]
fn rows_flagged_misfit_alone_show_the_way_of_the_pattern() {
    let bow = |flags: &str| {
        let row = |k: usize| {
            let begun = k as f64 - 14.0;
            let angle = 1e-3 * begun.clamp(0.0, 7.0).powi(2) + 0.014 * (begun - 7.0).max(0.0);
            let flags = match k {
                15..18 => "misfit",
                18..21 => flags,
                _ => "",
            };
            let time = 0.01 * k as f64;
            format!("a,{time},0.5,0.02,{angle},5332,0.001,0.001,0.01,{flags}\n")
        };
        let all = read(&(0..40).map(row).collect::<String>());
        assert_eq!(lengths(&all), [34]);
        let [others, next] = [14, 15].map(|index| all.runs[0].rows[index].bow);
        assert_eq!(others, [0.0; BOWS]);
        next
    };
    let [first, ..] = bow("misfit");
    // −θ̈ T²/2.
    assert!((first + 0.049).abs() < 1e-3, "{first}");
    assert_eq!(bow("circular"), [0.0; BOWS]);
    assert_eq!(bow("circular+misfit"), [0.0; BOWS]);
}
