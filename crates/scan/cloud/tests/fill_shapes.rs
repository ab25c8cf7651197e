//! Filling where a surface is no smooth sheet: thin plates, edges, sheets that meet, open borders; with noise of a third of the spacing.
//! Each scan has one hole that is to be closed, and nothing is added anywhere else.

mod random;

use cloud::Cloud;
use cloud::fill::{Filled, Settings};
use geom::Vec3;
use random::Random;
use stream::Table;

/// Mean spacing of the scans [m], and their noise.
const SPACING: f64 = 0.02;
const NOISE: f64 = SPACING / 3.0;

/// A flat piece: corner, sides [m].
#[derive(Clone, Copy)]
struct Piece(Vec3, Vec3, Vec3);

impl Piece {
    fn area(&self) -> f64 {
        self.1.cross(&self.2).norm()
    }

    /// Distance of a place from the piece [m]; its sides are at right angles.
    fn off(&self, p: &Vec3) -> f64 {
        let share = |side: &Vec3| ((p - self.0).dot(side) / side.norm_squared()).clamp(0.0, 1.0);
        (p - self.0 - self.1 * share(&self.1) - self.2 * share(&self.2)).norm()
    }
}

/// What is scanned: pieces, the lower half of a pipe of radius 0.5 m along x, or half a ball on the ground.
enum Body {
    Pieces(Vec<Piece>),
    HalfPipe,
    Boulder,
}

/// Radius of the boulder [m].
const BOULDER: f64 = 0.2;

impl Body {
    fn area(&self) -> f64 {
        match self {
            Body::Pieces(all) => all.iter().map(Piece::area).sum(),
            Body::HalfPipe => std::f64::consts::PI * 0.5 * 2.0,
            Body::Boulder => 4.0 + std::f64::consts::PI * BOULDER * BOULDER,
        }
    }

    /// An even place from chance.
    fn place(&self, random: &mut Random) -> Vec3 {
        let (s, t) = (random.next(), random.next());
        match self {
            Body::HalfPipe => {
                let (sin, cos) = (std::f64::consts::PI * (1.0 + t)).sin_cos();
                Vec3::new(2.0 * s - 1.0, 0.5 * cos, 0.5 * sin)
            }
            Body::Boulder => loop {
                // Archimedes: even in height is even on a ball; half of the places are on the boulder's disc of ground.
                if random.next() * self.area() < 2.0 * std::f64::consts::PI * BOULDER * BOULDER {
                    let (z, turn) = (BOULDER * s, std::f64::consts::TAU * t);
                    let r = (BOULDER * BOULDER - z * z).sqrt();
                    return Vec3::new(r * turn.cos(), r * turn.sin(), z);
                }
                let p = Vec3::new(2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0, 0.0);
                if p.norm() > BOULDER {
                    return p;
                }
            },
            Body::Pieces(all) => {
                let mut left = random.next() * self.area();
                let of = all.iter().find(|piece| {
                    left -= piece.area();
                    left < 0.0
                });
                let Piece(corner, a, b) = *of.unwrap_or(&all[0]);
                corner + a * s + b * t
            }
        }
    }

    fn off(&self, p: &Vec3) -> f64 {
        match self {
            Body::HalfPipe if p.z <= 0.0 => (p.y.hypot(p.z) - 0.5).abs(),
            Body::HalfPipe => (p.y.abs() - 0.5).hypot(p.z),
            Body::Boulder => (p.norm() - BOULDER).abs().min(p.z.abs()),
            Body::Pieces(all) => all.iter().map(|piece| piece.off(p)).fold(f64::INFINITY, f64::min),
        }
    }
}

/// Scans the body with noise but for what is `open`, and fills it.
fn filled(body: &Body, open: impl Fn(&Vec3) -> bool) -> (usize, Filled) {
    filled_with(body, open, false)
}

fn filled_with(body: &Body, open: impl Fn(&Vec3) -> bool, bridge: bool) -> (usize, Filled) {
    let mut random = Random(7);
    let count = (body.area() / (SPACING * SPACING)) as usize;
    let mut points = Vec::new();
    for _ in 0..count {
        let p = body.place(&mut random);
        if !open(&p) {
            points.push(p + Vec3::new(random.normal(), random.normal(), random.normal()) * NOISE);
        }
    }
    let scanned = points.len();
    let cloud = Cloud { attributes: Table::with_rows(scanned), points, ..Cloud::default() };
    (scanned, cloud::fill(cloud, &Settings { max_hole: Some(0.6), bridge, ..Settings::default() }).unwrap())
}

/// The hole is closed, within its bounds, and what was added lies on the body: root mean square of its distance over the noise.
fn closes(name: &str, body: &Body, middle: Vec3, radius: f64, open: impl Fn(&Vec3) -> bool) -> f64 {
    let (scanned, filled) = filled(body, &open);
    let added = &filled.cloud.points[scanned..];
    let stray = added.iter().filter(|p| (*p - middle).norm() > radius + 3.0 * SPACING).count();
    assert_eq!(
        stray,
        0,
        "{name}: {stray} of {} points beside the hole: {:?}",
        added.len(),
        filled.report.holes
    );
    let mut random = Random(5);
    let places = (0..40_000).map(|_| body.place(&mut random)).filter(|p| open(p));
    let bare = places.filter(|place| !filled.cloud.points.iter().any(|p| (p - place).norm() < 3.5 * SPACING));
    assert!(filled.report.holes.iter().all(|h| !h.between), "{name}: {:?}", filled.report.holes);
    assert_eq!(bare.count(), 0, "{name}: places of the hole have nothing near; {:?}", filled.report.holes);
    let squares: f64 = added.iter().map(|p| body.off(p).powi(2)).sum();
    let off = (squares / added.len() as f64).sqrt() / NOISE;
    println!("{name}: {} added, {off:.2} of the noise off", added.len());
    off
}

fn in_ball(middle: Vec3, radius: f64) -> impl Fn(&Vec3) -> bool {
    move |p| (p - middle).norm() < radius
}

fn square(z: f64) -> Piece {
    Piece(Vec3::new(-1.0, -1.0, z), Vec3::x() * 2.0, Vec3::y() * 2.0)
}

/// A plate scanned from both sides: the hole of one side is closed on that side, where the other side is as far away as the hole is wide.
/// Nearer, it counts as what covers the hole.
#[test]
fn thin_plate() {
    let body = Body::Pieces(vec![square(0.0), square(-0.26)]);
    let hole = in_ball(Vec3::zeros(), 0.12);
    let off = closes("plate of 0.26 m, hole of 0.24 m", &body, Vec3::zeros(), 0.12, hole);
    assert!(off < 1.0, "{off} of the noise");
}

/// A hole beside a right-angled edge is closed flat; one across a blunt edge is closed, too, and the edge in it is rounded.
#[test]
fn sharp_edge() {
    let wall = |angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        Piece(Vec3::new(-1.0, -1.0, 0.0), Vec3::y() * 2.0, Vec3::new(cos, 0.0, sin))
    };
    let body = Body::Pieces(vec![square(0.0), wall(90.0)]);
    let beside = Vec3::new(-0.7, 0.0, 0.0);
    let off = closes("hole 0.18 m beside an edge", &body, beside, 0.12, in_ball(beside, 0.12));
    assert!(off < 1.0, "beside: {off} of the noise");
    let (body, across) = (Body::Pieces(vec![square(0.0), wall(120.0)]), Vec3::new(-1.0, 0.0, 0.0));
    let off = closes("hole across an edge of 120°", &body, across, 0.12, in_ball(across, 0.12)) * NOISE;
    // The chord between its ends is 0.12 cos 60° off the edge: what bends least comes nearer.
    assert!(off < 0.5 * 0.06, "across: {off} m");
}

/// Three sheets along a line, a hole in one of them: the line, where no surface is a sheet, has no hole.
#[test]
fn sheets_that_meet() {
    let up = Piece(Vec3::new(0.0, -1.0, 0.0), Vec3::y() * 2.0, Vec3::z());
    let body = Body::Pieces(vec![square(0.0), up]);
    let middle = Vec3::new(0.0, 0.2, 0.5);
    let off = closes("hole in a fin on a plate", &body, middle, 0.12, in_ball(middle, 0.12));
    assert!(off < 1.0, "{off} of the noise");
}

/// A chute is open above and at both ends: its rim is no hole.
#[test]
fn open_chute() {
    let middle = Vec3::new(0.1, 0.0, -0.5);
    let off = closes("hole in a half pipe", &Body::HalfPipe, middle, 0.12, in_ball(middle, 0.12));
    assert!(off < 1.0, "{off} of the noise");
    let (scanned, filled) = filled(&Body::HalfPipe, |_| false);
    assert_eq!(
        filled.cloud.points.len(),
        scanned,
        "nothing is added to a whole chute: {:?}",
        filled.report.holes
    );
}

/// A boulder on the ground, scanned from one side, and its shadow: the far side of the boulder and the ground behind it are two surfaces. Nothing is
/// added between them unless asked for.
#[test]
fn shadow_of_a_boulder() {
    let body = Body::Boulder;
    let shadow = |p: &Vec3| p.x > 0.0 && p.x < 0.35 && p.y.abs() < BOULDER;
    for bridge in [false, true] {
        let (scanned, filled) = filled_with(&body, shadow, bridge);
        let (added, holes) = (filled.cloud.points.len() - scanned, &filled.report.holes);
        assert!(holes.len() == 1 && holes[0].between && holes[0].step > Some(0.5), "{holes:?}");
        assert_eq!(
            (added > 100, added == 0, holes[0].open),
            (bridge, !bridge, !bridge),
            "{added}: {holes:?}"
        );
    }
}
