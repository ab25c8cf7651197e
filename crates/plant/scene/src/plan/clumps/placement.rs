//! Positions of rigid clumps at t = 0: `[[body]]`, `[[particles]]` and `[[fill]]` with `clump`.

use crate::error::{Result, SceneError};
use crate::input::{ParticleTable, RunClumps};
use crate::keys::{Fill, OneOrRange, Particles};
use crate::plan::builder::PlanBuilder;
use crate::plan::grains::fill::{FILLED, LARGER, sizes};
use crate::plan::grains::packing::{Packing, bounds};
use crate::plan::grains::random::{CLUMPS, generator, random_orientation};
use dem::setup::Body;
use geom::{Shape, Vec3};
use nalgebra::{Quaternion, UnitQuaternion};
use record::Columns;
use record::column::{CLUMP, ID, ORIENTATION, ORIENTATION_REAL, POSITION, SCALE, SPIN, VELOCITY};

/// More than this is a mistake.
const MOST: u64 = 10_000_000;

/// w, x, y, z, of any length but 0.
fn turn(q: [f64; 4]) -> Option<UnitQuaternion<f64>> {
    UnitQuaternion::try_new(Quaternion::new(q[0], q[1], q[2], q[3]), 1e-9).filter(|q| q.norm().is_finite())
}

impl PlanBuilder<'_> {
    /// `[[body]]`: one clump each.
    pub(in crate::plan) fn bodies(&mut self) -> Result<()> {
        for (i, entry) in self.keys().body.iter().enumerate() {
            let shape = self.clump(&format!("body.{i}.clump"), &entry.clump)?;
            let Some(orientation) = turn(entry.quaternion) else {
                let value = format!("{:?}", entry.quaternion);
                let key = format!("body.{i}.quaternion");
                let cure = "give [w, x, y, z], such as [1, 0, 0, 0]";
                return Err(self.check.wrong(&key, value, "is not an orientation", cure));
            };
            self.clumps.placed.push(Body {
                id: self.next_id(),
                shape,
                scale: entry.scale,
                position: Vec3::from(entry.position),
                orientation,
                velocity: Vec3::from(entry.velocity),
                spin: Vec3::from(entry.spin),
            });
        }
        Ok(())
    }

    /// `[[particles]]` with `clump`: a clump for each row of a file.
    pub(in crate::plan) fn clump_file(&mut self, key: &str, entry: &Particles, clump: &str) -> Result<()> {
        let shape = self.clump(&format!("{key}.clump"), clump)?;
        let file = self.file(&format!("{key}.source"), &entry.source, |file| {
            ParticleTable::read(file, entry.length_factor())
        })?;
        if file.clumps.is_some() {
            let (at, cure) = (format!("{key}.clump"), "take it out: the clumps of the run keep their shapes");
            let why = "would place a clump at each sphere, and the file is a run with clumps";
            return Err(self.check.wrong(&at, format!("\"{clump}\""), why, cure));
        }
        let columns = file.columns();
        self.inputs.push(("particles".to_owned(), record::hash(&file.table)));
        self.warnings.extend(columns.unused(&known()));
        if file.table.rows() == 0 {
            let name = &file.name;
            self.warnings.push(format!("{name}: holds no clump: it has names of columns and no row"));
        }
        self.rows_of_clumps(&columns, |_| shape)
    }

    /// The clumps of a run, as its last frame has them. Each has the shape of that name.
    pub(in crate::plan) fn clumps_of_run(&mut self, entry: &Particles, clumps: &RunClumps) -> Result<()> {
        let columns = Columns { name: &entry.source, table: &clumps.rows };
        let kind = columns.needed(CLUMP, clumps.shapes.len() as f64 - 1.0)?;
        let mut shapes = vec![u32::MAX; clumps.shapes.len()];
        for &k in &kind {
            if shapes[k as usize] == u32::MAX {
                let cure = "take the [[clump]] over from the scene of that run";
                shapes[k as usize] = self.same_clump(&entry.source, &clumps.shapes[k as usize], cure)?;
            }
        }
        let first = self.clumps.placed.len();
        self.rows_of_clumps(&columns, |row| shapes[kind[row] as usize])?;
        self.read.settled_clumps.push(first..self.clumps.placed.len());
        Ok(())
    }

    /// Clumps by rows of position, orientation, scale, velocity, angular velocity and id.
    fn rows_of_clumps(&mut self, columns: &Columns, shape: impl Fn(usize) -> u32) -> Result<()> {
        let name = columns.name;
        let positions = columns.vectors(POSITION)?;
        let (velocities, spins) = (columns.vectors_or_zero(VELOCITY)?, columns.vectors_or_zero(SPIN)?);
        let vector = columns.vectors_or_zero(ORIENTATION)?;
        let or_one = |column: &str| match columns.table.get(column) {
            Some(_) => columns.numbers(column),
            None => Ok(vec![1.0; positions.len()]),
        };
        let (real, scales) = (or_one(ORIENTATION_REAL)?, or_one(SCALE)?);
        let ids = columns.indices(ID, f64::from(u32::MAX - 1))?;
        let mut next = self.next_id();
        for k in 0..positions.len() {
            let q = vector[k];
            let Some(orientation) = turn([real[k], q.x, q.y, q.z]) else {
                let why = format!("row {k}: the quaternion (qw, qx, qy, qz) has no length");
                return Err(SceneError::file(name, why, "write 1, 0, 0, 0 for no turn"));
            };
            let scale = scales[k];
            if !(scale > 0.0 && scale.is_finite()) {
                let why = format!("row {k}: scale = {scale} is not a factor above 0");
                return Err(SceneError::file(name, why, "write 1 for the size of the [[clump]]"));
            }
            let shape = shape(k);
            let id = ids.as_ref().map_or(next, |ids| ids[k]);
            next = next.wrapping_add(self.clumps.shapes[shape as usize].spheres.len() as u32);
            self.clumps.placed.push(Body {
                id,
                shape,
                scale,
                position: positions[k],
                orientation,
                velocity: velocities[k],
                spin: spins[k],
            });
        }
        Ok(())
    }

    /// `[[fill]]` with `clump`: clumps at random positions and orientations; the spheres that hold them are inside the shape and do not touch.
    pub(in crate::plan) fn fill_with_clumps(
        &mut self,
        index: usize,
        entry: &Fill,
        name: &str,
        shape: &Shape,
    ) -> Result<()> {
        let key = |k: &str| format!("fill.{index}.{k}");
        let kind = self.clump(&key("clump"), name)?;
        let clump = &self.clumps.shapes[kind as usize];
        let density = self.materials[clump.material as usize].density;
        let Some(corners) = bounds(shape) else {
            return Err(self.check.wrong(&key("shape"), &entry.shape, FILLED, "use one of these"));
        };
        let mut random = generator(entry.seed, CLUMPS, index as u64);
        let range = entry.scale.unwrap_or(OneOrRange { low: 1.0, high: 1.0 });
        let mut scales = sizes(entry, range, MOST, |scale| clump.mass(scale, density), &mut random);
        scales.sort_by(|a, b| b.total_cmp(a));
        if scales.is_empty() || scales.len() as u64 > MOST {
            let value = format!("{} clumps", scales.len());
            let why = "is not a number of clumps that can be placed";
            return Err(self.check.wrong(&key(entry.amount()), value, why, "ask for 1 to 10 million"));
        }
        let taken = self.taken();
        let reach = clump.reach();
        let mut packing = Packing::new(shape, corners, scales[0] * reach, &taken);
        let (mut id, members) = (self.next_id(), clump.spheres.len() as u32);
        for (n, &scale) in scales.iter().enumerate() {
            let Some(position) = packing.place(scale * reach, &mut random) else {
                let count = scales.len();
                let what = self.in_the_way();
                let why =
                    format!("only {n} of {count} clumps fit without their bounding spheres touching{what}");
                return Err(self.check.wrong(&key("shape"), &entry.shape, &why, LARGER));
            };
            let (orientation, velocity) = (random_orientation(&mut random), Vec3::from(entry.velocity));
            let spin = Vec3::zeros();
            self.clumps.placed.push(Body { id, shape: kind, scale, position, orientation, velocity, spin });
            id = id.wrapping_add(members);
        }
        Ok(())
    }

    /// All spheres that are placed: centre, radius [m].
    pub(in crate::plan) fn spheres(&self) -> Vec<(Vec3, f64)> {
        let mut all: Vec<(Vec3, f64)> = self.particles.iter().map(|p| (p.position, p.radius)).collect();
        for b in &self.clumps.placed {
            let shape = &self.clumps.shapes[b.shape as usize];
            let turn = b.orientation * shape.frame;
            let member = |(c, r): &(Vec3, f64)| (b.position + turn * (c * b.scale), r * b.scale);
            all.extend(shape.spheres.iter().map(member));
        }
        all
    }
}

/// Columns of a file of clumps that are read.
fn known() -> Vec<&'static str> {
    [&[ID], &POSITION[..], &[ORIENTATION_REAL], &ORIENTATION, &[SCALE], &VELOCITY, &SPIN].concat()
}
