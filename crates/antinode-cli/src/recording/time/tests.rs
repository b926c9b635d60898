//! Times as programs print them, correct and faulty.

mod change;
mod rounded;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::*;

/// The rate of printed times, the first `head` of them read ahead; lost samples count as a fault.
fn run(times: &[String], head: usize) -> Result<Option<f64>, (usize, String)> {
    let (axis, gaps) = axis(times, head)?;
    match gaps.first() {
        Some((index, lost)) => Err((*index, format!("{lost} lost"))),
        None => Ok(Some(axis.rate())),
    }
}

/// The indices of times before which samples are lost, and how many.
type Gaps = Vec<(usize, u64)>;

/// The axis and the gaps once all printed times are read; or the index and the text of a fault.
fn axis(times: &[String], head: usize) -> Result<(TimeAxis, Gaps), (usize, String)> {
    let (first, mut printed) = read(&times[..head.min(times.len())]);
    let Some(mut axis) = TimeAxis::of(&first, printed) else {
        let (index, fault) = standstill(&first, printed).expect("a fault");
        return Err((index, fault.to_string()));
    };
    let mut gaps = Vec::new();
    for (index, text) in times.iter().enumerate().skip(1) {
        let time = text.parse().unwrap();
        printed.see(text.as_bytes(), time, 0);
        match axis.check(time, printed) {
            Ok(0) => {}
            Ok(lost) => gaps.push((index, lost)),
            Err(fault) => return Err((index, fault.to_string())),
        }
    }
    Ok((axis, gaps))
}

/// The numbers that these times print, and how they are printed.
fn read(times: &[String]) -> (Vec<f64>, Printed) {
    let mut printed = Printed::default();
    let read = times.iter().map(|text| {
        let time = text.parse().unwrap();
        printed.see(text.as_bytes(), time, 0);
        time
    });
    (read.collect(), printed)
}

fn times(count: usize, rate: f64, start: f64, print: impl Fn(f64) -> String) -> Vec<String> {
    (0..count).map(|k| print(start + k as f64 / rate)).collect()
}

const HEAD: usize = 1 << 16;

#[test]
fn rounded_times_give_the_rate() {
    for rate in [96_000.0, 100_000.0, 99_999.0, 44_100.0, 65_536.0, 1e6 / 3.0] {
        for start in [0.0, 3.7, 1000.0] {
            for decimals in [7, 9, 12] {
                let found = run(
                    &times(80_000, rate, start, |t| format!("{t:.decimals$}")),
                    HEAD,
                );
                let error = (found.unwrap().unwrap() - rate).abs() / rate;
                assert!(error < 1e-5, "{rate} {start} {decimals}: {error}");
            }
            let shortest = run(&times(80_000, rate, start, |t| format!("{t}")), HEAD)
                .unwrap()
                .unwrap();
            assert!((shortest - rate).abs() < 1e-6, "{rate} {start}: {shortest}");
            let exponent = run(&times(80_000, rate, start, |t| format!("{t:.9e}")), HEAD)
                .unwrap()
                .unwrap();
            assert!((exponent - rate).abs() < 1.0, "{rate} {start}: {exponent}");
            let ten = times(80_000, rate, start, |t| significant(t, 10).to_string());
            run(&ten, HEAD).unwrap();
        }
    }
}

#[test]
fn a_long_pause_is_measured_wherever_it_is() {
    for (rate, decimals, at, lost) in [
        (48_000.0, 7, 50_000, 1_000_003),
        (48_000.0, 7, 80_000, 1_000_003),
        (99_999.3, 6, 80_000, 300_001),
        (96_000.0, 5, 140_000, 20_003),
    ] {
        let mut text = times(150_000 + lost, rate, 0.0, |t| format!("{t:.decimals$}"));
        text.drain(at..at + lost);
        let (_, gaps) = axis(&text, HEAD).unwrap();
        assert_eq!(gaps, [(at, lost as u64)], "{rate} {decimals}");
    }
}

#[test]
fn a_round_rate_is_found_exactly() {
    for (rate, decimals) in [
        (100_000.0, 5),
        (100_000.0, 6),
        (96_000.0, 6),
        (44_100.0, 6),
        (8_000.0, 6),
    ] {
        let text = times(100_000, rate, 0.0, |t| format!("{t:.decimals$}"));
        assert_eq!(run(&text, HEAD), Ok(Some(rate)), "{rate} {decimals}");
    }
    assert_eq!(
        run(&times(5, 100_000.0, 0.0, |t| format!("{t:.6}")), HEAD),
        Ok(Some(100_000.0))
    );
    // Seconds since 1970, of which a 64-bit number holds no more than a fortieth of these samples.
    let found = run(
        &times(80_000, 100_000.0, 1.7e9, |t| format!("{t:.9}")),
        HEAD,
    );
    let epoch = found.unwrap().unwrap();
    assert!((epoch - 100_000.0).abs() < 1.0, "{epoch}");
}

#[test]
fn lost_samples_are_counted() {
    for decimals in [5, 6, 9] {
        for (at, lost) in [(1, 1), (10, 1), (70_000, 3), (30_000, 1000)] {
            let mut text = times(100_000, 100_000.0, 0.0, |t| format!("{t:.decimals$}"));
            text.drain(at..at + lost);
            let (axis, gaps) = axis(&text, HEAD).unwrap();
            assert_eq!(gaps, [(at, lost as u64)], "{decimals}");
            assert_eq!((axis.rate(), axis.drift()), (100_000.0, None));
        }
    }
}

#[test]
fn gaps_do_no_harm_to_what_follows() {
    // Several gaps, two of them adjacent, by a clock that is 12 ppm off in the end.
    let mut text: Vec<String> = (0..600_000)
        .map(f64::from)
        .map(|k| format!("{:.9}", 7.0 + k * 1e-5 * (1.0 - 1e-11 * k)))
        .collect();
    for at in [500_000, 300_000, 299_999, 120_000, 3] {
        text.drain(at..at + 7);
    }
    let (axis, gaps) = axis(&text, HEAD).unwrap();
    let found = [3, 119_993, 299_985, 299_986, 499_972];
    assert_eq!(gaps.len(), 4, "{gaps:?}");
    assert_eq!(gaps.iter().map(|gap| gap.1).sum::<u64>(), 35);
    assert!(gaps.iter().all(|gap| found.contains(&gap.0)), "{gaps:?}");
    let (_, late) = axis.drift().expect("a drift");
    // The mean rate of the first lines is that of their middle.
    let expected = -1e-16 * 6e5 * (6e5 - HEAD as f64);
    assert!((late / expected - 1.0).abs() < 0.01, "{late} {expected}");
}

#[test]
fn uneven_steps_are_named() {
    for (shift, expected) in [
        (0.02, "time steps by 1.0200e-5 s"),
        (-0.3, "time steps by 7.0000e-6 s"),
        (0.5, "time"),
    ] {
        let mut text = times(1000, 100_000.0, 0.0, |t| format!("{t:.9}"));
        text[500..]
            .iter_mut()
            .for_each(|time| *time = format!("{:.9}", time.parse::<f64>().unwrap() + shift * 1e-5));
        let (index, fault) = run(&text, HEAD).unwrap_err();
        assert_eq!(index, 500);
        assert!(fault.starts_with(expected), "{fault}");
    }
    let mut text = times(1000, 100_000.0, 0.0, |t| format!("{t:.9}"));
    text[500..]
        .iter_mut()
        .for_each(|time| *time = format!("{:.9}", time.parse::<f64>().unwrap() + 0.005e-5));
    assert!(run(&text, HEAD).is_ok());
}

#[test]
fn time_that_does_not_go_up_is_named() {
    let mut text = times(1000, 100_000.0, 0.0, |t| format!("{t:.6}"));
    text.swap(600, 601);
    assert_eq!(axis(&text, HEAD).err().unwrap().0, 601);
    let mut text = times(1000, 100_000.0, 0.0, |t| format!("{t:.6}"));
    text[700] = text[699].clone();
    let (index, fault) = run(&text, HEAD).unwrap_err();
    assert_eq!(index, 700);
    assert!(
        fault.starts_with("time goes from 0.00699 s to 0.00699 s, but must increase, and what follows is not read; "),
        "{fault}"
    );
}

#[test]
fn time_printed_too_coarsely_is_named() {
    // Fewer than seven different times.
    for (decimals, rate) in [(3, 200_000.0), (2, 100_000.0), (0, 1000.0)] {
        let (_, fault) =
            run(&times(1000, rate, 0.0, |t| format!("{t:.decimals$}")), HEAD).unwrap_err();
        assert!(
            fault.contains("times are given to 1e") || fault.starts_with("time goes from 0 s"),
            "{decimals} {rate}: {fault}"
        );
    }
    // So few that the rate may be off by percents, even where no other explains them.
    for rate in [97_000.0, 100_000.0] {
        let few = times(100, rate, 0.0, |t| format!("{t:.4}"));
        let (_, fault) = run(&few, HEAD).unwrap_err();
        assert!(
            fault.contains("times are given to 1e-4 s only, too coarse"),
            "{rate}: {fault}"
        );
    }
    // Lost samples that rounding hides would move the rate.
    let mut text = times(1500, 96_000.0, 123.456, |t| format!("{t:.3}"));
    text.drain(750..752);
    let (_, fault) = run(&text, HEAD).unwrap_err();
    assert!(
        fault.contains("times are given to 1e-3 s only, too coarse"),
        "{fault}"
    );
    // Not at equal distances.
    for rate in [70_000.0, 150_000.0] {
        let jitter = |t: f64| format!("{:.5}", t + 0.5 / rate * (1e5 * t * t).sin());
        let (_, fault) = run(&times(1000, rate, 0.1, jitter), HEAD).unwrap_err();
        assert!(
            fault.starts_with("times are given to 1e-5 s only, too coarse"),
            "{rate}: {fault}"
        );
    }
}

#[test]
fn single_precision_is_not_uneven_sampling() {
    type Print = fn(f32) -> String;
    let prints: [Print; 4] = [
        |t| format!("{t}"),
        |t| format!("{t:.18e}"),
        |t| format!("{t:.9}"),
        |t| format!("{t:.10}"),
    ];
    prints.into_par_iter().for_each(|print| {
        for start in [0.0, 7.3, 24.0] {
            let single = |t: f64| print(t as f32);
            let text = times(500_000, 100_000.0, start, single);
            let found = run(&text, HEAD).unwrap().unwrap();
            assert!((found / 100_000.0 - 1.0).abs() < 1e-5, "{found}");
            // A lost sample is found all the same.
            let mut text = text;
            text.remove(400_000);
            let (index, fault) = run(&text, HEAD).unwrap_err();
            assert_eq!(index, 400_000);
            assert_eq!(fault, "1 lost");
        }
        // Beyond 128 s single precision gives each time about twice.
        let text = times(200_000, 100_000.0, 127.5, |t| print(t as f32));
        let found = run(&text, HEAD).unwrap().unwrap();
        assert!((found / 100_000.0 - 1.0).abs() < 1e-5, "{found}");
    });
}

#[test]
fn a_rate_that_drifts_too_fast_is_named() {
    let text: Vec<String> = (0..300_000)
        .map(f64::from)
        .map(|k| format!("{:.12}", k * 1e-5 * (1.0 + 2e-9 * k)))
        .collect();
    let (index, fault) = run(&text, HEAD).unwrap_err();
    assert_eq!((index + 1) % (1 << 16), 1);
    assert!(
        fault.contains("the sample rate has changed from "),
        "{fault}"
    );
    let text: Vec<String> = (0..300_000)
        .map(f64::from)
        .map(|k| format!("{:.12}", k * 1e-5 * (1.0 + 1e-12 * k)))
        .collect();
    assert!(run(&text, HEAD).is_ok());
}

#[test]
fn a_slow_drift_is_followed_and_reported() {
    // Times of a rate whose relative growth from line to line is `growth`.
    let times = |growth: f64, count: usize| -> Vec<String> {
        let time = |k: f64| 7.0 + k * 1e-5 * (1.0 - 0.5 * growth * k);
        (0..count)
            .map(|k| format!("{:.9}", time(k as f64)))
            .collect()
    };
    for (growth, count) in [(2e-11, 600_000), (-4e-11, 525_000)] {
        let mut text = times(growth, count);
        let (axis, _) = axis(&text, HEAD).unwrap();
        let (rate, late) = axis.drift().expect("a drift");
        // The mean rate of the first lines is that of their middle.
        let lines = count as f64;
        let rate_off = growth * 1e5 * lines;
        let late_off = -1e-5 * growth * lines * (0.5 * lines - 0.5 * HEAD as f64);
        assert!(
            (rate - 1e5 - rate_off).abs() < 0.12 * rate_off.abs(),
            "{rate}"
        );
        assert!((late / late_off - 1.0).abs() < 0.01, "{late} {late_off}");
        // A lost or doubled sample is found all the same.
        let doubled = text[count - 1000].clone();
        text.insert(count - 1000, doubled);
        assert_eq!(run(&text, HEAD).unwrap_err().0, count - 999);
        text.drain(count - 1000..count - 998);
        let (index, fault) = run(&text, HEAD).unwrap_err();
        assert!(
            index == count - 1000 && fault == "1 lost",
            "{index} {fault}"
        );
    }
    let (steady, _) = axis(&times(1e-12, 300_000), HEAD).unwrap();
    assert_eq!(steady.drift(), None);
}

#[test]
fn a_rate_that_is_nearly_round_is_found_from_all_lines() {
    // By the first lines, printed to a microsecond, the rate may be 100 kHz; a tenth of a sample in all lines leaves it so.
    for (rate, count, told) in [
        (100_000.2, 1_000_000, Some(100_000.2)),
        (100_000.0, 1_000_000, None),
        (100_000.01, 1_000_000, None),
    ] {
        let (axis, _) = axis(&times(count, rate, 3.0, |t| format!("{t:.6}")), HEAD).unwrap();
        assert_eq!((axis.rate(), axis.drift()), (100_000.0, None));
        let beside = axis.beside(100_000.0);
        assert_eq!(beside.map(|(rate, _)| rate), told, "{rate}");
        if let Some((own, late)) = beside {
            let off = count as f64 * (1.0 / rate - 1e-5);
            assert!((late - off).abs() < 1.2e-5, "{late} {off}");
            assert_eq!(axis.beside(own), None);
        }
    }
}

#[test]
fn the_fewest_digits_are_chosen() {
    assert_eq!(roundest(99_999.3, 1.0), 100_000.0);
    assert_eq!(roundest(44_100.02, 0.1), 44_100.0);
    assert_eq!(roundest(44_100.02, 0.001), 44_100.02);
}
