//! The course of the pattern angle over the last windows: what rate it promises for the present one.
//!
//! With a quadrature wave a turning pattern shifts the apparent frequency, so a window that must find θ̇ and f together knows f up
//! to (a_A² + a_B²)/(a_A² − a_B²) times worse than the bound. The angles of the windows before know θ̇ far better than one window.

use heapless::Deque;

use crate::arch::square_root;
use crate::wave::Angle;
use crate::window::Normal;

/// Windows kept.
const KEPT: usize = 5;

/// A rate in rad/sample and its variance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rate {
    pub value: f32,
    pub variance: f32,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    /// Middle of the window, half samples.
    middle: u64,
    angle: Angle,
    variance: f32,
}

/// Angles of the last clean windows that do not overlap.
#[derive(Debug, Clone)]
pub(crate) struct Trend {
    points: Deque<Point, KEPT>,
}

impl Trend {
    pub(crate) const fn new() -> Self {
        Self {
            points: Deque::new(),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.points.clear();
    }

    /// Keeps a clean window of `samples`, unless it overlaps the last one kept.
    pub(crate) fn keep(&mut self, middle: u64, samples: u32, angle: Angle, variance: f32) {
        let overlaps = |last: &Point| middle < last.middle + 2 * u64::from(samples);
        if self.points.back().is_some_and(overlaps) {
            return;
        }
        if self.points.is_full() {
            self.points.pop_front();
        }
        // Never full here.
        let _ = self.points.push_back(Point {
            middle,
            angle,
            variance,
        });
    }

    /// The rate at the middle of a window, from its own angle and the angles before: constant through three points, linear in time
    /// through more. With none before, the pattern is taken to stand still until a window shows that it does not.
    pub(crate) fn rate(&self, middle: u64, samples: u32, angle: Angle, variance: f32) -> Rate {
        let mut normal = Normal::ZERO;
        let mut rhs = [0.0; 5];
        let mut used = 0;
        let window = samples as f32;
        let earlier = self
            .points
            .iter()
            .filter(|point| point.middle + 2 * u64::from(samples) <= middle)
            .map(|p| {
                (
                    -0.5 * (middle - p.middle) as f32 / window,
                    p.angle.less(angle),
                    p.variance,
                )
            });
        for (time, angle, variance) in earlier.chain(core::iter::once((0.0, 0.0, variance))) {
            let weight = 1.0 / square_root(variance.max(1e-18));
            let curve = if self.points.len() >= 3 {
                weight * time * time
            } else {
                0.0
            };
            let row = [weight, weight * time, curve, 0.0, 0.0];
            normal.add(&row);
            for (sum, value) in rhs.iter_mut().zip(row) {
                *sum += value * weight * angle;
            }
            used += 1;
        }
        if used < 2 {
            return Rate {
                value: 0.0,
                variance: 0.0,
            };
        }
        normal.factorise();
        let value = normal.solve(rhs)[1] / window;
        let variance = normal.solve([0.0, 1.0, 0.0, 0.0, 0.0])[1] / (window * window);
        Rate { value, variance }
    }
}
