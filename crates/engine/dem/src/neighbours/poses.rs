//! Where walls are: now, when neighbours were listed, and counted back into a periodic box.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::state::State;
use crate::walls::WallBody;
use geom::Vec3;
use geom::motion::Pose;
use laws::space::images::{Periods, WallImages};

/// Where a wall is at `time` [s], which is now.
pub fn pose(model: &Model, state: &State, wall: usize, time: f64) -> Pose {
    let WallBody { motion, servo, mount, .. } = &model.walls[wall];
    let pose = motion.pose(time);
    if let (Some(servo), Some(p)) = (servo, state.servos.get(wall)) {
        return pose.shifted(servo.direction * p.shift, servo.direction * p.governor.speed);
    }
    match (mount, state.mounts.get(wall)) {
        (Some(mount), Some(p)) => pose.shifted(mount.direction * p.shift, mount.direction * p.speed),
        _ => pose,
    }
}

/// Where a wall was when neighbours were listed.
pub fn pose_listed(model: &Model, state: &State, wall: usize) -> Pose {
    let WallBody { motion, servo, mount, .. } = &model.walls[wall];
    let pose = motion.pose(state.listing.step as f64 * model.dt);
    let by_servo = servo.as_ref().zip(state.servos.get(wall)).map(|(s, p)| s.direction * p.listed);
    let by_mount = mount.as_ref().zip(state.mounts.get(wall)).map(|(m, p)| m.direction * p.listed);
    by_servo.or(by_mount).map_or(pose, |by| pose.shifted(by, Vec3::zeros()))
}

/// How far a wall may have moved [m] in the time `since` [s] neighbours were listed.
pub fn wall_shift(model: &Model, state: &State, wall: usize, since: f64) -> f64 {
    let shift = state.servos.get(wall).map_or(0.0, |p| (p.shift - p.listed).abs());
    let vibrated = state.mounts.get(wall).map_or(0.0, |p| (p.shift - p.listed).abs());
    model.walls[wall].fastest_driven() * since + shift + vibrated
}

/// Where a wall is now, counted back into the box.
pub fn pose_in_box(model: &Model, state: &State, lists: &NeighbourLists, wall: usize, time: f64) -> Pose {
    shift_into_box(model, lists, wall, pose(model, state, wall, time))
}

/// A pose of a wall, counted back into the box.
pub fn shift_into_box(model: &Model, lists: &NeighbourLists, wall: usize, pose: Pose) -> Pose {
    let Some(back) = lists.wall_periods.get(wall).filter(|n| **n != [0; 3]) else { return pose };
    let period = model.cell().lengths();
    let by = Vec3::from([0, 1, 2].map(|a| -f64::from(back[a]) * period[a]));
    pose.shifted(by, Vec3::zeros())
}

/// Whole periods that the middle of each wall was away from the box when neighbours were listed; none where nothing is
/// periodic.
pub fn periods_travelled(model: &Model, state: &State) -> Vec<Periods> {
    let period = model.cell().lengths();
    if period == Vec3::zeros() {
        return Vec::new();
    }
    let middle = Vec3::from(model.setup.periodic.map(|p| p.map_or(0.0, |(lo, hi)| 0.5 * (lo + hi))));
    let whole = |shift: f64, period: f64| if period > 0.0 { (shift / period).round() as i32 } else { 0 };
    let of = |w: usize| {
        let (point, home) = model.walls[w].anchor_points(middle);
        let away = pose_listed(model, state, w).position(&point) - home;
        [0, 1, 2].map(|a| whole(away[a], period[a]))
    };
    (0..model.walls.len()).map(of).collect()
}

/// Where the images of a wall may be met.
pub fn around(model: &Model, wall: usize, pose: &Pose) -> WallImages {
    let [lo, hi] = model.walls[wall].bounds;
    let period = model.cell().lengths();
    if !lo.iter().all(|x| x.is_finite()) {
        return WallImages { period, lo, hi };
    }
    let corner =
        |k: usize| pose.position(&Vec3::from([0, 1, 2].map(|a| if k >> a & 1 == 1 { hi[a] } else { lo[a] })));
    let (lo, hi) = (1..8).map(corner).fold((corner(0), corner(0)), |(l, h), c| (l.inf(&c), h.sup(&c)));
    WallImages { period, lo, hi }
}
