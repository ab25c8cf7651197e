//! The point of a wall that a particle meets, as a row like a particle's.

use crate::simd::{Row, Row4};
use primitives::Pose;
use primitives::Vec3;

/// Where a wall is at one instant, and how its surface moves on it.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct WallPose {
    /// Where it is.
    pub pose: Pose,
    /// The motion of its surface on it, as that of a belt.
    pub belt: Pose,
    /// 1 where its surface moves on it.
    pub has_belt: u64,
}

impl WallPose {
    /// A wall whose surface moves on it, or not.
    #[inline]
    pub fn new(pose: Pose, belt: Option<Pose>) -> WallPose {
        WallPose { pose, belt: belt.unwrap_or(pose), has_belt: u64::from(belt.is_some()) }
    }

    /// The point of a plane, as at t = 0, that is nearest to `centre` now [m].
    #[inline(always)]
    pub fn on_plane(&self, [through, normal]: [Vec3; 2], centre: Vec3) -> Vec3 {
        let home = self.pose.home(&centre);
        self.pose.position(&(home - normal * (home - through).dot(&normal)))
    }

    /// Row and spin of the point at `position` [m] of a part of `radius` [m] (0: flat), whose image is shifted by `shift` [m]; `centre` is that of
    /// the particle.
    #[inline(always)]
    pub fn row(&self, position: Vec3, radius: f64, shift: Vec3, centre: Vec3) -> (Row, Row4) {
        let p = position + shift;
        let (mut v, mut turn) = (self.pose.velocity(&position), Vec3::zeros());
        if self.has_belt != 0 {
            v += along(self.belt.velocity(&position), centre - p);
            turn = self.belt.turn;
        }
        let turn = self.pose.turn + turn;
        (Row([p.x, p.y, p.z, radius, v.x, v.y, v.z, 0.0]), Row4::of(turn))
    }
}

/// The part of a velocity that is across a direction of any length, the normal of a contact.
#[inline(always)]
fn along(velocity: Vec3, normal: Vec3) -> Vec3 {
    let square = normal.norm_squared();
    if square > 0.0 { velocity - normal * (velocity.dot(&normal) / square) } else { velocity }
}
