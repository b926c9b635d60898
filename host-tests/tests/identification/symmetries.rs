//! The same stream in other units, upside down, with one pick-off's sign changed or with the pick-offs exchanged gives the same rows and
//! the same flags, whatever its faults.

use std::f32::consts::{FRAC_PI_4, PI};

use antinode::{Estimate, Flags, Settings};
use antinode_sim::{Flaws, Wave, random_wave};
use host_tests::random::Random;
use host_tests::{Core, stream, windows};

const FAULTS: u64 = 12;

/// A wave in noise, with a fault of one kind every 2000 pairs or so.
fn faulty(seed: u64) -> Vec<[f32; 2]> {
    let wave = Wave {
        angle_rate: 2.0,
        decay_rate: 0.5,
        ..random_wave(seed, 5332.0, 0.4)
    };
    let a = wave.main_amplitude as f32;
    let fault = seed % FAULTS;
    let flaws = Flaws {
        noise: if fault == 0 { 0.2 } else { 0.003 } * wave.main_amplitude,
        offset_c: 0.3 * wave.main_amplitude,
        offset_d: -0.1 * wave.main_amplitude,
        ..Flaws::default()
    };
    let mut pairs = stream(wave, flaws, 16_000, seed);
    let mut random = Random::new(seed as u32);
    for start in (2000..14_000).step_by(2000) {
        let at = start + (900.0 * random.draw()) as usize % 900;
        let of = usize::from(random.draw() > 0.0);
        let sign = random.draw().signum();
        let level = a * random.draw();
        for (i, pair) in pairs[at..].iter_mut().enumerate() {
            let sample = pair[of];
            match fault {
                1 if i == 0 => pair[of] = sign * 6.0 * a,
                2 if i < 300 => pair[of] = level,
                3 if i < 400 => pair[of] = 0.5 * level + 0.003 * a * random.draw(),
                4 if i < 500 && sign * sample > 0.5 * a => pair[of] = sign * 0.5 * a,
                5 if i < 500 => pair[of] = sample.clamp(-0.6 * a, 0.6 * a),
                6 if i < 700 => *pair = pair.map(|s| 0.8 * s),
                7 if i < 700 => pair[of] += 0.3 * sign * a,
                8 if i < 500 => pair[of] += 0.3 * a * (0.47 * i as f32).cos(),
                9 if i < 500 => pair[of] += 0.3 * a * random.draw(),
                10 if i < 500 && i % 2 == 0 => pair[of] = sign * f32::INFINITY,
                11 if i < 600 => *pair = pair.map(|_| level + 0.003 * a * random.draw()),
                _ => {}
            }
        }
    }
    pairs
}

fn settings(seed: u64) -> Settings {
    Settings {
        hop: [None, Some(4)][seed as usize / 3 % 2],
        hum: seed % 5 == 4,
        rails: Some([-2.5, 2.5]),
        resolution: (seed % 4 == 1).then_some(1e-3),
        frequency: (seed % 7 == 2).then_some(5300.0),
        ..windows(10)
    }
}

fn rows(pairs: impl Iterator<Item = [f32; 2]>, settings: Settings) -> Vec<Estimate> {
    let mut core = Core::new(settings).unwrap();
    pairs.filter_map(|pair| core.push(pair)).collect()
}

/// Flags that the streams raised, and the rows compared.
fn compare(
    change: impl Fn([f32; 2]) -> [f32; 2],
    settings_of: impl Fn(Settings) -> Settings,
    same: impl Fn(&Estimate, &Estimate) -> bool,
) {
    let (mut seen, mut count) = (Flags::empty(), 0);
    for seed in 0..4 * FAULTS {
        let pairs = faulty(seed);
        let settings = settings(seed);
        let straight = rows(pairs.iter().copied(), settings);
        let changed = rows(pairs.iter().copied().map(&change), settings_of(settings));
        assert_eq!(straight.len(), changed.len(), "seed {seed}");
        for (one, other) in straight.iter().zip(&changed) {
            let is_same = one.flags == other.flags
                && (one.start, one.samples) == (other.start, other.samples)
                // Of no wave, or of samples that are no numbers, no number means anything.
                && (one.flags.contains(Flags::LOST) || same(one, other));
            assert!(is_same, "seed {seed}:\n{one:?}\n{other:?}");
            seen |= one.flags;
            count += 1;
        }
    }
    println!("{count} rows, {seen}");
    assert!(count > 3000 && seen.bits().count_ones() >= 7, "{seen}");
}

/// The numbers of a row that are in input units, and those that are not, but for the angle, the phase and the offsets.
fn numbers(e: &Estimate) -> ([f32; 4], [f32; 8]) {
    (
        [
            e.main_amplitude,
            e.main_amplitude_std,
            e.quadrature_amplitude_std,
            e.residual_rms,
        ],
        [
            e.angle_std,
            e.phase_std,
            e.frequency_std,
            e.angle_rate_std,
            e.decay_rate_std,
            e.decay_rate,
            e.time as f32,
            (e.frequency - 5332.0) as f32,
        ],
    )
}

/// True if two rows agree but for rounding and these signs of a_B and of the angle; `sum` is what the angles then differ by.
fn agree(one: &Estimate, other: &Estimate, sign: f32, sum: f32) -> bool {
    let near = |a: f32, b: f32, scale: f32| (a - b).abs() <= 1e-3 * scale;
    let a = one.main_amplitude;
    let ((of_unit, free), (of_other, of_free)) = (numbers(one), numbers(other));
    let mut stds = of_unit[1..].iter().zip(&of_other[1..]);
    let mut more = free[..5].iter().zip(&of_free[..5]);
    let apart = (other.angle - f64::from(sign) * one.angle) as f32;
    near(a, other.main_amplitude, a)
        && stds.all(|(&one, &other)| near(one, other, one))
        && more.all(|(&one, &other)| near(one, other, one))
        && near(sign * one.quadrature_amplitude, other.quadrature_amplitude, a)
        // A circle has no angle of its own.
        && (near(apart, sum, 1.0) || one.flags.contains(Flags::CIRCULAR))
        && near(sign * one.angle_rate, other.angle_rate, one.angle_rate_std)
        && near(one.decay_rate, other.decay_rate, one.decay_rate_std)
        && (one.frequency - other.frequency).abs() as f32 <= 1e-3 * one.frequency_std
}

/// True if the offsets of two rows agree but for rounding.
fn are_same(one: [f32; 2], other: [f32; 2], size: f32) -> bool {
    (0..2).all(|i| (one[i] - other[i]).abs() <= 1e-5 * size)
}

#[test]
fn another_unit_changes_amplitudes_and_nothing_else() {
    for factor in [2f32.powi(-18), 2f32.powi(15)] {
        let times = |x: [f32; 2]| x.map(|x| factor * x);
        compare(
            times,
            |settings| Settings {
                rails: settings.rails.map(times),
                resolution: settings.resolution.map(|step| factor * step),
                ..settings
            },
            |one, other| {
                let ((of_unit, free), (of_other, of_free)) = (numbers(one), numbers(other));
                of_unit.map(|x| factor * x) == of_other
                    && free == of_free
                    && (one.angle, one.phase, one.angle_rate)
                        == (other.angle, other.phase, other.angle_rate)
                    && factor * one.quadrature_amplitude == other.quadrature_amplitude
                    && times(one.offsets) == other.offsets
            },
        );
    }
}

#[test]
fn a_stream_upside_down_is_half_a_period_later() {
    compare(
        |pair| pair.map(|x| -x),
        |settings| settings,
        |one, other| {
            let later = ((one.phase - other.phase).abs() - PI).abs();
            agree(one, other, 1.0, 0.0)
                && (later < 1e-5 || one.flags.contains(Flags::CIRCULAR))
                && are_same(one.offsets.map(|x| -x), other.offsets, one.main_amplitude)
        },
    );
}

#[test]
fn exchanged_pick_offs_mirror_the_pattern() {
    compare(
        |[c, d]| [d, c],
        |settings| Settings {
            start_angle: FRAC_PI_4 - settings.start_angle,
            ..settings
        },
        |one, other| {
            let [c, d] = other.offsets;
            agree(one, other, -1.0, FRAC_PI_4) && are_same(one.offsets, [d, c], one.main_amplitude)
        },
    );
}

#[test]
fn a_pick_off_of_the_other_sign_mirrors_the_pattern() {
    compare(
        |[c, d]| [c, -d],
        |settings| Settings {
            start_angle: -settings.start_angle,
            ..settings
        },
        |one, other| {
            let [c, d] = other.offsets;
            agree(one, other, -1.0, 0.0) && are_same(one.offsets, [c, -d], one.main_amplitude)
        },
    );
}
