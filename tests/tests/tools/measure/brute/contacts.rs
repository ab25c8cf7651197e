//! Contacts one by one, and bonds.

use super::super::kinds::{Held, kinds, near, values, vectors, whole_bonds};
use super::super::{column, measure};
use super::{PERIOD, frame, nearest};
use geom::Vec3;
use nalgebra::Matrix3 as Mat3;
use std::collections::{BTreeMap, BTreeSet};

/// A contact of a table, and the force on its first grain.
struct Touch {
    i: u64,
    /// The second grain, or the wall.
    j: Option<u64>,
    wall: u64,
    point: Vec3,
    force: Vec3,
    normal: Vec3,
    work: f64,
}

fn touches(run: &Held, time: f64) -> Vec<Touch> {
    let Some(table) = run.table("/contacts", time) else { return Vec::new() };
    let (force, point) = (vectors(table, ["fx", "fy", "fz"]), vectors(table, ["x", "y", "z"]));
    let normal = vectors(table, ["nx", "ny", "nz"]);
    let [i, j, kind, work] = ["id_i", "id_j", "kind", "work"].map(|name| values(table, name));
    let touch = |k: usize| Touch {
        i: i[k] as u64,
        j: (kind[k] == 0.0).then_some(j[k] as u64),
        wall: j[k] as u64,
        point: point[k],
        force: force[k],
        normal: normal[k],
        work: work[k],
    };
    (0..i.len()).map(touch).collect()
}

/// Contacts one by one: stress in a box that holds all of them, force through a plane, coordination, wear.
#[test]
fn contacts_add_up_one_by_one() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let [low, high] = if kind == "periodic" { [0.0, PERIOD] } else { [-0.1, 0.2] };
        let shape = format!("box:{low},{low},-0.1,{high},{high},0.4");
        let volume = (high - low) * (high - low) * 0.5;
        let mut wanted: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        let (mut normal, mut work) = (0.0, 0.0);
        for t in run.times() {
            let f = frame(&run, kind, t);
            let all = touches(&run, t);
            let place = |id: u64| f.units[&f.unit_of[&id]].x;
            let sphere = |id: u64| f.spheres[f.ids.iter().position(|i| *i == id).unwrap()].0.x;
            let (mut stress, mut through, mut across) = (Mat3::zeros(), Vec3::zeros(), Vec3::zeros());
            let mut pairs: BTreeMap<[u64; 2], ()> = BTreeMap::new();
            // Partners of each grain: other grains, and walls.
            let mut met: BTreeMap<u64, usize> = BTreeMap::new();
            let mut walls: BTreeSet<(u64, u64)> = BTreeSet::new();
            for touch in &all {
                work += if touch.j.is_none() && t > 0.0 { touch.work } else { 0.0 };
                if touch.force.norm() == 0.0 {
                    continue;
                }
                // Of a clump: from the middle of one to that of the other, by way of the spheres that touch.
                let of = |id: u64| place(id) - sphere(id);
                let branch = match touch.j {
                    Some(j) => nearest(kind, sphere(touch.i) - sphere(j)) + of(touch.i) - of(j),
                    None => nearest(kind, sphere(touch.i) - touch.point) + of(touch.i),
                };
                stress += touch.force * branch.transpose() / volume;
                if let Some(j) = touch.j {
                    // Planes at x = 10 mm and, in a periodic run, a period on and a period back.
                    let (x, by) = (sphere(touch.i).x, nearest(kind, sphere(j) - sphere(touch.i)).x);
                    for plane in if kind == "periodic" { vec![-0.04, 0.01, 0.06] } else { vec![0.01] } {
                        let side = f64::from(x >= plane) - f64::from(x + by >= plane);
                        across += side * touch.force;
                    }
                    let [above_i, above_j] = [sphere(touch.i).z > 0.01, sphere(j).z > 0.01];
                    if above_i != above_j {
                        through += if above_i { touch.force } else { -touch.force };
                    }
                    let [a, b] = [f.unit_of[&touch.i], f.unit_of[&j]];
                    if pairs.insert([a.min(b), a.max(b)], ()).is_none() {
                        *met.entry(a).or_default() += 1;
                        *met.entry(b).or_default() += 1;
                    }
                } else {
                    normal += touch.force.dot(&touch.normal).abs();
                    let unit = f.unit_of[&touch.i];
                    if walls.insert((unit, touch.wall)) {
                        *met.entry(unit).or_default() += 1;
                    }
                }
            }
            for [i, j] in whole_bonds(&run, t) {
                let [a, b] = [f.unit_of[&i], f.unit_of[&j]];
                if pairs.insert([a.min(b), a.max(b)], ()).is_none() {
                    *met.entry(a).or_default() += 1;
                    *met.entry(b).or_default() += 1;
                }
            }
            let mut add = |name: &'static str, value: f64| wanted.entry(name).or_default().push(value);
            add("xx", stress[(0, 0)]);
            add("zz", stress[(2, 2)]);
            add("xz", 0.5 * (stress[(0, 2)] + stress[(2, 0)]));
            add("fz", through.z);
            add("fx", across.x);
            let count = f.units.len() as f64;
            add("coordination", 2.0 * pairs.len() as f64 / count);
            let held: Vec<f64> = met.values().filter(|n| **n >= 2).map(|n| *n as f64).collect();
            add("rattlers", 1.0 - held.len() as f64 / count);
            add("mechanical_coordination", held.iter().sum::<f64>() / held.len() as f64);
        }
        let is = |words: &[&str], name: &str, as_column: &str| {
            let (all, on) = (&wanted[name], format!("{kind} {} {name}", words.join(" ")));
            let largest = all.iter().filter(|x| x.is_finite()).fold(1e-12, |m: f64, x| m.max(x.abs()));
            near(&on, &column(&measure(&run.folder, words), as_column), all, 1e-8 * largest);
        };
        if kind != "bonded" {
            for name in ["xx", "zz", "xz"] {
                is(&["--stress", &shape], name, name);
            }
        }
        is(&["--plane-force", "0,0,0.01,0,0,1"], "fz", "fz");
        is(&["--plane-force", "0.01,0,0,1,0,0"], "fx", "fx");
        if kind != "empty" {
            for name in ["coordination", "rattlers", "mechanical_coordination"] {
                is(&["--contacts"], name, name);
            }
        }
        let wear = measure(&run.folder, &["--wear", "all", "--cell", "0.3"]);
        let count = run.times().len() as f64;
        let sums = ["mean_normal", "sliding_work"].map(|name| column(&wear, name).iter().sum::<f64>());
        near(&format!("{kind} wear"), &sums, &[normal / count, work], 1e-9 * normal.max(1e-3));
    }
}

/// Bonds that broke, as the last state of the bonds has them.
#[test]
fn cracks_are_the_bonds_that_are_broken() {
    let (_, scene, options) = kinds().into_iter().find(|k| k.0 == "bonded").unwrap();
    let run = Held::new(&scene, options);
    let (_, last) = run.all("/bonds").last().unwrap();
    let [i, j, broken] = ["id_i", "id_j", "broken"].map(|name| values(last, name));
    let mut wanted: Vec<[u64; 2]> =
        (0..i.len()).filter(|k| broken[*k] > 0.0).map(|k| [i[k] as u64, j[k] as u64]).collect();
    let done = measure(&run.folder, &["--cracks"]);
    let [i, j] = ["id_i", "id_j"].map(|name| column(&done, name));
    let mut found: Vec<[u64; 2]> = (0..i.len()).map(|k| [i[k] as u64, j[k] as u64]).collect();
    let sorted = |all: &mut Vec<[u64; 2]>| {
        all.iter_mut().for_each(|pair| pair.sort_unstable());
        all.sort_unstable();
    };
    sorted(&mut wanted);
    sorted(&mut found);
    assert!(found == wanted && !found.is_empty(), "{found:?} for {wanted:?}");
}
