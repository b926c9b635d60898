//! Conclusions on algorithm 1's neglect of quadrature.

use antinode::methods::{Moments, Ratio, algorithm1};
use antinode_sim::Wave;

use super::{Conclusion, Verdict, at, error, phases, pure};
use crate::median::ends;
use crate::study::RATE;
use crate::study::figure::{Figure, Name};
use crate::study::samples::Samples;

/// Gates of (13), as shares of a_A: samples of S_C below them are left out. S_C itself reaches 0.5.
const GATES: [f64; 5] = [0.02, 0.05, 0.1, 0.2, 0.4];

pub fn floor(wave: &Wave, first: &Figure) -> Conclusion {
    let place = 3;
    let [a, angle] = ['a', 'c'].map(|letter| at(first, letter, Name::Algorithm1, place));
    let third = at(first, 'a', Name::Algorithm3, place);
    let pure = pure(wave);
    let without = error(
        &Samples::simulate(&pure, 4, RATE, 0.0, 0),
        &pure,
        Name::Algorithm1,
    );
    Conclusion {
        claim: "Algorithm 1's errors have a floor, from neglecting quadrature.",
        verdict: Verdict::confirmed_if(
            a > 10.0 * without[0] && a > 10.0 * third && angle > 10.0 * without[2],
        ),
        found: format!(
            "4 periods: a_A error {a:.1e} (a_B²/2a_A = {:.1e}), angle {angle:.1e}°; with a_B = 0: {:.1e} and {:.1e}°.",
            wave.quadrature_amplitude.powi(2) / (2.0 * wave.main_amplitude),
            without[0],
            without[2],
        ),
    }
}

/// Error of the angle by (12), degrees.
fn by_roots(wave: &Wave, samples: &Samples) -> f64 {
    let angle = algorithm1::shape(&Moments::of(samples.window())).angle;
    (angle - wave.angle).to_degrees()
}

/// Error of the angle by (13), degrees, without samples of S_C below `gate` of a_A.
fn by_ratio(wave: &Wave, samples: &Samples, gate: f64) -> f64 {
    let min = gate * wave.main_amplitude;
    let angle = algorithm1::rough_angle(&Ratio::of(samples.window(), min as f32));
    (angle - wave.angle).to_degrees()
}

pub fn longer(wave: &Wave) -> Conclusion {
    let both = |wave: &Wave| {
        [1, 8].map(|periods| by_roots(wave, &Samples::simulate(wave, periods, RATE, 0.0, 0)).abs())
    };
    let here = both(wave);
    let all: Vec<[f64; 2]> = phases(wave).map(|wave| both(&wave)).collect();
    let worse = all.iter().filter(|[one, eight]| eight > one).count();
    let [one, eight] = [0, 1].map(|i| ends(all.iter().map(|both| both[i])));
    Conclusion {
        claim: "Algorithm 1's angle gets worse as windows get longer, from neglecting quadrature.",
        verdict: match worse {
            0 => Verdict::NotConfirmed,
            _ if worse == all.len() => Verdict::Confirmed,
            _ => Verdict::InPart,
        },
        found: format!(
            "The error depends on the start phase. Here {:.3}° on one period, {:.3}° on eight.\nOver all phases {:.3} to {:.3}° on one, {:.3} \
             to {:.3}° on eight, worse than on one at {:.0} % of the phases: it settles at the floor.",
            here[0],
            here[1],
            one[0],
            one[1],
            eight[0],
            eight[1],
            100.0 * worse as f64 / all.len() as f64,
        ),
    }
}

/// Errors of (13) at a gate, in windows of 1 to 10 periods.
struct Rough {
    /// Absolute errors over those of (12), sorted.
    ratios: Vec<f64>,
    /// Mean error, degrees.
    bias: f64,
}

impl Rough {
    fn of(waves: &[Wave], gate: f64) -> Self {
        let mut ratios = Vec::new();
        let mut sum = 0.0;
        for wave in waves {
            for periods in 1..=10 {
                let samples = Samples::simulate(wave, periods, RATE, 0.0, 0);
                let error = by_ratio(wave, &samples, gate);
                sum += error;
                ratios.push((error / by_roots(wave, &samples)).abs());
            }
        }
        let bias = sum / ratios.len() as f64;
        ratios.sort_by(f64::total_cmp);
        Self { ratios, bias }
    }

    /// The ratio below which this many tenths of all lie.
    fn tenth(&self, tenth: usize) -> f64 {
        self.ratios[tenth * (self.ratios.len() - 1) / 10]
    }
}

pub fn rougher(wave: &Wave) -> Conclusion {
    let here = Rough::of(&[*wave], 0.0).tenth(0);
    let waves: Vec<Wave> = phases(wave).collect();
    let without = Rough::of(&waves, 0.0);
    let order = without.ratios.iter().filter(|&&ratio| ratio >= 10.0);
    let share = order.count() as f64 / without.ratios.len() as f64;
    let gated = GATES.map(|gate| Rough::of(&waves, gate));
    let texts: Vec<String> = GATES
        .iter()
        .zip(&gated)
        .map(|(gate, rough)| {
            let [low, middle, high] = [1, 5, 9].map(|tenth| rough.tenth(tenth));
            format!("{middle:.1} ({low:.1} to {high:.1}) at {gate}")
        })
        .collect();
    let [min, max] = ends(gated.iter().map(|rough| rough.bias.abs()));
    Conclusion {
        claim: "Formula (13) for the angle is often an order rougher than (12); leaving out small S_C helps.",
        verdict: Verdict::confirmed_if(
            here > 10.0 && share > 0.5 && gated.iter().all(|rough| rough.tenth(5) < 5.0),
        ),
        found: format!(
            "Without a gate {here:.0} times and more here, ten times and more in {:.0} % of windows of all phases.\nWith a gate, in a_A, the \
             median (and eight of ten): {}.\nNo gate removes a bias: {min:.3} to {max:.3}° in the mean of all phases.",
            100.0 * share,
            texts.join(", "),
        ),
    }
}
