//! Walls that follow a force: a piston that pushes along its direction until the contacts push back as much.
//!
//! ```text
//! s' = G (F − P), |s'| ≤ speed limit        P: force of the wall on the particles along its direction
//! G  = α / (N (k Δt + c)),  α = 1/2          N contacts that push, k and c the stiffest of them
//! s_{n+1} = s_n + s'_{n+1} Δt                s'_{n+1} from the loads of step n
//! ```
//!
//! The servo mechanism of Cundall, as described for PFC (Itasca: G = α A / (k N Δt)), with the dashpots of the contacts in the
//! gain. Loads see s and s' of the step before: s'_{n+1} = G (F − K s_n − C s'_n) with K = N k, C = N c turns unstable by an eigenvalue of −1, where
//! s = s' Δt/2, at G (K Δt/2 + C) = 1: at α = 2 for springs alone, at α = 1 for dashpots alone; α = ½ is half of the least. A wall moved like this is a piston
//! without mass in a dashpot of 1/G under the constant force F: passive, so it adds no energy but its work, which the ledger has.
//! A wall that touches nothing moves at its speed limit, and stays where its force is 0. N is that of the step; k is the slope of the law at the overlap limit, so that the real gain is lower.
//!
//! P is summed in the order of the contact list: the same bits for any number of threads.

use crate::effects::Elastic;
use crate::effects::Meeting;
use crate::effects::damping_ratio;
use crate::model::crowd::met;
use crate::model::error::Halt;
use crate::model::limit::Grain;
use crate::model::limit::contact_between;
use crate::model::limit::grains;
use crate::model::limit::stiffest;
use crate::neighbours::contacts::With;
use crate::setup::Setup;
use crate::setup::Wall;
use crate::simulation::Simulation;
use crate::walls::motion::Pose;
use geom::Vec3;
use serde::Deserialize;
use serde::Serialize;

/// Share α of the gain at which one contact is answered in one step [–].
const SHARE: f64 = 0.5;

/// A force to be followed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Servo {
    /// Which way the wall pushes [–].
    pub direction: Vec3,
    /// Force of the wall on the particles along `direction` [N].
    pub force: f64,
    /// Largest speed [m/s].
    pub speed_limit: f64,
}

/// Where a servo is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Piston {
    /// Way since t = 0 along the direction [m].
    pub way: f64,
    /// Its rate [m/s].
    pub speed: f64,
    /// Way when neighbours were listed [m].
    pub listed: f64,
}

impl Piston {
    /// Whether it is anywhere.
    pub fn is_finite(&self) -> bool {
        self.way.is_finite() && self.speed.is_finite()
    }
}

/// What acts on a wall at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct WallForce {
    /// Force of the particles on the wall [N].
    pub force: Vec3,
    /// How far the wall has been shifted since t = 0 [m], its turn apart.
    pub shift: Vec3,
    /// Number of contacts.
    pub contacts: u32,
}

impl Simulation {
    /// Whether a wall follows a force.
    pub fn wall_follows(&self, wall: usize) -> bool {
        self.walls[wall].motion.servo.is_some()
    }

    /// Force on each wall, and where it is.
    ///
    /// # Errors
    /// When the state is beyond a guard, or loads are not kept ([`Simulation::record_loads`]).
    pub fn wall_forces(&mut self) -> Result<Vec<WallForce>, Halt> {
        self.ready_to_record()?;
        let time = self.time();
        let of = |w: usize| {
            let (push, contacts) = self.push(w);
            WallForce { force: -push, shift: self.pose(w, time).shift(), contacts }
        };
        Ok((0..self.walls.len()).map(of).collect())
    }

    /// Where a wall is at `time` [s], which is now.
    pub(crate) fn pose(&self, wall: usize, time: f64) -> Pose {
        let motion = &self.walls[wall].motion;
        let pose = motion.pose(time);
        match (motion.servo, self.pistons.get(wall)) {
            (Some(servo), Some(p)) => pose.shifted(servo.direction * p.way, servo.direction * p.speed),
            _ => pose,
        }
    }

    /// Where a wall was when neighbours were listed.
    pub(crate) fn pose_listed(&self, wall: usize) -> Pose {
        let motion = &self.walls[wall].motion;
        let pose = motion.pose(self.listed as f64 * self.dt);
        match (motion.servo, self.pistons.get(wall)) {
            (Some(servo), Some(p)) => pose.shifted(servo.direction * p.listed, Vec3::zeros()),
            _ => pose,
        }
    }

    /// How far a wall may have moved [m] in the time `since` [s] neighbours were listed.
    pub(crate) fn wall_way(&self, wall: usize, since: f64) -> f64 {
        let way = self.pistons.get(wall).map_or(0.0, |p| (p.way - p.listed).abs());
        self.walls[wall].fastest_driven() * since + way
    }

    /// Force of a wall on the particles [N], and how many it pushes: those in zones feel nothing, and push no wall.
    fn push(&self, wall: usize) -> (Vec3, u32) {
        let c = &self.contacts;
        let (mut sum, mut count) = (Vec3::zeros(), 0);
        for segment in c.segments.iter().filter(|s| self.kinds[s.kind].with == With::Wall(wall)) {
            let acts = |place: &usize| !self.idles(With::Wall(wall), *place);
            for force in segment.contacts().filter(acts).map(|place| c.force(place)) {
                count += u32::from(force != Vec3::zeros());
                sum += force;
            }
        }
        (sum, count)
    }

    /// Moves the servos to the next step, by the loads of this one; an error where a wall is lost by that.
    pub(crate) fn drive_pistons(&mut self) -> Result<(), Halt> {
        let mut lost = None;
        for w in 0..self.pistons.len() {
            let Some(servo) = self.walls[w].motion.servo else { continue };
            let (push, count) = self.push(w);
            let lack = servo.force - push.dot(&servo.direction);
            let gain = SHARE / (f64::from(count.max(1)) * self.answers[w]);
            let piston = &mut self.pistons[w];
            let free = if lack == 0.0 { 0.0 } else { lack.signum() * servo.speed_limit };
            let speed = if count == 0 { free } else { gain * lack };
            piston.speed = speed.clamp(-servo.speed_limit, servo.speed_limit);
            piston.way += piston.speed * self.dt;
            if !piston.is_finite() {
                lost = lost.or(Some((w, servo.force - lack)));
            }
        }
        let time = self.time() + self.dt;
        lost.map_or(Ok(()), |(w, push)| {
            let wall = self.setup.walls[w].name.clone();
            Err(Halt::WallNotANumber { time, wall, push })
        })
    }
}

/// A piston for each wall, or none where no wall follows a force.
pub fn pistons(setup: &Setup) -> Vec<Piston> {
    let any = setup.walls.iter().any(|w| w.motion.servo.is_some());
    vec![Piston::default(); if any { setup.walls.len() } else { 0 }]
}

/// k Δt + c [N·s/m] of the stiffest contact with each wall that follows a force; of a clump with the mass of the whole body, as contacts have it.
pub fn answers(setup: &Setup, dt: f64) -> Vec<f64> {
    let grains = grains(setup);
    let of = |wall: &Wall, grain: &Grain| {
        let contact = contact_between(setup, grain.material, wall.material).ok()?;
        let [first, second] = [grain.material, wall.material].map(|m| &setup.materials[m as usize]);
        let (radius, smaller) = met(wall, grain.radius);
        let at = Meeting { radius, smaller, share: setup.guards.overlap };
        let k = stiffest(contact, Elastic::of(first, second), at);
        let gamma = damping_ratio(contact.number("restitution").unwrap_or(f64::NAN));
        Some(k * dt + gamma * (k / grain.inverse_mass).sqrt())
    };
    let largest = |wall: &Wall| match wall.motion.servo {
        Some(_) => grains.iter().filter_map(|g| of(wall, g)).fold(f64::MIN_POSITIVE, f64::max),
        None => 1.0,
    };
    setup.walls.iter().map(largest).collect()
}
