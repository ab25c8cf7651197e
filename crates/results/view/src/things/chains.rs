//! Force chains: a rod for each contact that carries a force, between the centres of two grains, or from the centre of a grain
//! to its contact point on a wall.
//!
//! With the unit normal n from j to i, the force F on i, the overlap δ, centres c and radii r:
//!
//! ```text
//! fₙ = F·n      d = r_i + r_j − δ      c_j = c_i − d n
//! ```
//!
//! Where c_j is elsewhere, the grains touch through a periodic face: each has its part of the line, to the contact point.

use super::extras::{missing, push, rods, vectors};
use crate::ViewError;
use crate::appearance::scale::rounded_out;
use geom::Vec3;
use record::column::{FIRST, FORCE, ID, KIND, NORMAL, OVERLAP, POSITION, RADIUS, SECOND};
use std::collections::HashMap;
use stream::{Table, Values};

/// Normal force of the contact of a rod [N]: positive if it pushes.
pub(crate) const NORMAL_FORCE: &str = "normal_force";
/// In each row: how many contacts of the moment are drawn, and how many carry a force.
pub(crate) const COUNTS: [&str; 2] = ["drawn", "contacts"];
/// In each row: the sums of the sizes of their normal forces [N].
pub(crate) const FORCES: [&str; 2] = ["force_drawn", "force_of_all"];

/// Radius of the rod of a large force, over that of the grains [–].
pub(crate) const THICKEST: f64 = 0.45;

/// Size of the grains of a page beside them [–]: they are not faint there.
pub(crate) const GRAINS: f64 = 0.25;

/// Contacts of a moment that are drawn, at most: the strongest.
pub(crate) const MOST: usize = 10_000;

/// Grains that touch are not farther apart than this, over the sum of their radii [–].
const REACH: f64 = 1.2;

/// A grain of the frame.
#[derive(Clone, Copy)]
struct Grain {
    centre: Vec3,
    radius: f64,
}

/// The end of the scale of forces, most of which are not larger than `most` [N].
pub(crate) fn end_of_scale(most: f64) -> f64 {
    if most > 0.0 && most.is_finite() { rounded_out(most) } else { 1.0 }
}

/// Rods of the `most` strongest contacts between the grains of a frame, and between them and walls.
pub(crate) fn chains(contacts: &Table, grains: &Table, most: usize) -> Result<Table, ViewError> {
    let here = || missing(record::topic::CONTACTS);
    let column = |name: &str| contacts.get(name).map(Values::to_f64).ok_or_else(here);
    let [point, normal, force] = [POSITION, NORMAL, FORCE].map(|of| vectors(contacts, of));
    let (point, normal, force) = (point.ok_or_else(here)?, normal.ok_or_else(here)?, force.ok_or_else(here)?);
    let (first, second) = (column(FIRST)?, column(SECOND)?);
    let (kind, overlap) = (column(KIND)?, column(OVERLAP)?);
    let grains = by_id(grains)?;
    let (mut middles, mut along, mut radii) = (vec![], vec![], vec![]);
    let mut forces = Vec::new();
    let pushes = |k: usize| Vec3::from(force[k]).dot(&Vec3::from(normal[k]));
    let is_there = |k: usize| {
        let partner = kind[k] != 0.0 || grains.contains_key(&(second[k] as u64));
        partner && grains.contains_key(&(first[k] as u64))
    };
    let acts = (0..force.len()).filter(|k| force[*k] != [0.0; 3] && is_there(*k));
    let all: Vec<(usize, f64)> = acts.map(|k| (k, pushes(k))).collect();
    let sum = |of: &[(usize, f64)]| of.iter().map(|(_, force)| force.abs()).sum::<f64>();
    let (count, total) = (all.len(), sum(&all));
    let drawn = strongest(all, most);
    for &(k, push) in &drawn {
        let Some(i) = grains.get(&(first[k] as u64)) else { continue };
        let [point, normal] = [point[k], normal[k]].map(Vec3::from);
        let partner = grains.get(&(second[k] as u64)).filter(|_| kind[k] == 0.0);
        let (lines, radius) = match partner {
            Some(j) => (between([i, j], normal, overlap[k]), i.radius.min(j.radius)),
            None => (vec![[i.centre, on_wall(i, point, normal, overlap[k])]], i.radius),
        };
        for [from, to] in lines {
            middles.push((0.5 * (from + to)).into());
            along.push((0.5 * (to - from)).into());
            radii.push(radius);
            forces.push(push as f32);
        }
    }
    let mut table = rods(&middles, &along, radii)?;
    let rows = forces.len();
    push(&mut table, NORMAL_FORCE, Values::F32(forces))?;
    for (name, number) in COUNTS.into_iter().zip([drawn.len(), count]) {
        push(&mut table, name, Values::U32(vec![number as u32; rows]))?;
    }
    for (name, force) in FORCES.into_iter().zip([sum(&drawn), total]) {
        push(&mut table, name, Values::F64(vec![force; rows]))?;
    }
    Ok(table)
}

/// The `most` contacts with the largest forces, in their order; of equal ones the first.
fn strongest(mut contacts: Vec<(usize, f64)>, most: usize) -> Vec<(usize, f64)> {
    let order = |a: &(usize, f64), b: &(usize, f64)| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0));
    if contacts.len() > most {
        contacts.select_nth_unstable_by(most, order);
        contacts.truncate(most);
    }
    contacts.sort_unstable_by_key(|(number, _)| *number);
    contacts
}

fn by_id(grains: &Table) -> Result<HashMap<u64, Grain>, ViewError> {
    let here = || missing(record::topic::PARTICLES);
    let column = |name: &str| grains.get(name).map(Values::to_f64).ok_or_else(here);
    let (centre, radius, id) = (vectors(grains, POSITION).ok_or_else(here)?, column(RADIUS)?, column(ID)?);
    let grain = |k: usize| Grain { centre: centre[k].into(), radius: radius[k] };
    Ok(id.iter().enumerate().map(|(k, id)| (*id as u64, grain(k))).collect())
}

/// The line from centre to centre, or two parts of it where the grains touch through a periodic face.
fn between([i, j]: [&Grain; 2], normal: Vec3, overlap: f64) -> Vec<[Vec3; 2]> {
    let (reach, apart) = (i.radius + j.radius, i.centre - j.centre);
    if apart.norm() <= REACH * reach && apart.dot(&normal) > 0.0 {
        return vec![[i.centre, j.centre]];
    }
    let share = (reach - overlap) / reach;
    vec![
        [i.centre, i.centre - normal * (share * i.radius)],
        [j.centre, j.centre + normal * (share * j.radius)],
    ]
}

/// The contact point on a wall; the recorded one may lie behind a periodic face.
fn on_wall(i: &Grain, point: Vec3, normal: Vec3, overlap: f64) -> Vec3 {
    let is_near = (point - i.centre).norm() <= REACH * i.radius;
    if is_near { point } else { i.centre - normal * (i.radius - overlap).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::things::extras::tests::table;

    /// Grains of radius 1 in a row at x = 0.9, 2.8 and 9.1, in a box that is periodic at 0 and 10; the first also stands on a floor.
    fn row() -> (Table, Table) {
        let grains = table(&[
            ("x", &[0.9, 2.8, 9.1]),
            ("y", &[0.0; 3]),
            ("z", &[1.0; 3]),
            ("radius", &[1.0; 3]),
            ("id", &[5.0, 6.0, 7.0]),
        ]);
        // 5–6, 5–7 through the face, 5 on the floor, one that has ended, one of a grain that has left.
        let contacts = table(&[
            ("x", &[1.85, 0.0, 0.9, 5.0, 5.0]),
            ("y", &[0.0; 5]),
            ("z", &[1.0, 1.0, 0.01, 1.0, 1.0]),
            ("nx", &[-1.0, 1.0, 0.0, 1.0, 1.0]),
            ("ny", &[0.0; 5]),
            ("nz", &[0.0, 0.0, 1.0, 0.0, 0.0]),
            ("fx", &[-3.0, 2.0, 0.5, 0.0, 9.0]),
            ("fy", &[0.0; 5]),
            ("fz", &[0.7, 0.0, 4.0, 0.0, 0.0]),
            ("overlap", &[0.1, 0.2, 0.01, 0.0, 0.0]),
            ("id_i", &[5.0, 5.0, 5.0, 6.0, 99.0]),
            ("id_j", &[6.0, 7.0, 0.0, 7.0, 6.0]),
            ("kind", &[0.0, 0.0, 1.0, 0.0, 0.0]),
        ]);
        (contacts, grains)
    }

    fn of(rods: &Table, name: &str) -> Vec<f64> {
        rods.get(name).map(Values::to_f64).expect("there")
    }

    /// The sum of force times length is that of all contacts, whichever way the lines go.
    #[test]
    fn lines_carry_the_forces_recorded() {
        let (contacts, grains) = row();
        let rods = chains(&contacts, &grains, 10).expect("complete");
        assert_eq!(of(&rods, NORMAL_FORCE), [3.0, 2.0, 2.0, 4.0]);
        assert_eq!((of(&rods, COUNTS[0])[0], of(&rods, COUNTS[1])[0]), (3.0, 3.0));
        assert_eq!((of(&rods, FORCES[0])[0], of(&rods, FORCES[1])[0]), (9.0, 9.0));
        let [x, y, z] = ["dx", "dy", "dz"].map(|name| of(&rods, name));
        let drawn: f64 = of(&rods, NORMAL_FORCE)
            .iter()
            .enumerate()
            .map(|(k, force)| 2.0 * force * Vec3::new(x[k], y[k], z[k]).norm())
            .sum();
        let recorded = 3.0 * 1.9 + 2.0 * 1.8 + 4.0 * 0.99;
        assert!((drawn - recorded).abs() < 1e-12, "{drawn} J drawn, {recorded} J recorded");
    }

    #[test]
    fn through_a_periodic_face_each_grain_has_its_part_of_the_line() {
        let (contacts, grains) = row();
        let rods = chains(&contacts, &grains, 10).expect("complete");
        let along = of(&rods, "dx");
        let ends: Vec<[f64; 2]> = of(&rods, "x").iter().zip(&along).map(|(x, d)| [x - d, x + d]).collect();
        let near = |a: &[f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-12;
        assert!(near(&ends[0], [0.9, 2.8]), "{ends:?}");
        assert!(near(&ends[1], [0.9, 0.0]) && near(&ends[2], [9.1, 10.0]), "{ends:?}");
        let (z, dz) = (of(&rods, "z")[3], of(&rods, "dz")[3]);
        assert!((z + dz - 0.01).abs() < 1e-12 && (z - dz - 1.0).abs() < 1e-12, "to the floor: {z} {dz}");
        let longest = along.iter().zip(of(&rods, "dz")).map(|(x, z)| 2.0 * x.hypot(z)).fold(0.0, f64::max);
        assert!(longest <= 2.0, "no line across the box: {longest}");
    }

    /// None that is left out is stronger than one that is drawn, and the sums tell what is left out.
    #[test]
    fn of_many_contacts_the_strongest_are_drawn_and_the_others_are_counted() {
        let (contacts, grains) = row();
        let rods = chains(&contacts, &grains, 2).expect("complete");
        assert_eq!(of(&rods, NORMAL_FORCE), [3.0, 4.0]);
        assert_eq!((of(&rods, COUNTS[0])[0], of(&rods, COUNTS[1])[0]), (2.0, 3.0));
        assert_eq!((of(&rods, FORCES[0])[0], of(&rods, FORCES[1])[0]), (7.0, 9.0));
    }

    #[test]
    fn a_run_without_columns_is_refused() {
        let (contacts, _) = row();
        assert!(chains(&contacts, &table(&[("x", &[1.0])]), 10).is_err());
        assert!(chains(&table(&[("x", &[1.0])]), &row().1, 10).is_err());
    }
}
