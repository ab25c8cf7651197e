//! What keeps a particle awake that would be at rest by itself: a wall that moves, or a particle that moves, touches it.
//!
//! Forces alone do not tell: friction of a belt on a grain is capped at μ times its weight, which may be less than what wakes it.

use crate::model::{Model, With};
use crate::neighbours::{Disturber, Slots};
use crate::state::{Particles, Sleepers};
use geom::Vec3;
use laws::contact::WrenchSlices;
use laws::simd::{BLOCK, Layout};

/// Which particles and which walls move in this step.
pub struct Movers {
    particles: Vec<bool>,
    walls: Vec<bool>,
}

impl Movers {
    /// Those of an instant [s]: particles that are awake and no slower than the speed of sleep, walls in motion, with a surface in motion or with a servo.
    pub fn new(model: &Model, particles: &Particles, sleepers: &Sleepers, time: f64) -> Movers {
        let moves = |k: usize| !sleepers.sleeps(k) && particles.surface_speed(k) >= sleepers.speed;
        Movers {
            particles: (0..particles.len()).map(moves).collect(),
            walls: model.walls.iter().map(|w| w.drives_at(time)).collect(),
        }
    }
}

/// What of that touches a particle.
#[derive(Clone, Copy)]
pub struct Stirred<'a> {
    pub movers: &'a Movers,
    pub lists: &'a Slots,
    /// Force of each contact.
    pub wrenches: WrenchSlices<'a>,
    pub layout: Layout,
}

impl Stirred<'_> {
    /// Whether a particle touches something that moves.
    pub fn touches(&self, particle: usize) -> bool {
        self.lists.of_particle(particle).iter().any(|&end| {
            let slot = end.slot();
            let moves = match self.lists.met[slot / BLOCK] {
                Disturber::StillWall => false,
                Disturber::Particles => self.movers.particles[self.lists.other(end) as usize],
                Disturber::MovingWall => match self.lists.segment_of(slot).with {
                    With::Wall(w) => self.movers.walls[w],
                    With::Particles | With::Images => false,
                },
            };
            moves && self.layout.force_at(self.wrenches.forces, slot) != Vec3::zeros()
        })
    }
}
