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
    all.write_notes(&all.runs, &mut notes).unwrap();
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
fn a_few_driven_runs_are_named_and_the_others_counted() {
    let run = read(&rows("a", 20, 0.01, |_| "")).runs.remove(0);
    let told = |count: usize| {
        let mut told = Vec::new();
        warn_of_driven(&mut told, &vec![run.clone(); count]).unwrap();
        String::from_utf8(told).unwrap()
    };
    assert_eq!(told(0), "");
    let named = "a, 0.2 s from 0.0 s on";
    let one = told(1);
    assert!(
        one.starts_with("warning: left out: 1 run in which"),
        "{one}"
    );
    assert!(one.ends_with(&format!("in others: {named}\n")), "{one}");
    let seven = told(7);
    assert_eq!(seven.matches(named).count(), MAX_NAMED);
    assert!(seven.ends_with("; and 2 more\n"), "{seven}");
}
