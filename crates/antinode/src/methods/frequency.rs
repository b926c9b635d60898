//! J → min(ω): the frequency at which a wave explains its window best.
//!
//! Within about fs/n Hz of the truth, with n samples a window, J has a single valley. Both searches descend from a start within it, which
//! (9) or (10) gives. `j` maps ω in rad a sample to J.

/// The paper's search: the lowest J on a grid of `step` rad a sample about `start`, within `reach` steps of it.
///
/// It walks downhill with strides of 64, 16, 4 and 1 steps: in a valley that is the same grid point as trying each of them finds,
/// for some 20 values of J rather than thousands. 1 Hz is a step of 2π/fs.
pub fn on_grid(start: f64, step: f64, reach: u32, mut j: impl FnMut(f64) -> f64) -> f64 {
    let reach = i64::from(reach);
    let mut place = 0i64;
    let mut lowest = j(start);
    for stride in [64i64, 16, 4, 1] {
        for direction in [stride, -stride] {
            while (place + direction).abs() <= reach {
                let value = j(start + (place + direction) as f64 * step);
                // False for NaN.
                if value < lowest {
                    lowest = value;
                    place += direction;
                } else {
                    break;
                }
            }
        }
    }
    start + place as f64 * step
}

/// The minimum itself, to about 10⁻⁸/`count` rad a sample for a smooth J over `count` samples; `start` within 0.5/`count` of it or
/// so, as [`on_grid`] leaves it. [`functional::absolutes`](super::functional::absolutes) is not smooth: leave it at the grid.
///
/// Fits parabolas through three points, each about the vertex of the last one, with ever smaller arms. A start without a valley is
/// returned as it is.
pub fn exact(start: f64, count: u32, mut j: impl FnMut(f64) -> f64) -> f64 {
    let mut omega = start;
    for arm in [0.3, 0.1, 1e-2, 1e-3, 1e-4] {
        let arm = arm / f64::from(count.max(1));
        let (before, here, after) = (j(omega - arm), j(omega), j(omega + arm));
        let bend = before + after - 2.0 * here;
        if bend > 0.0 {
            let move_by = 0.5 * arm * (before - after) / bend;
            omega += move_by.clamp(-10.0 * arm, 10.0 * arm);
        }
    }
    omega
}
