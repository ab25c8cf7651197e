//! The chute and its scanner.
//!
//! ```text
//! chute    tapered half pipe along x, 0 … 3 m, R = 0.45 → 0.40 m, lowest line at −z, |θ| ≤ π/2 + 0.3
//! scanner  0.6 m before the proximal end: points per area ∝ 1/(x + 0.6 m)²
//! blind    no point within `blind` [m] of x = 1.7 m, θ = 0.2, along the surface
//! mounting x < 0: a ring plate at x = −0.03 m (radii 0.46 … 0.65 m) and a sleeve (R = 0.5 m) behind it
//! noise    normal, the same along each axis
//! tilt     the whole turned about y, so that the far end goes down
//! ```

use cloud::Cloud;
use geom::Vec3;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::{FRAC_PI_2, PI};
use stream::{Table, Values};

const LENGTH: f64 = 3.0;
const SCANNER: f64 = 0.6;
/// Share of the points that lie on the mounting end.
const MOUNTING: f64 = 0.12;
/// Where the blind spot is: x [m] and θ.
const BLIND: (f64, f64) = (1.7, 0.2);

/// What to scan and how.
pub struct Scan {
    pub points: usize,
    /// [m]
    pub noise: f64,
    /// [m]
    pub blind: f64,
    /// [rad]
    pub tilt: f64,
    pub seed: u64,
}

impl Scan {
    /// The points, with `intensity` falling with distance and grazing angle.
    pub fn cloud(&self) -> Cloud {
        let mut random = Random(Pcg64Mcg::seed_from_u64(self.seed));
        let mut points = Vec::with_capacity(self.points);
        let mut intensity = Vec::with_capacity(self.points);
        for _ in 0..self.points {
            let (p, normal) =
                if random.share() < MOUNTING { mounting(&mut random) } else { self.chute(&mut random) };
            let ray = p - Vec3::new(-SCANNER, 0.0, 0.0);
            let facing = (ray.dot(&normal) / ray.norm()).abs();
            intensity.push((4000.0 * facing / ray.norm_squared()).clamp(1.0, 65535.0) as u16);
            let noisy = p + Vec3::new(random.normal(), random.normal(), random.normal()) * self.noise;
            points.push(self.tilted(noisy));
        }
        let mut attributes = Table::with_rows(points.len());
        let pushed = attributes.push("intensity", Values::U16(intensity));
        debug_assert!(pushed.is_ok());
        let comments = vec![
            "synthetic scan of a swivel chute, made by chute-scan".to_owned(),
            format!(
                "seed {} noise {} m blind spot {} m tilt {} deg",
                self.seed,
                self.noise,
                self.blind,
                self.tilt.to_degrees()
            ),
        ];
        Cloud { points, attributes, comments, ..Cloud::default() }
    }

    fn tilted(&self, p: Vec3) -> Vec3 {
        let (sin, cos) = (libm::sin(self.tilt), libm::cos(self.tilt));
        Vec3::new(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin)
    }

    /// A place on the half pipe and the normal there.
    fn chute(&self, random: &mut Random) -> (Vec3, Vec3) {
        loop {
            // Inverse of the distribution whose density is 1/(x + SCANNER)².
            let (near, far) = (1.0 / SCANNER, 1.0 / (LENGTH + SCANNER));
            let x = 1.0 / (near - random.share() * (near - far)) - SCANNER;
            let theta = (2.0 * random.share() - 1.0) * (FRAC_PI_2 + 0.3);
            let radius = 0.45 - 0.05 * x / LENGTH;
            let (dx, along) = (x - BLIND.0, radius * (theta - BLIND.1));
            if dx * dx + along * along >= self.blind * self.blind {
                let (sin, cos) = (libm::sin(theta), libm::cos(theta));
                return (Vec3::new(x, radius * sin, -radius * cos), Vec3::new(0.0, -sin, cos));
            }
        }
    }
}

/// A place on the plate or the sleeve, and the normal there.
fn mounting(random: &mut Random) -> (Vec3, Vec3) {
    let (x, inner, outer, sleeve, depth) = (-0.03, 0.46, 0.65, 0.5, 0.22);
    let theta = 2.0 * PI * random.share();
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    let ring = PI * (outer * outer - inner * inner);
    if random.share() < ring / (ring + 2.0 * PI * sleeve * depth) {
        let radius = (inner * inner + random.share() * (outer * outer - inner * inner)).sqrt();
        (Vec3::new(x, radius * sin, -radius * cos), -Vec3::x())
    } else {
        let x = x - depth * random.share();
        (Vec3::new(x, sleeve * sin, -sleeve * cos), Vec3::new(0.0, sin, -cos))
    }
}

/// Uniform and normal numbers of one stream.
struct Random(Pcg64Mcg);

impl Random {
    /// Uniform in 0 … 1.
    fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Mean 0, deviation 1 (Box & Muller 1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.share())).sqrt();
        radius * libm::cos(2.0 * PI * self.share())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blind_spot_is_empty_and_the_mounting_end_is_there() {
        let cloud = Scan { points: 20_000, noise: 0.0, blind: 0.12, tilt: 0.0, seed: 0 }.cloud();
        let radius = 0.45 - 0.05 * 1.7 / 3.0;
        let centre = Vec3::new(1.7, radius * libm::sin(0.2), -radius * libm::cos(0.2));
        assert!(cloud.points.iter().all(|p| (p - centre).norm() > 0.115));
        let mounted = cloud.points.iter().filter(|p| p.x < -0.01).count();
        assert!((2000..2900).contains(&mounted));
        assert_eq!(cloud.attributes.rows(), 20_000);
    }

    #[test]
    fn a_seed_gives_the_same_scan() {
        let scan = |seed| Scan { points: 100, noise: 0.001, blind: 0.1, tilt: 0.0, seed }.cloud();
        assert_eq!(scan(3), scan(3));
        assert_ne!(scan(3), scan(4));
    }

    #[test]
    fn the_sample_is_what_its_readme_says() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../sample-data/chute/chute.ply");
        let sample = std::fs::read(path).unwrap();
        let tilt = 40f64.to_radians();
        let cloud = Scan { points: 75_000, noise: 0.0008, blind: 0.12, tilt, seed: 0 }.cloud();
        let mut bytes = Vec::new();
        cloud::write_ply(&mut bytes, &cloud, stream::ply::Encoding::BinaryLittleEndian).unwrap();
        assert!(bytes == sample, "the sample differs when made again: run chute-scan and update its README");
    }
}
