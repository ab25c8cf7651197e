//! How many contacts grains have.
//!
//! ```text
//! Z = 2 C / N        Z_m = (2 C − N₁) / (N − N₀ − N₁)
//! ```
//!
//! with C contacts between N grains (a rigid clump is one), N₀ of which touch nothing and N₁ one grain: Z_m, without those rattlers, is the
//! mechanical coordination number of Thornton (2000), Géotechnique 50(1), DOI 10.1680/geot.2000.50.1.43. Contacts are
//! those of the run if it holds them, with whole bonds; walls then count in separate numbers. Otherwise two grains touch if their
//! distance is less than the sum of their radii, which is exact for every law whose forces end there, and walls are
//! unknown.

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::{NO_FRAMES, Observer};
use crate::reading::time_slice::{Gathered, TimeSlice};
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{Bonds, Contacts, Frame, MeasureError, Partner, Run, RunMessage};
use geom::Vec3;
use std::collections::{BTreeSet, HashMap};

/// Contact numbers of one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordination {
    /// Contacts of each grain with grains.
    pub of_grains: Vec<u32>,
    /// Contacts of each grain with walls; `None` when the run does not say.
    pub of_walls: Option<Vec<u32>>,
}

impl Coordination {
    /// From positions and radii, with the shortest ways of a periodic box, and from whole bonds.
    pub fn of_frame(frame: &Frame, bonds: Option<&Bonds>) -> Coordination {
        let touch = touching(frame).into_iter().map(|(a, b)| (frame.id[a], frame.id[b]));
        let (of_grains, _) = counted(frame, touch.chain(whole(bonds)), std::iter::empty());
        Coordination { of_grains, of_walls: None }
    }

    /// From contacts that the run recorded, and from whole bonds.
    pub fn of_contacts(frame: &Frame, contacts: &Contacts, bonds: Option<&Bonds>) -> Coordination {
        let pairs = contacts.acting().filter_map(|contact| match contact.partner {
            Partner::Grain(other) => Some((contact.grain, other)),
            Partner::Wall(_) => None,
        });
        let walls = contacts.acting().filter_map(|contact| match contact.partner {
            Partner::Wall(wall) => Some((contact.grain, wall)),
            Partner::Grain(_) => None,
        });
        let (of_grains, of_walls) = counted(frame, pairs.chain(whole(bonds)), walls);
        Coordination { of_grains, of_walls: Some(of_walls) }
    }

    /// Contacts of grain `row`, walls included where they are known.
    fn all(&self, row: usize) -> u32 {
        self.of_grains[row] + self.of_walls.as_ref().map_or(0, |w| w[row])
    }

    /// Grains with so many contacts: index 0 for none.
    pub fn histogram(&self) -> Vec<u64> {
        let mut bars = Vec::new();
        for row in 0..self.of_grains.len() {
            let count = self.all(row) as usize;
            if bars.len() <= count {
                bars.resize(count + 1, 0);
            }
            bars[count] += 1;
        }
        bars
    }

    /// Contacts between grains.
    pub fn pairs(&self) -> u64 {
        self.of_grains.iter().map(|n| u64::from(*n)).sum::<u64>() / 2
    }

    /// Z: contacts with grains, for each grain [–].
    pub fn mean(&self) -> f64 {
        2.0 * self.pairs() as f64 / self.of_grains.len() as f64
    }

    /// Contacts with grains and walls, for each grain [–]; NaN when walls are unknown.
    pub fn mean_with_walls(&self) -> f64 {
        let count = |w: &Vec<u32>| w.iter().map(|n| f64::from(*n)).sum::<f64>() / w.len() as f64;
        self.of_walls.as_ref().map_or(f64::NAN, |w| self.mean() + count(w))
    }

    /// Z_m: contacts of the grains that have at least two, for each of these, and the share of the others [–].
    pub fn mechanical(&self) -> (f64, f64) {
        let all: Vec<u32> = (0..self.of_grains.len()).map(|row| self.all(row)).collect();
        let bearing = all.iter().filter(|n| **n >= 2).count() as f64;
        let sum: f64 = all.iter().filter(|n| **n >= 2).map(|n| f64::from(*n)).sum();
        (sum / bearing, 1.0 - bearing / all.len() as f64)
    }
}

/// Ids of both grains of bonds that hold.
fn whole(bonds: Option<&Bonds>) -> impl Iterator<Item = (u64, u64)> {
    let rows = bonds.into_iter().flat_map(|b| &b.rows).filter(|bond| bond.broken.is_none());
    rows.map(|bond| (bond.grains[0], bond.grains[1]))
}

/// Partners of each grain among grains and among walls, from pairs of ids of spheres, and of spheres and walls. Several contacts of the same two (faces of a mesh,
/// members of clumps, a contact and a bond) count once.
fn counted(
    frame: &Frame,
    pairs: impl Iterator<Item = (u64, u64)>,
    walls: impl Iterator<Item = (u64, u64)>,
) -> (Vec<u32>, Vec<u32>) {
    let (of, count) = numbered(frame);
    let rows: HashMap<u64, usize> = frame.id.iter().copied().zip(of).collect();
    let mut partners = vec![BTreeSet::new(); count];
    let mut touched = vec![BTreeSet::new(); count];
    for (a, b) in pairs {
        // A partner that is not in the frame counts, too: it may have been left out by a filter.
        let (i, j) = (rows.get(&a).copied(), rows.get(&b).copied());
        let name = |row: Option<usize>, id: u64| row.map_or((1, id), |row| (0, row as u64));
        if name(i, a) != name(j, b) {
            for (row, partner) in [(i, name(j, b)), (j, name(i, a))] {
                if let Some(row) = row {
                    partners[row].insert(partner);
                }
            }
        }
    }
    for (grain, wall) in walls {
        if let Some(row) = rows.get(&grain) {
            touched[*row].insert(wall);
        }
    }
    let count = |sets: Vec<BTreeSet<_>>| sets.iter().map(|set| set.len() as u32).collect();
    (count(partners), touched.iter().map(|set: &BTreeSet<u64>| set.len() as u32).collect())
}

/// Number of the grain of each row, and how many there are: a rigid clump is one.
fn numbered(frame: &Frame) -> (Vec<usize>, usize) {
    let mut numbers = HashMap::new();
    let number = |body: u64| {
        let next = numbers.len();
        *numbers.entry(body).or_insert(next)
    };
    let of = frame.body().into_iter().map(number).collect();
    (of, numbers.len())
}

/// Pairs of spheres (rows of the frame) that overlap.
pub fn touching(frame: &Frame) -> Vec<(usize, usize)> {
    let largest = frame.radius.iter().copied().fold(0.0, f64::max);
    let (mut positions, mut rows) = (frame.position.clone(), (0..frame.len()).collect::<Vec<_>>());
    for (axis, period) in frame.periodic.range.iter().enumerate() {
        let Some((low, high)) = period else { continue };
        for k in 0..positions.len() {
            for (near, shift) in
                [(positions[k][axis] - low, high - low), (high - positions[k][axis], low - high)]
            {
                if near < 2.0 * largest {
                    let mut position = positions[k];
                    position[axis] += shift;
                    positions.push(position);
                    rows.push(rows[k]);
                }
            }
        }
    }
    if positions.is_empty() {
        return Vec::new();
    }
    let grid = geom::Grid::new(&positions, 2.0 * largest);
    let mut pairs = Vec::new();
    for a in 0..frame.len() {
        for k in grid.within(&positions, frame.position[a], frame.radius[a] + largest) {
            let b = rows[k as usize];
            let reach = frame.radius[a] + frame.radius[b];
            let way: Vec3 = positions[k as usize] - frame.position[a];
            if a < b && way.norm_squared() < reach * reach {
                pairs.push((a, b));
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

const FEW: MeasureError = MeasureError::FewGrains { what: "a contact number", most: 0, wanted: 1 };

/// Measures contact numbers over time.
#[derive(Default)]
pub struct ContactNumbers {
    gathered: Gathered,
    recorded: bool,
    last: Option<(Coordination, f64)>,
    /// Most grains of a frame.
    grains: usize,
}

impl ContactNumbers {
    fn count(&mut self, TimeSlice { frame, contacts, bonds }: TimeSlice, rows: &mut Vec<Row>) {
        let c = match &contacts {
            Some(contacts) => Coordination::of_contacts(&frame, contacts, bonds.as_ref()),
            None => Coordination::of_frame(&frame, bonds.as_ref()),
        };
        self.recorded |= contacts.is_some();
        rows.push(row(&frame, &c));
        self.grains = self.grains.max(frame.len());
        self.last = Some((c, frame.time));
    }
}

fn row(frame: &Frame, c: &Coordination) -> Row {
    let (mechanical, rattlers) = c.mechanical();
    let walls = c.of_walls.as_ref().map_or(f64::NAN, |w| w.iter().map(|n| f64::from(*n)).sum());
    let pairs = c.pairs() as f64;
    let grains = c.of_grains.len() as f64;
    vec![frame.time, grains, pairs, walls, c.mean(), c.mean_with_walls(), mechanical, rattlers]
}

impl Observer for ContactNumbers {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("grains", "1"),
            ("pairs", "1"),
            ("wall_contacts", "1"),
            ("coordination", "1"),
            ("coordination_with_walls", "1"),
            ("mechanical_coordination", "1"),
            ("rattlers", "1"),
        ])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        if let Some(slice) = self.gathered.add(message) {
            self.count(slice, rows);
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if let Some(slice) = self.gathered.end() {
            self.count(slice, rows);
        }
        let (c, time) = self.last.as_ref().ok_or(NO_FRAMES)?;
        if self.grains == 0 {
            return Err(FEW);
        }
        let (mechanical, rattlers) = c.mechanical();
        let summary = Summary::default()
            .with("coordination", "1", c.mean())
            .with("coordination_with_walls", "1", c.mean_with_walls())
            .with("mechanical_coordination", "1", mechanical)
            .with("rattlers", "1", rattlers)
            .with("time", "s", *time);
        let by_distance =
            "contacts from distances of grains, walls unknown: [output] contacts = true records all contacts";
        Ok(summary.note(if self.recorded { "contacts as recorded" } else { by_distance }))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let mut chart = Chart::new("Contact numbers");
        if rows.len() > 1 {
            let both = [("all grains", 4), ("without rattlers", 6)];
            chart = chart.columns(("time [s]", 0), "contacts of a grain [1]", &both, rows);
        }
        let Some((c, time)) = &self.last else { return chart };
        let mut points: Vec<[f64; 2]> =
            c.histogram().iter().enumerate().map(|(k, n)| [k as f64 - 0.5, *n as f64]).collect();
        points.push([points.len() as f64 - 0.5, 0.0]);
        let curve = Curve { name: String::new(), points, look: Look::Steps };
        chart.curves(&format!("contacts at {time:.4} s [1]"), "grains [1]", vec![curve])
    }
}

impl Measure for ContactNumbers {
    const NAME: &'static str = "contacts";
    const HELP: &'static str = "Coordination numbers, with and without rattlers";
    const FRAMES: Frames = Frames::Every;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<ContactNumbers>::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Contact;
    use crate::bonds::{Bond, Break};

    /// A row of three grains: the first two overlap, the others are bonded and apart; a broken bond does not count.
    #[test]
    fn bonds_count_alike_with_and_without_recorded_contacts() {
        let frame = Frame {
            id: vec![5, 6, 7],
            position: [0.0, 0.19, 0.395].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec(),
            velocity: vec![Vec3::zeros(); 3],
            radius: vec![0.1; 3],
            material: vec![0; 3],
            mass: vec![1.0; 3],
            ..Frame::default()
        };
        let bond = |a: u64, b: u64, broken: Option<f64>| Bond {
            grains: [a, b],
            force: Vec3::x(),
            stress: [0.0; 2],
            broken,
            by: Break::Unknown,
        };
        let bonds =
            Bonds { time: 0.0, rows: vec![bond(5, 6, None), bond(6, 7, None), bond(5, 7, Some(0.1))] };
        let touch = Contact {
            grain: 5,
            partner: Partner::Grain(6),
            point: Vec3::zeros(),
            normal: Vec3::x(),
            force: Vec3::x(),
            work: 0.0,
            overlap: 0.01,
        };
        let measured = |recorded: bool| {
            let (mut numbers, run, mut rows) = (ContactNumbers::default(), Run::default(), Vec::new());
            let mut messages = vec![RunMessage::Frame(frame.clone()), RunMessage::Bonds(bonds.clone())];
            if recorded {
                let rows = vec![touch];
                messages.push(RunMessage::Contacts(Contacts { time: 0.0, rows }));
            }
            messages.into_iter().for_each(|m| numbers.observe(&run, m, &mut rows).unwrap());
            numbers.end(&run, &mut rows).unwrap();
            numbers.last.unwrap().0.of_grains
        };
        assert_eq!((measured(false), measured(true)), (vec![1, 2, 1], vec![1, 2, 1]));
    }
}
