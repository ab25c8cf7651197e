//! Spheres that are one body, drawn as one: normals go smoothly from each member of a clump to the next.
//!
//! ```text
//! n = Σ w_j (p − c_j)/|p − c_j|      w_j = max(0, 1 − (|p − c_j| − r_j)/h)³
//! ```
//!
//! over the spheres j of the body, at a place p of its surface. Where two of them intersect, both have the weight 1, so there is no
//! crease; a sphere farther off than h has none. The outline stays that of the spheres.

use super::splat::NOTHING;

/// How far a sphere bends the normals of others, in mean radii of the body [–].
const BLEND: f64 = 0.6;

/// The bodies among spheres, as the eye sees them.
#[derive(Default)]
pub(super) struct JoinedBodies {
    /// Body of each sphere and rod, or [`NOTHING`]; empty without bodies.
    body: Vec<u32>,
    /// Spheres of each body: where they begin and end in `members`, and how far they bend normals [m].
    span: Vec<([u32; 2], f64)>,
    /// Centre as seen [m] and radius [m].
    members: Vec<([f64; 3], f64)>,
}

impl JoinedBodies {
    /// Adds a body of spheres with these numbers; its number. `smooth` gives centre and radius of each; none where they
    /// have no creases to smooth.
    pub fn add(&mut self, numbers: &[usize], smooth: Vec<([f64; 3], f64)>) -> u32 {
        let body = self.span.len() as u32;
        numbers.iter().for_each(|&number| self.join(number, body));
        let start = self.members.len() as u32;
        let radii = smooth.iter().map(|m| m.1).sum::<f64>();
        let blend = BLEND * radii / smooth.len().max(1) as f64;
        self.members.extend(smooth);
        self.span.push(([start, self.members.len() as u32], blend));
        body
    }

    /// Makes a sphere or rod a part of a body.
    pub fn join(&mut self, number: usize, body: u32) {
        if self.body.len() <= number {
            self.body.resize(number + 1, NOTHING);
        }
        self.body[number] = body;
    }

    /// Whether there is no body of several spheres.
    pub fn is_empty(&self) -> bool {
        self.span.is_empty()
    }

    /// The body of a sphere or rod.
    pub fn of(&self, number: usize) -> Option<u32> {
        self.body.get(number).copied().filter(|body| *body != NOTHING)
    }

    /// The normal at a place of the surface of sphere `number`; none where that is no member of a body.
    pub fn normal(&self, number: usize, point: [f64; 3]) -> Option<[f32; 3]> {
        let ([from, to], blend) = self.span[self.of(number)? as usize];
        let members = &self.members[from as usize..to as usize];
        if members.is_empty() {
            return None;
        }
        let mut sum = [0.0; 3];
        for (centre, radius) in members {
            let away: [f64; 3] = std::array::from_fn(|k| point[k] - centre[k]);
            let square = away.iter().map(|a| a * a).sum::<f64>();
            let reach = radius + blend;
            if square >= reach * reach {
                continue;
            }
            let length = square.sqrt().max(1e-12 * radius);
            let weight = (1.0 - ((length - radius) / blend).max(0.0)).powi(3);
            (0..3).for_each(|k| sum[k] += weight * away[k] / length);
        }
        let length = sum.iter().map(|s| s * s).sum::<f64>().sqrt();
        (length > 0.0).then(|| sum.map(|s| (s / length) as f32))
    }
}
