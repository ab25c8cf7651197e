//! What is shown of a run besides grains and walls: bonds and cracks, arrows, the share of broken bonds of a grain.
//!
//! Bonds and arrows are tables of rods: x, y, z [m], a vector dx, dy, dz, and radius [m] of the grains beside it. A bond
//! reaches from (x, y, z) − d to (x, y, z) + d, and `broken` is 1 if it is, 2 if its grains are
//! far apart; an arrow starts at (x, y, z), and its vector is in
//! the unit of what it shows.

use crate::ViewError;
use geom::Vec3;
use record::column::{BROKEN, FIRST, FORCE, ID, POSITION, RADIUS, SECOND, VELOCITY, Vector as Columns};
use std::collections::HashMap;
use stream::{Table, Values};
use wear::WearField;

/// Columns of the vector of a rod.
pub(crate) const ALONG: Columns = ["dx", "dy", "dz"];

/// Radius of a bond and of a crack as drawn, over that of the smaller grain [–].
pub(crate) const BOND: f64 = 0.22;
pub(crate) const CRACK: f64 = 0.75;

/// Length of a long arrow, in radii of the grains [–], and radius and length of its head.
pub(crate) const ARROW: f64 = 5.0;
pub(crate) const HEAD: [f64; 2] = [0.32, 0.85];

/// Size of the grains beside bonds or arrows, which would be hidden in them [–].
pub(crate) const GRAINS: f64 = 0.5;

/// A crack that has opened wider than so many smaller radii is counted and not drawn: its grains are apart.
const OPEN: f64 = 0.5;

/// What is shown of a run besides grains and walls.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Extras {
    /// Bonds, and cracks where they broke.
    pub bonds: bool,
    /// Grains get the field `broken`: the share of their bonds that are broken.
    pub broken: bool,
    pub arrows: Option<Arrows>,
    /// A rod for each contact that carries a force.
    pub chains: bool,
    /// Grains get the fields `residence` and `origin`: how long they have been there, and whether from the start.
    pub history: bool,
    /// What the parts of walls are coloured by.
    pub wear: Option<WearField>,
}

/// What arrows show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Arrows {
    /// Velocity of each grain [m/s].
    Velocity,
    /// Force of each contact [N], at its point.
    Force,
    /// Velocities that a scene gives [m/s]: of belts, and of grains that come in.
    Planned,
}

impl Arrows {
    /// Its name.
    pub fn word(self) -> &'static str {
        match self {
            Arrows::Velocity | Arrows::Planned => "velocity",
            Arrows::Force => "force",
        }
    }

    /// The unit of its vectors.
    pub fn unit(self) -> &'static str {
        match self {
            Arrows::Velocity | Arrows::Planned => "m/s",
            Arrows::Force => "N",
        }
    }
}

impl Extras {
    pub(crate) fn needs_bonds(self) -> bool {
        self.bonds || self.broken
    }

    /// Whether a frame must wait for its bonds or contacts.
    pub(crate) fn waits(self) -> bool {
        self.needs_bonds() || self.chains
    }

    pub(crate) fn needs_contacts(self) -> bool {
        self.chains || self.arrows == Some(Arrows::Force)
    }
}

/// Three columns of a table.
pub(crate) fn vectors(table: &Table, columns: Columns) -> Option<Vec<[f64; 3]>> {
    let [x, y, z] = columns.map(|c| table.get(c).map(Values::to_f64));
    Some(x?.into_iter().zip(y?).zip(z?).map(|((x, y), z)| [x, y, z]).collect())
}

pub(crate) fn missing(topic: &'static str) -> ViewError {
    ViewError::Columns { topic }
}

pub(crate) fn rods(position: &[[f64; 3]], along: &[[f64; 3]], radius: Vec<f64>) -> Result<Table, ViewError> {
    let mut table = Table::with_rows(radius.len());
    for k in 0..3 {
        push(&mut table, POSITION[k], Values::F64(position.iter().map(|p| p[k]).collect()))?;
    }
    for k in 0..3 {
        push(&mut table, ALONG[k], Values::F64(along.iter().map(|d| d[k]).collect()))?;
    }
    push(&mut table, RADIUS, Values::F64(radius))?;
    Ok(table)
}

pub(crate) fn push(table: &mut Table, name: &str, values: Values) -> Result<(), ViewError> {
    table.push(name, values).map_err(|e| ViewError::Table { why: e.to_string() })
}

/// Arrows of the velocities of grains.
pub(crate) fn velocities(grains: &Table) -> Result<Table, ViewError> {
    let here = || missing(record::topic::PARTICLES);
    let position = vectors(grains, POSITION).ok_or_else(here)?;
    let velocity = vectors(grains, VELOCITY).ok_or_else(here)?;
    let radius = grains.get(RADIUS).map(Values::to_f64).ok_or_else(here)?;
    rods(&position, &velocity, radius)
}

/// Arrows of the forces on the first grain of each contact that carries one; `radius` [m] is that of the grains.
pub(crate) fn forces(contacts: &Table, radius: f64) -> Result<Table, ViewError> {
    let here = || missing(record::topic::CONTACTS);
    let position = vectors(contacts, POSITION).ok_or_else(here)?;
    let force = vectors(contacts, FORCE).ok_or_else(here)?;
    let acts: Vec<usize> = (0..force.len()).filter(|k| force[*k] != [0.0; 3]).collect();
    let of = |all: &[[f64; 3]]| acts.iter().map(|k| all[*k]).collect::<Vec<_>>();
    rods(&of(&position), &of(&force), vec![radius; acts.len()])
}

/// Middle and half of a bond from `a` to `b`; where the recorded middle is another one than theirs, the bond goes through
/// a periodic face, and it is its part at the nearer of the two.
fn between(a: [f64; 3], b: [f64; 3], recorded: [f64; 3], slack: f64) -> [[f64; 3]; 2] {
    let [a, b, recorded] = [a, b, recorded].map(Vec3::from);
    let half = 0.5 * (b - a);
    if (a + half - recorded).norm() <= slack {
        return [(a + half).into(), half.into()];
    }
    let near = if (a - recorded).norm() <= (b - recorded).norm() { a } else { b };
    let half = 0.5 * (recorded - near);
    [(near + half).into(), half.into()]
}

/// The bonds between the grains of a frame as rods, and for each grain the share of its bonds that are broken.
pub(crate) fn bonds(bonds: &Table, grains: &Table) -> Result<(Table, Vec<f64>), ViewError> {
    let here = || missing(record::topic::BONDS);
    let column = |table: &Table, name: &str| table.get(name).map(Values::to_f64);
    let position = vectors(grains, POSITION).ok_or_else(here)?;
    let radius = column(grains, RADIUS).ok_or_else(here)?;
    let id = column(grains, ID).ok_or_else(here)?;
    let rows: HashMap<u64, usize> = id.iter().enumerate().map(|(row, id)| (*id as u64, row)).collect();
    let (first, second) = (column(bonds, FIRST).ok_or_else(here)?, column(bonds, SECOND).ok_or_else(here)?);
    let broken = column(bonds, BROKEN).ok_or_else(here)?;
    let recorded = vectors(bonds, POSITION).ok_or_else(here)?;
    let (mut middles, mut along, mut radii, mut cracks) = (vec![], vec![], vec![], vec![]);
    let mut counts = vec![[0u32; 2]; id.len()];
    for k in 0..first.len() {
        let [a, b] = [first[k], second[k]].map(|id| rows.get(&(id as u64)).copied());
        let (Some(a), Some(b)) = (a, b) else { continue };
        let is_broken = broken[k] != 0.0;
        for row in [a, b] {
            counts[row][0] += 1;
            counts[row][1] += u32::from(is_broken);
        }
        let least = radius[a].min(radius[b]);
        let [middle, half] = between(position[a], position[b], recorded[k], 0.1 * least);
        let length = 2.0 * Vec3::from(half).norm();
        let open = length > radius[a] + radius[b] + OPEN * least;
        middles.push(middle);
        along.push(half);
        radii.push(least);
        cracks.push(u8::from(is_broken) + u8::from(is_broken && open));
    }
    let mut table = rods(&middles, &along, radii)?;
    push(&mut table, BROKEN, Values::U8(cracks))?;
    let share = |[all, broken]: &[u32; 2]| if *all == 0 { 0.0 } else { f64::from(*broken) / f64::from(*all) };
    Ok((table, counts.iter().map(share).collect()))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A table of these columns.
    pub(crate) fn table(columns: &[(&str, &[f64])]) -> Table {
        let mut table = Table::default();
        for (name, values) in columns {
            table.push(name, Values::F64(values.to_vec())).expect("fits");
        }
        table
    }

    /// Four grains in a row; the bond 1–2 is a crack, that of 2–3 has opened wide, that of 3–0 goes through a face.
    #[test]
    fn bonds_reach_from_grain_to_grain_and_wide_cracks_are_marked() {
        let grains = table(&[
            ("x", &[0.0, 2.0, 4.0, 9.0]),
            ("y", &[0.0; 4]),
            ("z", &[0.0; 4]),
            ("radius", &[1.0; 4]),
            ("id", &[10.0, 11.0, 12.0, 13.0]),
        ]);
        let of = table(&[
            ("x", &[1.0, 3.0, 6.5, 9.9, 7.0]),
            ("y", &[0.0; 5]),
            ("z", &[0.0; 5]),
            ("id_i", &[10.0, 11.0, 12.0, 10.0, 13.0]),
            ("id_j", &[11.0, 12.0, 13.0, 13.0, 99.0]),
            ("broken", &[0.0, 1.0, 1.0, 0.0, 0.0]),
        ]);
        let (rods, share) = bonds(&of, &grains).expect("complete");
        let column = |name| rods.get(name).map(Values::to_f64).unwrap_or_default();
        assert_eq!((column("x"), column("broken")), (vec![1.0, 3.0, 6.5, 9.45], vec![0.0, 1.0, 2.0, 0.0]));
        let dx = column("dx");
        assert!(dx[0] == 1.0 && dx[1] == 1.0 && (dx[3] - 0.45).abs() < 1e-12, "{dx:?}");
        assert_eq!(share, [0.0, 0.5, 1.0, 0.5]);
    }

    #[test]
    fn contacts_that_have_ended_have_no_arrow() {
        let contacts = table(&[
            ("x", &[1.0, 2.0]),
            ("y", &[0.0; 2]),
            ("z", &[0.0; 2]),
            ("fx", &[0.0, 0.0]),
            ("fy", &[0.0; 2]),
            ("fz", &[0.0, 3.0]),
        ]);
        let rods = forces(&contacts, 0.5).expect("complete");
        assert_eq!(rods.get("x").map(Values::to_f64), Some(vec![2.0]));
        assert_eq!(rods.get("dz").map(Values::to_f64), Some(vec![3.0]));
        assert!(forces(&table(&[("x", &[1.0])]), 0.5).is_err());
    }
}
