//! Tests of derivatives and of variances by differences.

use num_complex::Complex;

use super::*;
use crate::calibration::moments::Moment;

/// Splits, per unit of time, and that unit, s.
const OF_SPLITS: [f64; SPLITS] = [0.3, -0.2, 0.5, 0.4];
const UNIT: f64 = 6.0;
/// 2πf, rad/s: periods count as infinitely short.
const OMEGA: f64 = 0.5;
const NOISE: f64 = 1e-3;
/// A difference of a flaw or a phasor.
const STEP: f64 = 1e-5;

/// A run that turns, in which quadrature grows.
fn run() -> Run {
    let moment = |k: u32| {
        let time = 0.1 * f64::from(k);
        let (sine, cosine) = (0.4 + 0.4 * time).sin_cos();
        let quadrature = 0.3 + 0.02 * time;
        Moment {
            time,
            raw: [
                Complex::new(cosine, quadrature * sine),
                Complex::new(sine, -quadrature * cosine),
            ],
            omega: OMEGA,
            variance: NOISE * NOISE,
            corrected: PickOffs::IDEAL,
            seconds: 0.0,
        }
    };
    Run {
        moments: (0..80).map(moment).collect(),
        turns: [0.0, 1.6],
    }
}

fn of(run: &Run, pick_offs: &PickOffs, splits: [f64; SPLITS]) -> Vec<AtMoment> {
    let decay = Decay::Straight;
    equations((0, run), pick_offs, decay, FLAWS + SPLITS, splits, UNIT).collect()
}

/// What is seen, without the part of the splits.
fn without_splits(equation: &Equation, splits: [f64; SPLITS]) -> f64 {
    let of_splits = equation.entries[FLAWS..].iter().zip(splits);
    equation.seen - of_splits.map(|(&(_, by), split)| by * split).sum::<f64>()
}

#[test]
fn factors_of_flaws_are_derivatives() {
    let run = run();
    for (gain_ratio, phase, angle) in [(1.0, 0.0, 0.0), (2.0, 0.3, 0.15), (0.4, -0.2, -0.1)] {
        // With one flaw changed by this.
        let changed = |flaw: usize, by: f64| {
            let by = |one: usize| if one == flaw { by } else { 0.0 };
            let pick_offs = PickOffs {
                gain_ratio: gain_ratio * by(0).exp(),
                skew: (phase + by(1)) / OMEGA,
                angle: angle + by(2),
            };
            of(&run, &pick_offs, OF_SPLITS)
        };
        for flaw in 0..FLAWS {
            let [less, now, more] = [-STEP, 0.0, STEP].map(|by| changed(flaw, by));
            let equations: [fn(&AtMoment) -> &Equation; 2] = [|at| &at.energy, |at| &at.quadrature];
            for of in equations {
                let apart = |index: usize| {
                    let [less, more] =
                        [&less, &more].map(|all| without_splits(of(&all[index]), OF_SPLITS));
                    // What is seen falls by as much as a flaw is allowed for.
                    of(&now[index]).entries[flaw].1 - (less - more) / (2.0 * STEP)
                };
                // Unknowns of the run take up what all moments have in common.
                let common = apart(0);
                for index in 1..now.len() {
                    let apart = apart(index) - common;
                    assert!(apart.abs() < 1e-6, "{gain_ratio}, {flaw}, {index}: {apart}");
                }
            }
        }
    }
}

#[test]
fn noise_in_the_integrals_adds_the_variance_that_differences_show() {
    let run = run();
    let unknowns = FLAWS + SPLITS + Decay::Straight.own();
    // What changes of the right-hand side do to a solution: any numbers.
    let of_flaws = [0.0, 1.0, 2.0]
        .map(|flaw| DVector::from_fn(unknowns, |at, _| (flaw + 1.7 * at as f64).sin()));
    let about = of(&run, &PickOffs::IDEAL, OF_SPLITS);
    let added = by_integrals(
        of(&run, &PickOffs::IDEAL, OF_SPLITS).into_iter(),
        OF_SPLITS,
        &of_flaws,
    );
    for (of_flaw, added) in of_flaws.iter().zip(added) {
        let solution = |run: &Run, splits: [f64; SPLITS]| {
            let moments = of(run, &PickOffs::IDEAL, splits);
            let each = moments.iter().zip(&about).map(|(moment, about)| {
                let pairs = [
                    (&moment.energy, &about.energy),
                    (&moment.quadrature, &about.quadrature),
                ];
                let each = pairs.map(|(equation, about)| {
                    let by = about.entries.iter().map(|&(at, by)| by * of_flaw[at]);
                    about.weight * by.sum::<f64>() * without_splits(equation, splits)
                });
                each[0] + each[1]
            });
            each.sum::<f64>()
        };
        let variance = |splits: [f64; SPLITS]| {
            let mut variance = 0.0;
            for index in 0..run.moments.len() {
                for (part, by) in [
                    (0, Complex::ONE),
                    (0, Complex::I),
                    (1, Complex::ONE),
                    (1, Complex::I),
                ] {
                    let [less, more] = [-STEP, STEP].map(|step| {
                        let mut run = run.clone();
                        run.moments[index].raw[part] += by * step;
                        solution(&run, splits)
                    });
                    variance += (NOISE * (more - less) / (2.0 * STEP)).powi(2);
                }
            }
            variance
        };
        let seen = variance(OF_SPLITS) - variance([0.0; SPLITS]);
        assert!((added / seen - 1.0).abs() < 0.05, "{added} {seen}");
    }
}
