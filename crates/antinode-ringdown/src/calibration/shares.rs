//! Energy and quadrature of phasors, and their noise.

use num_complex::Complex;

/// E, and R/E, S/E and Q/E, of the phasors of ideal pick-offs; Q is −2 a_A a_B here.
pub fn shares([c, d]: [Complex<f64>; 2]) -> [f64; 4] {
    let [of_c, of_d] = [c.norm_sqr(), d.norm_sqr()];
    let energy = of_c + of_d;
    let product = c.conj() * d;
    [
        energy,
        (of_c - of_d) / energy,
        2.0 * product.re / energy,
        2.0 * product.im / energy,
    ]
}

/// The variances of ln E and Q/E of the phasors of ideal pick-offs, for noise of variance 1 on the raw phasors of pick-offs with these
/// [gains](PickOffs::noise_gains).
pub fn variances([c, d]: [Complex<f64>; 2], [d_on_d, c_on_d]: [f64; 2]) -> [f64; 2] {
    let [energy, _, _, q] = shares([c, d]);
    // Coefficients of the noise of each raw phasor, of which only the real parts of the products count.
    let [c, d] = [c.conj(), d.conj()];
    let by_energy = [c + d * c_on_d, d * d_on_d];
    let by_quadrature = [(d - c * c_on_d) * Complex::i(), -c * d_on_d * Complex::i()];
    let mut variances = [0.0; 2];
    for (energy, quadrature) in by_energy.into_iter().zip(by_quadrature) {
        variances[0] += energy.norm_sqr();
        variances[1] += (quadrature - energy * q).norm_sqr();
    }
    variances.map(|sum| 4.0 * sum / (energy * energy))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::pick_offs::PickOffs;

    #[test]
    fn variances_are_those_that_noise_on_raw_phasors_causes() {
        let (step, omega) = (1e-6, 2.0);
        for (gain_ratio, skew, angle) in [(1.0, 0.0, 0.0), (3.0, 0.1, 0.15), (0.4, -0.2, -0.2)] {
            let pick_offs = PickOffs {
                gain_ratio,
                skew,
                angle,
            };
            let ideal = [Complex::new(0.6, -0.1), Complex::new(-0.4, 0.3)];
            let raw = pick_offs.at(omega).distort(ideal);
            let mut squares = [0.0; 2];
            for (part, by) in [0, 1]
                .into_iter()
                .flat_map(|part| [(part, Complex::ONE), (part, Complex::I)])
            {
                let [less, more] = [-step, step].map(|step| {
                    let mut raw = raw;
                    raw[part] += by * step;
                    let [energy, _, _, q] = shares(pick_offs.at(omega).correct(raw));
                    [energy.ln(), q]
                });
                for (square, (less, more)) in squares.iter_mut().zip(less.into_iter().zip(more)) {
                    *square += ((more - less) / (2.0 * step)).powi(2);
                }
            }
            for (variance, square) in variances(ideal, pick_offs.noise_gains())
                .into_iter()
                .zip(squares)
            {
                assert!(
                    (variance / square - 1.0).abs() < 1e-6,
                    "{gain_ratio}: {variance} {square}"
                );
            }
        }
    }
}
