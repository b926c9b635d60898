//! The five-parameter normal equations that both pick-offs share, and their inverse by columns.

/// Parameters of one pick-off: Re z, Im z, Re z′, Im z′, offset.
pub(crate) const PARAMETERS: usize = 5;

/// One row of the design, or one right-hand side.
pub(crate) type Row = [f32; PARAMETERS];

/// A symmetric positive matrix, gathered row by row and then factorised as L D Lᵀ in place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Normal {
    /// Lower triangle; after [`Normal::factorise`] the unit L below the diagonal and 1/D on it.
    entries: [[f32; PARAMETERS]; PARAMETERS],
}

impl Normal {
    pub(crate) const ZERO: Self = Self {
        entries: [[0.0; PARAMETERS]; PARAMETERS],
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

    /// Factorises; a direction that the data do not see (pivot below 10⁻⁵ of its diagonal) is held at zero.
    #[expect(
        clippy::needless_range_loop,
        reason = "the indices are those of the textbook"
    )]
    pub(crate) fn factorise(&mut self) {
        let a = &mut self.entries;
        for j in 0..PARAMETERS {
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
            for i in j + 1..PARAMETERS {
                for k in 0..j {
                    a[i][j] -= a[i][k] * a[j][k];
                }
            }
        }
    }

    /// Solves for one right-hand side.
    pub(crate) fn solve(&self, mut rhs: Row) -> Row {
        let l = &self.entries;
        for i in 1..PARAMETERS {
            for k in 0..i {
                rhs[i] -= l[i][k] * rhs[k];
            }
        }
        for i in 0..PARAMETERS {
            rhs[i] *= l[i][i];
        }
        for i in (0..PARAMETERS - 1).rev() {
            for k in i + 1..PARAMETERS {
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
        let mut rhs = [0.0; PARAMETERS];
        let truth = [1.0, -2.0, 0.5, 3.0, -0.25];
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
        normal.factorise();
        for (found, wanted) in normal.solve(rhs).iter().zip(&truth) {
            assert!((found - wanted).abs() < 2e-5, "{found} {wanted}");
        }
    }

    #[test]
    fn an_unseen_parameter_stays_at_zero() {
        let mut normal = Normal::ZERO;
        normal.add(&[1.0, 0.0, 0.0, 0.0, 1.0]);
        normal.add(&[0.0, 2.0, 0.0, 0.0, 0.0]);
        normal.factorise();
        let x = normal.solve([1.0, 4.0, 0.0, 0.0, 1.0]);
        assert_eq!(x, [1.0, 1.0, 0.0, 0.0, 0.0]);
    }
}
