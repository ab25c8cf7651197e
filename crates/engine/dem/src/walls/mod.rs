//! Walls: a shape × a motion, yielding contact points that are rows like a particle's.
//!
//! A wall sphere is its centre and radius; a plane or a triangle is the point of it that is nearest to the particle, with radius
//! 0. A wall has no mass of its own in a contact (1/m = 0, so m* = m_i). Across a periodic face its images act: the partner
//! of a contact tells part and image ([`laws::space::images`]).
//!
//! The surface of a belt moves on its wall, which stays where it is: at a contact with the normal n a contact point has the velocity of the wall
//! plus v_s − (v_s·n) n, with v_s that of the surface there. So a belt drives along itself and never pushes.

pub(crate) mod beside;
mod parts;
pub(crate) mod remembered;
mod triangles;

use crate::setup::{Mount, Servo, Wall, WallShape};
use crate::space::wall_sphere_order;
use crate::walls::remembered::HistorySlots;
pub use crate::walls::triangles::{Nearby, Triangles};
use geom::motion::{Pose, SurfaceMotion};
use geom::{Grid, Motion, Plane, Vec3};
use laws::contact::seams;
use laws::contact::wall_point::WallPose;
use laws::simd::{Row, Row4};
use laws::space::images::Image;
use laws::space::sphere::{FAR, is_away};

/// A wall, ready to be met.
#[derive(Debug, Clone)]
pub struct WallBody {
    /// Prescribed motion.
    pub motion: Motion,
    /// The force that it follows besides.
    pub servo: Option<Servo>,
    /// The spring that holds it.
    pub mount: Option<Mount>,
    surface: Surface,
    /// How its surface moves on it, as that of a belt.
    belt: Option<SurfaceMotion>,
    /// Upper bound of the speed of its prescribed motion [m/s].
    driven: f64,
    /// The same of its surface on it [m/s].
    belt_speed: f64,
    /// Largest gap at which a contact that was made still acts [m].
    reach: f64,
    /// How far ahead in time contacts are looked for [s].
    ahead: f64,
    /// Lowest and highest corner at t = 0 [m].
    pub bounds: [Vec3; 2],
    /// Meshes that keep their place beside this one: one surface together ([`beside`]).
    beside: Vec<usize>,
}

#[derive(Debug, Clone)]
enum Surface {
    /// In the grid's sorted order.
    Spheres {
        centres: Vec<Vec3>,
        radii: Vec<f64>,
        grid: Grid,
        largest: f64,
        original: Vec<u32>,
    },
    Plane(Plane),
    Triangles(Triangles),
}

impl WallBody {
    /// Sorts wall spheres into their own grid and triangles into their tree, once; contacts act up to a gap of `reach` [m], and are looked for a time `ahead` [s].
    pub fn new(wall: &Wall, reach: f64, ahead: f64) -> WallBody {
        let surface = match &wall.shape {
            WallShape::Spheres(spheres) => sorted_spheres(spheres),
            WallShape::Plane(plane) => Surface::Plane(*plane),
            WallShape::Mesh(mesh) => Surface::Triangles(Triangles::new(mesh.triangles().collect())),
        };
        let span = |axis: &Vec3| span(&wall.shape, axis);
        WallBody {
            driven: wall.motion.fastest(span),
            belt: Some(wall.surface).filter(SurfaceMotion::moves),
            belt_speed: wall.surface.fastest(span(&wall.surface.through)),
            motion: wall.motion.clone(),
            servo: wall.servo.clone(),
            mount: wall.mount,
            bounds: bounds(&surface),
            beside: Vec::new(),
            surface,
            reach,
            ahead,
        }
    }

    /// Whether it moves at all.
    pub fn moves(&self) -> bool {
        self.motion.moves() || self.answers()
    }

    /// Whether forces of the particles move it.
    pub fn answers(&self) -> bool {
        self.servo.is_some() || self.mount.is_some()
    }

    /// Whether it, or its surface on it, moves at all: it may then move what rests on it.
    pub fn drives(&self) -> bool {
        self.moves() || self.belt.is_some()
    }

    /// Whether it or its surface is in motion at `time` [s], or follows a force.
    pub fn drives_at(&self, time: f64) -> bool {
        self.answers() || self.belt.is_some() || (self.motion.moves() && self.motion.runs(time))
    }

    /// Whether contact points must be found in each step.
    pub fn refreshes(&self) -> bool {
        self.flat() || self.drives()
    }

    /// Whether its contact points belong to a flat surface.
    pub fn flat(&self) -> bool {
        !matches!(self.surface, Surface::Spheres { .. })
    }

    /// Upper bound of the speed of its surface [m/s].
    pub fn fastest(&self) -> f64 {
        let servo = self.servo.as_ref().map(|s| s.speed_limit);
        self.fastest_driven() + servo.or(self.mount.map(|m| m.speed_limit)).unwrap_or(0.0)
    }

    /// The same without a servo or a spring.
    pub fn fastest_driven(&self) -> f64 {
        self.driven
    }

    /// Upper bound of the speed of its surface on it [m/s]; 0: no belt.
    pub fn belt_speed(&self) -> f64 {
        self.belt_speed
    }

    /// A point of the wall at t = 0, and where it is to be near [m]: its middle in the middle of the box, a plane where it
    /// began, so that no more than must be is behind it.
    pub fn anchor_points(&self, middle: Vec3) -> (Vec3, Vec3) {
        match &self.surface {
            Surface::Plane(plane) => (plane.point, plane.point),
            _ => ((self.bounds[0] + self.bounds[1]) * 0.5, middle),
        }
    }

    /// How much farther than it touches a particle of `radius` [m] is listed with it [m]: which points of a mesh are contacts depends on those nearby.
    pub fn room(&self, radius: f64) -> f64 {
        if self.triangles().is_some() { seams::room(radius, self.reach) } else { 0.0 }
    }

    /// Wall spheres: centre and radius [m], in the order they were given.
    pub fn spheres(&self, pose: &Pose) -> Vec<(Vec3, f64)> {
        let Surface::Spheres { centres, radii, original, .. } = &self.surface else { return Vec::new() };
        let mut out = vec![(Vec3::zeros(), 0.0); centres.len()];
        for (k, &o) in original.iter().enumerate() {
            out[o as usize] = (pose.position(&centres[k]), radii[k]);
        }
        out
    }

    /// Parts of the wall, as at t = 0, within `reach` [m] of `p`, in order; of an image of it when `image`.
    pub fn parts_near(&self, p: Vec3, reach: f64, image: bool, mut found: impl FnMut(u32)) {
        match &self.surface {
            Surface::Spheres { centres, radii, grid, largest, .. } => {
                for k in grid.runs_near(p, reach + largest).flatten() {
                    let close = reach + radii[k];
                    if (centres[k] - p).norm_squared() < close * close {
                        found(k as u32);
                    }
                }
            }
            Surface::Plane(plane) => {
                // Behind a plane is where it is to be noticed; behind its image is the next period.
                let distance = plane.signed_distance(&p);
                if distance < reach && (!image || distance > -reach) {
                    found(0);
                }
            }
            Surface::Triangles(triangles) => triangles.near(p, reach, found),
        }
    }

    /// The wall in a pose, with what its surface does on it.
    pub fn pose(&self, pose: &Pose) -> WallPose {
        WallPose::new(*pose, self.belt.as_ref().map(|belt| pose.surface(belt)))
    }

    /// Centre [m] and radius [m] of each wall sphere as at t = 0, in the order of the grid that they are found by; `None` of other walls.
    pub fn sorted_spheres(&self) -> Option<(impl Iterator<Item = (Vec3, f64)>, &Grid)> {
        let Surface::Spheres { centres, radii, grid, .. } = &self.surface else { return None };
        Some((centres.iter().copied().zip(radii.iter().copied()), grid))
    }

    /// Largest radius of its spheres [m]; 0 of other walls.
    pub fn largest(&self) -> f64 {
        if let Surface::Spheres { largest, .. } = &self.surface { *largest } else { 0.0 }
    }

    /// Largest gap at which a contact that was made still acts [m].
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Numbers of the walls that are one surface with this one, itself among them; none where no other is.
    pub fn surface_of(&self, own: usize) -> Vec<u32> {
        let mut all = self.beside.clone();
        if !all.is_empty() {
            all.push(own);
            all.sort_unstable();
        }
        all.into_iter().map(|wall| wall as u32).collect()
    }

    /// Its triangles; `None` of other walls.
    pub fn triangles(&self) -> Option<&Triangles> {
        if let Surface::Triangles(triangles) = &self.surface { Some(triangles) } else { None }
    }

    /// As a plane at t = 0; `None` of other walls.
    pub fn plane(&self) -> Option<&Plane> {
        if let Surface::Plane(plane) = &self.surface { Some(plane) } else { None }
    }

    /// Contact points of one particle, whose position and radius are `row`, on the wall in a pose, number `own` of `walls`: `partners` are all that it may
    /// touch.
    pub fn contact_points(
        &self,
        (walls, own): (&[WallBody], usize),
        (wall, period): (&WallPose, &Vec3),
        row: &Row,
        partners: &[u32],
        (rows, spins): (&mut [Row], &mut [Row4]),
        (mut slots, nearby): (HistorySlots, &mut Nearby),
    ) {
        if is_away(row) {
            rows.fill(FAR[0]);
            spins.fill(Row4::default());
            return;
        }
        let centre = row.position();
        let count = self.parts();
        let part = |k: usize| (partners[k] % count) as usize;
        let shift = |k: usize| Image(partners[k] / count).shift(period);
        let pose = &wall.pose;
        let mut put = |k: usize, position: Vec3, radius: f64| {
            let (row, spin) = wall.row(position, radius, shift(k), centre);
            rows[k] = row;
            if let Some(own) = spins.get_mut(k) {
                *own = spin;
            }
        };
        match &self.surface {
            Surface::Spheres { centres, radii, .. } => {
                (0..partners.len()).for_each(|k| put(k, pose.position(&centres[part(k)]), radii[part(k)]));
            }
            Surface::Plane(plane) => {
                for k in 0..partners.len() {
                    put(k, wall.on_plane([plane.point, plane.normal], centre - shift(k)), 0.0);
                }
            }
            Surface::Triangles(Triangles { corners, .. }) => {
                let local = |k: usize| pose.home(&(centre - shift(k)));
                let way = if self.ahead > 0.0 {
                    self.ahead * (row.velocity().norm() + self.fastest())
                } else {
                    0.0
                };
                let reach = self.reach + way;
                let image = |k: usize| (partners[k], local(k));
                let all = (0..partners.len()).map(|k| (corners[part(k)], local(k)));
                let near = nearby.find(all, (walls, own), image, (row.radius(), reach));
                slots.take_over(near, row.radius());
                for (k, point) in near.iter().enumerate() {
                    // What is no contact of its own is put out of reach.
                    let far = Vec3::repeat(FAR[1][0]);
                    put(k, if point.counts { pose.position(&(local(k) + point.way)) } else { far }, 0.0);
                }
            }
        }
    }
}

/// Largest distance of a wall's points from a point of an axis [m]; 0 of a plane, which turns in itself.
fn span(shape: &WallShape, axis: &Vec3) -> f64 {
    match shape {
        WallShape::Spheres(s) => s.iter().map(|(c, r)| (c - axis).norm() + r).fold(0.0, f64::max),
        WallShape::Plane(_) => 0.0,
        WallShape::Mesh(mesh) => mesh.vertices.iter().map(|v| (v - axis).norm()).fold(0.0, f64::max),
    }
}

fn sorted_spheres(spheres: &[(Vec3, f64)]) -> Surface {
    let (order, largest) =
        (wall_sphere_order::order_of_spheres(spheres), wall_sphere_order::largest_of(spheres));
    let centres: Vec<Vec3> = order.iter().map(|&k| spheres[k as usize].0).collect();
    let grid = Grid::new(&centres, wall_sphere_order::cell_of_spheres(spheres));
    let radii = order.iter().map(|&k| spheres[k as usize].1).collect();
    Surface::Spheres { centres, radii, grid, largest, original: order }
}

/// Lowest and highest corner; a plane has none along the axes that lie in it, so that it has no image there.
fn bounds(surface: &Surface) -> [Vec3; 2] {
    match surface {
        Surface::Spheres { centres, radii, .. } => {
            let (lo, hi) = geom::grid::bounds(centres);
            let largest = Vec3::repeat(radii.iter().copied().fold(0.0, f64::max));
            [lo - largest, hi + largest]
        }
        Surface::Plane(plane) => {
            let across = plane.normal.map(|n| if n.abs() > 1e-9 { f64::INFINITY } else { f64::NAN });
            [-across, across]
        }
        Surface::Triangles(triangles) => triangles.boxes.bounds(),
    }
}

#[cfg(test)]
mod tests;
