//! Equation (1): radius, distance and roughness of two neighbouring wall spheres.
//!
//! ```text
//! √(2 r_i ζ − ζ²) + √(2 r_j ζ − ζ²) = √(P² − (r_i − r_j)²)          (1)
//! equal radii:   r = (P²/4 + ζ²) / (2ζ),   ζ = r − √(r² − P²/4),   P = 2 √(2rζ − ζ²)
//! ```
//!
//! P [m] distance of the centres, r_i, r_j [m] radii, ζ [m] depth of the dent: from the line that touches both
//! spheres on the flow side to the point where the spheres meet on that side. Japanese patent JP6939487B2. Valid for 0 < ζ ≤ P/2.
//!
//! Solved for ζ, (1) has a closed form: with a = (r_i − r_j)/P the tilt of the tangent and S = r_i + r_j, r_i − a x − √(1 − a²) h is,
//! for the meeting point x = (P² + r_i² − r_j²)/2P, h = √(r_i² − x²), without the difference of two near numbers,
//!
//! ```text
//! ζ = (1 − a²) P² / 2 (S + √(S² − P²))
//! ```
//!
//! Solved for one half chord t = √(2 r_j ζ − ζ²), the other one s being known, it is
//!
//! ```text
//! (s + t) √(1 + (s − t)²/4ζ²) = P
//! ```
//!
//! which may have no root (r_i too large for this P), one, or more: the dent is deepest for nearly equal radii.

/// A length that is too large by less than this factor is meant to be equal.
pub(crate) const ROUNDED: f64 = 1.0 + 1e-9;
/// A step of Newton's method this small, as a share, leaves nothing to a further one.
const NEAR: f64 = 3e-9;

/// Radius [m] of equal spheres at distance `spacing` [m] with dents of depth `roughness` [m]; `None` outside 0 < ζ ≤ P/2.
pub fn radius(spacing: f64, roughness: f64) -> Option<f64> {
    let valid = roughness > 0.0 && roughness <= 0.5 * spacing && spacing.is_finite();
    // ζ/2 is kept apart so that a tiny ζ does not vanish beside P².
    valid.then(|| 0.5 * (0.25 * spacing * spacing / roughness + roughness)).filter(|r| r.is_finite())
}

/// Depth of the dents [m] between equal spheres; `None` when they do not meet, r < P/2.
pub fn roughness(radius: f64, spacing: f64) -> Option<f64> {
    let half = 0.5 * spacing;
    let valid = half > 0.0 && radius >= half && radius.is_finite();
    // r − √(r² − P²/4), written without the difference of two near numbers.
    valid.then(|| half * half / (radius + ((radius - half) * (radius + half)).sqrt()))
}

/// Distance [m] of equal spheres with dents of depth `roughness` [m]; `None` outside 0 < ζ ≤ r.
pub fn spacing(radius: f64, roughness: f64) -> Option<f64> {
    let valid = roughness > 0.0 && roughness <= radius && radius.is_finite();
    valid.then(|| 2.0 * (roughness * (2.0 * radius - roughness)).sqrt())
}

/// Depth of the dent [m] between any two spheres at distance `p` [m]. Goes on steadily where there is none, so that a solver
/// can come back: below 0 when one sphere lies inside the other, above the deepest dent when they do not meet.
#[inline(always)]
pub fn dent(r_i: f64, r_j: f64, p: f64) -> f64 {
    // Without branches and with one root, so that the compiler does several pairs at once.
    let (sum, difference, per) = (r_i + r_j, r_i - r_j, 1.0 / p);
    let a = difference * per;
    let square = (sum - p) * (sum + p);
    let root = if square > 0.0 { square } else { 0.0 }.sqrt();
    let (meets, gap) = if p > sum { (sum, p - sum) } else { (p, 0.0) };
    let meeting = 0.5 * (1.0 - a) * (1.0 + a) * meets * (meets / (sum + root)) + gap;
    if a.abs() >= 1.0 { p * (1.0 - a.abs()) } else { meeting }
}

/// Left side minus right side of (1) [m]; NaN where a root has no value.
pub fn residual(r_i: f64, r_j: f64, zeta: f64, p: f64) -> f64 {
    let chord = |r: f64| (zeta * (2.0 * r - zeta)).sqrt();
    chord(r_i) + chord(r_j) - ((p - (r_i - r_j)) * (p + (r_i - r_j))).sqrt()
}

/// Spheres that are computed at once.
pub const LANES: usize = 8;

/// Neighbours, a column each.
#[derive(Debug, Clone, Copy)]
pub struct Beside<'a> {
    /// Radii r_i [m].
    pub radius: &'a [f64; LANES],
    /// ζ [m] asked for beside each.
    pub zeta: &'a [f64; LANES],
    /// Distances P [m].
    pub p: &'a [f64; LANES],
}

/// Adds to `radii`, for each of the first `count` neighbours, the radii [m] r_j between `within.0` and `within.1` that meet (1) beside it:
/// the one on the far side of the least P of r_i, and the one on the near side. Where neither exists, r_i is too large for this pair.
#[inline(always)]
pub fn partners(others: Beside, count: usize, within: (f64, f64), radii: &mut Vec<f64>) {
    let mut halves = [Half::default(); 2];
    let [larger, smaller] = &mut halves;
    for k in 0..LANES {
        let (radius, zeta, p) = (others.radius[k], others.zeta[k], others.p[k]);
        let half_chord = |r: f64| above_zero(zeta * (2.0 * r - zeta)).sqrt();
        let (s, lowest, highest) = (half_chord(radius), half_chord(within.0), half_chord(within.1));
        // Turning points of the left side: t (s − t) = 2ζ².
        let turn = s * s - 8.0 * zeta * zeta;
        let root = above_zero(turn).sqrt();
        let most = if turn > 0.0 { 0.5 * (s - root) } else { 0.0 };
        let least = if turn > 0.0 { 0.5 * (s + root) } else { 0.0 };
        let four = 4.0 * zeta * zeta;
        let terms = Terms { s, four, p };
        let fits = (2.0 * radius >= zeta) as u64;
        // Two equal half chords are P.
        larger.set(k, terms, p - s, (greater(least, lowest), highest));
        larger.there[k] &= fits;
        // Where the slope is steepest Newton's method cannot overshoot.
        let steepest = above_zero((s * s - 0.5 * four) / 3.0).sqrt();
        smaller.set(k, terms, steepest, (lesser(least, highest), greater(most, lowest)));
        smaller.there[k] &= fits & (turn > 0.0) as u64 & (lowest < least) as u64;
    }
    let mut open = Half::default();
    let (mut used, mut zetas) = (0, [1.0; LANES]);
    for k in 0..count.min(LANES) {
        for half in &halves {
            if half.there[k] == 0 {
                continue;
            }
            open.take(used, half, k);
            zetas[used] = others.zeta[k];
            used += 1;
            if used == LANES {
                open.find(used, &zetas, radii);
                used = 0;
            }
        }
    }
    open.find(used, &zetas, radii);
}

#[inline(always)]
fn above_zero(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

#[inline(always)]
fn lesser(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

#[inline(always)]
fn greater(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// (1), squared, for one half chord t, the other one being s: (s + t)² (4ζ² + (s − t)²) = 4ζ² P². Several at once, each t between `low`,
/// where the left side of (1) is at most P, and `high`, where it is at least P.
#[derive(Clone, Copy, Default)]
struct Half {
    s: [f64; LANES],
    /// 4ζ².
    four: [f64; LANES],
    /// 4ζ² P².
    right: [f64; LANES],
    low: [f64; LANES],
    high: [f64; LANES],
    t: [f64; LANES],
    /// 1 where the root lies between the two.
    there: [u64; LANES],
}

/// s, 4ζ² and P of one pair.
#[derive(Clone, Copy)]
struct Terms {
    s: f64,
    four: f64,
    p: f64,
}

impl Half {
    #[inline(always)]
    fn set(&mut self, k: usize, Terms { s, four, p }: Terms, start: f64, (below, above): (f64, f64)) {
        (self.s[k], self.four[k], self.right[k]) = (s, four, four * p * p);
        (self.low[k], self.high[k]) = (below, above);
        self.t[k] = lesser(greater(start, lesser(below, above)), greater(below, above));
        self.there[k] = (self.excess(k, below) <= 0.0) as u64 & (self.excess(k, above) >= 0.0) as u64;
    }

    #[inline(always)]
    fn excess(&self, k: usize, t: f64) -> f64 {
        let (sum, difference) = (self.s[k] + t, self.s[k] - t);
        sum * sum * (self.four[k] + difference * difference) - self.right[k]
    }

    /// Takes the lane `from` of another.
    #[inline(always)]
    fn take(&mut self, k: usize, other: &Half, from: usize) {
        (self.s[k], self.four[k], self.right[k]) = (other.s[from], other.four[from], other.right[from]);
        (self.low[k], self.high[k], self.t[k]) = (other.low[from], other.high[from], other.t[from]);
    }

    /// Newton's method in the first `used` lanes, halving where it leaves the bracket; adds the radii [m] to `radii`.
    #[inline(always)]
    fn find(&mut self, used: usize, zetas: &[f64; LANES], radii: &mut Vec<f64>) {
        // A lane that has arrived waits for the others.
        let mut open = [0u64; LANES];
        open[..used].fill(1);
        for _ in 0..80 {
            if open.iter().sum::<u64>() == 0 {
                break;
            }
            for (k, open) in open.iter_mut().enumerate() {
                let (s, four, t) = (self.s[k], self.four[k], self.t[k]);
                let f = self.excess(k, t);
                let high = if f > 0.0 { t } else { self.high[k] };
                let low = if f > 0.0 { self.low[k] } else { t };
                let slope = 2.0 * (s + t) * (four - 2.0 * t * (s - t));
                let newton = t - f / slope;
                let inside = (newton >= lesser(low, high)) & (newton <= greater(low, high));
                let next = if inside { newton } else { 0.5 * (low + high) };
                // The error of a step of Newton's is about the square of the step.
                let close = if inside { NEAR } else { 4.0 * f64::EPSILON };
                let goes_on = ((next - t).abs() > close * (s + t)) as u64;
                self.t[k] = if *open != 0 { next } else { t };
                (self.low[k], self.high[k]) = (low, high);
                *open &= goes_on;
            }
        }
        let radius = |k: usize| 0.5 * (self.t[k] * self.t[k] / zetas[k] + zetas[k]);
        let found: [f64; LANES] = std::array::from_fn(radius);
        radii.extend_from_slice(&found[..used]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radius_roughness_and_spacing_of_equal_spheres_undo_each_other() {
        for p in [1e-3, 0.01, 1.0] {
            for share in [1e-9, 1e-4, 0.01, 0.1, 0.3, 0.499, 0.5] {
                let zeta = share * p;
                let r = radius(p, zeta).unwrap();
                assert!((roughness(r, p).unwrap() / zeta - 1.0).abs() < 1e-7, "ζ/P = {share}");
                assert!((spacing(r, zeta).unwrap() / p - 1.0).abs() < 1e-12);
                assert!(residual(r, r, zeta, p).abs() < 1e-12 * p);
            }
        }
        // By hand: P = 6, ζ = 1: r = (9 + 1)/2 = 5, and 5 − √(25 − 9) = 1.
        assert_eq!(radius(6.0, 1.0), Some(5.0));
        assert_eq!(roughness(5.0, 6.0), Some(1.0));
        assert_eq!(spacing(5.0, 1.0), Some(6.0));
    }

    #[test]
    fn limits_of_the_roughness() {
        assert_eq!(radius(0.01, 0.005), Some(0.005), "ζ = P/2: the spheres just touch");
        assert_eq!(radius(0.01, 0.005000001), None);
        assert_eq!(radius(0.01, 0.0), None);
        assert_eq!(radius(0.01, -1e-3), None);
        assert_eq!(radius(0.01, f64::NAN), None);
        let r = radius(0.01, 1e-15).unwrap();
        assert!(r.is_finite() && (r * 8e-15 / 1e-4 - 1.0).abs() < 1e-12, "ζ → 0: r → P²/8ζ");
        assert_eq!(radius(0.01, 1e-320), None, "a radius that is not finite");
    }

    #[test]
    fn dent_meets_equation_1_for_unequal_radii() {
        for (r_i, r_j, p) in
            [(5.0, 5.0, 6.0), (5.0, 4.0, 6.0), (3.0, 7.0, 6.5), (10.0, 9.0, 3.0), (3.0, 3.0, 6.0)]
        {
            let zeta = dent(r_i, r_j, p);
            assert!(zeta > 0.0 && residual(r_i, r_j, zeta, p).abs() < 1e-9, "{r_i} {r_j} {p}: {zeta}");
            assert!((dent(r_j, r_i, p) - zeta).abs() < 1e-12, "the same from both sides");
        }
    }

    #[test]
    fn dents_are_exact_however_shallow() {
        for share in [1e-300, 1e-100, 1e-15, 1e-9, 1e-4, 0.1, 0.5] {
            let (p, zeta) = (0.01, 0.01 * share);
            let r = radius(p, zeta).unwrap();
            // Where √(S² − P²) is small, it is what is left of two near numbers.
            let exact = if share < 0.4 { 1e-14 } else { 1e-7 };
            if share >= 1e-15 {
                assert!((dent(r, r, p) / zeta - 1.0).abs() < exact, "ζ/P = {share}: {}", dent(r, r, p));
            }
            assert!(dent(r, r, p) >= 0.0 && dent(r, r, p).is_finite(), "ζ/P = {share}");
        }
    }

    #[test]
    fn partners_meet_equation_1() {
        let mut found = 0;
        for r_i in [0.004, 0.006, 0.01, 0.02] {
            for p in [0.005, 0.006, 0.008, 0.012] {
                for zeta in [0.0004, 0.001, 0.0024] {
                    let beside = Beside { radius: &[r_i; LANES], zeta: &[zeta; LANES], p: &[p; LANES] };
                    let mut radii = Vec::new();
                    partners(beside, 1, (zeta, 1.0), &mut radii);
                    for r_j in radii {
                        found += 1;
                        let off = residual(r_i, r_j, zeta, p);
                        assert!(off.abs() < 1e-9 * p, "r_i {r_i} r_j {r_j} ζ {zeta} P {p}: {off}");
                    }
                }
            }
        }
        assert!(found > 25, "{found}");
    }
}
