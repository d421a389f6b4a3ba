//! Uniform cubic B-splines between texels (de Boor 1978).

/// The four weights of a uniform cubic B-spline and their derivatives, at `t` from the second knot to the third.
#[inline(always)]
pub(super) fn spline(t: f64) -> ([f64; 4], [f64; 4]) {
    let (u, t2) = (1.0 - t, t * t);
    let weights = [
        u * u * u * (1.0 / 6.0),
        (3.0 * t2 * t - 6.0 * t2 + 4.0) * (1.0 / 6.0),
        (3.0 * (t + t2 - t2 * t) + 1.0) * (1.0 / 6.0),
        t2 * t * (1.0 / 6.0),
    ];
    (weights, [-0.5 * u * u, 1.5 * t2 - 2.0 * t, 0.5 + t - 1.5 * t2, 0.5 * t2])
}

/// As `f64::floor` for small numbers, without a call on machines that lack the instruction.
#[inline(always)]
pub(super) fn floor(x: f64) -> f64 {
    let whole = x as isize as f64;
    if whole > x { whole - 1.0 } else { whole }
}

/// The spline at `(x, y)` in texels (the centre of texel `i` is at `i + 0.5`), and its derivatives by x and y.
/// `row(y, x)` gives four texels of row `y` from column `x` on.
#[inline(always)]
pub(super) fn bicubic(x: f64, y: f64, row: impl Fn(isize, isize) -> [f64; 4]) -> (f64, f64, f64) {
    let (x, y) = (x - 0.5, y - 0.5);
    let (column, line) = (floor(x), floor(y));
    let (wx, dx) = spline(x - column);
    let (wy, dy) = spline(y - line);
    let (mut value, mut by_x, mut by_y) = (0.0, 0.0, 0.0);
    for k in 0..4 {
        let t = row(line as isize - 1 + k as isize, column as isize - 1);
        let along = (t[0] * wx[0] + t[1] * wx[1]) + (t[2] * wx[2] + t[3] * wx[3]);
        let slope = (t[0] * dx[0] + t[1] * dx[1]) + (t[2] * dx[2] + t[3] * dx[3]);
        value += along * wy[k];
        by_x += slope * wy[k];
        by_y += along * dy[k];
    }
    (value, by_x, by_y)
}

/// 0 at `t <= 0`, 1 at `t >= 1`, smooth between; and its derivative.
#[inline(always)]
pub(super) fn smoothstep(t: f64) -> (f64, f64) {
    let t = t.clamp(0.0, 1.0);
    (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t))
}
