//! Plates and half pipes of wall spheres, made as a user makes them: a scan of random points, sampled, then radii by equation (1).

use super::chance::Chance;
use dem::setup::{Wall, WallShape};
use geom::Vec3;
use record::MaterialRecord;
use sampling::{Amount, Method};
use wall::{Radius, Regions, WallSettings};

/// Scanned points for each point kept.
const DENSE: f64 = 30.0;

/// How the points of a wall lie. All have one point for each square of the spacing P.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Layout {
    /// Exactly on a square lattice.
    Square,
    /// Exactly on a lattice of equilateral triangles of side P.
    Triangles,
    /// Sampled from a scan, with a seed.
    Sampled(Method, u64),
}

impl Layout {
    /// As `bluenoise-sample --method` calls it.
    pub fn name(self) -> &'static str {
        match self {
            Layout::Square => "square lattice",
            Layout::Triangles => "triangles",
            Layout::Sampled(Method::Poisson, _) => "poisson",
            Layout::Sampled(Method::Eliminate, _) => "eliminate",
            Layout::Sampled(Method::Relax, _) => "relax",
            Layout::Sampled(Method::Grid, _) => "grid",
            Layout::Sampled(Method::Tile, _) => "tile",
        }
    }

    /// Points on z = 0, in a square of `width` [m] about the origin, at spacing `p` [m].
    ///
    /// # Panics
    /// When there is nothing to sample.
    pub fn points(self, p: f64, width: f64) -> Vec<Vec3> {
        match self {
            Layout::Square => lattice(p, p, 0.0, width),
            Layout::Triangles => lattice(p, p * 0.75f64.sqrt(), 0.5 * p, width),
            Layout::Sampled(method, seed) => {
                let mut chance = Chance::new(seed);
                let half = 0.5 * width;
                let count = (DENSE * (width / p).powi(2)) as usize;
                let scan = (0..count)
                    .map(|_| Vec3::new(chance.between(-half, half), chance.between(-half, half), 0.0))
                    .collect();
                sampled(scan, method, p, width * width, seed)
            }
        }
    }

    /// Points on the lower half of a pipe of radius `pipe` [m] and length `width` [m] along x, its axis at z = 0.
    ///
    /// # Panics
    /// For lattices: they are sampled.
    pub fn pipe_points(self, p: f64, pipe: f64, width: f64) -> Vec<Vec3> {
        let Layout::Sampled(method, seed) = self else { panic!("a pipe is sampled") };
        let mut chance = Chance::new(seed);
        let area = std::f64::consts::PI * pipe * width;
        let scan = (0..(DENSE * area / (p * p)) as usize)
            .map(|_| {
                let (x, angle) = (chance.between(-0.5, 0.5) * width, chance.between(-0.5, 0.5));
                let (sin, cos) = (angle * std::f64::consts::PI).sin_cos();
                Vec3::new(x, pipe * sin, -pipe * cos)
            })
            .collect();
        sampled(scan, method, p, area, seed)
    }
}

/// Rows at distance `row`, every other one shifted.
fn lattice(p: f64, row: f64, shift: f64, width: f64) -> Vec<Vec3> {
    let (half, rows) = ((0.5 * width / p).floor() as i64, (0.5 * width / row).floor() as i64);
    (-rows..=rows)
        .flat_map(|j| (-half..=half).map(move |i| (i, j)))
        .map(|(i, j)| {
            let odd = if j.rem_euclid(2) == 1 { shift } else { 0.0 };
            Vec3::new(i as f64 * p + odd, j as f64 * row, 0.0)
        })
        .collect()
}

fn sampled(scan: Vec<Vec3>, method: Method, p: f64, area: f64, seed: u64) -> Vec<Vec3> {
    let amount = match method {
        Method::Grid => Amount::Spacing(p),
        _ => Amount::Count((area / (p * p)).round() as usize),
    };
    let settings = sampling::SampleSettings { amount, method, distance: sampling::Distance::Surface, seed };
    let kept = sampling::sample(&scan, None, &settings).expect("there is a scan").kept;
    kept.iter().map(|&k| scan[k as usize]).collect()
}

/// Wall spheres: centre and radius [m].
pub type Spheres = Vec<(Vec3, f64)>;

/// One sphere on each point, all of the radius that equation (1) gives for roughness ζ [m] at the mean distance of neighbours;
/// what wallgen reports besides. `smallest` is the diameter of the smallest grain [m].
///
/// # Panics
/// When the points make no wall of that roughness.
pub fn spheres(points: &[Vec3], roughness: f64, smallest: f64) -> (Spheres, wall::WallReport) {
    let material = MaterialRecord { name: "wall".to_owned(), ..MaterialRecord::default() };
    let regions = Regions::one(Some(roughness), material, Vec3::zeros()).expect("positive");
    let settings = WallSettings {
        radius: Radius::Uniform,
        smallest_particle: Some(smallest),
        ..WallSettings::default()
    };
    let (wall, report) = wall::build(points, &regions, &settings).expect("a wall");
    (wall.centres.into_iter().zip(wall.radii).collect(), report)
}

/// The wall of an engine.
pub fn still(spheres: &[(Vec3, f64)]) -> Wall {
    let shape = WallShape::Spheres(spheres.to_vec());
    Wall::new("spheres", 1, shape)
}

/// Height z [m] at which a grain of radius `r` [m] that comes down at (x, y) touches first, and the sphere it touches; `None`
/// beside the wall.
pub fn touch(spheres: &[(Vec3, f64)], r: f64, x: f64, y: f64) -> Option<(f64, usize)> {
    let height = |(k, (centre, radius)): (usize, &(Vec3, f64))| {
        let reach = radius + r;
        let left = reach * reach - (centre.x - x).powi(2) - (centre.y - y).powi(2);
        (left > 0.0).then(|| (centre.z + left.sqrt(), k))
    };
    spheres.iter().enumerate().filter_map(height).max_by(|a, b| a.0.total_cmp(&b.0))
}
