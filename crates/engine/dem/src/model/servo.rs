//! What is fixed of servos: how stiffly each contact answers a wall, and the walls that bound an area.

use crate::model::dense_walls::met;
use crate::model::limit::{contact_between, grains, stiffest};
use crate::model::{Check, Kind, SetupError, With};
use crate::setup::clumps::SizeClass;
use crate::setup::{Length, Setup, Wall, WallShape};
use laws::effects::{Elastic, OverlapLimit, damping_ratios};

/// Levels of overlap, each half of the one before.
const LEVELS: usize = 13;

/// How stiffly the contacts of one kind answer a wall that moves, by their overlap.
#[derive(Debug, Clone, Default)]
pub struct Response {
    /// Overlap [–] of the first level, as a share of the smaller radius.
    share: f64,
    /// k Δt + c [N·s/m] up to this share of the overlap, halved with each level; empty: the kind meets no wall that answers.
    levels: Vec<f64>,
}

impl Response {
    /// k Δt + c [N·s/m] of a contact that overlaps by `share` of the smaller radius, or a little more.
    pub fn at(&self, share: f64) -> f64 {
        let mut level = 0;
        let mut bound = 0.5 * self.share;
        while level + 1 < self.levels.len() && share <= bound {
            (level, bound) = (level + 1, 0.5 * bound);
        }
        self.levels.get(level).copied().unwrap_or(f64::MIN_POSITIVE)
    }
}

/// The response of each kind of contact that meets a servo, or lies in a cell that follows a stress; of a clump with its whole mass, as contacts have it.
pub fn responses(setup: &Setup, kinds: &[Kind], dt: f64) -> Vec<Response> {
    let grains = grains(setup);
    let follows_stress = setup.strain.iter().flatten().any(|s| s.stress(0.0).is_some());
    let of = |kind: &Kind| {
        let wall = match kind.with {
            With::Wall(w) => Some(&setup.walls[w]),
            With::Particles | With::Images => None,
        };
        let answers = wall.map_or(follows_stress, |w| w.servo.is_some() || w.mount.is_some());
        if !answers {
            return Response::default();
        }
        let own = || grains.iter().filter(|g| g.material == kind.between.0);
        // Of two grains at most that of each on a plane: R* and m* are smaller.
        let (other, met) =
            (wall.map_or(kind.between.1, |w| w.material), |r: f64| wall.map_or((r, r), |w| met(w, r)));
        let at = |level: usize| {
            let share = setup.guards.overlap * 0.5f64.powi(level as i32);
            own()
                .filter_map(|g| response(setup, (g, other), met(g.radius), (share, dt)))
                .fold(f64::MIN_POSITIVE, f64::max)
        };
        Response { share: setup.guards.overlap, levels: (0..LEVELS).map(at).collect() }
    };
    kinds.iter().map(of).collect()
}

/// k Δt + c of a grain on another material at an overlap; R* and the smaller radius [m] are given.
fn response(
    setup: &Setup,
    (grain, other): (&SizeClass, u16),
    (radius, smaller): (f64, f64),
    (share, dt): (f64, f64),
) -> Option<f64> {
    let (material, inverse_mass) = (grain.material, grain.inverse_mass);
    let contact = contact_between(setup, material, other).ok()?;
    let [first, second] = [material, other].map(|m| &setup.materials[m as usize]);
    let k = stiffest(contact, Elastic::of(first, second), OverlapLimit { radius, smaller, share });
    let impedance = (k / inverse_mass).sqrt();
    let [gamma, _] = damping_ratios(contact, [impedance; 2]);
    Some(k * dt + gamma * impedance)
}

/// Refuses servos without meaning: numbers, a plane that would pull, an area that no planes bound.
pub fn check<F: Fn() -> crate::model::Subject>(
    setup: &Setup,
    wall: &Wall,
    check: &Check<F>,
) -> Result<(), SetupError> {
    let Some(s) = &wall.servo else { return Ok(()) };
    let length = s.direction.norm();
    let unit = (length - 1.0).abs() < 1e-9;
    check.within("servo.direction", length, "[–]", unit, "directions of length 1")?;
    s.target.rows().iter().try_for_each(|row| check.finite("servo.force", row[1], "N"))?;
    check.positive("servo.speed_limit", s.speed_limit, "m/s")?;
    if let WallShape::Plane(plane) = &wall.shape {
        let along = s.direction.dot(&plane.normal);
        let pushes = "directions to the side of the grains: of positive product with the plane's normal";
        check.within("servo.direction along the plane's normal", along, "[–]", along > 1e-9, pushes)?;
    }
    for side in s.area.iter().flatten() {
        match *side {
            Length::Fixed(length) => check.positive("servo.area_between", length, "m")?,
            Length::Between(a, b) => {
                let apart = face_distance(&setup.walls, a, b).unwrap_or(f64::NAN);
                let facing = "two parallel planes that face each other";
                check.within("servo.area_between", apart, "m", apart > 0.0, facing)?;
            }
        }
    }
    Ok(())
}

/// Distance at t = 0 of two planes that face each other [m]; `None` where they do not.
pub fn face_distance(walls: &[Wall], a: usize, b: usize) -> Option<f64> {
    let (WallShape::Plane(one), WallShape::Plane(other)) = (&walls.get(a)?.shape, &walls.get(b)?.shape)
    else {
        return None;
    };
    let parallel = (one.normal + other.normal).norm() < 1e-9;
    Some((other.point - one.point).dot(&one.normal)).filter(|apart| parallel && *apart > 0.0)
}
