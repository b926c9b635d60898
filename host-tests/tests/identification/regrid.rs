//! Re-gridding: on a grid that fits the period all four methods are free of leakage, and the filter works.

use std::f64::consts::TAU;

use antinode::methods::{
    Delayed, Moments, Products, Shape, algorithm1, algorithm2, algorithm3, algorithm4,
};
use antinode::regrid::{Regrid, RegridError};
use antinode_sim::{Wave, random_wave};
use host_tests::{RATE, angle_error};

/// Samples of the new grid, from output number `skip` on.
fn regridded<const TAPS: usize>(
    signal: impl Fn(usize) -> [f64; 2],
    period: f64,
    count: usize,
) -> Vec<[f32; 2]> {
    let mut regrid = Regrid::<TAPS>::new(period as f32, 20, 2.0).expect("a valid grid");
    let mut out = Vec::new();
    let mut k = 0;
    while out.len() < count {
        regrid.push(signal(k).map(|x| x as f32), |pair| out.push(pair));
        k += 1;
    }
    out
}

fn errors(shape: &Shape, wave: &Wave) -> [f64; 3] {
    [
        (shape.main_amplitude - wave.main_amplitude).abs() / wave.main_amplitude,
        (shape.quadrature_amplitude - wave.quadrature_amplitude).abs() / wave.main_amplitude,
        angle_error(shape.angle, wave.angle).abs(),
    ]
}

/// Worst error of algorithms 2, 3 and 4, and of algorithm 1 with a_A² compared with a_A² + a_B², over one period of 20 samples after 5.
fn worst(pairs: &[[f32; 2]], wave: &Wave) -> f64 {
    let window = &pairs[5..25];
    let (moments, products) = (Moments::of(window), Products::of(window, TAU / 20.0));
    let delayed = Delayed::of(&pairs[..25], 5, 5);
    let shapes = [
        algorithm2::shape(&moments, delayed.q()),
        algorithm3::shape(&moments, products.q()),
        algorithm4::wave(&products).shape,
    ];
    let size = wave.main_amplitude.hypot(wave.quadrature_amplitude);
    let first = (algorithm1::shape(&moments).main_amplitude - size).abs() / size;
    let others = shapes.iter().flat_map(|shape| errors(shape, wave));
    others.fold(first, f64::max)
}

#[test]
fn on_a_fitting_grid_one_period_has_no_leakage() {
    let (mut before, mut after) = (f64::INFINITY, 0f64);
    for seed in 0..100 {
        let wave = Wave {
            quadrature_amplitude: 0.3,
            ..random_wave(seed, 5332.0, 0.5)
        };
        let signal = |k: usize| wave.pick_offs(k as f64 / RATE);
        let period = RATE / wave.frequency;
        let fitted = regridded::<32>(signal, period, 60);
        after = after.max(worst(&fitted[30..], &wave));
        // The first output lies at input sample TAPS/2 − 1, each next one a twentieth of a period later.
        for (k, pair) in fitted.iter().enumerate() {
            let [c, d] = wave.pick_offs((15.0 + k as f64 * period / 20.0) / RATE);
            assert!((f64::from(pair[0]) - c).abs() + (f64::from(pair[1]) - d).abs() < 2e-5);
        }
        // The same on the converter's own grid, 19 samples for a period of 18.75.
        let raw: Vec<[f32; 2]> = (0..24).map(|k| signal(k).map(|x| x as f32)).collect();
        let shape = algorithm4::wave(&Products::of(&raw[5..], TAU / period)).shape;
        before = before.min(errors(&shape, &wave).into_iter().fold(0.0, f64::max));
    }
    println!(
        "one period, worst error: {before:.1e} at least on the converter's grid, {after:.1e} at most on the fitting one"
    );
    assert!(before > 1e-3 && after < 3.5e-6);
}

/// Worst error of a wave of `period` samples, on a grid with room for `cut_off`, and its stated bound.
fn error_and_bound<const TAPS: usize>(period: f32, per_period: u16, cut_off: f32) -> (f64, f64) {
    let mut regrid = Regrid::<TAPS>::new(period, per_period, cut_off).unwrap();
    let turn = TAU / f64::from(period);
    let (step, mut time, mut worst) = (regrid.step(), (TAPS / 2 - 1) as f64, 0f64);
    for k in 0..2 * TAPS + 8 * period as usize {
        let (sine, cosine) = (turn * k as f64).sin_cos();
        regrid.push([cosine as f32, sine as f32], |pair| {
            let (sine, cosine) = (turn * time).sin_cos();
            worst = worst.max((f64::from(pair[0]) - cosine).hypot(f64::from(pair[1]) - sine));
            time += step;
        });
    }
    (worst, (turn / 64.0).powi(2) / 8.0)
}

#[test]
fn a_wave_passes_with_the_stated_error() {
    for (error, bound) in [
        error_and_bound::<6>(2.5, 3, 1.1),
        error_and_bound::<8>(2.6, 4, 1.2),
        error_and_bound::<38>(18.75, 20, 2.0),
        error_and_bound::<120>(60.0, 64, 2.0),
        error_and_bound::<400>(200.0, 200, 2.0),
        error_and_bound::<4>(1000.0, 1000, 2.0),
    ] {
        println!("{error:.1e}, of the table {bound:.1e}");
        assert!(error < bound + 1e-6, "{error:e}");
    }
}

#[test]
fn the_filter_removes_noise_and_harmonics() {
    // Two and a half periods of taps, with the cut-off at twice the frequency.
    let period = RATE / 5332.0;
    let power = |signal: &dyn Fn(usize) -> [f64; 2]| {
        let out = regridded::<48>(signal, period, 4000);
        let sum: f64 = out[100..].iter().map(|p| f64::from(p[0]).powi(2)).sum();
        sum / 3900.0
    };
    let tone =
        |multiple: f64| power(&move |k| [(TAU * multiple * k as f64 / period).cos(), 0.0]) / 0.5;
    assert!((tone(1.0) - 1.0).abs() < 1e-5);
    for multiple in [3.0, 4.0, 5.5, 8.0] {
        let kept = tone(multiple);
        println!(
            "{multiple} times the frequency: {:.0} dB",
            10.0 * kept.log10()
        );
        assert!(kept < 1e-3, "{multiple}: {kept}");
    }
    // White noise keeps the share of its band that passes: 2·2/18.75.
    let gyro = antinode_sim::Gyro::new(
        Wave {
            main_amplitude: 1e-9,
            quadrature_amplitude: 0.0,
            ..Wave::default()
        },
        antinode_sim::Flaws {
            noise: 1.0,
            ..Default::default()
        },
        RATE,
        7,
    );
    let noise: Vec<[f64; 2]> = gyro.unwrap().take(8000).collect();
    let kept = power(&|k| noise[k]);
    println!("white noise: {kept:.3} of its power passes");
    assert!((kept / (4.0 / period) - 1.0).abs() < 0.15, "{kept}");
}

#[test]
fn a_grid_changes_to_valid_periods_only() {
    let mut regrid = Regrid::<32>::new(18.75, 20, 2.0).unwrap();
    for period in [2.4, 1000.5, 0.0, f32::NAN] {
        let refused = regrid.retune(period);
        assert!(matches!(refused, Err(RegridError::Period(_))), "{period}");
        assert_eq!(regrid.step(), 0.9375);
    }
    regrid.retune(18.8).unwrap();
    assert!((regrid.step() - 0.94).abs() < 1e-7);
}

#[test]
fn invalid_grids_are_refused() {
    assert_eq!(
        Regrid::<32>::new(1.0, 20, 2.0).err(),
        Some(RegridError::Period(1.0))
    );
    assert_eq!(
        Regrid::<32>::new(18.75, 2, 0.9).err(),
        Some(RegridError::PerPeriod(2))
    );
    assert_eq!(
        Regrid::<32>::new(18.75, 20, 1.0).err(),
        Some(RegridError::CutOff(1.0))
    );
    assert_eq!(
        Regrid::<32>::new(18.75, 20, 9.5).err(),
        Some(RegridError::CutOff(9.5))
    );
    assert_eq!(
        Regrid::<5>::new(18.75, 20, 2.0).err(),
        Some(RegridError::Taps(5))
    );
    assert!(Regrid::<32>::new(f32::NAN, 20, 2.0).is_err());
    let told = RegridError::CutOff(1.0).to_string();
    assert!(
        told.ends_with("it must be above 1, and at most half the samples a period of either grid")
    );
}
