//! Random places for whole spheres inside a shape, none of which touch.

use crate::plan::grains::images::Images;
use crate::plan::grains::obstacles::{Obstacles, Taken};
use crate::plan::grains::random::unit;
use geom::{Shape, Vec3, shape::Solid};
use rand_pcg::Pcg64Mcg;
use std::sync::Arc;

/// Tries for a place before the shape counts as full.
const TRIES: usize = 20_000;

/// The corners (lowest, highest) [m] of a shape that has an end; `None` for one that has none.
pub fn bounds(shape: &Shape) -> Option<(Vec3, Vec3)> {
    if shape.outside {
        return None;
    }
    match &shape.solid {
        Solid::Box(low, high) => Some((*low, *high)),
        Solid::Sphere(centre, r) => Some((centre.add_scalar(-r), centre.add_scalar(*r))),
        Solid::Cylinder(a, b, r) => {
            let axis = (b - a).normalize();
            let reach = axis.map(|c| r * (1.0 - c * c).max(0.0).sqrt());
            Some((a.inf(b) - reach, a.sup(b) + reach))
        }
        Solid::Cone(a, b, [ra, rb]) => {
            let axis = (b - a).normalize();
            let reach = |r: &f64| axis.map(|c| r * (1.0 - c * c).max(0.0).sqrt());
            Some(((a - reach(ra)).inf(&(b - reach(rb))), (a + reach(ra)).sup(&(b + reach(rb)))))
        }
        Solid::Mesh(inside) => Some(inside.bounds()),
        Solid::Halfspace(_) | Solid::Prism(_) => None,
    }
}

/// Whether a whole sphere lies inside the shape.
pub(in crate::plan) fn holds(shape: &Shape, centre: &Vec3, radius: f64) -> bool {
    match (&shape.solid, shape.outside) {
        (Solid::Box(low, high), false) => {
            (0..3).all(|a| low[a] + radius <= centre[a] && centre[a] <= high[a] - radius)
        }
        (Solid::Sphere(middle, r), false) => (centre - middle).norm() + radius <= *r,
        (Solid::Cylinder(a, b, r), false) => {
            let length = (b - a).norm();
            let along = (centre - a).dot(&(b - a)) / length;
            let out = (centre - a - (b - a) * (along / length)).norm();
            (radius..=length - radius).contains(&along) && out + radius <= *r
        }
        (Solid::Cone(a, b, [ra, rb]), false) => {
            let length = (b - a).norm();
            let along = (centre - a).dot(&(b - a)) / length;
            let out = (centre - a - (b - a) * (along / length)).norm();
            let slope = (rb - ra) / length;
            let room = ra + slope * along - radius * (1.0 + slope * slope).sqrt();
            (radius..=length - radius).contains(&along) && out <= room
        }
        (Solid::Mesh(inside), false) => inside.contains(centre) && inside.distance(centre) >= radius,
        _ => shape.contains(centre),
    }
}

/// Spheres sorted into cells as they come, to see at once whether another one fits between them.
pub(in crate::plan) struct Occupied {
    low: Vec3,
    high: Vec3,
    /// Radius of the largest one, there or to come [m].
    largest: f64,
    cell: f64,
    count: [usize; 3],
    /// Last sphere of each cell, and for each sphere the one before it in its cell.
    last: Vec<u32>,
    before: Vec<u32>,
    spheres: Vec<(Vec3, f64)>,
    walls: Option<Arc<Obstacles>>,
}

const NONE: u32 = u32::MAX;

impl Occupied {
    /// The spheres near the box between two corners [m] and the walls, for others of at most the radius `largest` [m].
    pub(in crate::plan) fn with((low, high): (Vec3, Vec3), largest: f64, taken: &Taken) -> Occupied {
        let spheres = &taken.spheres;
        let largest = spheres.iter().map(|s| s.1).fold(largest, f64::max);
        let mut occupied = Occupied { walls: taken.walls.clone(), ..Occupied::new(low, high, largest) };
        spheres.iter().for_each(|s| occupied.take(s.0, s.1));
        occupied
    }

    /// Whether there is neither a sphere nor a wall.
    pub(in crate::plan) fn is_empty(&self) -> bool {
        self.spheres.is_empty() && self.walls.is_none()
    }

    /// No spheres yet, of at most this radius, between two corners [m].
    fn new(low: Vec3, high: Vec3, largest: f64) -> Occupied {
        let size = high - low;
        // A very large empty shape gets larger cells rather than more of them than memory has room for.
        let cell = (2.0 * largest).max((size.x * size.y * size.z / 2e7).cbrt()).max(size.max() / 4e3);
        let count = [0, 1, 2].map(|a| (size[a] / cell) as usize + 1);
        let cells = count.iter().product();
        Occupied {
            low,
            high,
            largest,
            cell,
            count,
            last: vec![NONE; cells],
            before: Vec::new(),
            spheres: Vec::new(),
            walls: None,
        }
    }

    fn cell_of(&self, at: &Vec3) -> [usize; 3] {
        let index = |a: usize| ((at[a] - self.low[a]) / self.cell).max(0.0) as usize;
        [0, 1, 2].map(|a| index(a).min(self.count[a] - 1))
    }

    /// Whether a sphere touches none of those that are there, and no wall.
    pub(in crate::plan) fn is_free(&self, centre: &Vec3, radius: f64) -> bool {
        let here = self.cell_of(centre);
        let range = |a: usize| here[a].saturating_sub(1)..=(here[a] + 1).min(self.count[a] - 1);
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let mut next = self.last[(z * self.count[1] + y) * self.count[0] + x];
                    while next != NONE {
                        let (other, r) = &self.spheres[next as usize];
                        if (other - centre).norm_squared() < (r + radius) * (r + radius) {
                            return false;
                        }
                        next = self.before[next as usize];
                    }
                }
            }
        }
        self.walls.as_ref().is_none_or(|walls| walls.is_free(centre, radius))
    }

    /// Puts a sphere there, and its images; what is too far from the box to be touched from there is left out.
    fn take(&mut self, centre: Vec3, radius: f64) {
        let reach = 2.0 * self.largest;
        let (low, high) = (self.low.add_scalar(-reach), self.high.add_scalar(reach));
        let images = self.walls.as_ref().map_or_else(Images::default, |walls| walls.images);
        for at in images.between(centre, &low, &high) {
            if (0..3).all(|a| at[a] > low[a] && at[a] < high[a]) {
                self.put(at, radius);
            }
        }
    }

    fn put(&mut self, centre: Vec3, radius: f64) {
        let [x, y, z] = self.cell_of(&centre);
        let cell = (z * self.count[1] + y) * self.count[0] + x;
        self.before.push(self.last[cell]);
        self.last[cell] = self.spheres.len() as u32;
        self.spheres.push((centre, radius));
    }
}

/// Spheres between two reports of how many have been placed.
const REPORT: usize = 1 << 14;

/// Radii of spheres to be placed [m], and what hears how many have a place.
pub(in crate::plan) struct Radii<'a> {
    pub(in crate::plan) all: &'a [f64],
    pub(in crate::plan) hear: &'a dyn Fn(usize),
}

impl Radii<'_> {
    /// Each in turn: those before it have a place.
    pub(in crate::plan) fn iter(&self) -> impl ExactSizeIterator<Item = &f64> {
        self.all
            .iter()
            .enumerate()
            .inspect(|(n, _)| {
                if n.is_multiple_of(REPORT) {
                    (self.hear)(*n);
                }
            })
            .map(|(_, radius)| radius)
    }
}

/// A shape that is filled with spheres one after the other.
pub(in crate::plan) struct Packing<'a> {
    shape: &'a Shape,
    low: Vec3,
    high: Vec3,
    occupied: Occupied,
}

impl<'a> Packing<'a> {
    /// A shape between two corners, what is in it, and the largest radius of those to come [m].
    pub(in crate::plan) fn new(
        shape: &'a Shape,
        corners: (Vec3, Vec3),
        largest: f64,
        taken: &Taken,
    ) -> Packing<'a> {
        let (low, high) = corners;
        Packing { shape, low, high, occupied: Occupied::with(corners, largest, taken) }
    }

    /// A place for each sphere; else how many found one.
    pub(in crate::plan) fn place_all(
        mut self,
        radii: &Radii,
        random: &mut Pcg64Mcg,
    ) -> Result<Vec<Vec3>, usize> {
        radii.iter().enumerate().map(|(n, &radius)| self.place(radius, random).ok_or(n)).collect()
    }

    /// Places one more sphere at random; `None` when there is no space.
    pub(in crate::plan) fn place(&mut self, radius: f64, random: &mut Pcg64Mcg) -> Option<Vec3> {
        let (low, size) = (self.low.add_scalar(radius), (self.high - self.low).add_scalar(-2.0 * radius));
        if size.min() < 0.0 {
            return None;
        }
        let found = (0..TRIES).find_map(|_| {
            let at = low + Vec3::new(unit(random), unit(random), unit(random)).component_mul(&size);
            (holds(self.shape, &at, radius) && self.occupied.is_free(&at, radius)).then_some(at)
        })?;
        self.occupied.take(found, radius);
        Some(found)
    }
}
