use num_complex::Complex32;

use super::*;
use crate::block::Layout;
use crate::calibration::Calibration;
use crate::phase::PhaseStep;

const BLOCKS: u16 = 5;

/// The fit of a window of a steady wave, in noise of these variances about the carrier and about the third harmonic.
fn fit([own, third]: [f32; 2]) -> Fit {
    let mut fit = Fit {
        settled: true,
        ..Fit::default()
    };
    fit.waves.value = [Complex32::ONE; 2];
    fit.remains = Remains {
        residual: 20.0 * own,
        freedom: 20.0,
        worst_block: 4.0 * own,
        step: 4.0 * own,
        third_noise: third,
        third_freedom: 16.0,
        third_without_worst: third,
        third_without_image: third,
        ..Remains::default()
    };
    fit
}

fn model() -> Model {
    let carrier = PhaseStep::from_period(18.75);
    let layout = Layout::unrounded(carrier, 37);
    Model::new(layout, carrier, BLOCKS, Calibration::IDEAL, 1e5, false)
}

fn flags(fit: &Fit, noise: &mut Noise) -> Flags {
    let model = model();
    let own = fit.remains.variance();
    let levels = Levels {
        own,
        stated: own,
        coding: 0.0,
        colour: MAX_COLOUR,
    };
    let wave = Standing::new(&model, fit, [own, 1.0], own, 0);
    within(&model, fit, &wave, levels, noise, BLOCKS)
}

#[test]
fn a_fit_that_does_not_settle_is_a_misfit() {
    let mut noise = Noise::NONE;
    for _ in 0..3 {
        let mut fit = fit([1e-4; 2]);
        assert_eq!(flags(&fit, &mut noise), Flags::empty());
        fit.settled = false;
        assert_eq!(flags(&fit, &mut noise), Flags::MISFIT);
    }
}

#[test]
fn only_white_noise_becomes_a_new_level() {
    let mut noise = Noise::NONE;
    for _ in 0..20 {
        assert_eq!(flags(&fit([1e-4; 2]), &mut noise), Flags::empty());
    }
    // A tone near the wave raises the residual there, but not about the third harmonic.
    for _ in 0..10 {
        assert_eq!(flags(&fit([1e-2, 1e-4]), &mut noise), Flags::MISFIT);
    }
    assert!(noise.freedom > 0.0);
    // Nor is it a level if one block has nearly all of it, or one step explains it.
    let mut faulty = [(); 2].map(|()| fit([1e-2; 2]));
    faulty[0].remains.worst_block = 0.998 * faulty[0].remains.residual;
    faulty[1].remains.step = 0.998 * faulty[1].remains.residual;
    for fit in faulty {
        for _ in 0..10 {
            assert_eq!(flags(&fit, &mut noise), Flags::MISFIT);
        }
        assert!(noise.freedom > 0.0);
    }
    for i in 0..6 {
        let is_new = i < Noise::NEW_LEVEL;
        let expected = Flags::empty().with_if(is_new, Flags::MISFIT);
        assert_eq!(flags(&fit([1e-2; 2]), &mut noise), expected, "{i}");
    }
}

#[test]
fn a_circle_explains_twice_the_power_of_a_flat_pattern() {
    let model = model();
    for (waves, power) in [
        ([Complex32::ONE; 2], 1.0),
        ([Complex32::ONE, Complex32::ZERO], 0.5),
    ] {
        for (share, is_strange) in [(0.2, false), (0.3, true)] {
            let mut fit = fit([0.0; 2]);
            fit.waves.value = waves;
            fit.remains.residual = share * power * model.half;
            fit.remains.freedom = 1000.0;
            let own = fit.remains.variance();
            let wave = Standing::new(&model, &fit, [own, 1.0], own, 0);
            assert_eq!(
                is_no_wave(&model, &fit, &wave),
                is_strange,
                "{power}, {share}"
            );
        }
    }
}
