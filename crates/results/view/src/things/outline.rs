//! The points that stand out farthest, each way: what a camera must see to see everything.

use crate::appearance::scale::Range;
use crate::things::spheres::Spheres;
use geom::Vec3;
use record::WallsEnd;

/// Spheres of a layer that are looked at, at most: their outline hardly depends on more.
const SAMPLE: usize = 8192;

/// Share of grains left out at each end of each direction: strays that fell off must not shrink the rest to a dot.
const STRAYS: f64 = 0.01;

/// They are kept where leaving them out would gain less than this share of the width [–].
const NEAR: f64 = 0.12;

/// Places that stand out.
#[derive(Clone, Default)]
pub(crate) struct Outline {
    /// The farthest point in each direction [m], with how far.
    ends: Vec<(f64, Vec3)>,
}

impl Outline {
    /// Takes in spheres; without their strays when they are `loose`. Each of the `bodies` is one grain. What is past the `end` of all walls,
    /// and falls on, is left out, unless all of them are.
    pub fn add_spheres(
        &mut self,
        spheres: &Spheres,
        bodies: &[Vec<u32>],
        loose: bool,
        end: Option<WallsEnd>,
    ) {
        let mut alone = vec![true; spheres.len()];
        bodies.iter().flatten().for_each(|&row| alone[row as usize] = false);
        let alone: Vec<u32> = (0..spheres.len() as u32).filter(|&row| alone[row as usize]).collect();
        let all = || alone.chunks(1).chain(bodies.iter().map(Vec::as_slice));
        let is_past =
            |end: &WallsEnd, row: u32| end.is_past(&spheres.at(row as usize), spheres.radius(row as usize));
        let stays =
            |rows: &&[u32]| !end.as_ref().is_some_and(|end| rows.iter().all(|row| is_past(end, *row)));
        let mut grains: Vec<&[u32]> = all().filter(stays).collect();
        if grains.is_empty() {
            grains = all().collect();
        }
        let step = if loose { grains.len().div_ceil(SAMPLE).max(1) } else { 1 };
        let grains: Vec<&[u32]> = grains.into_iter().step_by(step).collect();
        for (n, direction) in directions().enumerate() {
            let far = |row: usize| spheres.at(row).dot(&direction) + spheres.radius(row);
            let farthest_of = |rows: &&[u32]| {
                let reach = rows.iter().map(|&row| (far(row as usize), row as usize));
                reach.max_by(|a, b| a.0.total_cmp(&b.0))
            };
            if let Some(row) = farthest(grains.iter().filter_map(farthest_of).collect(), loose) {
                let point = spheres.at(row) + direction * spheres.radius(row);
                self.take(n, point.dot(&direction), point);
            }
        }
    }

    /// Whether some spheres are far outside: strays that were left out.
    pub fn leaves_out(&self, spheres: &Spheres) -> bool {
        let points = self.points();
        (0..3).any(|k| {
            let of = Range::of(points.iter().map(|p| p[k]));
            let (all, far) = (Range::of(spheres.centre[k].iter()), NEAR * (of.hi - of.lo));
            all.hi > of.hi + far || all.lo < of.lo - far
        })
    }

    /// Takes in points.
    pub fn add(&mut self, points: &[Vec3]) {
        for (n, direction) in directions().enumerate() {
            for point in points {
                self.take(n, point.dot(&direction), *point);
            }
        }
    }

    fn take(&mut self, direction: usize, far: f64, point: Vec3) {
        match self.ends.get_mut(direction) {
            Some(end) if end.0 < far => *end = (far, point),
            Some(_) => {}
            None => self.ends.push((far, point)),
        }
    }

    /// The points [m].
    pub fn points(&self) -> Vec<Vec3> {
        let mut points: Vec<Vec3> = self.ends.iter().map(|(_, point)| *point).collect();
        points.dedup();
        points
    }
}

/// Which of (how far, which) is the farthest, strays left out when they are `loose` and far off.
fn farthest(mut reach: Vec<(f64, usize)>, loose: bool) -> Option<usize> {
    let order = |a: &(f64, usize), b: &(f64, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
    let first = *reach.iter().min_by(|a, b| order(a, b))?;
    let strays = (STRAYS * (reach.len() - 1) as f64).round() as usize;
    let (last, strays) = (reach.len() - 1 - strays, if loose { strays } else { 0 });
    let most = *reach.select_nth_unstable_by(strays, order).1;
    let least = *reach.select_nth_unstable_by(last, order).1;
    Some(if first.0 - most.0 <= NEAR * (most.0 - least.0) { first.1 } else { most.1 })
}

/// 98 directions: those of a lattice five wide, each once.
fn directions() -> impl Iterator<Item = Vec3> {
    let at = |n: i32| [n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2];
    let once = |p: &[i32; 3]| p.iter().any(|c| c % 2 != 0);
    (0..125).map(at).filter(once).map(|p| Vec3::from(p.map(f64::from)).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use stream::{Table, Values};

    #[test]
    fn a_ball_of_spheres_is_outlined_without_its_stray() {
        let outlined = |loose| reach(&with_strays(1), &[], loose);
        assert!(outlined(false) > 1e3 && (outlined(true) - 1.0).abs() < 1e-9);
        assert_eq!(directions().count(), 98);
    }

    /// One clump of 30 spheres, of 100 grains in all, is a stray as one sphere is.
    #[test]
    fn a_clump_far_off_is_one_stray_whatever_its_spheres() {
        let spheres = with_strays(30);
        let clump = (1000..1030).collect();
        let tens = (0..100).map(|k| (10 * k..10 * k + 10).collect());
        let bodies: Vec<Vec<u32>> = tens.chain([clump]).collect();
        assert!(reach(&spheres, &[], true) > 1e3, "30 of 1030 spheres are no strays");
        assert!((reach(&spheres, &bodies, true) - 1.0).abs() < 1e-9);
    }

    /// A plant from which much falls is looked at, not the falling grains: as many as they are, they are no part of it.
    #[test]
    fn what_has_fallen_past_all_walls_is_not_looked_at() {
        let table = with_strays(900);
        let spheres = Spheres::of(&table, "grains").expect("spheres");
        let reach = |end| {
            let mut outline = Outline::default();
            outline.add_spheres(&spheres, &[], true, end);
            outline.points().iter().map(|p| p.norm()).fold(0.0, f64::max)
        };
        let down = Vec3::x();
        assert!(reach(None) > 1e3 && reach(Some(WallsEnd { down, depth: 1e5 })) > 1e3);
        assert!((reach(Some(WallsEnd { down, depth: 1.5 })) - 1.0).abs() < 1e-9);
        assert!(reach(Some(WallsEnd { down, depth: -2.0 })) > 1e3, "all of them have fallen");
    }

    /// Farthest that an outline goes.
    fn reach(table: &Table, bodies: &[Vec<u32>], loose: bool) -> f64 {
        let mut outline = Outline::default();
        outline.add_spheres(&Spheres::of(table, "grains").expect("spheres"), bodies, loose, None);
        outline.points().iter().map(|p| p.norm()).fold(0.0, f64::max)
    }

    /// 1000 points on a ball of radius 1, and some 10 km off.
    fn with_strays(strays: usize) -> Table {
        let point = |i: usize| {
            let (a, z) = (2.4 * i as f64, (i as f64 + 0.5) / 500.0 - 1.0);
            let r = (1.0 - z * z).sqrt();
            Vec3::new(r * a.cos(), r * a.sin(), z)
        };
        let mut all: Vec<Vec3> = (0..1000).map(point).collect();
        all.extend(vec![Vec3::new(1e4, 0.0, 0.0); strays]);
        let mut table = Table::default();
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            table.push(axis, Values::F64(all.iter().map(|p| p[k]).collect())).expect("as many rows");
        }
        table.push("radius", Values::F64(vec![1e-12; all.len()])).expect("as many rows");
        table
    }
}
