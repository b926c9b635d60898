//! Waves, flaws, settings and arithmetic drawn at random: no clean row is off, and nothing is flagged that is no fault.

use antinode::{Calibration, Estimate, Flags, Identifier, Sample, SamplePair, Settings};
use antinode_sim::{Flaws, Gyro, Wave, random_wave};
use host_tests::codes::converted;
use host_tests::random::Random;
use host_tests::score::{errors, stated};
use host_tests::{RATE, windows};

/// Windows of a stream, at most.
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
    // A first window takes the pattern to be at rest, which costs the frequency more the nearer that is to a circle.
    let turns = draw.one_in(3);
    let mut wave = random_wave(seed, RATE / period, if turns { 0.3 } else { 0.95 });
    let a = wave.main_amplitude;
    if turns {
        wave.angle_rate = draw.between(-0.02, 0.02) * RATE / samples;
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
        let scale = flaws.full_scale as f32;
        settings.rails = Some([-scale, scale - 1.0]);
        settings.resolution = Some(1.0);
    }
    Case {
        seed,
        wave,
        flaws,
        settings,
        samples: (samples * (WINDOWS + 0.5) + 20.0 * period) as usize,
    }
}

fn identified<S: Sample>(case: &Case, sample: impl Fn(f64) -> S) -> Vec<Estimate>
where
    [S; 2]: SamplePair<S>,
{
    let gyro = Gyro::new(case.wave, case.flaws.clone(), RATE, case.seed).unwrap();
    let pairs: Vec<_> = gyro.take(case.samples).map(|p| p.map(&sample)).collect();
    let mut core = Box::new(Identifier::<S, 256, 256>::new(case.settings).unwrap());
    let mut found = Vec::new();
    core.extend(&pairs, |estimate| found.push(estimate));
    found
}

#[test]
fn clean_rows_are_within_their_deviations_whatever_the_wave_and_the_settings() {
    let [mut rows, mut clean] = [0u32; 2];
    let (mut worst, mut squares) = ([0f64; 4], [0f64; 4]);
    for seed in 0..1500 {
        let case = case(seed);
        let found = match case.flaws.bits {
            None => identified(&case, |x| x as f32),
            Some(16) => identified(&case, |x| x as i16),
            Some(_) => identified(&case, |x| x as i32),
        };
        assert!(found.len() >= 4, "{} of {case:?}", found.len());
        for estimate in &found {
            rows += 1;
            // Noise may hide the angle, and the first one seen after that is reacquired.
            let faults = estimate
                .flags
                .without(Flags::CIRCULAR)
                .without(Flags::REACQUIRED);
            assert!(faults.is_empty(), "{estimate:?} of {case:?}");
            if !estimate.flags.is_empty() {
                continue;
            }
            clean += 1;
            let each = errors(estimate, &case.wave)
                .into_iter()
                .zip(stated(estimate));
            for (i, (error, stated)) in each.enumerate() {
                let sigmas = error.abs() / stated;
                assert!(sigmas < 6.5, "{sigmas} {estimate:?} of {case:?}");
                worst[i] = worst[i].max(sigmas);
                squares[i] += sigmas * sigmas;
            }
        }
    }
    let ratios = squares.map(|square| (square / f64::from(clean)).sqrt());
    println!("{clean} of {rows} rows clean, rms error over stated {ratios:.3?}, worst {worst:.1?}");
    assert!(clean > 10_000 && ratios.iter().all(|ratio| (0.95..1.05).contains(ratio)));
}
