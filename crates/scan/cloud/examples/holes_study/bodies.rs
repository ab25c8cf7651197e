//! What holes are cut out of: bodies whose surface is known, and scans.
//!
//! Lengths of bodies are in the spacing of their densest part, 1/√density. Their points are random, with noise of a fifth of the spacing.

use geom::Vec3;
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// Standard deviation of the noise along each axis, in local spacings.
const NOISE: f64 = 0.2;

/// Uniform numbers in [0, 1) (splitmix64, Steele et al. 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Nearly normal, of variance 1.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() - 6.0
    }

    /// A uniform direction.
    fn direction(&mut self) -> Vec3 {
        let (z, turn) = (2.0 * self.next() - 1.0, TAU * self.next());
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * turn.cos(), r * turn.sin(), z)
    }
}

/// A surface.
#[derive(Clone, Copy, PartialEq)]
pub enum Body {
    /// A square of 300.
    Plane,
    /// A pipe of radius 50 and length 280.
    Cylinder,
    /// Two faces of 300 × 150 at 90°.
    Edge,
    /// A square of 600 whose spacing grows from 1 to 4 along x.
    Gradient,
    /// Four squares of 300 side by side along x, with spacings of 1, 4, 1 and 4.
    Steps,
    /// A stone of radius 80 with dents and bumps of 4 and 30 wide.
    Stone,
    /// A scan, by its number.
    Scan(usize),
}

/// Names and bodies, in the order of the table.
pub const BODIES: [(&str, Body); 9] = [
    ("plane", Body::Plane),
    ("cylinder", Body::Cylinder),
    ("edge of 90°", Body::Edge),
    ("spacing grows 1 : 4", Body::Gradient),
    ("spacing steps 1 : 4", Body::Steps),
    ("rough stone", Body::Stone),
    ("river boulders", Body::Scan(0)),
    ("stone pile", Body::Scan(1)),
    ("airborne terrain", Body::Scan(2)),
];

const SCANS: [&str; 3] = ["Otira_1cm_grains.ply", "stonepile2_depthcam_120k.ply", "autzen_trim.laz"];

fn bumps(d: &Vec3) -> f64 {
    let k = 80.0 * TAU / 30.0;
    let wave = |a: f64, b: f64, c: f64| (k * (a * d.x + b * d.y + c * d.z) / 2.0).sin();
    80.0 + 1.4 * (wave(1.0, 0.3, -0.2) + wave(-0.4, 1.0, 0.5) + wave(0.2, -0.5, 1.0))
}

impl Body {
    /// Points of it; of a scan, those of the file in `folder`.
    pub fn points(self, seed: u64, folder: &Path) -> Result<Vec<Vec3>, String> {
        if let Body::Scan(number) = self {
            let path = folder.join(SCANS[number]);
            let name = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
            let open = std::fs::File::open(&path).map_err(|why| name(&why))?;
            let cloud = cloud::read(open).map_err(|why| name(&why))?;
            return Ok(cloud.finite().0.points);
        }
        let mut random = Random(seed);
        let noisy = |(p, spacing): (Vec3, f64), random: &mut Random| {
            p + Vec3::new(random.normal(), random.normal(), random.normal()) * (NOISE * spacing)
        };
        let count = match self {
            Body::Steps => 2.0 * 300.0 * 300.0 * (1.0 + 1.0 / 16.0),
            Body::Stone => 4.0 * PI * 80.0 * 80.0,
            _ => 300.0 * 300.0,
        };
        Ok((0..count as usize)
            .map(|_| {
                let place = self.place(&mut random);
                noisy(place, &mut random)
            })
            .collect())
    }

    /// A random place on it, and the spacing there.
    fn place(self, random: &mut Random) -> (Vec3, f64) {
        let (s, t) = (random.next(), random.next());
        match self {
            Body::Plane => (Vec3::new(300.0 * s, 300.0 * t, 0.0), 1.0),
            Body::Cylinder => (Vec3::new(50.0 * (TAU * s).cos(), 50.0 * (TAU * s).sin(), 286.5 * t), 1.0),
            Body::Edge => {
                let along = 300.0 * s - 150.0;
                (Vec3::new(along.max(0.0), 300.0 * t, (-along).max(0.0)), 1.0)
            }
            Body::Gradient => {
                // The share of points up to spacing g is (1 − 1/g) / (1 − 1/4).
                let spacing = 1.0 / (1.0 - 0.75 * s);
                (Vec3::new(600.0 * (spacing - 1.0) / 3.0, 600.0 * t, 0.0), spacing)
            }
            Body::Steps => {
                // Shares of the points: 16, 1, 16 and 1 of 34.
                let which = 34.0 * random.next();
                let square = [16.0, 17.0, 33.0, 34.0].iter().filter(|upper| which >= **upper).count();
                let spacing = if square % 2 == 0 { 1.0 } else { 4.0 };
                (Vec3::new(300.0 * (square as f64 + s), 300.0 * t, 0.0), spacing)
            }
            _ => {
                let d = random.direction();
                (d * bumps(&d), 1.0)
            }
        }
    }

    /// Distance of a place from the surface; none of a scan.
    pub fn off(self, p: &Vec3) -> Option<f64> {
        Some(match self {
            Body::Plane | Body::Gradient | Body::Steps => p.z.abs(),
            Body::Cylinder => (p.xy().norm() - 50.0).abs(),
            Body::Edge => {
                let face = |along: f64, off: f64| off.hypot((-along).max(0.0));
                face(p.x, p.z).min(face(p.z, p.x))
            }
            Body::Stone => (p.norm() - bumps(&p.normalize())).abs(),
            Body::Scan(_) => return None,
        })
    }
}
