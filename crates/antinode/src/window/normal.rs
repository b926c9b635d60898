//! The normal equations that both pick-offs share, and their inverse.
//!
//! A window is symmetric about its middle, where the carrier's phase is zero. So the parameters that are even in time (Re z, Im z′ and the
//! offset) do not mix with the odd ones (Im z and Re z′): five equations split into three and two.

/// Parameters of one pick-off: Re z, Im z, Re z′, Im z′, offset.
pub(crate) const PARAMETERS: usize = 5;

/// Parameters of one side, the even or the odd.
const SIDE: usize = 3;

/// One design row of one side, or one right-hand side; the third entry of the odd side is zero.
pub(crate) type Row = [f32; SIDE];

/// Covariance of a pick-off's parameters for a noise variance of one a sample.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Covariance {
    /// Of Re z, Im z′ and the offset.
    pub even: [Row; SIDE],
    /// Of Im z and Re z′.
    pub odd: [Row; SIDE],
}

/// A symmetric positive matrix, gathered row by row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Normal {
    /// The upper triangle: (0,0), (0,1), (1,1), (0,2), (1,2), (2,2).
    entries: [f32; 6],
}

impl Normal {
    pub(crate) const ZERO: Self = Self { entries: [0.0; 6] };

    /// Adds the square of one design row.
    #[inline(never)]
    pub(crate) fn add(&mut self, [a, b, c]: &Row) {
        let e = &mut self.entries;
        e[0] += a * a;
        e[1] += a * b;
        e[2] += b * b;
        e[3] += a * c;
        e[4] += b * c;
        e[5] += c * c;
    }

    /// The inverse, by L D Lᵀ; a direction that the data do not see (pivot below 10⁻⁵ of its diagonal) is held at zero.
    #[inline(never)]
    pub(crate) fn inverse(&self) -> [Row; SIDE] {
        let [d0, a01, a11, a02, a12, a22] = self.entries;
        let per = |pivot: f32, whole: f32| {
            if pivot > 1e-5 * whole {
                1.0 / pivot
            } else {
                0.0
            }
        };
        let p0 = per(d0, d0);
        let (l1, l2) = (a01 * p0, a02 * p0);
        let p1 = per(a11 - l1 * a01, a11);
        let b12 = a12 - l1 * a02;
        let l21 = b12 * p1;
        let p2 = per(a22 - l2 * a02 - l21 * b12, a22);
        // L⁻¹ has −l1, l1·l21 − l2 and −l21 below its diagonal.
        let m = l1 * l21 - l2;
        let (mp, lp) = (m * p2, l21 * p2);
        let i01 = -l1 * p1 - m * lp;
        let i11 = p1 + l21 * lp;
        [
            [p0 + l1 * l1 * p1 + m * mp, i01, mp],
            [i01, i11, -lp],
            [mp, -lp, p2],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_what_it_gathered() {
        let mut normal = Normal::ZERO;
        let mut rhs = Row::default();
        let truth = [1.0, -2.0, 0.5];
        let mut seed = 1u32;
        for _ in 0..12 {
            let row: Row = core::array::from_fn(|_| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (seed >> 8) as f32 / 8_388_608.0 - 1.0
            });
            let y: f32 = row.iter().zip(&truth).map(|(a, b)| a * b).sum();
            normal.add(&row);
            rhs.iter_mut().zip(&row).for_each(|(r, a)| *r += a * y);
        }
        for (row, wanted) in normal.inverse().iter().zip(&truth) {
            let found: f32 = row.iter().zip(&rhs).map(|(a, b)| a * b).sum();
            assert!((found - wanted).abs() < 2e-5, "{found} {wanted}");
        }
    }

    #[test]
    fn an_unseen_parameter_stays_at_zero() {
        let mut normal = Normal::ZERO;
        normal.add(&[1.0, 0.0, 1.0]);
        normal.add(&[0.0, 2.0, 0.0]);
        let inverse = normal.inverse();
        assert_eq!(inverse, [[1.0, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0; 3]]);
    }
}
