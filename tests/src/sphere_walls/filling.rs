//! How far points that cloud-fill adds lie from the surface that was scanned: a known surface with a round hole.

use super::chance::Chance;
use cloud::Cloud;
use cloud::fill::Settings;
use geom::Vec3;

/// A surface whose every point is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// z = 0.
    Plane,
    /// A half pipe of this radius [m] along x.
    Pipe(f64),
    /// A cap of a sphere of this radius [m].
    Ball(f64),
}

/// A scan with a hole.
#[derive(Debug, Clone, Copy)]
pub struct Scan {
    /// What is scanned.
    pub surface: Surface,
    /// Mean distance of points, one for each square of it [m].
    pub spacing: f64,
    /// Width of the hole along the surface [m].
    pub hole: f64,
    /// Deviation of the noise along each axis [m].
    pub noise: f64,
}

/// What came of it.
#[derive(Debug, Clone, Copy)]
pub struct Filled {
    /// Points added over those that the hole would have had [–].
    pub share: f64,
    /// Root mean square of their distances from the surface [m].
    pub off: f64,
    /// Largest distance [m].
    pub worst: f64,
    /// Whether the tool calls a hole open.
    pub open: bool,
    /// Largest ball that was rolled [m].
    pub ball: f64,
}

impl Surface {
    /// Name.
    pub fn name(self) -> &'static str {
        match self {
            Surface::Plane => "plane",
            Surface::Pipe(_) => "half pipe",
            Surface::Ball(_) => "ball",
        }
    }

    /// The point at lengths (x, s) [m] along the surface from its lowest point.
    fn at(self, x: f64, s: f64) -> Vec3 {
        match self {
            Surface::Plane => Vec3::new(x, s, 0.0),
            Surface::Pipe(big) => Vec3::new(x, big * (s / big).sin(), -big * (s / big).cos()),
            Surface::Ball(big) => {
                let way = x.hypot(s);
                let (sin, cos) = (way / big).sin_cos();
                let out = if way > 0.0 { big * sin / way } else { 0.0 };
                Vec3::new(x * out, s * out, -big * cos)
            }
        }
    }

    /// Distance of a point from the surface [m].
    fn distance(self, p: &Vec3) -> f64 {
        match self {
            Surface::Plane => p.z.abs(),
            Surface::Pipe(big) => (p.y.hypot(p.z) - big).abs(),
            Surface::Ball(big) => (p.norm() - big).abs(),
        }
    }
}

/// Fills the hole with balls of these radii [m] (none: those that cloud-fill fits itself).
///
/// # Panics
/// When the cloud is refused.
pub fn fill(scan: Scan, balls: &[f64], seed: u64) -> Filled {
    let mut chance = Chance::new(seed);
    let half = 2.0 * scan.hole;
    let count = (2.0 * half / scan.spacing).powi(2) as usize;
    let mut points = Vec::with_capacity(count);
    let mut missing = 0.0;
    for _ in 0..count {
        let (x, s) = (chance.between(-half, half), chance.between(-half, half));
        let noise = Vec3::new(chance.normal(), chance.normal(), chance.normal()) * scan.noise;
        if x.hypot(s) < 0.5 * scan.hole {
            missing += 1.0;
        } else {
            points.push(scan.surface.at(x, s) + noise);
        }
    }
    let settings = Settings { balls: balls.to_vec(), max_hole: Some(3.0 * scan.hole), ..Settings::default() };
    let attributes = stream::Table::with_rows(points.len());
    let before = points.len();
    let filled = cloud::fill(Cloud { points, attributes, ..Cloud::default() }, &settings).expect("a cloud");
    // Random holes beside the one that was made do not count.
    let middle = scan.surface.at(0.0, 0.0);
    let near = |p: &&Vec3| (*p - middle).norm() < 0.75 * scan.hole;
    let added: Vec<f64> =
        filled.cloud.points[before..].iter().filter(near).map(|p| scan.surface.distance(p)).collect();
    let holes = filled.report.holes.iter();
    let own = holes.filter(|h| (Vec3::from(h.centre) - middle).norm() < 0.5 * scan.hole);
    let (open, ball) = own.fold((false, 0.0f64), |(open, ball), h| (open || h.open, ball.max(h.ball)));
    Filled {
        share: added.len() as f64 / missing,
        off: (added.iter().map(|d| d * d).sum::<f64>() / added.len() as f64).sqrt(),
        worst: added.iter().copied().fold(0.0, f64::max),
        open,
        ball,
    }
}
