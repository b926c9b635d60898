//! The equations of a run's moments: what pick-offs and splits do to the energy and the quadrature.

use nalgebra::DVector;

use super::moments::Run;
use super::pick_offs::PickOffs;
use super::shares::{shares, variances};
use super::solve::{Decay, FLAWS, SPLITS};
use super::within_period::{WithinPeriod, mean_decay};
use crate::runs::per_radian;

/// An equation of least squares: places and factors of unknowns, the value seen, and one over its variance.
pub struct Equation {
    pub entries: Vec<(usize, f64)>,
    pub seen: f64,
    pub weight: f64,
}

/// The equations of ln E and of Q/E at a moment.
pub struct AtMoment {
    /// Time, in units of that in which the splits are unknowns.
    pub time: f64,
    /// R/E, S/E and Q/E, and the variance of each across the vector of all three.
    pub state: [f64; 3],
    pub variance: f64,
    pub energy: Equation,
    pub quadrature: Equation,
}

/// The equations of the run with this index, if `shared` unknowns are those of all runs; the splits, about these, are per `unit` of
/// time, s.
pub fn equations<'a>(
    (index, run): (usize, &'a Run),
    pick_offs: &'a PickOffs,
    decay: Decay,
    shared: usize,
    [dc, ds, ws, wc]: [f64; SPLITS],
    unit: f64,
) -> impl Iterator<Item = AtMoment> + 'a {
    let ideal = run.ideal(pick_offs);
    let (first, last) = (run.moments[0].time, run.moments[ideal.len() - 1].time);
    let middle = 0.5 * (first + last);
    let own = shared + decay.own() * index;
    let tangent = (2.0 * pick_offs.angle).tan();
    let noise_gains = pick_offs.noise_gains();
    let mut sums = Sums::default();
    let mut within_period =
        WithinPeriod::new(mean_decay(&ideal, last - first), [dc, ds, ws, wc], unit);
    let each = run.moments.iter().zip(ideal);
    each.map(move |(moment, ideal)| {
        let [energy, r, s, q] = shares(ideal);
        // R/E, S/E and Q/E, and their derivatives if D grows by a share of its own, by one of C, and by ln g, by the phase of D, and by ε.
        let of_own = [r * r - 1.0, r * s, q * r];
        let of_other = [-s * (1.0 + r), 1.0 + r - s * s, -s * q];
        let of_gain = [0, 1, 2].map(|i| of_own[i] - tangent * of_other[i]);
        let of_phase = [
            tangent * q * (1.0 + r),
            tangent * q * s - q,
            tangent * (q * q - r - 1.0) + s,
        ];
        let of_angle = [0, 1, 2].map(|i| -2.0 * (of_other[i] + tangent * of_own[i]));
        let products = |[dr, ds, dq]: [f64; 3]| [dr, ds, q * dr + r * dq, q * ds + s * dq];
        let now = [r, s, q * r, q * s];
        sums.advance(
            moment.time,
            [
                now,
                products(of_gain),
                products(of_phase),
                products(of_angle),
            ],
        );
        let [[to_r, to_s, to_qr, to_qs], of_flaws @ ..] =
            sums.value.map(|sums| sums.map(|sum| sum / unit));
        // At equal energy the mode of the higher frequency moves less, by the share Δω/2ω.
        let [more_r, more_s] = [r, s].map(|part| 0.5 * part * per_radian(moment.omega) / unit);
        let more = 2.0 * (s - tangent * r);
        let (by_gain, by_phase) = (-r - tangent * s, -tangent * q);
        let mut of_energy = [by_gain, by_phase, -more, to_r, to_s, -more_s, more_r];
        let mut of_quadrature = [
            of_gain[2],
            of_phase[2],
            of_angle[2],
            -to_qr,
            -to_qs,
            to_r + q * more_s,
            to_s - q * more_r,
        ];
        // Flaws also change the integrals.
        for (flaw, [to_r, to_s, to_qr, to_qs]) in of_flaws.into_iter().enumerate() {
            of_energy[flaw] -= dc * to_r + ds * to_s;
            of_quadrature[flaw] -= ws * to_r + wc * to_s - dc * to_qr - ds * to_qs;
        }
        let [of_energy_within, of_quadrature_within] =
            within_period.advance(moment, moment.angle(pick_offs), [r, s, q]);
        let variances = variances(ideal, noise_gains).map(|part| part * moment.variance);
        let time = 2.0 * (moment.time - middle) / unit;
        let equation = |row: [f64; FLAWS + SPLITS], seen: f64, first: usize, variance: f64| {
            let columns = (0..shared).chain([first, first + 1]);
            let entries = row.into_iter().take(shared).chain([1.0, time]);
            Equation {
                entries: columns.zip(entries).collect(),
                seen,
                weight: 1.0 / variance,
            }
        };
        let mut of_energy = equation(of_energy, energy.ln() - of_energy_within, own, variances[0]);
        let bend = decay.bend_at(own).map(|place| (place, time * time));
        of_energy.entries.extend(bend);
        AtMoment {
            time: moment.time / unit,
            state: [r, s, q],
            variance: variances[0],
            energy: of_energy,
            quadrature: equation(
                of_quadrature,
                q - of_quadrature_within,
                own + 2,
                variances[1],
            ),
        }
    })
}

/// What is kept of a moment to sum up noise in the integrals, which runs backwards in time: a fraction of the size of its equations.
struct Weighed {
    time: f64,
    state: [f64; 3],
    variance: f64,
    /// Changes of each flaw with the values seen of ln E and of Q/E.
    by_energy: [f64; FLAWS],
    by_quadrature: [f64; FLAWS],
}

impl Weighed {
    fn new(moment: &AtMoment, of_flaws: &[DVector<f64>; FLAWS]) -> Self {
        let along = |equation: &Equation| {
            of_flaws.each_ref().map(|of_flaw| {
                let each = equation.entries.iter();
                equation.weight * each.map(|&(at, by)| by * of_flaw[at]).sum::<f64>()
            })
        };
        Self {
            time: moment.time,
            state: moment.state,
            variance: moment.variance,
            by_energy: along(&moment.energy),
            by_quadrature: along(&moment.quadrature),
        }
    }
}

/// Variances that noise in the integrals adds to those of the flaws, whose part of a solution is changed by `of_flaws` for each change of
/// the right-hand side, if the splits are these.
///
/// The integrals are those of what is seen, so that noise of one moment acts on all later ones.
pub fn by_integrals(
    run: impl Iterator<Item = AtMoment>,
    [dc, ds, ws, wc]: [f64; SPLITS],
    of_flaws: &[DVector<f64>; FLAWS],
) -> [f64; FLAWS] {
    let run: Vec<_> = run.map(|moment| Weighed::new(&moment, of_flaws)).collect();
    [0, 1, 2].map(|flaw| {
        let (mut later_energy, mut later_quadrature, mut sum) = (0.0, 0.0, 0.0);
        for (index, row) in run.iter().enumerate().rev() {
            let [r, s, q] = row.state;
            let before = &run[index.saturating_sub(1)];
            let after = &run[(index + 1).min(run.len() - 1)];
            let time = 0.5 * (after.time - before.time);
            let (of_energy, of_quadrature) = (later_energy * time, later_quadrature * time);
            let by = [
                -dc * of_energy - (ws - dc * q) * of_quadrature,
                -ds * of_energy - (wc - ds * q) * of_quadrature,
                (dc * r + ds * s) * of_quadrature,
            ];
            let now = row.by_quadrature[flaw];
            // R/E, S/E and Q/E are a vector of length 1: noise acts across it.
            let radial = by[0] * r + by[1] * s + by[2] * q;
            let across = by.iter().map(|by| by * by).sum::<f64>() - radial * radial;
            sum += row.variance * (across + 2.0 * now * (by[2] - q * radial));
            later_energy += row.by_energy[flaw];
            later_quadrature += now;
        }
        sum
    })
}

/// Integrals over time, by the trapezoidal rule.
#[derive(Default)]
struct Sums {
    value: [[f64; SPLITS]; 1 + FLAWS],
    last: Option<(f64, [[f64; SPLITS]; 1 + FLAWS])>,
}

impl Sums {
    fn advance(&mut self, time: f64, now: [[f64; SPLITS]; 1 + FLAWS]) {
        if let Some((before, last)) = self.last {
            let values = self.value.as_flattened_mut().iter_mut();
            for ((value, last), now) in values.zip(last.as_flattened()).zip(now.as_flattened()) {
                *value += 0.5 * (time - before) * (last + now);
            }
        }
        self.last = Some((time, now));
    }
}

#[cfg(test)]
mod tests;
