//! Where walls end in the direction of gravity: what is farther has fallen past all of them, and falls for ever.

use crate::error::Result;
use crate::keys::Outside;
use crate::plan::builder::PlanBuilder;
use dem::setup::{Wall, WallShape, Zone, ZoneMotion, ZoneTest};
use geom::{Plane, Vec3};

/// Instants at which walls that move are looked at, besides the first.
const INSTANTS: u32 = 512;

/// How far walls reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Below {
    /// Direction of gravity [–].
    pub down: Vec3,
    /// How far along it any wall reaches at any time [m].
    pub depth: f64,
}

impl PlanBuilder<'_> {
    /// Adds the outlet of `domain.outside = "remove"`.
    pub(in crate::plan) fn outside(&mut self) -> Result<()> {
        if self.keys().domain.outside != Outside::Remove {
            return Ok(());
        }
        let below = match self.below() {
            Ok(below) => below,
            Err(why) => {
                let cure = "leave it out, or give an [[outlet]] where grains leave";
                return Err(self.check.wrong("domain.outside", "\"remove\"".to_owned(), why, cure));
            }
        };
        let largest = 2.0 * self.sizes().map_or(0.0, |s| s.largest).max(self.widest_clump());
        let plane = Plane { point: below.down * (below.depth + largest), normal: below.down };
        let (motion, test) = (ZoneMotion::default(), ZoneTest::default());
        self.outlets.push(Zone { plane, length: 1.2 * largest, motion, test, when_blocked: None });
        Ok(())
    }

    /// How far walls reach, or why nothing falls past them, or it is not known where.
    pub(in crate::plan) fn below(&self) -> std::result::Result<Below, &'static str> {
        let keys = self.keys();
        let Some(down) = Vec3::from(keys.gravity).try_normalize(0.0) else {
            return Err("nothing falls without gravity");
        };
        if keys.domain.periodic.iter().any(|a| down[*a as usize].abs() > 1e-9) {
            return Err("grains that fall come back: gravity has a component along a periodic axis");
        }
        if self.walls.is_empty() {
            return Err("there is no wall to fall off");
        }
        let holds = |w: &Wall| matches!(&w.shape, WallShape::Plane(plane) if plane.normal.dot(&down) < -1e-9);
        if self.walls.iter().any(holds) {
            return Err("nothing falls past an unbounded plane below");
        }
        if self.walls.iter().any(|w| w.servo.is_some() || w.mount.is_some()) {
            return Err("where a wall with a servo or a spring will be is not known");
        }
        let until = keys.time.until.unwrap_or(0.0);
        let depth = self.walls.iter().map(|w| reach(w, &down, until)).fold(f64::NEG_INFINITY, f64::max);
        if depth.is_finite() { Ok(Below { down, depth }) } else { Err("no wall has an end below") }
    }
}

/// How far a wall reaches along `down` until a time [s].
fn reach(wall: &Wall, down: &Vec3, until: f64) -> f64 {
    let (low, high) = match &wall.shape {
        WallShape::Plane(_) => return f64::NEG_INFINITY,
        WallShape::Mesh(mesh) => geom::grid::bounds(&mesh.vertices),
        WallShape::Spheres(spheres) => {
            let nothing = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
            spheres.iter().fold(nothing, |(low, high), (centre, radius)| {
                (low.inf(&centre.add_scalar(-radius)), high.sup(&centre.add_scalar(*radius)))
            })
        }
    };
    let corner = |k: usize| Vec3::from([0, 1, 2].map(|a| if k >> a & 1 == 0 { low[a] } else { high[a] }));
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    let count = if wall.motion.moves() { INSTANTS } else { 0 };
    let at = |k: u32| {
        let pose = wall.motion.pose(until * f64::from(k) / f64::from(INSTANTS));
        corners.iter().map(|c| pose.position(c).dot(down)).fold(f64::NEG_INFINITY, f64::max)
    };
    (0..=count).map(at).fold(f64::NEG_INFINITY, f64::max)
}
