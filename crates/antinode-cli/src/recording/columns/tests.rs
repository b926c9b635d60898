//! Which columns are taken, by names, units and numbers.

use super::*;

fn places(header: &str, chosen: Option<&str>) -> Result<Places, String> {
    stamped_places(header, chosen, &[])
}

/// The same where a column holds clock times.
fn stamped_places(header: &str, chosen: Option<&str>, stamped: &[usize]) -> Result<Places, String> {
    let names: Vec<String> = header
        .split(',')
        .map(|name| name.trim().to_owned())
        .collect();
    let line = FirstLine {
        names: Some(&names),
        units: &[],
        width: names.len(),
        may_be_timed: true,
        has_numbers: false,
        stamped: stamped.to_vec(),
        clocks: vec![0, 2],
        start: &Start::default(),
        is_of_rows: false,
    };
    let chosen = chosen.map(str::parse).transpose()?;
    line.places(chosen.as_ref())
        .map_err(|fault| fault.to_string())
}

#[test]
fn names_decide_and_else_the_order() {
    let usual = Ok([Some(0), Some(1), Some(2)]);
    assert_eq!(places("time,c,d", None), usual);
    assert_eq!(places("zeit,x,y", None), usual);
    assert_eq!(places("zeit,c,d", None), usual);
    assert_eq!(places("Time [s], S_C (V), S_D (V)", None), usual);
    assert_eq!(places("x,y", None), Ok([None, Some(0), Some(1)]));
    assert_eq!(places("d,c", None), Ok([None, Some(1), Some(0)]));
    assert_eq!(
        places("right,left,t", None),
        Ok([Some(2), Some(1), Some(0)])
    );
    assert_eq!(places("x,time,y", None), Ok([Some(1), Some(0), Some(2)]));
    assert_eq!(
        places("micros,heat,c,d", None),
        Ok([Some(0), Some(2), Some(3)])
    );
    for count in ["index", "k", "Point", "#"] {
        let header = format!("{count},c,d");
        assert_eq!(places(&header, None), Ok([None, Some(1), Some(2)]));
    }
    assert_eq!(places("t,heat,c,d", None), Ok([Some(0), Some(2), Some(3)]));
}

#[test]
fn a_column_of_clock_times_is_the_time_unless_another_is() {
    for (header, stamped, expected) in [
        ("x,y,when", &[2][..], [Some(2), Some(0), Some(1)]),
        ("c,d,when", &[2], [Some(2), Some(0), Some(1)]),
        ("n,when,x,y", &[1], [Some(1), Some(2), Some(3)]),
        ("when,then,x,y", &[0, 1], [Some(0), Some(2), Some(3)]),
        ("when,t,x,y", &[0], [Some(1), Some(2), Some(3)]),
        ("when,since [s],x,y", &[0], [Some(1), Some(2), Some(3)]),
        // As without a clock.
        ("when,c,d,heat", &[0], [None, Some(1), Some(2)]),
    ] {
        assert_eq!(
            stamped_places(header, None, stamped),
            Ok(expected),
            "{header}"
        );
    }
    let chosen = stamped_places("x,y,when", Some("1,2"), &[2]);
    assert_eq!(chosen, Ok([None, Some(0), Some(1)]));
}

#[test]
fn names_that_may_be_of_either_signal_are_not_guessed() {
    for header in [
        "time,C,D,c,d",
        "t,left,right,c,d",
        "A,B,C,D",
        "t,Channel A,Channel B,Channel C,Channel D",
    ] {
        assert!(places(header, None).is_err(), "{header}");
    }
    let fault = places("t,A,B,C,D", None).unwrap_err();
    assert!(fault.starts_with(
        "S_C and S_D may be any of the columns `A` (2), `B` (3), `C` (4), `D` (5); choose"
    ));
    assert_eq!(
        places("t,A,B,C,D", Some("1,4,5")),
        Ok([Some(0), Some(3), Some(4)])
    );
    assert_eq!(places("t,a,c,d", None), Ok([Some(0), Some(2), Some(3)]));
}

#[test]
fn a_count_of_lines_is_no_clock() {
    for count in ["Sample", "Index", "n", "#", "Point", "No.", ""] {
        let header = format!("{count},ADC1,ADC2");
        assert_eq!(places(&header, None), Ok([None, Some(1), Some(2)]));
        let header = format!("{count},Time (ms),ADC1,ADC2");
        assert_eq!(places(&header, None), Ok([Some(1), Some(2), Some(3)]));
    }
    // With a unit of time it is a clock.
    let usual = Ok([Some(0), Some(1), Some(2)]);
    assert_eq!(places("Sample (s),ADC1,ADC2", None), usual);
    // With only two columns both are signals.
    assert_eq!(places("n,x", None), Ok([None, Some(0), Some(1)]));
}

#[test]
fn a_choice_is_by_name_or_number() {
    assert_eq!(places("a,b,c,d", Some("d,2")), Ok([None, Some(3), Some(1)]));
    assert_eq!(
        places("a,b,c,d", Some("1, b, d")),
        Ok([Some(0), Some(1), Some(3)])
    );
    // The names are numbers.
    assert_eq!(places("t,1,2", Some("2,3")), Ok([None, Some(1), Some(2)]));
    assert_eq!(
        places("t,1,2", Some("t,1,2")),
        Ok([Some(0), Some(1), Some(2)])
    );
    assert_eq!(places("0,1", Some("0,1")), Ok([None, Some(0), Some(1)]));
}

#[test]
fn a_name_may_be_chosen_without_its_unit() {
    let header = "time (ms),c (mV),d [V],U_1(V)";
    let usual = Ok([Some(0), Some(1), Some(2)]);
    assert_eq!(places(header, Some("time,c,d")), usual);
    assert_eq!(places(header, Some("time (ms),c (mV),d")), usual);
    assert_eq!(
        places(header, Some("U_1,d [V]")),
        Ok([None, Some(3), Some(2)])
    );
    // The whole name goes before, and a number after it.
    assert_eq!(
        places("c (V),c,d (V)", Some("c,d")),
        Ok([None, Some(1), Some(2)])
    );
    assert_eq!(
        places("t (s),x (V),1 (V)", Some("t,1,2")),
        Ok([Some(0), Some(2), Some(1)])
    );
    let unsure = places("c (V),c (mV),d", Some("c,d")).unwrap_err();
    assert_eq!(
        unsure,
        "`c` may be column 1 or 2; choose it by its number with --columns"
    );
}

#[test]
fn a_name_may_be_chosen_in_other_letters() {
    let usual = Ok([Some(0), Some(1), Some(2)]);
    assert_eq!(places("Time [s],C,D", Some("time,c,d")), usual);
    assert_eq!(
        places("t,T,c,d", Some("T,C,D")),
        Ok([Some(1), Some(2), Some(3)])
    );
    let unsure = places("Ua,UA,d", Some("ua,d")).unwrap_err();
    assert!(unsure.starts_with("`ua` may be column 1 or 2; "));
}

#[test]
fn of_columns_of_one_name_none_is_taken_silently() {
    for chosen in ["t,V,W", "V,W", "W,V", "V,V"] {
        let unsure = places("t,V,W,V", Some(chosen)).unwrap_err();
        assert!(unsure.starts_with("`V` may be column 2 or 4; "), "{unsure}");
    }
    assert_eq!(
        places("t,V,W,V", Some("t,4,W")),
        Ok([Some(0), Some(3), Some(2)])
    );
}

#[test]
fn no_column_is_chosen_twice() {
    for (chosen, number) in [
        ("3,3", 3),
        ("1,2,2", 2),
        ("2,2,3", 2),
        ("3,2,3", 3),
        ("c,2", 2),
    ] {
        let told = format!("column {number} is chosen twice; choose different columns for");
        let fault = places("time,c,d", Some(chosen)).unwrap_err();
        assert!(fault.starts_with(&told), "{chosen}: {fault}");
    }
}

#[test]
fn errors_name_the_columns() {
    let many = ["a"; 4000].join(",");
    let fault = |header, chosen| places(header, chosen).unwrap_err();
    assert!(fault("a", None).starts_with("found 1 column, but two"));
    assert!(fault("time,x", None).starts_with("found the time and one signal, but both"));
    assert!(fault("a,b,x,y,z", None).starts_with("found 5 columns, but two"));
    let pasted = fault("a,b,x,y", None);
    assert!(
        pasted.ends_with("if 1 and 3 are the times of 2 and 4, give --columns 1,2,4"),
        "{pasted}"
    );
    assert!(fault(&many, None).contains("of a line for each channel in Python"));
    assert!(fault("a,b", Some("a,e")).starts_with("there is no column `e`; choose among `a`, `b`"));
    assert!(fault("a,b", Some("0,1")).starts_with("there is no column `0`"));
    assert!(fault("a,b", Some("a")).starts_with("give two"));
    assert!(fault("a,b", Some("a,,b")).starts_with("give two"));
}
