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
#[inline]
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

/// Radii [m] r_j between `within.0` and `within.1` that meet (1) beside `r_i`: the one on the far side of the least P of `r_i`, and
/// the one on the near side. Where neither exists, `r_i` is too large for this pair.
#[inline]
pub fn partners(r_i: f64, zeta: f64, p: f64, within: (f64, f64)) -> [Option<f64>; 2] {
    let half_chord = |r: f64| (zeta * (2.0 * r - zeta)).max(0.0).sqrt();
    if 2.0 * r_i < zeta {
        return [None, None];
    }
    let (s, lowest, highest) = (half_chord(r_i), half_chord(within.0), half_chord(within.1));
    // Turning points of the left side: t (s − t) = 2ζ².
    let turn = s * s - 8.0 * zeta * zeta;
    let (most, least) =
        if turn > 0.0 { (0.5 * (s - turn.sqrt()), 0.5 * (s + turn.sqrt())) } else { (0.0, 0.0) };
    let radius = |t: f64| 0.5 * (t * t / zeta + zeta);
    let half = Half { s, four: 4.0 * zeta * zeta, p };
    // Two equal half chords are P.
    let larger = half.root(p - s, least.max(lowest), highest).map(radius);
    // Where the slope is steepest Newton's method cannot overshoot.
    let steepest = ((s * s - 0.5 * half.four) / 3.0).max(0.0).sqrt();
    let below = turn > 0.0 && lowest < least;
    let smaller = below.then(|| half.root(steepest, least.min(highest), most.max(lowest)));
    [larger, smaller.flatten().map(radius)]
}

/// (1), squared, for one half chord: ((s + t)² (4ζ² + (s − t)²) = 4ζ² P².
struct Half {
    s: f64,
    four: f64,
    p: f64,
}

impl Half {
    fn excess(&self, t: f64) -> f64 {
        let (sum, difference) = (self.s + t, self.s - t);
        sum * sum * (self.four + difference * difference) - self.four * self.p * self.p
    }

    /// The half chord t from `below`, where the left side of (1) is at most P, to `above`, where it is at least P; `None` when they are
    /// not. Newton's method from `start`, halving where it leaves the bracket.
    fn root(&self, start: f64, below: f64, above: f64) -> Option<f64> {
        if self.excess(below) > 0.0 || self.excess(above) < 0.0 {
            return None;
        }
        let (mut low, mut high) = (below, above);
        let mut t = start.clamp(below.min(above), below.max(above));
        for _ in 0..80 {
            let f = self.excess(t);
            if f > 0.0 {
                high = t
            } else {
                low = t
            }
            let slope = 2.0 * (self.s + t) * (self.four - 2.0 * t * (self.s - t));
            let newton = t - f / slope;
            let inside = newton >= low.min(high) && newton <= low.max(high);
            let next = if inside { newton } else { 0.5 * (low + high) };
            // The error of a step of Newton's is about the square of the step.
            let close = if inside { NEAR } else { 4.0 * f64::EPSILON };
            if (next - t).abs() <= close * (self.s + t) {
                return Some(next);
            }
            t = next;
        }
        Some(t)
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
        assert_eq!(radius(0.01, 1e-320), None, "a radius beyond all numbers");
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
                    for r_j in partners(r_i, zeta, p, (zeta, 1.0)).into_iter().flatten() {
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
