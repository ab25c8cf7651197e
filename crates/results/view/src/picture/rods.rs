//! Rods: cones with round ends, discs, and triangles. Bonds, cracks, arrows and polyhedra are made of them.
//!
//! A cone is what a sphere sweeps whose centre goes from a to b while its radius goes from r_a to r_b. Of the spheres
//! c(s) = a + s u, r(s) = r_a + s δ (u = b − a, δ = r_b − r_a) that touch its surface at a place p, q = p − a:
//!
//! ```text
//! |p − c|² = r²  and  (p − c)·u + r δ = 0   ⇒   s = (q·u + r_a δ)/(u² − δ²),   (u² − δ²)(q² − r_a²) = (q·u + r_a δ)²
//! ```
//!
//! The second is quadratic along a ray; where s is not in 0…1, the sphere at that end counts. Without b, a = b, it is a
//! sphere.

use super::lens::Lens;
use super::rod::{Rod, RodShape};
use geom::Vec3;

/// A rod as seen from the eye.
pub(super) struct SeenRod {
    ends: [Vec3; 2],
    radii: [f64; 2],
    shape: RodShape,
    /// First and last sample in x and y, not yet cut to the picture.
    pub window: [f64; 4],
}

impl SeenRod {
    /// None where nothing of it is in the picture, or the eye is in it.
    pub fn new(rod: &Rod, lens: &Lens) -> Option<SeenRod> {
        let ends = rod.ends.map(|p| Vec3::from(lens.seen(p)));
        let mut window = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        let (shape, balls) = match rod.shape {
            RodShape::Cone => (RodShape::Cone, vec![(ends[0], rod.radii[0]), (ends[1], rod.radii[1])]),
            RodShape::Disc => (RodShape::Disc, vec![(ends[0], rod.radii[0])]),
            RodShape::Face(third) => {
                let third = Vec3::from(lens.seen(third));
                // Right, up and forward are a left-handed frame.
                if (ends[1] - ends[0]).cross(&(third - ends[0])).dot(&ends[0]) <= 0.0 {
                    return None;
                }
                (RodShape::Face(third), vec![(ends[0], 0.0), (ends[1], 0.0), (third, 0.0)])
            }
        };
        for (end, radius) in balls {
            let own = lens.window([end.x, end.y, end.z], radius)?;
            let wider =
                |k: usize| if [0, 2].contains(&k) { window[k].min(own[k]) } else { window[k].max(own[k]) };
            window = std::array::from_fn(wider);
        }
        lens.shows(window).then_some(SeenRod { ends, radii: rod.radii, shape, window })
    }

    /// Nothing of it is nearer to the eye [m].
    pub fn nearest(&self) -> f64 {
        let [a, b] = [0, 1].map(|k| self.ends[k].z - self.radii[k]);
        if let RodShape::Face(c) = self.shape { a.min(b).min(c.z) } else { a.min(b) }
    }

    /// The larger radius [m].
    pub fn radius(&self) -> f64 {
        self.radii[0].max(self.radii[1])
    }

    /// The depth at which the ray through (dx, dy, 1) from the eye meets it.
    pub fn depth(&self, dx: f64, dy: f64) -> Option<f64> {
        let ray = Vec3::new(dx, dy, 1.0);
        let [a, b] = self.ends;
        if let RodShape::Face(c) = self.shape {
            return met_face([a, b, c], ray);
        }
        if matches!(self.shape, RodShape::Disc) {
            let normal = b - a;
            let t = normal.dot(&a) / normal.dot(&ray);
            return (t > 0.0 && (ray * t - a).norm_squared() <= self.radii[0] * self.radii[0]).then_some(t);
        }
        let (u, delta) = (b - a, self.radii[1] - self.radii[0]);
        let rest = u.norm_squared() - delta * delta;
        if rest > 0.0 {
            let offset = self.radii[0] * delta - u.dot(&a);
            let (ru, ra) = (ray.dot(&u), ray.dot(&a));
            let outside = a.norm_squared() - self.radii[0] * self.radii[0];
            let (p, q, c) = (
                rest * ray.norm_squared() - ru * ru,
                -rest * ra - ru * offset,
                rest * outside - offset * offset,
            );
            let root = q * q - p * c;
            if root < 0.0 {
                return None;
            }
            let t = (-q - root.sqrt()) / p;
            let s = (t * ru + offset) / rest;
            if (0.0..=1.0).contains(&s) && t > 0.0 {
                return Some(t);
            }
        }
        let end = |k: usize| {
            let (across, along) = (ray.norm_squared(), ray.dot(&self.ends[k]));
            let outside = self.ends[k].norm_squared() - self.radii[k] * self.radii[k];
            let inside = along * along - across * outside;
            (inside >= 0.0).then(|| (along - inside.sqrt()) / across).filter(|t| *t > 0.0)
        };
        [end(0), end(1)].into_iter().flatten().reduce(f64::min)
    }

    /// The unit normal at a place of its surface, towards the eye.
    pub fn normal(&self, place: [f64; 3]) -> [f32; 3] {
        let (place, [a, b]) = (Vec3::from(place), self.ends);
        let u = b - a;
        let towards_eye = |normal: Vec3| if normal.dot(&a) > 0.0 { -normal } else { normal };
        let normal = if let RodShape::Face(c) = self.shape {
            towards_eye(u.cross(&(c - a)))
        } else if matches!(self.shape, RodShape::Disc) {
            towards_eye(u)
        } else {
            let delta = self.radii[1] - self.radii[0];
            let rest = u.norm_squared() - delta * delta;
            let s = ((place - a).dot(&u) + self.radii[0] * delta) / rest;
            let s = if rest > 0.0 { s.clamp(0.0, 1.0) } else { 0.0 };
            place - (a + u * s)
        };
        let normal = normal.try_normalize(0.0).unwrap_or(-Vec3::z());
        [normal.x as f32, normal.y as f32, normal.z as f32]
    }
}

/// How far along a ray from the eye a triangle is: the ray passes all its sides on the same side.
fn met_face([a, b, c]: [Vec3; 3], ray: Vec3) -> Option<f64> {
    let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(&q).dot(&ray));
    let inside = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
    let normal = (b - a).cross(&(c - a));
    let t = normal.dot(&a) / normal.dot(&ray);
    (inside && t > 0.0 && t.is_finite()).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rod(ends: [[f64; 3]; 2], radii: [f64; 2], shape: RodShape) -> SeenRod {
        SeenRod { ends: ends.map(Vec3::from), radii, shape, window: [0.0; 4] }
    }

    /// Every place that a ray finds lies on the surface: its distance from the nearest of the swept spheres is 0.
    #[test]
    fn rays_meet_the_surface_that_the_spheres_sweep() {
        for (ends, radii) in [
            ([[-1.0, 0.2, 10.0], [1.5, -0.4, 9.0]], [0.5, 0.5]),
            ([[-1.0, 0.2, 10.0], [1.5, -0.4, 9.0]], [0.7, 0.0]),
            ([[0.0, 0.0, 10.0], [0.0, 0.0, 10.0]], [0.5, 0.5]),
            ([[0.0, 0.0, 9.0], [0.1, 0.0, 12.0]], [0.2, 0.9]),
        ] {
            let rod = rod(ends, radii, RodShape::Cone);
            let mut met = 0;
            for k in 0..144 {
                let [dx, dy] = [k % 12, k / 12].map(|n| 0.04 * (f64::from(n) - 5.5));
                let distance = |p: Vec3| {
                    let at = |n: i32| f64::from(n) / 200.0;
                    let [a, b] = rod.ends;
                    let from = |s: f64| (p - a - (b - a) * s).norm() - radii[0] - s * (radii[1] - radii[0]);
                    (0..=200).map(|n| from(at(n))).fold(f64::INFINITY, f64::min)
                };
                let ray = Vec3::new(dx, dy, 1.0);
                let first = (0..400).map(|n| 7.0 + 0.015 * f64::from(n)).find(|t| distance(ray * *t) < 0.0);
                match rod.depth(dx, dy) {
                    None => assert!(first.is_none(), "{ends:?} {radii:?}: {dx} {dy}: {first:?}"),
                    Some(t) => {
                        met += 1;
                        assert!(distance(ray * t).abs() < 1e-3, "{ends:?}: {dx} {dy}: {}", distance(ray * t));
                        let n = Vec3::from(rod.normal([t * dx, t * dy, t]).map(f64::from));
                        assert!((n.norm() - 1.0).abs() < 1e-5 && n.dot(&ray) < 1e-4, "towards the eye");
                    }
                }
            }
            assert!(met > 3, "{ends:?}");
        }
    }

    #[test]
    fn a_disc_is_met_inside_its_radius_only() {
        let disc = rod([[0.0, 0.0, 10.0], [0.0, 1.0, 11.0]], [1.0, 1.0], RodShape::Disc);
        assert!((disc.depth(0.0, 0.0).unwrap_or(0.0) - 10.0).abs() < 1e-12);
        assert!(disc.depth(0.099, 0.0).is_some() && disc.depth(0.101, 0.0).is_none());
        assert!(disc.normal([0.0, 0.0, 10.0])[2] < 0.0);
    }

    #[test]
    fn a_triangle_is_met_inside_its_sides_only() {
        let third = Vec3::new(0.0, 1.0, 11.0);
        let face = rod([[0.0, 0.0, 10.0], [1.0, 0.0, 10.0]], [0.1; 2], RodShape::Face(third));
        assert!((face.depth(0.02, 0.02).unwrap_or(0.0) - 10.0 / 0.98).abs() < 1e-12, "z = 10 + y");
        assert!(face.depth(-0.001, 0.02).is_none() && face.depth(0.09, 0.02).is_none());
        assert!(face.normal([0.2, 0.2, 10.2])[2] < 0.0);
    }
}
