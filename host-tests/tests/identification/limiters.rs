//! Hard limiters, which have a fifth harmonic too.

use antinode::Flags;
use antinode_sim::{Flaws, Wave};
use host_tests::{RATE, identify, windows};

#[test]
fn a_hard_limiter_is_flagged_where_its_fifth_harmonic_folds_onto_the_third() {
    // A crest a twentieth above the limit has hardly two samples there: only the harmonics show it.
    for period in [7.9, 8.05, 8.1] {
        for limit in [0.95, 1.05] {
            let wave = Wave {
                main_amplitude: 1.0,
                quadrature_amplitude: 0.05,
                angle: 0.03,
                frequency: RATE / period,
                ..Wave::default()
            };
            let flaws = Flaws {
                noise: 1e-4,
                clip: Some(limit),
                ..Flaws::default()
            };
            let samples = (100.0 * period * 20.0) as usize;
            let found = identify(wave, &flaws, windows(20), samples, 1);
            let clipped = found.iter().filter(|e| e.flags.contains(Flags::CLIPPED));
            let (count, rows) = (clipped.count(), found.len());
            println!("{period} samples a period, limit {limit}: {count} of {rows} clipped");
            assert!(rows > 90);
            if limit < 1.0 {
                assert!(10 * count > 9 * rows, "{period}: {count} of {rows}");
            } else {
                assert!(found.iter().all(|e| e.flags.is_empty()), "{period}");
            }
        }
    }
}
