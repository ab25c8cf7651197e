//! Columns of a run at one time: grains, their contacts, grains that passed an outlet.

use crate::MeasureError;
use crate::periodic::PeriodicBox;
use crate::reading::table::Columns;
use geom::Vec3;
use record::column::{
    FIRST, FORCE, ID, KIND, MASS, MATERIAL, NORMAL, OUTLET, OVERLAP, POSITION, RADIUS, SECOND, TIME,
    VELOCITY, WORK,
};
use record::topic::{CONTACTS, CROSSINGS, PARTICLES};
use std::borrow::Cow;
use stream::Table;

/// All grains at one time.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// Time [s].
    pub time: f64,
    /// Identity of each grain.
    pub id: Vec<u64>,
    /// Centres [m].
    pub position: Vec<Vec3>,
    /// Velocities [m/s].
    pub velocity: Vec<Vec3>,
    /// Radii [m].
    pub radius: Vec<f64>,
    /// Index of the material.
    pub material: Vec<u16>,
    /// Masses [kg]; NaN where the material has no density.
    pub mass: Vec<f64>,
    /// The periodic box at this time.
    pub periodic: PeriodicBox,
    /// All columns of the message.
    pub table: Table,
    /// Volume of each over that of its ball [–]; empty without clumps.
    pub(crate) shares: Vec<f64>,
    /// Its grains, where some of its spheres are clumps.
    pub(crate) clumped: Option<Box<Frame>>,
}

impl Frame {
    /// A frame from the table of a message; `densities` [kg/m³] are by material, NaN where unknown.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite, radii not above zero.
    pub fn new(time: f64, table: Table, densities: &[f64]) -> Result<Frame, MeasureError> {
        let columns = Columns { topic: PARTICLES, time, table: &table };
        let position = columns.vectors(POSITION)?;
        let velocity = columns.vectors(VELOCITY)?;
        let radius = columns.positive(RADIUS)?;
        let id = columns.whole(ID)?;
        let material = columns.or_zero(MATERIAL)?.into_iter().map(|m| m as u16).collect::<Vec<_>>();
        let mass = material.iter().zip(&radius).map(|(m, r)| mass(*m, *r, densities)).collect();
        Ok(Frame { time, id, position, velocity, radius, material, mass, table, ..Frame::default() })
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there is no grain.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// The grains (rows) that are wanted.
    pub fn only(&self, wanted: impl Fn(usize) -> bool) -> Frame {
        self.rows(&(0..self.len() as u32).filter(|row| wanted(*row as usize)).collect::<Vec<u32>>())
    }

    fn rows(&self, rows: &[u32]) -> Frame {
        Frame {
            time: self.time,
            id: chosen(&self.id, rows),
            position: chosen(&self.position, rows),
            velocity: chosen(&self.velocity, rows),
            radius: chosen(&self.radius, rows),
            material: chosen(&self.material, rows),
            mass: chosen(&self.mass, rows),
            periodic: self.periodic,
            table: self.table.select(rows),
            shares: chosen(&self.shares, rows),
            clumped: None,
        }
    }

    /// With the images of grains that reach through a periodic face, so that all of each ball is in the periodic box.
    pub fn with_images(&self) -> Cow<'_, Frame> {
        if self.periodic.is_open() {
            return Cow::Borrowed(self);
        }
        let room = self.periodic.corners();
        let (mut rows, mut shifts): (Vec<u32>, Vec<Vec3>) =
            ((0..self.len() as u32).collect(), vec![Vec3::zeros(); self.len()]);
        for (row, (p, r)) in (0..).zip(self.position.iter().zip(&self.radius)) {
            let images = self.periodic.shifts((p.add_scalar(-r), p.add_scalar(*r)), room);
            for shift in images.into_iter().filter(|shift| *shift != Vec3::zeros()) {
                rows.push(row);
                shifts.push(shift);
            }
        }
        let mut all = self.rows(&rows);
        all.position.iter_mut().zip(&shifts).for_each(|(p, shift)| *p += shift);
        Cow::Owned(all)
    }

    /// Masses [kg], when all are known.
    ///
    /// # Errors
    /// A material without density.
    pub fn masses(&self) -> Result<&[f64], MeasureError> {
        match self.mass.iter().position(|m| m.is_nan()) {
            None => Ok(&self.mass),
            Some(row) => Err(MeasureError::Density { index: self.material.get(row).copied().unwrap_or(0) }),
        }
    }

    /// Mean diameter [m]; NaN without grains.
    pub fn mean_diameter(&self) -> f64 {
        2.0 * self.radius.iter().sum::<f64>() / self.len() as f64
    }

    /// Corners of the box around all grains, surfaces included [m].
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        self.position
            .iter()
            .zip(&self.radius)
            .fold(none, |(low, high), (p, r)| (low.inf(&p.add_scalar(-r)), high.sup(&p.add_scalar(*r))))
    }
}

/// The given rows of a column; none of a column that was left empty.
fn chosen<T: Copy>(column: &[T], rows: &[u32]) -> Vec<T> {
    rows.iter().filter_map(|row| column.get(*row as usize).copied()).collect()
}

/// Mass of a ball [kg]; NaN where the density is unknown.
pub(crate) fn mass(material: u16, radius: f64, densities: &[f64]) -> f64 {
    let density = densities.get(usize::from(material)).copied().unwrap_or(f64::NAN);
    geom::sphere::volume(radius) * density
}

/// What a grain touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Partner {
    /// Another grain, by id.
    Grain(u64),
    /// A wall, by index.
    Wall(u64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Grain i, by id.
    pub grain: u64,
    /// What it touches, j.
    pub partner: Partner,
    /// Where [m].
    pub point: Vec3,
    /// Unit normal from j to i [–].
    pub normal: Vec3,
    /// Force on i [N].
    pub force: Vec3,
    /// Sliding work since the frame before [J].
    pub work: f64,
    /// Overlap [m]; 0 where the run does not tell.
    pub overlap: f64,
}

impl Contact {
    /// Whether it is one at this time: a row without force tells the work of a contact that has ended since the frame before.
    pub fn acts(&self) -> bool {
        self.force != Vec3::zeros()
    }
}

/// All contacts at one time, and those that have ended since the frame before and did work.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Contacts {
    /// Time [s].
    pub time: f64,
    /// The rows, in the order of the message.
    pub rows: Vec<Contact>,
}

impl Contacts {
    /// The contacts of this time; to sum work, take all `rows`.
    pub fn acting(&self) -> impl Iterator<Item = &Contact> {
        self.rows.iter().filter(|c| c.acts())
    }

    /// Contacts from the table of a message: x y z, nx ny nz, fx fy fz, id_i, id_j, kind (0 pair, 1 wall), work.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite.
    pub fn new(time: f64, table: &Table) -> Result<Contacts, MeasureError> {
        let columns = Columns { topic: CONTACTS, time, table };
        let point = columns.vectors(POSITION)?;
        let normal = columns.vectors(NORMAL)?;
        let force = columns.vectors(FORCE)?;
        let (i, j, kind) = (columns.whole(FIRST)?, columns.whole(SECOND)?, columns.whole(KIND)?);
        let (work, overlap) = (columns.or_zero(WORK)?, columns.or_zero(OVERLAP)?);
        let row = |k: usize| Contact {
            grain: i[k],
            partner: if kind[k] == 0 { Partner::Grain(j[k]) } else { Partner::Wall(j[k]) },
            point: point[k],
            normal: normal[k],
            force: force[k],
            work: work[k],
            overlap: overlap[k],
        };
        Ok(Contacts { time, rows: (0..point.len()).map(row).collect() })
    }
}

/// A grain that crossed a storage plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// When [s].
    pub time: f64,
    /// Index of the outlet.
    pub outlet: usize,
    /// Where [m].
    pub position: Vec3,
    /// Identity.
    pub id: u64,
    /// Index of the material.
    pub material: u16,
    /// Mass [kg]; NaN where the material has no density.
    pub mass: f64,
}

impl Crossing {
    /// Crossings from the table of a message of `/crossings`.
    ///
    /// # Errors
    /// Columns that are missing, numbers that are not finite.
    pub fn list(time: f64, table: &Table, densities: &[f64]) -> Result<Vec<Crossing>, MeasureError> {
        let columns = Columns { topic: CROSSINGS, time, table };
        let position = columns.vectors(POSITION)?;
        let (times, radius) = (columns.numbers(TIME)?, columns.positive(RADIUS)?);
        let (id, material) = (columns.whole(ID)?, columns.or_zero(MATERIAL)?);
        let outlet = columns.or_zero(OUTLET)?;
        // The mass of a clump is written; that of a sphere follows from its radius.
        let written = columns.or_zero(MASS)?;
        let of_sphere = |k: usize| mass(material[k] as u16, radius[k], densities);
        let row = |k: usize| Crossing {
            time: times[k],
            outlet: outlet[k] as usize,
            position: position[k],
            id: id[k],
            material: material[k] as u16,
            mass: if written[k] > 0.0 { written[k] } else { of_sphere(k) },
        };
        Ok((0..position.len()).map(row).collect())
    }
}
