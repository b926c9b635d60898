//! Waves, flaws, settings and arithmetic drawn at random: no clean row is off, and nothing is flagged that is no fault.

use antinode::{Calibration, Estimate, Flags, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::codes::{self, converted};
use host_tests::random::Random;
use host_tests::score::{errors, stated};
use host_tests::{RATE, identify_parts, windows};

/// Windows of a stream, about.
const WINDOWS: f64 = 6.0;

/// A stream, and how it is identified.
#[derive(Debug)]
struct Case {
    seed: u64,
    wave: Wave,
    flaws: Flaws,
    settings: Settings,
    samples: usize,
}

/// Draws from ranges and lists.
struct Draw(Random);

impl Draw {
    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * 0.5 * f64::from(self.0.draw() + 1.0)
    }

    /// Evenly on a logarithmic scale.
    fn scaled(&mut self, from: f64, to: f64) -> f64 {
        self.between(from.ln(), to.ln()).exp()
    }

    fn one_of<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.between(0.0, 1.0) * list.len() as f64) as usize % list.len()]
    }

    /// True for one in `count`.
    fn one_in(&mut self, count: u32) -> bool {
        self.between(0.0, f64::from(count)) < 1.0
    }

    fn offset(&mut self) -> f64 {
        self.one_of(&[0.0, 1.0, -1.0]) * self.scaled(1e-3, 40.0)
    }
}

fn case(seed: u64) -> Case {
    let mut draw = Draw(Random::new(seed as u32));
    let period = draw.scaled(5.0, 100.0);
    let periods = draw.one_of(&[3, 4, 5, 6, 7, 10, 15, 20, 50, 100, 250]);
    let samples = f64::from(periods) * period;
    let mut wave = random_wave(seed, RATE / period, 0.95);
    let a = wave.main_amplitude;
    let turns = draw.one_in(2);
    if turns {
        let turn = draw.one_of(&[-1.0, 1.0]) * draw.scaled(1e-5, 0.1);
        wave.angle_rate = turn * RATE / samples;
    }
    if draw.one_in(3) {
        wave.decay_rate = draw.scaled(1e-3, 0.05) * RATE / samples;
    }
    let noise = if turns || draw.one_in(2) {
        draw.scaled(1e-5, 0.01)
    } else {
        draw.scaled(0.01, 0.2)
    };
    let mut flaws = Flaws {
        noise: a * noise,
        offset_c: a * draw.offset(),
        offset_d: a * draw.offset(),
        ..Flaws::default()
    };
    if draw.one_in(3) {
        flaws.gain_ratio = draw.scaled(0.4, 2.5);
        flaws.skew = draw.between(-0.4, 0.4) * period / RATE;
        flaws.pick_off_angle = draw.between(-0.25, 0.25);
    }
    let mut settings = Settings {
        watch: !draw.one_in(6),
        calibration: Calibration {
            gain_ratio: flaws.gain_ratio as f32,
            skew: flaws.skew as f32,
            pick_off_angle: flaws.pick_off_angle as f32,
        },
        ..windows(periods)
    };
    if draw.one_in(3) {
        settings.hop = Some(draw.one_of(&[1, 2, 3, 5]));
    }
    settings.hum = draw.one_in(6) && periods >= if settings.hop.is_some() { 10 } else { 5 };
    if draw.one_in(4) {
        settings.frequency = Some((wave.frequency * draw.between(0.97, 1.03)) as f32);
    }
    if let Some(bits) = draw.one_of(&[None, Some(16), Some(24)]) {
        let offsets = flaws.offset_c.abs().max(flaws.offset_d.abs());
        let peak = 1.4 * a * flaws.gain_ratio.max(1.0) + offsets + 6.0 * flaws.noise;
        (wave, flaws) = converted(&wave, &flaws, bits, a / peak);
        let coded = codes::settings(bits, periods);
        (settings.rails, settings.resolution) = (coded.rails, coded.resolution);
    }
    Case {
        seed,
        wave,
        flaws,
        settings,
        samples: (samples * (WINDOWS + 0.5) + 20.0 * period) as usize,
    }
}

impl Case {
    /// The samples, and `extra` more.
    fn pairs(&self, extra: usize) -> Vec<[f64; 2]> {
        let gyro = Gyro::new(self.wave, self.flaws.clone(), RATE, self.seed).unwrap();
        gyro.take(self.samples + extra).collect()
    }

    fn identified(&self, pairs: &[[f64; 2]]) -> Vec<Estimate> {
        let Some(bits) = self.flaws.bits else {
            let pairs: Vec<_> = pairs.iter().map(|p| p.map(|x| x as f32)).collect();
            return identify_parts(&[&pairs], self.settings);
        };
        let pairs: Vec<_> = pairs.iter().map(|p| p.map(|x| x as i32)).collect();
        if bits > 16 {
            codes::identify(&pairs, self.settings, |code| code)
        } else {
            codes::identify(&pairs, self.settings, |code| code as i16)
        }
    }

    /// Errors of a row in its deviations, if all samples come `later` than they should, s; 0 for the frequency of a turning pattern before
    /// sample pair `told`, when the windows before do not tell its rate.
    fn sigmas(&self, estimate: &Estimate, later: f64, told: u64) -> [f64; 4] {
        let at_source = Estimate {
            time: estimate.time - later,
            ..*estimate
        };
        let (errors, stated) = (errors(&at_source, &self.wave), stated(estimate));
        let mut sigmas: [f64; 4] = std::array::from_fn(|i| errors[i].abs() / stated[i]);
        if self.wave.angle_rate != 0.0 && estimate.start < told {
            sigmas[3] = 0.0;
        }
        sigmas
    }
}

/// The greatest, or infinity if one is not a number.
fn greatest(sigmas: [f64; 4]) -> f64 {
    let numbers = sigmas.map(|one| if one.is_nan() { f64::INFINITY } else { one });
    numbers.into_iter().fold(0.0, f64::max)
}

/// True if a row has a flag of a fault. Noise may hide the angle, and the first one seen after that is reacquired.
fn is_faulty(estimate: &Estimate) -> bool {
    let harmless = Flags::CIRCULAR.with(Flags::REACQUIRED);
    !estimate.flags.without(harmless).is_empty()
}

#[test]
fn clean_rows_are_within_their_deviations_whatever_the_wave_and_the_settings() {
    let [mut rows, mut clean] = [0u32; 2];
    let [mut worst, mut squares, mut counts] = [[0f64; 4]; 3];
    for seed in 0..1500 {
        let case = case(seed);
        let found = case.identified(&case.pairs(0));
        assert!(found.len() >= 4, "{} of {case:?}", found.len());
        let told = found[0].start + 4 * u64::from(found[0].samples);
        for estimate in &found {
            rows += 1;
            assert!(!is_faulty(estimate), "{estimate:?} of {case:?}");
            if estimate.flags.is_empty() {
                clean += 1;
                let sigmas = case.sigmas(estimate, 0.0, told);
                let most = greatest(sigmas);
                assert!(most < 6.5, "{most} sigma: {estimate:?} of {case:?}");
                for (i, sigmas) in sigmas.into_iter().enumerate() {
                    worst[i] = worst[i].max(sigmas);
                    squares[i] += sigmas * sigmas;
                    counts[i] += f64::from(u8::from(sigmas > 0.0));
                }
            }
        }
    }
    let ratios: [f64; 4] = std::array::from_fn(|i| (squares[i] / counts[i]).sqrt());
    println!("{clean} of {rows} rows clean, rms error over stated {ratios:.3?}, worst {worst:.1?}");
    assert!(clean > 10_000 && ratios.iter().all(|ratio| (0.95..1.05).contains(ratio)));
}

#[test]
fn a_fault_leaves_clean_rows_right_whatever_the_wave_and_the_settings() {
    let [mut rows, mut clean] = [0u32; 2];
    for seed in 0..1500 {
        let case = case(seed);
        let mut draw = Draw(Random::new(!seed as u32));
        let at = (case.samples as f64 * draw.between(0.4, 0.6)) as usize;
        let length = draw.scaled(1.0, case.samples as f64 / 8.0) as usize;
        let mut pairs = case.pairs(length);
        let (channel, size) = (draw.one_of(&[0, 1]), draw.scaled(1e-3, 0.3));
        let (mut end, mut later) = (at, 0);
        match draw.one_of(&[0, 1, 2, 3, 4]) {
            // Pairs are missing.
            0 => {
                pairs.drain(at..at + length);
                later = -(length as i64);
            }
            // Pairs come twice.
            1 => {
                let again = pairs[at - length.min(at)..at].to_vec();
                later = again.len() as i64;
                pairs.splice(at..at, again);
            }
            // A pick-off, or both, keep their values.
            kind @ (2 | 3) => {
                end = at + length;
                let held = pairs[at];
                for pair in &mut pairs[at..end] {
                    pair[channel] = held[channel];
                    if kind == 3 {
                        *pair = held;
                    }
                }
            }
            // An offset steps.
            _ => {
                let step = size * case.wave.main_amplitude;
                let step = case.flaws.bits.map_or(step, |_| step.round());
                for pair in &mut pairs[at..] {
                    pair[channel] += step;
                }
            }
        }
        let later = later as f64 / RATE;
        for estimate in case.identified(&pairs) {
            let is_before = estimate.end() <= at as u64;
            let is_after = estimate.start >= end as u64;
            assert!(
                !is_before || !is_faulty(&estimate),
                "{estimate:?} of {case:?}"
            );
            rows += u32::from(is_after);
            if !estimate.flags.is_empty() {
                continue;
            }
            clean += u32::from(is_after);
            let [before, after] =
                [0.0, later].map(|later| greatest(case.sigmas(&estimate, later, u64::MAX)));
            let (off, most) = match (is_before, is_after) {
                (true, _) => (before, 6.5),
                (_, true) => (after, 6.5),
                // A fault too small for a flag.
                _ => (before.min(after), 20.0),
            };
            assert!(off < most, "{off} sigma: {estimate:?} of {case:?}");
        }
    }
    println!("{clean} of {rows} rows after a fault are clean");
    assert!(clean > 9 * rows / 10 && rows > 20_000);
}
