//! What can leak through a wall of spheres.
//!
//! ```text
//! |c − p_k| = ρ + r_k,  k = 1, 2, 3,   c in the plane of p_1, p_2, p_3
//! ```
//!
//! ρ is the radius of the sphere that touches three neighbouring wall spheres and has its centre c in their plane. A particle up to
//! that size passes between them (Apollonius' circle). The voids are the corners of the Voronoi cells of [`geom::star`].
//!
//! A gap wider than the largest of these circles cannot be distinguished from the wall's outline. Along the outline, three points
//! may lie nearly in a row, and the sphere that touches them is outside. So a gap is a notch of the rim, not a leak, if its centre
//! lies beyond an edge of the outline, or if it opens to that edge as wide as the particle. If the centre lies beyond an inner edge of
//! the three, the void continues there and is wider: the next three points give its width, or it is open to the rim.

use geom::Vec3;
use rayon::prelude::*;
use serde::Serialize;

/// A centre so little beyond a side, as a share, lies on it [–].
const ON_SIDE: f64 = 1e-9;

/// The widest gap of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gap {
    /// Diameter of the largest sphere that passes [m].
    pub diameter: f64,
    /// Where its centre passes [m].
    pub at: [f64; 3],
}

/// The widest gap between three neighbours, and the number of gaps wider than `limit` [m]; `None` for a wall without gaps.
/// `outline` are the edges of the wall's outline, lower index first, ascending.
pub fn widest(
    centres: &[Vec3],
    radii: &[f64],
    triangles: &[[u32; 3]],
    outline: &[(u32, u32)],
    limit: f64,
) -> (Option<Gap>, usize) {
    let inside = |t: &[u32; 3], g: &Gap| !is_notch(centres, radii, t, outline, g, limit);
    let gap = |t: &[u32; 3]| gap(centres, radii, t).filter(|g| inside(t, g));
    let gaps: Vec<Gap> = triangles.par_iter().filter_map(gap).collect();
    let wider = gaps.iter().filter(|g| g.diameter >= limit).count();
    let widest = gaps.into_iter().fold(None, |best: Option<Gap>, g| match best {
        Some(b) if b.diameter >= g.diameter => Some(b),
        _ => Some(g),
    });
    (widest, wider)
}

/// Whether a gap lies beyond an edge of the outline, or a particle of diameter `limit` [m] reaches it from there.
fn is_notch(
    centres: &[Vec3],
    radii: &[f64],
    triangle: &[u32; 3],
    outline: &[(u32, u32)],
    gap: &Gap,
    limit: f64,
) -> bool {
    (0..3).any(|k| {
        let [i, j, other] = [0, 1, 2].map(|n| triangle[(k + n) % 3]);
        if outline.binary_search(&(i.min(j), i.max(j))).is_err() {
            return false;
        }
        let [p, q, s] = [i, j, other].map(|n| centres[n as usize]);
        let along = (q - p).normalize();
        let off = |to: Vec3| (to - p) - along * along.dot(&(to - p));
        let is_beyond = off(Vec3::from(gap.at)).dot(&off(s)) <= 0.0;
        is_beyond || (q - p).norm() - radii[i as usize] - radii[j as usize] >= limit
    })
}

/// The sphere that passes between three; `None` when they close the gap.
pub fn gap(centres: &[Vec3], radii: &[f64], triangle: &[u32; 3]) -> Option<Gap> {
    let [p, q, s] = triangle.map(|i| centres[i as usize]);
    let [r0, r1, r2] = triangle.map(|i| radii[i as usize]);
    let u = (q - p).normalize();
    let (a, b) = ((q - p).norm(), (s - p).dot(&u));
    let v = (s - p) - u * b;
    let height = v.norm();
    if height.is_nan() || height <= 1e-9 * a {
        return None;
    }
    // In the plane: p = (0, 0), q = (a, 0), s = (b, h). Differences of the squares are linear in x, y, ρ.
    let (x0, x1) = ((a * a + r0 * r0 - r1 * r1) / (2.0 * a), (r0 - r1) / a);
    let y0 = (b * b + height * height + r0 * r0 - r2 * r2 - 2.0 * b * x0) / (2.0 * height);
    let y1 = (r0 - r2 - b * x1) / height;
    // (x0 + x1 ρ)² + (y0 + y1 ρ)² = (ρ + r0)²
    let (k2, k1, k0) = (x1 * x1 + y1 * y1 - 1.0, x0 * x1 + y0 * y1 - r0, x0 * x0 + y0 * y0 - r0 * r0);
    // The three already overlap where the gap would be.
    if k0 <= 0.0 {
        return None;
    }
    let rho = if k2.abs() < 1e-14 {
        -0.5 * k0 / k1
    } else {
        let root = (k1 * k1 - k2 * k0).max(0.0).sqrt();
        let both = [(-k1 - root) / k2, (-k1 + root) / k2];
        both.into_iter().filter(|&x| x > 0.0).fold(f64::INFINITY, f64::min)
    };
    let (x, y) = (x0 + x1 * rho, y0 + y1 * rho);
    // Place among the three by its shares of p, q, s; a right angle has its middle on the longest side.
    let (of_s, of_q) = (y / height, (x - b * y / height) / a);
    if of_s.min(of_q).min(1.0 - of_s - of_q) < -ON_SIDE {
        return None;
    }
    // No position between the points is farther from all three than the centre of their circle: beyond it, the sphere
    // touches the three from outside.
    let middle = (b * b + height * height - a * b) / (2.0 * height);
    let circle = (0.25 * a * a + middle * middle).sqrt();
    if rho + r0.min(r1).min(r2) > circle * (1.0 + 1e-9) {
        return None;
    }
    let at = p + u * x + v / height * y;
    (rho.is_finite() && rho > 0.0).then(|| Gap { diameter: 2.0 * rho, at: at.into() })
}
