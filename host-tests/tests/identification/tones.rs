//! Two tones at once: which of them is found, and that none is found between them.

use antinode::Settings;
use antinode::period::DifferenceDetector;
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::score::{errors, stated};
use host_tests::{Core, RATE, identify_changed, stream, windows};

use crate::detector::wave;

#[test]
fn two_unrelated_tones_are_no_wave() {
    let (mut rows, mut clean) = (0, 0);
    for seed in 0..300 {
        let period = 5.0 * 20f64.powf((seed as f64 * 0.618_034).fract());
        let ratio = 1.15 + 2.0 * (seed as f64 * 0.754_878).fract();
        let first = random_wave(seed, RATE / period, 0.5);
        let mut second = random_wave(seed + 5000, RATE / period / ratio, 0.5);
        second.quadrature_amplitude *= first.main_amplitude / second.main_amplitude;
        second.main_amplitude = first.main_amplitude;
        let flaws = Flaws::white(0.01);
        let one = Gyro::new(first, flaws.clone(), RATE, seed).unwrap();
        let two = Gyro::new(second, flaws, RATE, seed + 1).unwrap();
        let mut core = Core::new(windows(10)).unwrap();
        for (one, two) in one.zip(two).take((60.0 * period) as usize) {
            if let Some(estimate) = core.push([(one[0] + two[0]) as f32, (one[1] + two[1]) as f32])
            {
                rows += 1;
                if estimate.flags.is_empty() {
                    clean += 1;
                    // The few that are found must be one of the two tones.
                    let far = |wave: &Wave| {
                        let allowed = 6.0 * f64::from(estimate.frequency_std);
                        (estimate.frequency - wave.frequency).abs() > allowed
                    };
                    assert!(!(far(&first) && far(&second)), "seed {seed}: {estimate:?}");
                }
            }
        }
    }
    println!("two tones: {rows} windows reported of about 1500, {clean} without a flag");
    assert!(rows < 15, "{rows}");
}

#[test]
fn beside_a_tone_half_as_large_hardly_any_clean_row_is_wrong() {
    // The detector refuses most of these waves, as the period would be pulled from one tone towards the other.
    let (mut rows, mut clean, mut wrong) = (0, 0, 0);
    for share in [0.4, 0.5, 0.6] {
        for seed in 0..500 {
            let period = 5.0 * 20f64.powf((seed as f64 * 0.618_034).fract());
            let ratio = 1.05 + (seed as f64 * 0.754_878).fract();
            let first = random_wave(seed, RATE / period, 0.5);
            let second = random_wave(seed + 5000, RATE / period * ratio, 0.5);
            let size = share * first.main_amplitude / second.main_amplitude;
            let second = Wave {
                main_amplitude: size * second.main_amplitude,
                quadrature_amplitude: size * second.quadrature_amplitude,
                ..second
            };
            let flaws = Flaws::white(0.005 * first.main_amplitude);
            let mut core = Core::new(windows(10)).unwrap();
            let pairs = stream(first, flaws, (60.0 * period) as usize, seed);
            for (k, [c, d]) in pairs.into_iter().enumerate() {
                let [more_c, more_d] = second.pick_offs(k as f64 / RATE);
                let Some(estimate) = core.push([c + more_c as f32, d + more_d as f32]) else {
                    continue;
                };
                rows += 1;
                let far = |wave: &Wave| {
                    let allowed = 6.0 * f64::from(estimate.frequency_std);
                    (estimate.frequency - wave.frequency).abs() > allowed
                };
                clean += usize::from(estimate.flags.is_empty());
                let is_wrong = estimate.flags.is_empty() && far(&first) && far(&second);
                wrong += usize::from(is_wrong);
            }
        }
    }
    println!("a tone half as large: {rows} rows, {clean} clean, {wrong} of them wrong");
    assert!(
        rows > 4000 && clean > 2000 && wrong < 10,
        "{wrong} of {rows}"
    );
}

#[test]
fn a_spur_does_not_hide_the_wave() {
    // A tone beside the wave, as a share of a_A, at a fifth of its frequency to five times it.
    for share in [0.02, 0.1, 0.2] {
        let (mut worst, mut latest, mut none) = (0f64, 0f64, 0);
        for seed in 0..3000 {
            let (wave, period) = wave(seed);
            let ratio = 0.2 * 25f64.powf((seed as f64 * 0.754_878).fract());
            let advance = std::f64::consts::TAU * ratio / period;
            let size = share * wave.main_amplitude;
            let flaws = Flaws::white(0.002 * wave.main_amplitude);
            let mut detector = DifferenceDetector::<f32>::new();
            let gyro = Gyro::new(wave, flaws, RATE, seed).unwrap();
            let pairs = (0..).zip(gyro.take((20.0 * period) as usize));
            let found = pairs.into_iter().find_map(|(k, pair)| {
                let (sine, cosine) = (advance * f64::from(k) + seed as f64).sin_cos();
                let pair = [pair[0] + size * cosine, pair[1] + size * sine];
                let found = detector.push(pair.map(|x| x as f32))?;
                Some((f64::from(k), f64::from(found)))
            });
            match found {
                Some((k, found)) => {
                    worst = worst.max((found / period - 1.0).abs());
                    latest = latest.max(k / period);
                }
                None => none += 1,
            }
        }
        println!("spur of {share}: worst {worst:.3}, latest {latest:.1} periods, none {none}");
        assert_eq!(none, 0, "spur of {share}");
        assert!(
            worst < 0.5 * share.max(0.02) && latest < 5.5,
            "spur of {share}: {worst} {latest}"
        );
    }
}

/// Windows with a tone of 1 % of a_A beside the wave, in noise of 2·10⁻⁴: the share without a flag, and the largest errors of a_A and a_B
/// in these, as shares of the tone and in deviations.
fn beside(ratios: [f64; 2], settings: impl Fn(u16) -> Settings, periods: [u16; 2]) -> [f64; 3] {
    let (mut rows, mut clean, mut leaked, mut most) = (0.0, 0.0, 0f64, 0f64);
    for seed in 0..400 {
        let part = |step: f64| (seed as f64 * step).fract();
        let period = 5.0 * 12f64.powf(part(0.618_034));
        let ratio = ratios[0] + (ratios[1] - ratios[0]) * part(0.754_878);
        let wave = random_wave(seed, RATE / period, 0.5);
        let a = wave.main_amplitude;
        let flaws = Flaws::white(2e-4 * a);
        let count =
            periods[0] + (f64::from(periods[1] - periods[0]) * part(0.569_84)).round() as u16;
        let samples = (period * f64::from(count) * 15.0) as usize;
        let tone = |k: usize| {
            let phase = std::f64::consts::TAU * ratio / period * k as f64 + seed as f64;
            [0.01 * a * phase.cos(), 0.01 * a * (phase + 1.0).sin()]
        };
        for estimate in
            identify_changed(wave, &flaws, settings(count), samples, seed, |k, [c, d]| {
                let [of_c, of_d] = tone(k);
                [c + of_c, d + of_d]
            })
        {
            rows += 1.0;
            if estimate.flags.is_empty() {
                clean += 1.0;
                let (errors, stated) = (errors(&estimate, &wave), stated(&estimate));
                for i in 0..2 {
                    leaked = leaked.max(errors[i].abs() / (0.01 * a));
                    most = most.max(errors[i].abs() / stated[i]);
                }
            }
        }
    }
    [clean / rows, leaked, most]
}

#[test]
fn tones_that_blocks_do_not_see_leak_as_documented() {
    let coloured = |periods| Settings {
        coloured: true,
        ..windows(periods)
    };
    let hop = |periods| Settings {
        hop: Some(periods),
        ..windows(periods)
    };
    for (name, [share, leaked, deviations], of_clean, of_leaked, most) in [
        (
            "f/2",
            beside([0.45, 0.55], windows, [8, 24]),
            0.5..1.0,
            0.05..0.13,
            60.0,
        ),
        (
            "3f/2",
            beside([1.45, 1.55], windows, [8, 24]),
            0.5..1.0,
            0.05..0.13,
            60.0,
        ),
        (
            "f/2 with a hop",
            beside([0.45, 0.55], hop, [10, 24]),
            0.0..1.0,
            0.0..0.13,
            5.0,
        ),
        (
            "2f",
            beside([1.9, 2.1], windows, [8, 24]),
            0.8..1.01,
            0.01..0.08,
            30.0,
        ),
        (
            "coloured",
            beside([0.24, 0.34], coloured, [7, 8]),
            0.9..1.01,
            0.05..0.3,
            100.0,
        ),
    ] {
        println!(
            "a tone near {name}: {share:.2} without a flag, {leaked:.3} of it leaks, {deviations:.0} deviations"
        );
        assert!(
            of_clean.contains(&share) && of_leaked.contains(&leaked) && deviations < most,
            "{name}: {share} {leaked} {deviations}"
        );
    }
}
