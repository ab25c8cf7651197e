//! Where the motion of a zone has brought a particle.

use crate::setup::Particle;
use crate::space::rotation::spun;
use geom::Vec3;

/// Shift [m], velocity [m/s] and acceleration [m/s²] of a zone particle at one instant.
#[derive(Clone, Copy, Default)]
pub struct Kinematics {
    pub shift: Vec3,
    pub velocity: Vec3,
    pub acceleration: Vec3,
    pub spin: Vec3,
}

impl Kinematics {
    /// After `tau` [s] from a velocity, with a spin that stays. Before its time it comes along a straight line, listed but hidden.
    pub fn after(tau: f64, start: &Particle, acceleration: Vec3) -> Kinematics {
        let Particle { velocity, spin, .. } = *start;
        if tau < 0.0 {
            return Kinematics { shift: velocity * tau, velocity, acceleration: Vec3::zeros(), spin };
        }
        let shift = velocity * tau + acceleration * (0.5 * tau * tau);
        Kinematics { shift, velocity: velocity + acceleration * tau, acceleration, spin }
    }

    /// Of a point that was this far from the centre [m] before the clump turned for `tau` [s].
    pub(crate) fn about(self, arm: &Vec3, tau: f64) -> Kinematics {
        if self.spin == Vec3::zeros() || tau < 0.0 {
            return self;
        }
        self.around(arm, &(spun(&(self.spin * tau)) * arm))
    }

    /// Of a point that was at `arm` from the centre [m], and is at `r`.
    pub(crate) fn around(self, arm: &Vec3, r: &Vec3) -> Kinematics {
        let spin = self.spin;
        let (around, inwards) = (spin.cross(r), spin.cross(&spin.cross(r)));
        Kinematics {
            shift: self.shift + (r - arm),
            velocity: self.velocity + around,
            acceleration: self.acceleration + inwards,
            spin,
        }
    }
}
