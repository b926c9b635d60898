//! The paper's formulas, written straight from the text with the errata of `antinode::methods`, in f64 over plain samples, to compare the
//! core's with.

use std::f64::consts::PI;

/// a_A, a_B, θ, α.
pub type Found = [f64; 4];

/// The mean (7) of a function of the sample index.
pub fn mean(n: usize, f: impl Fn(usize) -> f64) -> f64 {
    (0..n).map(f).sum::<f64>() / n as f64
}

/// A window of samples, `lead` of them before its time zero.
pub struct Window<'a> {
    /// All samples.
    pub pairs: &'a [[f64; 2]],
    /// Samples before time zero.
    pub lead: usize,
    /// Rad a sample.
    pub omega: f64,
}

impl Window<'_> {
    fn n(&self) -> usize {
        self.pairs.len() - self.lead
    }

    fn c(&self, k: usize) -> f64 {
        self.pairs[self.lead + k][0]
    }

    fn d(&self, k: usize) -> f64 {
        self.pairs[self.lead + k][1]
    }

    /// S_A and S_B of (5).
    fn axes(&self, k: usize, theta: f64) -> (f64, f64) {
        let (s, c) = (2.0 * theta).sin_cos();
        (
            self.c(k) * c + self.d(k) * s,
            -self.c(k) * s + self.d(k) * c,
        )
    }

    /// (19), and (14) for a_B = 0.
    fn phase(&self, a: f64, b: f64, theta: f64) -> f64 {
        let n = self.n();
        let t = |k: usize| self.omega * k as f64;
        let upper = mean(n, |k| self.axes(k, theta).0 * t(k).sin())
            - b / a * mean(n, |k| self.axes(k, theta).1 * t(k).cos());
        let lower = mean(n, |k| self.axes(k, theta).0 * t(k).cos())
            + b / a * mean(n, |k| self.axes(k, theta).1 * t(k).sin());
        upper.atan2(lower)
    }

    fn angle(&self) -> f64 {
        let n = self.n();
        let s = 2.0 * mean(n, |k| self.c(k) * self.d(k));
        let r = mean(n, |k| self.c(k).powi(2)) - mean(n, |k| self.d(k).powi(2));
        s.atan2(r) / 4.0
    }

    /// (12), (14).
    pub fn algorithm1(&self) -> Found {
        let n = self.n();
        let a = (2.0 * mean(n, |k| self.c(k).powi(2) + self.d(k).powi(2))).sqrt();
        let tangent = (mean(n, |k| self.d(k).powi(2)) / mean(n, |k| self.c(k).powi(2))).sqrt()
            * mean(n, |k| self.c(k) * self.d(k)).signum();
        let theta = tangent.atan() / 2.0;
        [a, 0.0, theta, self.phase(a, 0.0, theta)]
    }

    /// q of (16) at a delay of `lag` samples.
    pub fn q(&self, lag: usize) -> f64 {
        mean(self.n(), |k| self.c(k) * self.pairs[self.lead + k - lag][1])
    }

    /// (16), (19).
    pub fn algorithm2(&self, q: f64) -> Found {
        let n = self.n();
        let power = 2.0 * (mean(n, |k| self.c(k).powi(2)) + mean(n, |k| self.d(k).powi(2)));
        let (e, f) = ((power + 4.0 * q).sqrt(), (power - 4.0 * q).sqrt());
        let (a, b, theta) = ((e + f) / 2.0, (f - e) / 2.0, self.angle());
        [a, b, theta, self.phase(a, b, theta)]
    }

    /// (21), (22), (19).
    pub fn algorithm3(&self, sign: f64) -> Found {
        let n = self.n();
        let theta = self.angle();
        let a = (2.0 * mean(n, |k| self.axes(k, theta).0.powi(2))).sqrt();
        let b = (2.0 * mean(n, |k| self.axes(k, theta).1.powi(2))).sqrt() * sign.signum();
        [a, b, theta, self.phase(a, b, theta)]
    }

    /// (24), (25).
    pub fn algorithm4(&self) -> Found {
        let n = self.n();
        let t = |k: usize| self.omega * k as f64;
        let cx = 2.0 * mean(n, |k| self.c(k) * t(k).cos());
        let cy = 2.0 * mean(n, |k| self.d(k) * t(k).cos());
        let sx = 2.0 * mean(n, |k| self.c(k) * t(k).sin());
        let sy = 2.0 * mean(n, |k| self.d(k) * t(k).sin());
        let e = sx * sx + cx * cx + sy * sy + cy * cy;
        let q = 2.0 * (sy * cx - sx * cy);
        let r = sx * sx + cx * cx - sy * sy - cy * cy;
        let s = 2.0 * (sx * sy + cx * cy);
        let l = 2.0 * (sx * cx + sy * cy);
        let m = cx * cx + cy * cy - sx * sx - sy * sy;
        let (sum, difference) = ((e + q).sqrt(), (e - q).sqrt());
        let (a, b) = ((sum + difference) / 2.0, (sum - difference) / 2.0);
        let theta = s.atan2(r) / 4.0;
        let mut alpha = l.atan2(m) / 2.0;
        // α or α + π by the smaller J of (18).
        if self.j([a, b, theta, alpha + PI]) < self.j([a, b, theta, alpha]) {
            alpha += if alpha > 0.0 { -PI } else { PI };
        }
        [a, b, theta, alpha]
    }

    /// J of (6), sample by sample.
    pub fn j(&self, [a, b, theta, alpha]: Found) -> f64 {
        let (s2, c2) = (2.0 * theta).sin_cos();
        mean(self.n(), |k| {
            let tau = self.omega * k as f64 - alpha;
            let (main, quadrature) = (a * tau.cos(), b * tau.sin());
            (self.c(k) - main * c2 + quadrature * s2).powi(2)
                + (self.d(k) - main * s2 - quadrature * c2).powi(2)
        })
    }
}
