//! Shadows: what does not see the lamp. The spheres are drawn once more from the lamp, far away, and a place is in the
//! shadow where that drawing has something nearer (L. Williams 1978, SIGGRAPH 12, 270).

use super::{
    joined::Joined,
    joined_bodies::JoinedBodies,
    lens::Lens,
    rod::Rod,
    splat::{Met, NOTHING, splat},
};
use geom::Vec3;

/// Side of the drawing from the lamp [sample].
const SIZE: usize = 2048;

/// How far a shadow reaches, in usual radii [–]: it shows what rests on what; a jet high above a floor darkens nothing.
const REACH: f64 = 14.0;

/// How much of the lamp a full shadow takes [–]; the rest comes from around.
const DEEP: f32 = 0.8;

/// How far around a place the lamp is looked for, for soft edges [sample].
const SOFT: f64 = 1.3;

/// Direction to the lamp: right, up, forward (unit length).
pub const LAMP: [f32; 3] = [-0.424, 0.707, -0.566];

/// A drawing from the lamp.
pub struct Shadow {
    lamp: Lens,
    /// Distance of the nearest sphere [m]; infinite where there is none; empty without spheres.
    depth: Vec<f32>,
    /// The body of that sphere, or [`NOTHING`]; empty without bodies.
    body: Vec<u32>,
    /// Side of a sample [m].
    fine: f64,
    /// How far a shadow reaches [m].
    reach: f64,
}

impl Shadow {
    /// The shadows that spheres cast, usually of `usual` radius [m], under the lamp of an eye, in the ball around what
    /// is looked at (middle and radius [m]).
    pub fn of(
        spheres: &Joined,
        rods: &[Rod],
        joined: &JoinedBodies,
        usual: f64,
        eye: &Lens,
        (middle, radius): (Vec3, f64),
    ) -> Shadow {
        let [right, up, forward] = LAMP.map(f64::from);
        let towards = (eye.place([right, up, forward]) - eye.eye).normalize();
        let lamp = Lens::far(middle, radius, towards, SIZE);
        let fine = 2.0 * radius / SIZE as f64;
        let mut drawn = splat(spheres, rods, &lamp);
        drawn.hold([0, SIZE], spheres, &lamp);
        let body_at = |at| drawn.number(at).and_then(|n| joined.of(n)).unwrap_or(NOTHING);
        let body = if joined.is_empty() { Vec::new() } else { (0..SIZE * SIZE).map(body_at).collect() };
        Shadow { lamp, depth: drawn.all(), body, fine, reach: REACH * usual }
    }

    /// How much of the lamp a point of what was met sees, 0 to 1; it and its normal are as seen by `eye`. A body casts no
    /// shadow on itself: its spheres would, along the lines between them.
    pub fn lit(&self, eye: &Lens, point: [f64; 3], met: &Met, at: [usize; 2]) -> f32 {
        if self.depth.is_empty() {
            return 1.0;
        }
        let slack = 0.05 * met.radius + 1.5 * self.fine;
        let outside = std::array::from_fn(|k| point[k] + slack * f64::from(met.normal[k]));
        let [x, y, z] = self.lamp.seen(eye.place(outside));
        let column = self.lamp.centre[0] + self.lamp.focal * x / z;
        let row = self.lamp.centre[1] - self.lamp.focal * y / z;
        // The four samples of a pixel look to different sides.
        let turn = [[1.0, 0.5], [-0.5, 1.0], [0.5, -1.0], [-1.0, -0.5]][at[0] % 2 + 2 * (at[1] % 2)];
        let shade = |side: f64| {
            let (x, y) = (column + SOFT * side * turn[0], row + SOFT * side * turn[1]);
            let inside = x >= 0.0 && y >= 0.0 && x < SIZE as f64 && y < SIZE as f64;
            let place = if inside { y as usize * SIZE + x as usize } else { 0 };
            let own = met.body.is_some() && self.body.get(place).copied() == met.body;
            let above = if inside && !own { z - f64::from(self.depth[place]) } else { 0.0 };
            if above > slack { (1.0 - above / self.reach).max(0.0) as f32 } else { 0.0 }
        };
        1.0 - DEEP * (shade(1.0) + shade(0.15) + shade(-0.7)) / 3.0
    }
}
