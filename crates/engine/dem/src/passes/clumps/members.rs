//! The rows of members: position, velocity and spin of a sphere that a clump carries along, for as many spheres at a time as a lane has.

use crate::state::{ClumpMotion, RigidClumps};
use laws::contact::MoveFlags;
use laws::simd::compiled::Job;
use laws::simd::{BLOCK, Indices, Lane, Row, Row4, V};
use laws::space::cell::{Cell, ImageOf};

/// Rows whose clumps are looked up together.
const ROWS: usize = 64;
/// All of them, in order.
const EACH: [u32; ROWS] = {
    let (mut each, mut k) = ([0; ROWS], 0);
    while k < ROWS {
        each[k] = k as u32;
        k += 1;
    }
    each
};

/// What all members share in one step.
#[derive(Clone, Copy)]
pub struct Members<'a> {
    pub clumps: &'a RigidClumps,
    pub cell: Cell,
    /// Largest motion in one step over the radius [–].
    pub motion_limit: f64,
    /// Δt [s].
    pub dt: f64,
    /// How far ahead in time contacts are looked for [s].
    pub ahead: f64,
}

/// Some rows of all particles, those of members among them.
pub struct MemberRows<'a> {
    /// Number of the first.
    pub first: usize,
    pub rows: &'a mut [Row],
    /// Empty without rotation.
    pub spins: &'a mut [Row4],
    pub acceleration: &'a mut [Row4],
    pub home: &'a [Row4],
}

/// Writes the rows of members, where their clumps are now.
pub struct Write<'a> {
    pub members: Members<'a>,
    pub to: MemberRows<'a>,
}

impl Job for Write<'_> {
    type Output = MoveFlags;
    #[inline(always)]
    fn run<R: Lane>(self) -> MoveFlags {
        let Write { members, mut to } = self;
        let (mut bodies, mut moved) = (Bodies::new(), MoveFlags::default());
        for first in (0..to.rows.len()).step_by(ROWS) {
            let count = ROWS.min(to.rows.len() - first);
            bodies.find(members.clumps, to.first + first, count);
            let mut k = 0;
            while k < count {
                let wide = k + R::WIDTH <= count && bodies.carry_all(k, R::WIDTH);
                if wide {
                    moved = moved.and(write::<R>(&members, &bodies, k, &mut to, first + k));
                } else if bodies.carry_all(k, 1) {
                    moved = moved.and(write::<f64>(&members, &bodies, k, &mut to, first + k));
                }
                k += if wide { R::WIDTH } else { 1 };
            }
        }
        moved
    }
}

/// The clumps that some rows are members of.
struct Bodies {
    /// Which of them each row belongs to; [`NONE`] where no clump carries it.
    which: [u32; ROWS],
    /// Position and velocity of each.
    places: [Row; ROWS],
    /// Spin, and principal axes to space.
    turns: [Row; ROWS],
    /// Position before the last move.
    places_before: [Row4; ROWS],
    /// Axes then.
    turns_before: [Row4; ROWS],
}

/// A sphere that moves on its own.
const NONE: u32 = u32::MAX;

impl Bodies {
    #[inline(always)]
    fn new() -> Bodies {
        let (row, row4) = (Row::default(), Row4::default());
        Bodies {
            which: [NONE; ROWS],
            places: [row; ROWS],
            turns: [row; ROWS],
            places_before: [row4; ROWS],
            turns_before: [row4; ROWS],
        }
    }

    /// Looks up those of `count` rows from number `first` on. Neighbouring rows are often of one clump.
    #[inline(always)]
    fn find(&mut self, clumps: &RigidClumps, first: usize, count: usize) {
        let (mut last, mut found) = (None, 0);
        for (which, &of) in self.which.iter_mut().zip(&clumps.of[first..first + count]) {
            let Some(f) = clumps.flights.get(of as usize).filter(|f| !f.is_prescribed) else {
                *which = NONE;
                continue;
            };
            if last != Some(of) {
                let ClumpMotion { position: p, velocity: v, spin: w, turn: [i, j, k, t], .. } = *f;
                self.places[found] = Row([p.x, p.y, p.z, 0.0, v.x, v.y, v.z, 0.0]);
                self.turns[found] = Row([w.x, w.y, w.z, 0.0, i, j, k, t]);
                self.places_before[found] = Row4::of(f.place_before);
                self.turns_before[found] = Row4(f.turn_before);
                (last, found) = (Some(of), found + 1);
            }
            *which = found as u32 - 1;
        }
    }

    /// Whether clumps carry all of `n` rows from `k` on.
    #[inline(always)]
    fn carry_all(&self, k: usize, n: usize) -> bool {
        self.which[k..k + n].iter().fold(true, |all, &which| all & (which != NONE))
    }
}

/// Writes the rows of `WIDTH` members: `k` counts those of `bodies`, `at` those of `to`.
#[inline(always)]
fn write<R: Lane>(members: &Members, bodies: &Bodies, k: usize, to: &mut MemberRows, at: usize) -> MoveFlags {
    let Members { clumps, cell, dt, .. } = members;
    let (of, own) =
        (Indices::within(&bodies.which[k..k + R::WIDTH], ROWS), Indices::within(&EACH[..R::WIDTH], R::WIDTH));
    let [px, py, pz, _, vx, vy, vz, _] = R::rows(&bodies.places, of);
    let [wx, wy, wz, _, i, j, l, w] = R::rows(&bodies.turns, of);
    let [bx, by, bz, _] = R::rows4(&bodies.places_before, of);
    let (centre, before, spin) = (V::new(px, py, pz), V::new(bx, by, bz), V::new(wx, wy, wz));
    let all = to.first + at..to.first + at + R::WIDTH;
    let [x, y, z, _] = R::rows4(&clumps.arms[all.clone()], own);
    let arm = V::new(x, y, z);
    let r = turned([i, j, l, w], arm);
    let r_before = turned(R::rows4(&bodies.turns_before, of), arm);
    let mut way = (centre - before) + (r - r_before);
    let mut velocity = V::new(vx, vy, vz) + spin.cross(r);
    let image = image::<R>(&clumps.images[all]);
    if cell.moves() {
        let drift = by_axis(image, &cell.speed.into());
        velocity = velocity + drift;
        way = way + drift.scale(R::splat(*dt));
    }
    let position = centre + r + by_axis(image, &cell.lengths().into());
    let rows = &mut to.rows[at..at + R::WIDTH];
    let [_, _, _, radius, _, _, _, inverse_mass] = R::rows(rows, own);
    let (zero, mut lines) = (R::splat(0.0), [[0.0; 8]; BLOCK]);
    let V { x, y, z } = position;
    let columns = [x, y, z, radius, velocity.x, velocity.y, velocity.z, inverse_mass];
    R::store_rows(columns, lines.as_flattened_mut());
    // A loop over the width, which the compiler unrolls.
    for lane in 0..R::WIDTH {
        rows[lane].0 = lines[lane];
    }
    if !to.spins.is_empty() {
        store4([spin.x, spin.y, spin.z, zero], &mut to.spins[at..at + R::WIDTH]);
    }
    // What brings it back to where it was: `position_before`.
    let a = (velocity.scale(R::splat(*dt)) - way).scale(R::splat(2.0 / (dt * dt)));
    store4([a.x, a.y, a.z, zero], &mut to.acceleration[at..at + R::WIDTH]);
    let limit = R::splat(members.motion_limit) * radius;
    // A number that is none counts as infinitely large.
    let too_fast = way.dot(way).min(R::splat(f64::INFINITY)).gt(limit * limit);
    let [hx, hy, hz, margin] = R::rows4(&to.home[at..at + R::WIDTH], own);
    let margin = (margin - R::splat(members.ahead) * velocity.dot(velocity).sqrt()).max(zero);
    let gone = position - V::new(hx, hy, hz);
    let left_margin = gone.dot(gone).gt(margin * margin);
    MoveFlags { too_fast: R::any(too_fast), left_margin: R::any(left_margin) }
}

/// A vector, turned by quaternions i, j, k, w; rounded as nalgebra rounds it, which turns arms one by one elsewhere.
#[inline(always)]
fn turned<R: Lane>([i, j, k, w]: [R; 4], arm: V<R>) -> V<R> {
    let axis = V::new(i, j, k);
    let twice = axis.cross(arm).scale(R::splat(2.0));
    twice.scale(w) + axis.cross(twice) + arm
}

/// Numbers of some images.
#[inline(always)]
fn image<R: Lane>(images: &[ImageOf]) -> V<R> {
    let mut columns = [[0.0; BLOCK]; 3];
    if images.iter().fold(false, |any, image| any | (*image != [0; 3])) {
        for (k, image) in images.iter().enumerate() {
            for a in 0..3 {
                columns[a][k] = f64::from(image[a]);
            }
        }
    }
    V::new(R::load(&columns[0]), R::load(&columns[1]), R::load(&columns[2]))
}

/// Times one number for each axis.
#[inline(always)]
fn by_axis<R: Lane>(v: V<R>, by: &[f64; 3]) -> V<R> {
    V::new(v.x * R::splat(by[0]), v.y * R::splat(by[1]), v.z * R::splat(by[2]))
}

/// Writes columns as rows of four.
#[inline(always)]
fn store4<R: Lane>(columns: [R; 4], to: &mut [Row4]) {
    let mut lines = [[0.0; 4]; BLOCK];
    R::store_rows4(columns, lines.as_flattened_mut());
    let to = &mut to[..R::WIDTH];
    for lane in 0..R::WIDTH {
        to[lane].0 = lines[lane];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::{Body, ClumpShape, Clumps, Particle, Setup};
    use crate::state::Particles;
    use geom::{Moments, Vec3};
    use laws::effects::Material;
    use laws::simd::Width;
    use laws::simd::compiled::{self, Registers};
    use nalgebra::UnitQuaternion;

    /// Clumps of one to five members with a free sphere after each third one, in a cell that shrinks: each member has the row that
    /// [`ClumpMotion::point`] gives, bit for bit, whatever the width of lanes, and free spheres and prescribed clumps stay as they are.
    #[test]
    fn members_are_where_their_clump_has_them() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut vector = || Vec3::new(random(), random(), random());
        let material = Material { name: "a".to_owned(), density: 1e3, young: 1e6, poisson: 0.3 };
        let mut setup = Setup { materials: vec![material], ..Setup::default() };
        let shape = |n: usize| {
            // Not in a row: along an axis many sums are the same in any order.
            let at = |k: f64| Vec3::new(0.1 * k, 0.03 * k * k, 0.02 * (3.0 * k).sin());
            let spheres: Vec<(Vec3, f64)> = (0..n).map(|k| (at(k as f64), 0.1)).collect();
            ClumpShape::new("bow", 0, &spheres, &Moments::of_sum(&spheres))
        };
        setup.clumps = Clumps { shapes: (1..=5).map(shape).collect(), ..Clumps::default() };
        let (mut particles, mut clumps) = (Particles::new(true), RigidClumps::default());
        for k in 0..60_u32 {
            let orientation = UnitQuaternion::from_scaled_axis(vector() * 6.0);
            let [position, velocity, spin] = [vector(), vector(), vector()];
            let body = Body { id: 6 * k, shape: k % 5, scale: 1.0, position, orientation, velocity, spin };
            clumps.push(&body, &setup, &mut particles);
            if k % 3 == 0 {
                let alone = Particle { id: 6 * k + 5, material: 0, radius: 0.1, position, velocity, spin };
                particles.push(&alone, &setup.materials);
            }
        }
        let count = particles.len();
        clumps.of.resize(count, crate::state::clumps::FREE);
        clumps.arms.resize(count, Row4::default());
        clumps.images = (0..count).map(|k| [(k % 7 == 0) as i8, -((k % 11 == 0) as i8), 0]).collect();
        for (n, f) in clumps.flights.iter_mut().enumerate() {
            f.advance(vector(), vector(), 1e-3);
            f.is_prescribed = n % 13 == 0;
        }
        let cell =
            Cell { range: [Some((0.0, 2.0)), Some((0.0, 3.0)), None], speed: Vec3::new(-0.1, 0.2, 0.0) };
        let members = Members { clumps: &clumps, cell, motion_limit: 0.5, dt: 1e-3, ahead: 5e-4 };
        for width in Width::available() {
            let mut p = particles.clone();
            let Particles { rows, spins, acceleration, home, .. } = &mut p;
            let (rows, spins) = (&mut rows[..count], &mut spins[..count]);
            let to = MemberRows { first: 0, rows, spins, acceleration, home };
            let moved = compiled::run::<Registers, _>(width, Write { members, to });
            assert!(moved.left_margin && !moved.too_fast, "{moved:?}");
            for k in 0..count {
                let (now, was) = (p.rows[k], particles.rows[k]);
                let Some(f) = clumps.body_of(k).filter(|f| !f.is_prescribed) else {
                    assert_eq!((now, p.spins[k]), (was, particles.spins[k]), "{width:?}");
                    continue;
                };
                let (position, velocity, way) = f.point(&clumps.arms[k]);
                let (shift, drift) = (cell.shift(&clumps.images[k]), cell.drift(&clumps.images[k]));
                let (x, v) = (position + shift, velocity + drift);
                assert_eq!(now.0, [x.x, x.y, x.z, was[3], v.x, v.y, v.z, was[7]], "{width:?}");
                assert_eq!(p.spins[k], Row4::of(f.spin));
                let a = (v * 1e-3 - (way + drift * 1e-3)) * (2.0 / (1e-3 * 1e-3));
                assert_eq!(p.acceleration[k], Row4::of(a));
            }
        }
    }
}
