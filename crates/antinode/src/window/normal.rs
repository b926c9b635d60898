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

/// A symmetric positive matrix, gathered row by row and then factorised as L D Lᵀ in place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Normal {
    /// Lower triangle; after [`Normal::factorise`] the unit L below the diagonal and 1/D on it.
    entries: [Row; SIDE],
}

impl Normal {
    pub(crate) const ZERO: Self = Self {
        entries: [[0.0; SIDE]; SIDE],
    };

    /// Adds the square of one design row.
    #[inline(never)]
    pub(crate) fn add(&mut self, row: &Row) {
        for (i, (entries, &left)) in self.entries.iter_mut().zip(row).enumerate() {
            for (entry, &right) in entries.iter_mut().zip(row).take(i + 1) {
                *entry += left * right;
            }
        }
    }

    /// The inverse; a direction that the data do not see (pivot below 10⁻⁵ of its diagonal) is held at zero.
    pub(crate) fn inverse(mut self) -> [Row; SIDE] {
        self.factorise();
        let mut inverse = [[0.0; SIDE]; SIDE];
        for (i, row) in inverse.iter_mut().enumerate() {
            row[i] = 1.0;
            *row = self.solve(*row);
        }
        inverse
    }

    #[expect(
        clippy::needless_range_loop,
        reason = "the indices are those of the textbook"
    )]
    fn factorise(&mut self) {
        let a = &mut self.entries;
        for j in 0..SIDE {
            // Row j holds L·D up to here; dividing by D turns it into L and takes its square off the pivot.
            let mut pivot = a[j][j];
            for k in 0..j {
                let scaled = a[j][k];
                a[j][k] = scaled * a[k][k];
                pivot -= scaled * a[j][k];
            }
            a[j][j] = if pivot > 1e-5 * a[j][j] {
                1.0 / pivot
            } else {
                0.0
            };
            for i in j + 1..SIDE {
                for k in 0..j {
                    a[i][j] -= a[i][k] * a[j][k];
                }
            }
        }
    }

    /// Solves for one right-hand side.
    fn solve(&self, mut rhs: Row) -> Row {
        let l = &self.entries;
        for i in 1..SIDE {
            for k in 0..i {
                rhs[i] -= l[i][k] * rhs[k];
            }
        }
        for i in 0..SIDE {
            rhs[i] *= l[i][i];
        }
        for i in (0..SIDE - 1).rev() {
            for k in i + 1..SIDE {
                rhs[i] -= l[k][i] * rhs[k];
            }
        }
        rhs
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
