//! Where grains go from frame to frame: flow, residence, tracks, strain.

use super::super::kinds::{Held, kinds, near};
use super::super::{column, measure};
use super::{Frame, PERIOD, Unit, frames, way};
use geom::Vec3;
use nalgebra::Matrix3 as Mat3;
use std::collections::BTreeMap;

/// Grains through planes: sides before and after, counted one by one.
#[test]
fn flow_is_the_count_of_changed_sides() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        for (plane, axis, at) in [("0,0,0.02,0,0,-1", 2, 0.02), ("0.03,0,0,1,0,0", 0, 0.03)] {
            let mut wanted = [Vec::new(), Vec::new(), Vec::new()];
            for pair in all.windows(2) {
                let [(t0, before), (t1, after)] = pair else { continue };
                let (mut counts, mut mass) = ([0.0; 2], 0.0);
                for (id, a) in &before.units {
                    let Some(b) = after.units.get(id) else { continue };
                    let to = a.x + way(kind, a, b, t1 - t0);
                    let period = if kind == "periodic" && axis < 2 { PERIOD } else { f64::INFINITY };
                    let side = |x: f64| {
                        if period.is_finite() { ((x - at) / period).floor() } else { f64::from(x >= at) }
                    };
                    let net = (side(to[axis]) - side(a.x[axis])) * if axis == 2 { -1.0 } else { 1.0 };
                    counts[usize::from(net < 0.0)] += net.abs();
                    mass += net.max(0.0) * a.mass;
                }
                wanted[0].push(counts[0]);
                wanted[1].push(counts[1]);
                wanted[2].push(mass);
            }
            let done = measure(&run.folder, &["--flow", plane]);
            for (name, wanted) in ["forward", "backward", "mass_forward"].iter().zip(&wanted) {
                near(&format!("{kind} {plane} {name}"), &column(&done, name), wanted, 1e-9);
            }
            let passed: f64 = wanted[0].iter().chain(&wanted[1]).sum();
            assert!(passed > 0.0 || axis == 0, "{kind} {plane}: some pass");
        }
    }
}

/// Cubic between two frames, at a share of their distance h.
fn cubic([a, va]: [f64; 2], [b, vb]: [f64; 2], h: f64, s: f64) -> f64 {
    let (s2, s3) = (s * s, s * s * s);
    (2.0 * s3 - 3.0 * s2 + 1.0) * a
        + (s3 - 2.0 * s2 + s) * h * va
        + (3.0 * s2 - 2.0 * s3) * b
        + (s3 - s2) * h * vb
}

/// When the way between two frames passes a height, in small steps and by bisection [s].
fn passes(t: [f64; 2], a: [f64; 2], b: [f64; 2], height: f64) -> f64 {
    let h = t[1] - t[0];
    let inside = |s: f64| cubic(a, b, h, s) < height;
    let steps = 4000;
    let last = (0..steps).rfind(|k| inside(f64::from(*k) / 4000.0) == inside(0.0)).unwrap_or(0);
    let [mut low, mut high] = [f64::from(last) / 4000.0, f64::from(last + 1) / 4000.0];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if inside(middle) == inside(0.0) { &mut low } else { &mut high }) = middle;
    }
    t[0] + h * low
}

/// Stays below a height: the frames that hold a grain there, and where its path passes the height.
#[test]
fn residence_is_the_time_between_two_passages() {
    let height = 0.02;
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        let mut wanted: BTreeMap<u64, Vec<[f64; 2]>> = BTreeMap::new();
        let mut since: BTreeMap<u64, f64> = BTreeMap::new();
        for pair in all.windows(2) {
            let [(t0, before), (t1, after)] = pair else { continue };
            for (id, b) in &after.units {
                let Some(a) = before.units.get(id) else { continue };
                let at = || passes([*t0, *t1], [a.x.z, a.v.z], [b.x.z, b.v.z], height);
                match [a.x.z < height, b.x.z < height] {
                    [false, true] => drop(since.insert(*id, at())),
                    [true, false] => {
                        if let Some(from) = since.remove(id) {
                            wanted.entry(*id).or_default().push([from, at()]);
                        }
                    }
                    _ => {}
                }
            }
        }
        let done = measure(&run.folder, &["--residence", "box:-1,-1,-1,1,1,0.02"]);
        let [ids, entered, left] = ["id", "entered", "left"].map(|name| column(&done, name));
        let in_a_frame = |k: &usize| run.times().iter().any(|t| entered[*k] < *t && *t < left[*k]);
        let mut found: BTreeMap<u64, Vec<[f64; 2]>> = BTreeMap::new();
        for k in (0..ids.len()).filter(in_a_frame) {
            found.entry(ids[k] as u64).or_default().push([entered[k], left[k]]);
        }
        let flat = |of: &BTreeMap<u64, Vec<[f64; 2]>>| -> Vec<f64> {
            of.values().flatten().flatten().copied().collect()
        };
        // Clumps are named by the body or by a member.
        let (found, wanted) = match kind {
            "clumps" => {
                let sorted = |of| {
                    let mut all: Vec<f64> = flat(of);
                    all.sort_by(f64::total_cmp);
                    all
                };
                (sorted(&found), sorted(&wanted))
            }
            _ => (flat(&found), flat(&wanted)),
        };
        near(&format!("{kind} residence"), &found, &wanted, 1e-6);
    }
}

#[test]
fn tracks_are_the_rows_of_their_grains() {
    for (kind, scene, options) in kinds() {
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        let ids = &all.last().unwrap().1.ids;
        let id = ids[ids.len() / 2];
        let of = |f: &Frame| f.ids.iter().position(|i| *i == id).map(|k| f.spheres[k].0);
        let mut wanted = [Vec::new(), Vec::new(), Vec::new()];
        let mut passed: Option<(f64, Unit, Vec3)> = None;
        for (t, f) in &all {
            let Some(now) = of(f) else { continue };
            let moved =
                passed.map_or(Vec3::zeros(), |(before, a, sum)| sum + way(kind, &a, &now, t - before));
            passed = Some((*t, now, moved));
            wanted[0].push(now.x.z);
            wanted[1].push(moved.norm());
            wanted[2].push(now.v.norm());
        }
        let done = measure(&run.folder, &["--track", &id.to_string()]);
        for (name, wanted) in ["z", "way", "speed"].iter().zip(&wanted) {
            near(&format!("{kind} track {name}"), &column(&done, name), wanted, 1e-9);
        }
    }
}

/// The strain that a linear map of all displacements explains best, by its normal equations.
#[test]
fn strain_is_the_best_linear_map() {
    for (kind, scene, options) in kinds() {
        if kind == "empty" {
            continue; // no grains in the first frame
        }
        let run = Held::new(&scene, options);
        let all = frames(&run, kind);
        let mut wanted = [Vec::new(), Vec::new()];
        let first = &all[0].1;
        let mut ways: BTreeMap<u64, Vec3> = first.ids.iter().map(|id| (*id, Vec3::zeros())).collect();
        for (n, (t, f)) in all.iter().enumerate() {
            if n > 0 {
                let (before, a) = &all[n - 1];
                for (k, id) in a.ids.iter().enumerate() {
                    if let Some(l) = f.ids.iter().position(|i| i == id) {
                        *ways.get_mut(id).unwrap() += way(kind, &a.spheres[k].0, &f.spheres[l].0, t - before);
                    }
                }
            }
            let start: Vec<Vec3> = first.spheres.iter().map(|s| s.0.x).collect();
            let end: Vec<Vec3> = first.ids.iter().zip(&start).map(|(id, x)| x + ways[id]).collect();
            let mean = |of: &[Vec3]| of.iter().sum::<Vec3>() / of.len() as f64;
            let [from, to] = [mean(&start), mean(&end)];
            let (mut left, mut right) = (Mat3::zeros(), Mat3::zeros());
            for (a, b) in start.iter().zip(&end) {
                left += (b - to) * (a - from).transpose();
                right += (a - from) * (a - from).transpose();
            }
            let h = left * right.try_inverse().unwrap() - Mat3::identity();
            wanted[0].push(-h[(2, 2)]);
            wanted[1].push(1.0 - (h + Mat3::identity()).determinant());
        }
        let done = measure(&run.folder, &["--strain"]);
        near(&format!("{kind} strain zz"), &column(&done, "zz"), &wanted[0], 1e-7);
        near(&format!("{kind} strain volumetric"), &column(&done, "volumetric"), &wanted[1], 1e-7);
    }
}
