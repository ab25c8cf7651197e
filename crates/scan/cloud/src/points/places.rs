//! Points in one place: returns without an echo at the scanner, scans that were merged twice.
//!
//! Rules that compare a point with its neighbours judge each place once, whatever lies in it: a thousand points at the origin are one place, far from the scan, and not the
//! densest part of it. They take time n log n then, too.

use geom::Vec3;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashMap;

/// Points in one place that are no chance: so many, and such a share of all.
const MANY: (usize, f64) = (20, 0.01);

/// Many points in one place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Crowd {
    /// Points in this place.
    pub points: usize,
    /// Their common position [m].
    pub place: [f64; 3],
}

/// The places of points.
pub struct Places {
    /// Of each place its first row, in order.
    firsts: Vec<u32>,
    /// Of each row its place.
    place_of: Vec<u32>,
    /// The place with the most points, if there are two in any.
    pub crowd: Option<Crowd>,
}

impl Places {
    /// Of the finite `points` [m]. None if no two are in one place.
    pub fn of(points: &[Vec3]) -> Option<Places> {
        let mut sorted: Vec<(u64, u32)> = (0u32..).zip(points).map(|(row, p)| (hash(p), row)).collect();
        sorted.par_sort_unstable();
        let alike = |pair: &[(u64, u32)]| pair[0].0 == pair[1].0;
        if !sorted.windows(2).any(alike) {
            return None;
        }
        // Of each row the first one of its place; hashes of other places may be the same.
        let mut first_of: Vec<u32> = (0..points.len() as u32).collect();
        for run in sorted.chunk_by(|a, b| a.0 == b.0).filter(|run| run.len() > 1) {
            let mut firsts: Vec<u32> = Vec::new();
            for &(_, row) in run {
                let same = firsts.iter().find(|&&first| points[first as usize] == points[row as usize]);
                match same {
                    Some(&first) => first_of[row as usize] = first,
                    None => firsts.push(row),
                }
            }
        }
        let mut counts = vec![0u32; points.len()];
        first_of.iter().for_each(|&first| counts[first as usize] += 1);
        let most = (0..points.len()).max_by_key(|&row| (counts[row], std::cmp::Reverse(row)))?;
        let crowd =
            (counts[most] > 1).then(|| Crowd { points: counts[most] as usize, place: points[most].into() });
        let firsts: Vec<u32> =
            (0u32..).zip(&counts).filter(|(_, count)| **count > 0).map(|(row, _)| row).collect();
        let mut number = vec![0; points.len()];
        (0u32..).zip(&firsts).for_each(|(place, &row)| number[row as usize] = place);
        let place_of = first_of.iter().map(|&first| number[first as usize]).collect();
        crowd.is_some().then_some(Places { firsts, place_of, crowd })
    }

    /// Points that lie where another one lies already.
    pub fn repeated(&self) -> usize {
        self.place_of.len() - self.firsts.len()
    }

    /// A place with so many of the points that it is no chance.
    pub fn doubtful(&self) -> Option<Crowd> {
        self.crowd.filter(|crowd| {
            crowd.points >= MANY.0 && crowd.points as f64 >= MANY.1 * self.place_of.len() as f64
        })
    }
}

/// Rows of the finite `points` [m] that a rule keeps, in order, which sees each place once.
pub(crate) fn judged<E>(
    points: &[Vec3],
    rule: impl FnOnce(&[Vec3]) -> Result<Vec<u32>, E>,
) -> Result<Vec<u32>, E> {
    let Some(places) = Places::of(points) else { return rule(points) };
    let firsts: Vec<Vec3> = places.firsts.iter().map(|&row| points[row as usize]).collect();
    let mut stays = vec![false; firsts.len()];
    rule(&firsts)?.into_iter().for_each(|place| stays[place as usize] = true);
    Ok((0u32..)
        .zip(&places.place_of)
        .filter(|(_, place)| stays[**place as usize])
        .map(|(row, _)| row)
        .collect())
}

/// Rows of the finite `points` [m] that are farther than `apart` [m] from every row before them that stays, in order; with 0, the first of each place.
pub fn distinct(points: &[Vec3], apart: f64) -> Vec<u32> {
    if !(apart > 0.0) {
        return Places::of(points).map_or_else(|| (0..points.len() as u32).collect(), |places| places.firsts);
    }
    // No two that stay are in one cell of this width, so that few are looked at.
    let width = apart / 3f64.sqrt();
    let mut cells: HashMap<[i64; 3], u32> = HashMap::new();
    let mut rows = Vec::new();
    for (row, p) in (0u32..).zip(points) {
        let cell: [i64; 3] = [p.x, p.y, p.z].map(|c| (c / width).floor() as i64);
        let near = |other: &u32| (points[*other as usize] - p).norm_squared() <= apart * apart;
        let around = || {
            let range = -2..=2i64;
            range.clone().flat_map(move |a| {
                let range = -2..=2i64;
                range.flat_map(move |b| (-2..=2i64).map(move |c| [a, b, c]))
            })
        };
        let at = |[a, b, c]: [i64; 3]| {
            [cell[0].saturating_add(a), cell[1].saturating_add(b), cell[2].saturating_add(c)]
        };
        if !cells.contains_key(&cell) && !around().filter_map(|off| cells.get(&at(off))).any(near) {
            cells.insert(cell, row);
            rows.push(row);
        }
    }
    rows
}

/// Of the bits of a place; 0 and −0 are the same.
fn hash(p: &Vec3) -> u64 {
    let mut mixed = 0u64;
    for c in p.iter() {
        mixed = (mixed ^ (c + 0.0).to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^= mixed >> 32;
    }
    mixed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_once() {
        let mut points: Vec<Vec3> = (0..500).map(|k| Vec3::new(f64::from(k), 0.0, 0.0)).collect();
        assert!(Places::of(&points).is_none() && Places::of(&[]).is_none());
        assert_eq!(judged(&points, |p| Ok::<_, ()>(vec![p.len() as u32 - 1])), Ok(vec![499]));
        points.splice(100..100, [Vec3::new(0.0, -0.0, 0.0); 60]);
        let places = Places::of(&points).expect("60 at the origin");
        assert_eq!(places.crowd, Some(Crowd { points: 61, place: [0.0; 3] }));
        assert_eq!((places.repeated(), places.doubtful()), (60, places.crowd));
        // The rule sees 500 places and keeps the first one: all points of it stay.
        let kept = judged(&points, |p| {
            assert_eq!(p.len(), 500);
            Ok::<_, ()>(vec![0])
        });
        assert_eq!(kept, Ok([0].into_iter().chain(100..160).collect()));
        assert_eq!(distinct(&points, 0.0).len(), 500);
    }

    #[test]
    fn points_that_stay_are_apart_and_the_others_near() {
        let point = |i: u32| {
            let v = |s: u32| f64::from(i.wrapping_mul(2654435761).rotate_left(s) % 1000) / 100.0;
            Vec3::new(v(1), v(9), v(17))
        };
        let points: Vec<Vec3> = (0..800).map(point).collect();
        for apart in [0.2, 0.7, 2.0, 30.0] {
            let kept = distinct(&points, apart);
            let mut wanted: Vec<u32> = Vec::new();
            for (row, p) in (0u32..).zip(&points) {
                if wanted.iter().all(|&other| (points[other as usize] - p).norm_squared() > apart * apart) {
                    wanted.push(row);
                }
            }
            assert_eq!(kept, wanted, "{apart}");
        }
    }
}
