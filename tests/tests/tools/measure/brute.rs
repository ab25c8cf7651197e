//! Measures by brute force, on each kind of run: grains one by one, paths in small steps, contacts one by one, from the tables of the run and with no code of the library.

mod contacts;
mod ways;

use super::kinds::{Held, kinds, near, values, vectors};
use super::{column, measure};
use geom::Vec3;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Density of all materials [kg/m³].
const DENSITY: f64 = 2500.0;

/// A period of the runs that have one [m].
const PERIOD: f64 = 0.05;

/// A grain, or a clump as one.
#[derive(Clone, Copy)]
struct Unit {
    x: Vec3,
    v: Vec3,
    mass: f64,
}

fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// Volume of a dumbbell over that of its two spheres of 4 mm, 6 mm apart, that overlap in a lens.
fn share_of_members() -> f64 {
    let (r, d) = (0.004f64, 0.006);
    let lens = PI * (4.0 * r + d) * (2.0 * r - d).powi(2) / 12.0;
    1.0 - lens / (2.0 * ball(r))
}

/// All spheres of a frame with their masses, and the unit that each belongs to.
struct Frame {
    spheres: Vec<(Unit, f64)>,
    ids: Vec<u64>,
    unit_of: BTreeMap<u64, u64>,
    units: BTreeMap<u64, Unit>,
}

fn frame(run: &Held, kind: &str, time: f64) -> Frame {
    let table = run.table("/particles", time).unwrap();
    let (x, v) = (vectors(table, ["x", "y", "z"]), vectors(table, ["vx", "vy", "vz"]));
    let (radius, ids) = (values(table, "radius"), values(table, "id"));
    let ids: Vec<u64> = ids.iter().map(|id| *id as u64).collect();
    let share = if kind == "clumps" { share_of_members() } else { 1.0 };
    let mass = |k: usize| share * DENSITY * ball(radius[k]);
    let spheres: Vec<(Unit, f64)> =
        (0..x.len()).map(|k| (Unit { x: x[k], v: v[k], mass: mass(k) }, radius[k])).collect();
    let body: Vec<u64> = match kind {
        "clumps" => values(table, "body").iter().map(|b| *b as u64).collect(),
        _ => ids.clone(),
    };
    let mut units: BTreeMap<u64, Unit> = BTreeMap::new();
    for ((sphere, _), body) in spheres.iter().zip(&body) {
        // Its two members are alike.
        let unit = units.entry(*body).or_insert(Unit { x: Vec3::zeros(), v: Vec3::zeros(), mass: 0.0 });
        let mass = unit.mass + sphere.mass;
        unit.x = (unit.x * unit.mass + sphere.x * sphere.mass) / mass;
        unit.v = (unit.v * unit.mass + sphere.v * sphere.mass) / mass;
        unit.mass = mass;
    }
    let unit_of = ids.iter().copied().zip(body).collect();
    Frame { spheres, ids, unit_of, units }
}

fn frames(run: &Held, kind: &str) -> Vec<(f64, Frame)> {
    run.times().into_iter().map(|t| (t, frame(run, kind, t))).collect()
}

/// The way from one frame to the next, over periodic faces: nearest to the mean velocity.
fn way(kind: &str, a: &Unit, b: &Unit, h: f64) -> Vec3 {
    let mut way = b.x - a.x;
    if kind == "periodic" {
        let guess = 0.5 * h * (a.v + b.v);
        for axis in 0..2 {
            way[axis] += PERIOD * ((guess[axis] - way[axis]) / PERIOD).round();
        }
    }
    way
}

/// Volume of a ball below a height over its centre.
fn below(radius: f64, height: f64) -> f64 {
    let h = (height + radius).clamp(0.0, 2.0 * radius);
    PI * h * h * (3.0 * radius - h) / 3.0
}

/// Slabs of a box that holds all grains: the parts of balls between two heights.
#[test]
fn a_profile_is_a_sum_over_parts_of_balls() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        let (_, last) = all.iter().rfind(|(_, f)| !f.ids.is_empty()).unwrap();
        let [low, high] = if kind == "periodic" { [0.0, PERIOD] } else { [-0.01, 0.06] };
        let done = measure(
            &run.folder,
            &["--profile", "--bins", "4", "--within", &format!("box:{low},{low},-0.002,{high},{high},0.038")],
        );
        let volume = (high - low) * (high - low) * 0.01;
        let mut wanted = [Vec::new(), Vec::new(), Vec::new(), Vec::new()];
        for slab in 0..4 {
            let from = -0.002 + 0.01 * f64::from(slab);
            let part = |(u, r): &(Unit, f64)| below(*r, from + 0.01 - u.x.z) - below(*r, from - u.x.z);
            let share = |(u, r): &(Unit, f64)| u.mass / (DENSITY * ball(*r));
            let (mut solid, mut grains, mut mass, mut momentum) = (0.0, 0.0, 0.0, Vec3::zeros());
            for sphere in &last.spheres {
                let (v, s) = (part(sphere), share(sphere));
                solid += s * v / volume;
                grains += v / ball(sphere.1);
                mass += s * v * DENSITY;
                momentum += sphere.0.v * (s * v * DENSITY);
            }
            let mean = momentum / mass;
            let agitation: f64 = last
                .spheres
                .iter()
                .map(|s| share(s) * part(s) * DENSITY * (s.0.v - mean).norm_squared())
                .sum();
            wanted[0].push(solid);
            wanted[1].push(grains);
            wanted[2].push(mean.z);
            wanted[3].push(agitation / (3.0 * mass));
        }
        for (name, wanted) in ["solid_fraction", "grains", "vz", "granular_temperature"].iter().zip(&wanted) {
            let largest = wanted.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            near(&format!("{kind} profile {name}"), &column(&done, name), wanted, 1e-7 * largest.max(1e-9));
        }
    }
}

/// Grains and mass in rings, and all of the mass in them.
#[test]
fn rings_hold_the_centres_between_their_radii() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        let (_, last) = all.iter().rfind(|(_, f)| !f.ids.is_empty()).unwrap();
        let done =
            measure(&run.folder, &["--radial", "0.025,0.025,0,0,0,1", "--bins", "3", "--outer", "0.04"]);
        let mut wanted = [vec![0.0; 3], vec![0.0; 3]];
        for (unit, _) in &last.spheres {
            let ring = ((unit.x.x - 0.025).hypot(unit.x.y - 0.025) / 0.04 * 3.0) as usize;
            if ring < 3 {
                wanted[0][ring] += 1.0;
                wanted[1][ring] += unit.mass;
            }
        }
        near(&format!("{kind} radial grains"), &column(&done, "grains"), &wanted[0], 0.0);
        near(&format!("{kind} radial mass"), &column(&done, "mass"), &wanted[1], 1e-9);
    }
}

/// The larger half over the smaller one: means over grains.
#[test]
fn segregation_is_the_distance_of_two_centres() {
    for (kind, scene, options) in kinds() {
        if kind == "clumps" {
            continue; // all of one size
        }
        let run = Held::new(&scene, options);
        let mut wanted = [Vec::new(), Vec::new()];
        for (_, f) in frames(&run, kind) {
            let large = |s: &&(Unit, f64)| 2.0 * s.1 > 0.007;
            let heights = |of: Vec<&(Unit, f64)>| {
                let mass: f64 = of.iter().map(|s| s.0.mass).sum();
                of.iter().map(|s| s.0.x.z * s.0.mass).sum::<f64>() / mass
            };
            let (a, b) = f.spheres.iter().partition::<Vec<_>, _>(large);
            let (count, all) = (f.spheres.len() as f64, f.spheres.iter().map(|s| s.0.mass).sum::<f64>());
            let mean = f.spheres.iter().map(|s| s.0.mass * s.0.x.z).sum::<f64>() / all;
            let square = |s: &(Unit, f64)| s.0.mass * (s.0.x.z - mean).powi(2);
            let spread = (f.spheres.iter().map(square).sum::<f64>() / all).sqrt();
            // Grains of one kind have no second one to be mixed with.
            let one_kind = a.is_empty() || b.is_empty();
            wanted[0].push(if one_kind { f64::NAN } else { a.len() as f64 / count });
            wanted[1].push((heights(a) - heights(b)) / (0.5 * 12f64.sqrt() * spread));
        }
        let done = measure(&run.folder, &["--segregation", "--split", "0.007"]);
        near(&format!("{kind} share"), &column(&done, "share"), &wanted[0], 1e-9);
        near(&format!("{kind} centre_difference"), &column(&done, "centre_difference"), &wanted[1], 1e-6);
    }
}

/// From one place to the nearest image of another.
fn nearest(kind: &str, by: Vec3) -> Vec3 {
    let mut by = by;
    if kind == "periodic" {
        for axis in 0..2 {
            by[axis] -= PERIOD * (by[axis] / PERIOD).round();
        }
    }
    by
}

/// The surface as vertical rays find it: the highest ball above each of many places.
#[test]
fn the_bed_is_as_high_as_rays_find_it() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        let (_, last) = all.iter().rfind(|(_, f)| !f.ids.is_empty()).unwrap();
        let mut tops = Vec::new();
        for k in 0..40_000 {
            let at = [0.05 * (f64::from(k % 200) + 0.5) / 200.0, 0.05 * (f64::from(k / 200) + 0.5) / 200.0];
            let top = last.spheres.iter().filter_map(|(u, r)| {
                let by = nearest(kind, Vec3::new(at[0] - u.x.x, at[1] - u.x.y, 0.0));
                let square = r * r - by.norm_squared();
                (square > 0.0).then(|| u.x.z + square.sqrt())
            });
            tops.extend(top.reduce(f64::max));
        }
        tops.sort_by(f64::total_cmp);
        let found = column(&measure(&run.folder, &["--bed-height", "--ground", "0"]), "height");
        let wanted = tops[tops.len() / 2];
        assert!((found[0] - wanted).abs() < 0.0008, "{kind}: {found:?} for {wanted}");
    }
}
