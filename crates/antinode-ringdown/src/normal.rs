//! Normal equations of runs that share some unknowns, while each run has others of its own.
//!
//! Only the shared unknowns couple the runs, so that these are solved one by one, at a cost in proportion to their number: it reaches
//! hundreds where a ring-down reaches the noise.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// The equations. Unknowns are the shared ones, followed by each run's own.
pub struct Equations {
    shared: usize,
    own: usize,
    /// The matrix of each run, for the shared unknowns and its own.
    matrices: Vec<DMatrix<f64>>,
    right: DVector<f64>,
}

impl Equations {
    /// Equations without rows, with `shared` unknowns in common and `own` unknowns of each run.
    pub fn new(shared: usize, own: usize, runs: usize) -> Self {
        let size = shared + own;
        Self {
            shared,
            own,
            matrices: vec![DMatrix::zeros(size, size); runs],
            right: DVector::zeros(shared + own * runs),
        }
    }

    /// The number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.right.len()
    }

    /// The right-hand side.
    pub fn right(&self) -> &DVector<f64> {
        &self.right
    }

    /// Adds an equation of a run with a weight: its entries, as places and factors of unknowns, and the value seen.
    pub fn add_equation(&mut self, run: usize, entries: &[(usize, f64)], seen: f64, weight: f64) {
        let within = self.within(run);
        for &(j, right) in entries {
            let weighed = weight * right;
            self.right[j] += weighed * seen;
            let mut column = self.matrices[run].column_mut(within(j));
            for &(i, left) in entries {
                column[within(i)] += weighed * left;
            }
        }
    }

    /// Adds to the right-hand side of an unknown.
    pub fn add_right(&mut self, place: usize, more: f64) {
        self.right[place] += more;
    }

    /// Adds to the matrix entry of two unknowns, shared or of this run.
    pub fn add(&mut self, run: usize, [i, j]: [usize; 2], more: f64) {
        let [i, j] = [i, j].map(self.within(run));
        self.matrices[run][(i, j)] += more;
    }

    /// The place of an unknown in the matrix of this run.
    fn within(&self, run: usize) -> impl Fn(usize) -> usize + use<> {
        let (shared, before) = (self.shared, self.own * run);
        move |place| {
            if place < shared {
                place
            } else {
                place - before
            }
        }
    }

    /// Factors of the matrix with its diagonal increased by the share `more`; `None` if an unknown is not determined at all.
    ///
    /// As unknowns differ widely in size, they are scaled to a unit diagonal.
    pub fn factors(&self, more: f64) -> Option<Factors> {
        let (shared, own) = (self.shared, self.own);
        let scale_of = |matrix: &DMatrix<f64>| matrix.diagonal().map(|entry| entry.sqrt().recip());
        let scaled = |matrix: &DMatrix<f64>, scale: &DVector<f64>| {
            matrix.map_with_location(|i, j, entry| {
                let by = if i == j { 1.0 + more } else { 1.0 };
                entry * by * scale[i] * scale[j]
            })
        };
        let mut whole = DMatrix::zeros(shared, shared);
        for matrix in &self.matrices {
            whole += matrix.view((0, 0), (shared, shared));
        }
        let of_shared = scale_of(&whole);
        whole = scaled(&whole, &of_shared);
        let mut scale = DVector::zeros(self.unknowns());
        scale.rows_mut(0, shared).copy_from(&of_shared);
        let mut runs = Vec::with_capacity(self.matrices.len());
        for (run, matrix) in self.matrices.iter().enumerate() {
            let mut of_run = scale_of(matrix);
            of_run.rows_mut(0, shared).copy_from(&of_shared);
            let mut of_own = scale.rows_mut(shared + own * run, own);
            of_own.copy_from(&of_run.rows(shared, own));
            let matrix = scaled(matrix, &of_run);
            let factors = matrix.view((shared, shared), (own, own));
            let factors = factors.into_owned().cholesky()?;
            let coupling = matrix.view((shared, 0), (own, shared));
            let coupling = factors.l_dirty().solve_lower_triangular(&coupling)?;
            whole -= coupling.tr_mul(&coupling);
            runs.push(RunFactors { factors, coupling });
        }
        Some(Factors {
            shared: whole.cholesky()?,
            runs,
            scale,
        })
    }
}

/// Factors of the equations' matrix, from which each run's own unknowns are eliminated first.
#[derive(Debug)]
pub struct Factors {
    shared: Cholesky<f64, Dyn>,
    runs: Vec<RunFactors>,
    scale: DVector<f64>,
}

/// The factors of one run.
#[derive(Debug)]
struct RunFactors {
    factors: Cholesky<f64, Dyn>,
    /// Coupling of its unknowns to the shared ones, divided by the factor.
    coupling: DMatrix<f64>,
}

impl RunFactors {
    /// The right-hand side of the run's own unknowns divided by the factor.
    fn divide(&self, own: &DVector<f64>) -> DVector<f64> {
        let mut divided = own.clone();
        // No entry of the factor's diagonal is 0.
        self.factors
            .l_dirty()
            .solve_lower_triangular_mut(&mut divided);
        divided
    }
}

impl Factors {
    /// The unknowns that solve the equations with this right-hand side.
    pub fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        let mut found = right.component_mul(&self.scale);
        let shared = self.shared.l_dirty().nrows();
        let mut of_shared = found.rows(0, shared).into_owned();
        let mut from = shared;
        for run in &self.runs {
            let own = run.coupling.nrows();
            let divided = run.divide(&found.rows(from, own).into_owned());
            of_shared -= run.coupling.tr_mul(&divided);
            found.rows_mut(from, own).copy_from(&divided);
            from += own;
        }
        self.shared.solve_mut(&mut of_shared);
        found.rows_mut(0, shared).copy_from(&of_shared);
        from = shared;
        for run in &self.runs {
            let own = run.coupling.nrows();
            let mut left = found.rows(from, own) - &run.coupling * &of_shared;
            run.factors
                .l_dirty()
                .tr_solve_lower_triangular_mut(&mut left);
            found.rows_mut(from, own).copy_from(&left);
            from += own;
        }
        found.component_mul(&self.scale)
    }

    /// The variance of a linear combination of shared unknowns and one run's own, given as places and factors, if the matrix is the
    /// covariance of the right-hand side.
    pub fn variance(&self, terms: &[(usize, f64)]) -> f64 {
        let shared = self.shared.l_dirty().nrows();
        let mut of_shared = DVector::zeros(shared);
        let own = self.runs[0].coupling.nrows();
        let mut of_run: Option<(usize, DVector<f64>)> = None;
        for &(place, by) in terms {
            let by = by * self.scale[place];
            if place < shared {
                of_shared[place] += by;
            } else {
                let run = (place - shared) / own;
                let (_, of_own) = of_run.get_or_insert_with(|| (run, DVector::zeros(own)));
                of_own[place - shared - own * run] += by;
            }
        }
        let mut variance = 0.0;
        if let Some((run, of_own)) = of_run {
            let divided = self.runs[run].divide(&of_own);
            of_shared -= self.runs[run].coupling.tr_mul(&divided);
            variance += divided.norm_squared();
        }
        variance + of_shared.dot(&self.shared.solve(&of_shared))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use antinode_sim::Deviates;

    #[test]
    fn solving_run_by_run_equals_solving_all_together() {
        for (shared, own, runs) in [(0, 3, 4), (5, 4, 1), (6, 4, 30), (2, 1, 7)] {
            let mut random = Deviates::new(shared as u64);
            let unknowns = shared + own * runs;
            let mut equations = Equations::new(shared, own, runs);
            let mut whole = DMatrix::zeros(unknowns, unknowns);
            for run in 0..runs {
                let from = shared + own * run;
                for _ in 0..2 * (shared + own) {
                    let places: Vec<_> = (0..shared).chain(from..from + own).collect();
                    // Unknowns of widely different sizes.
                    let line = places
                        .iter()
                        .map(|&place| 10f64.powi(place as i32 % 9) * random.draw());
                    let line: Vec<_> = line.collect();
                    for (&i, left) in places.iter().zip(&line) {
                        for (&j, right) in places.iter().zip(&line) {
                            equations.add(run, [i, j], left * right);
                            whole[(i, j)] += left * right;
                        }
                    }
                }
            }
            let truth =
                DVector::from_fn(unknowns, |i, _| 10f64.powi(-(i as i32 % 9)) * random.draw());
            for more in [0.0, 0.5] {
                let mut damped = whole.clone();
                for i in 0..unknowns {
                    damped[(i, i)] *= 1.0 + more;
                }
                let factors = equations.factors(more).unwrap();
                let found = factors.solve(&(&damped * &truth));
                for (found, truth) in found.iter().zip(&truth) {
                    assert!((found / truth - 1.0).abs() < 1e-6, "{found} {truth}");
                }
                let inverse = damped.try_inverse().unwrap();
                for run in 0..runs {
                    let mut terms = vec![
                        (shared + own * run, 2.0),
                        (shared + own * (run + 1) - 1, -0.7),
                    ];
                    terms.extend((0..shared).map(|place| (place, 0.3)));
                    let mut expected = 0.0;
                    for (i, left) in &terms {
                        for (j, right) in &terms {
                            expected += left * right * inverse[(*i, *j)];
                        }
                    }
                    let variance = factors.variance(&terms);
                    assert!(
                        (variance / expected - 1.0).abs() < 1e-6,
                        "{variance} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn an_undetermined_unknown_gives_no_factors() {
        for (shared, own) in [(2, 2), (0, 2)] {
            let mut equations = Equations::new(shared, own, 2);
            for place in 0..shared + 3 {
                let run = usize::from(place >= shared + own);
                equations.add(run, [place, place], 1.0);
            }
            assert!(equations.factors(0.0).is_none());
        }
    }
}
