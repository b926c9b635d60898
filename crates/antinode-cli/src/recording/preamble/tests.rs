//! Where samples are found to begin.

use super::*;

/// The number of lines skipped `above` rows of samples.
fn skipped(above: &str, row: impl Fn(usize) -> String) -> Option<usize> {
    let rows = (0..20).map(|k| row(k) + "\n");
    let text = format!("{above}{}", rows.collect::<String>());
    find(text.as_bytes(), false).map(|start| start.lines)
}

fn three(k: usize) -> String {
    format!("{k}e-5,0.{k},-0.{k}")
}

fn two(k: usize) -> String {
    format!("0.{k},-0.{k}")
}

#[test]
fn settings_are_skipped_down_to_the_names() {
    for (above, expected) in [
        ("Model,X\nTIME,CH1,CH2\n", 1),
        ("Model,X\n\nTIME,CH1,CH2\nms,V,V\n", 2),
        ("Model,X\nTime,1,2\n", 1),
        ("Model,X\nTime,A,B\n0,1,2\n1,x,2\n", 1),
        ("Model,X\nTime,A,B\nlow,low,low\n", 1),
        ("Model,X\nTime,A,B\na garbled line,of three,words\n", 1),
        ("a = 5\nx-axis,1,2\nsecond,Volt,Volt\n", 1),
        ("Model,X,1\n# 1,2,3\nTIME,CH1,CH2\n", 2),
        ("Model,A\nRate,1,2\nScale,2,3\n\"DATA\"\n", 4),
    ] {
        assert_eq!(skipped(above, three), Some(expected), "{above}");
    }
}

#[test]
fn names_and_possible_samples_stay() {
    for above in [
        "",
        "time,c,d\n",
        "time,c,d\ns,V,V\n",
        "X,CH1,CH2,Start,Increment\nSequence,Volt,Volt,-5e-2,1e-5\n",
        "x,y,z\nfoo,bar,baz\n",
        "x,y,z\na garbled line,of three,words\n",
        "time,c,d\nx,1,2\n",
        "time,c,d\n0,low,high\n",
        "time,c,d\n0,1,2\nlow,low,low\n",
        "Model,A\n1,2,3\nTIME,CH1,CH2\n",
        "?,1,2\n",
        "Recording\nlow,1,2\n",
        "?,1,2\n!,1,2\n+,1,2\n;,1,2\n",
        "low,1,2\nlow,1,2\nlow,1,2\nlow,1,2\n",
    ] {
        assert_eq!(skipped(above, three), Some(0), "{above}");
    }
    for above in [
        "d,c\nx1,5\n",
        "x,y\nx1,5\n",
        "d c\n",
        "x,y\nfoo\n",
        "1,2\nx,y\n",
    ] {
        assert_eq!(skipped(above, two), Some(0), "{above}");
    }
}

#[test]
fn garbled_lines_among_the_first_samples_stay() {
    let settings = "Model,X\nRate,1e5\nPoints,1000\nTrigger,A\n";
    for (names, lines) in [("TIME,CH1,CH2\n", 4), ("x,foo,bar\n", 4), ("", 4)] {
        for garbled in ["1e-5", "1e-5,0.1", "x#!1e-5,0.1,0.1", "1e-5,0q1,0.1", "1e"] {
            for place in [0, 1, 5, 14, 15, 16] {
                let row = |k: usize| {
                    if k == place {
                        garbled.to_owned()
                    } else {
                        three(k)
                    }
                };
                // Without names, words or a short first line may be some.
                let is_told = place > 0 || !names.is_empty() && garbled.starts_with("1e-5");
                let above = format!("{settings}{names}");
                let mut text = above.clone();
                let mut found = None;
                for k in 0..40 {
                    text += &(row(k) + "\n");
                    found = found.or_else(|| find(text.as_bytes(), false));
                }
                let found = found.map(|start| (start.lines, start.numbers));
                let whole = Some((lines, vec![0, 1, 2]));
                assert!(
                    found == whole || !is_told,
                    "{above}{garbled} at {place}: {found:?}"
                );
            }
        }
    }
    // No more than two lines are garbled samples, and names are none.
    let garbled = format!("{settings}0,1,2\n1,1\n2,1\n3,1\n");
    assert_eq!(skipped(&garbled, three), Some(0));
    let stamped = |k: usize| format!("a{k},0.{k},-0.{k}");
    let names = format!("{settings}Offset,0,0\nTime,CH1,CH2\na,1\n");
    assert_eq!(skipped(&names, stamped), Some(0));
}

#[test]
fn more_lines_are_asked_for_until_samples_are_seen() {
    let names = "Model,X\n".repeat(20);
    assert_eq!(find(names.as_bytes(), false), None);
    assert_eq!(find(names.as_bytes(), true), Some(Start::default()));
    assert_eq!(
        find("Model,X\n".repeat(300).as_bytes(), false),
        Some(Start::default())
    );
    // Blank lines and comments count too, up to a limit.
    for above in ["\n", "# a comment\n", "%\n"] {
        let text = |count| "Model,X\n".to_owned() + &above.repeat(count);
        assert_eq!(find(text(4000).as_bytes(), false), None, "{above}");
        assert_eq!(
            find(text(4096).as_bytes(), false),
            Some(Start::default()),
            "{above}"
        );
    }
    let long = "Model,X\n".to_owned() + &("#".repeat(60_000) + "\n").repeat(70);
    assert_eq!(find(long.as_bytes(), false), Some(Start::default()));
    // Numbers at the front are samples: no more of a pipe is waited for.
    assert_eq!(
        find("1,x\n".repeat(3).as_bytes(), false),
        Some(Start::default())
    );
}

/// The lines skipped above such first lines and rows, and how many of those left are without values.
fn silent(above: &str, row: impl Fn(usize) -> String) -> Option<(usize, usize)> {
    let rows = (0..40).map(|k| row(k) + "\n");
    let text = format!("{above}{}", rows.collect::<String>());
    let start = find(text.as_bytes(), false)?;
    assert_eq!(start.silent_bytes > 0, start.silent_lines > 0);
    Some((start.lines, start.silent_lines))
}

#[test]
fn first_lines_without_values_stay_right_above_samples() {
    for (above, expected) in [
        ("", 0),
        ("1,,\n", 1),
        ("1,,\n2,,\n\n3,,\n", 4),
        (",,\n,,\n", 2),
        ("nan,,\n,,\n", 2),
        // A sample.
        ("1,,0.5\n", 0),
    ] {
        assert_eq!(silent(above, three), Some((0, expected)), "{above}");
    }
    assert_eq!(silent("5,\n\n,\n", two), Some((0, 3)));
    assert_eq!(silent("5,\n", three), Some((1, 0)));
    let apart = |k: usize| format!("0.{k} -0.{k}");
    assert_eq!(silent("5 \n", apart), Some((1, 0)));
    // Above a line that is cut they tell nothing.
    let later = |k: usize| format!("12.{:05},0.{k},-0.{k}", 341 + k);
    assert_eq!(silent(",,\n40,0.2,-0.2\n", later), Some((2, 0)));
    // Above names and settings they are padding.
    for (names, skipped) in [("time,c,d\n", 2), ("Model,X\ntime,c,d\n", 3)] {
        let above = format!(",,\n,,\n{names}");
        assert_eq!(silent(&above, three), Some((skipped, 0)), "{names}");
    }
    // However many they are, the samples are waited for.
    let lines = "1,,\n".repeat(500);
    assert_eq!(find(lines.as_bytes(), false), None);
    assert_eq!(silent(&lines, three), Some((0, 500)));
    assert_eq!(
        find("1,,\n".repeat(5000).as_bytes(), false),
        Some(Start::default())
    );
}

#[test]
fn the_columns_of_numbers_are_found() {
    let row = |k: usize| format!("{},{k}e-5,,0.{k},,", ["a,x", "b,1", ",", ","][k % 4]);
    let text: String = (0..17).map(|k| row(k) + "\n").collect();
    let start = find(text.as_bytes(), false).unwrap();
    assert_eq!(
        (start.lines, start.numbers, start.is_clocked),
        (0, vec![2, 4], true)
    );
}
