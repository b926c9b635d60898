//! Times rounded to about a sample or more.

use super::*;

/// The number of samples lost in all, and the first line behind some of them.
fn lost(gaps: &Gaps) -> (u64, usize) {
    let sum = gaps.iter().map(|gap| gap.1).sum();
    (sum, gaps.first().map_or(0, |gap| gap.0))
}

#[test]
fn no_rounding_gives_a_wrong_rate() {
    // Samples 0.1 to 10 last digits apart.
    let ratios = (1..=300).map(|k| 0.1 * 1.01561f64.powi(k));
    let even = (2..=20).map(|k| 4.0 / f64::from(k));
    let ratios: Vec<f64> = ratios.chain(even).collect();
    ratios.into_par_iter().for_each(|ratio| {
        for (decimals, start) in [(6, 0.0), (6, -0.0012345), (4, 7.3)] {
            let tick = 10f64.powi(-decimals);
            let rate = 1.0 / (ratio * tick);
            let count = 6000;
            let print = |t: f64| format!("{t:.*}", decimals as usize);
            match axis(&times(count, rate, start, print), HEAD) {
                Ok((axis, gaps)) => {
                    let off = (1.0 / axis.rate() - 1.0 / rate).abs() * count as f64;
                    // Where steps look even both ends are rounded, and the rate is too.
                    let allowed = if ratio < 4.0 { tick } else { 2.0 * tick };
                    assert!(off <= allowed, "{ratio} {start}: {}", axis.rate());
                    assert_eq!(gaps, [], "{ratio} {start}");
                }
                Err((_, fault)) => {
                    let is_paired = (ratio - 0.5).abs() < 0.01;
                    assert!(
                        is_paired && fault.contains("too coarse"),
                        "{ratio}: {fault}"
                    );
                }
            }
        }
    });
}

#[test]
fn the_roundest_rate_that_explains_all_times_is_found() {
    for (decimals, rate) in [
        (6, 640_000.0),
        (6, 454_000.0),
        (5, 66_700.0),
        (5, 80_000.0),
        (5, 96_000.0),
        (5, 104_000.0),
        (4, 100_000.0),
        (3, 96_000.0),
    ] {
        let text = times(60_000, rate, 0.0, |t| format!("{t:.decimals$}"));
        assert_eq!(run(&text, HEAD), Ok(Some(rate)), "{decimals}");
    }
}

#[test]
fn the_first_sample_may_lie_anywhere_in_its_digit() {
    for (rate, decimals) in [(48_000.0, 4), (44_100.0, 4), (192_000.0, 5), (100_000.0, 4)] {
        let digit = 10f64.powi(decimals);
        for start in [0.1, 0.45, 0.9] {
            // As a logger prints them that rounds or that cuts.
            for print in [f64::round, f64::floor] {
                let text = times(140_000, rate, start / digit, |t| {
                    format!("{:.*}", decimals as usize, print(t * digit) / digit)
                });
                let (found, gaps) = axis(&text, HEAD).unwrap();
                assert_eq!(gaps, [], "{rate} {start}");
                assert!((found.rate() / rate - 1.0).abs() < 1e-4, "{rate} {start}");
            }
        }
    }
}

#[test]
fn a_first_time_that_is_wrong_is_not_the_start() {
    let mut text = times(12_000, 80_000.0, 0.0, |t| format!("{t:.5}"));
    text[0] = "0.70000".to_owned();
    let (first, printed) = read(&text);
    let axis = TimeAxis::of(&first, printed).unwrap();
    assert_eq!((axis.rate(), axis.start()), (80_000.0, first[1]));
}

#[test]
fn fewer_digits_behind_the_first_lines_end_nothing() {
    for (digits, rate) in [
        (3, 100_000.0),
        (4, 100_000.0),
        (4, 96_000.0),
        (3, 640_000.0),
    ] {
        let print = |t: f64| format!("{t:.digits$e}");
        let whole = times(300_000, rate, 0.0, print);
        let (found, gaps) = axis(&whole, HEAD).unwrap();
        assert_eq!((found.rate(), gaps), (rate, vec![]), "{digits}");
        assert!(
            found
                .coarse_warning()
                .is_some_and(|told| told.contains("gaps of up to "))
        );
        // A gap is found as soon as the next time is due, and its length is found too.
        let mut text = whole.clone();
        text.drain(200_000..200_030);
        let (_, gaps) = axis(&text, HEAD).unwrap();
        let (sum, at) = lost(&gaps);
        assert!(sum.abs_diff(30) <= 1, "{digits} {rate}: {gaps:?}");
        let late = (found.coarsest * rate) as usize + 1;
        assert!((200_000..=200_000 + late).contains(&at), "{gaps:?}");
        // Time that stands still or goes back ends the rows.
        let mut text = whole.clone();
        let at = text[200_000].clone();
        text[200_000..].fill(at);
        let (index, fault) = run(&text, HEAD).unwrap_err();
        assert!((200_001..=200_001 + late).contains(&index), "{index}");
        assert!(fault.contains("but must increase"), "{fault}");
        let mut text = whole;
        text.drain(100_000..);
        text.extend(times(100, rate, 0.1, print));
        let (index, fault) = run(&text, HEAD).unwrap_err();
        assert!(
            index == 100_000 && fault.contains("must increase"),
            "{fault}"
        );
    }
}

#[test]
fn a_sample_lost_between_uneven_steps_is_found() {
    for (rate, decimals) in [
        (640_000.0, 6),
        (80_000.0, 5),
        (66_700.0, 5),
        (96_000.0, 5),
        (99_900.0, 5),
        (104_000.0, 5),
    ] {
        for at in [5, 3000, 70_000] {
            let mut text = times(80_000, rate, 0.3, |t| format!("{t:.decimals$}"));
            text.remove(at);
            let (found, gaps) = axis(&text, HEAD).unwrap();
            assert_eq!(found.rate(), rate);
            let (sum, line) = lost(&gaps);
            assert!(sum == 1 && (at..at + 4).contains(&line), "{at}: {gaps:?}");
            let is_told = rate / 10f64.powi(decimals as i32) > 0.99;
            assert_eq!(found.coarse_warning().is_some(), is_told, "{rate}");
        }
    }
}

#[test]
fn a_long_pause_costs_no_lines_behind_it() {
    for (rate, decimals) in [(331_000.0, 5), (802_985.0, 6), (96_000.0, 5)] {
        for at in [46, 76_000] {
            let mut text = times(300_000, rate, 0.3, |t| format!("{t:.decimals$}"));
            text.drain(at..at + 200_000);
            let (_, gaps) = axis(&text, HEAD).unwrap();
            // Not all of so many samples can be counted by a rate that is rounded too.
            let (sum, line) = lost(&gaps);
            assert!(
                sum.abs_diff(200_000) < 20 && gaps.len() == 1 && line == at,
                "{gaps:?}"
            );
        }
    }
}

#[test]
fn wrong_times_do_not_mislead_the_phase_of_the_first() {
    for (wrong, is_known) in [("0.90000", true), ("0.10000", false)] {
        let mut text = times(60_000, 96_000.0, 0.3, |t| format!("{t:.5}"));
        text.remove(40);
        text[20] = wrong.to_owned();
        let (first, printed) = read(&text);
        let phase = TimeAxis::of(&first, printed).unwrap().phase;
        assert_eq!(phase.is_some(), is_known, "{wrong}");
        let is_true = |phase: Phase| (phase.middle() - 0.3).abs() <= 0.5 * phase.width();
        assert!(phase.is_none_or(is_true), "{phase:?}");
        // The last digit is a sample, and its part is known.
        assert!(phase.is_none_or(|phase| phase.width() < 2e-6), "{phase:?}");
    }
}

#[test]
fn a_clock_may_drift_though_its_times_are_coarse() {
    let time = |k: f64| k * 1.25e-5 * (1.0 + 2e-11 * k);
    let text: Vec<String> = (0..500_000)
        .map(|k| format!("{:.5}", time(f64::from(k))))
        .collect();
    let (found, gaps) = axis(&text, HEAD).unwrap();
    assert!(gaps.is_empty() && found.beside(found.rate()).is_some());
}

#[test]
fn minima_and_maxima_are_no_doubled_rate() {
    // Each time stands in two lines, but for one line that is lost.
    let mut text: Vec<String> = (0..2000)
        .map(|k| format!("{:.5}", f64::from(k / 2) * 1e-5))
        .collect();
    text.remove(901);
    assert!(axis(&text, HEAD).is_err());
}
