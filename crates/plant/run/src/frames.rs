//! Tables and messages of a run: particles, clumps, contacts, bonds and walls at one time.

use dem::setup::{ClumpShape, Clumps, Particle, Setup, Target, Wall, WallShape, cluster_of};
use dem::{BondState, BreakMode, CellReport, ClumpState, ContactRecord, Crack, Simulation, Snapshot};
use geom::Vec3;
use record::column::{self, FIRST, FORCE, ID, MATERIAL, NORMAL, POSITION, RADIUS, SECOND, SPIN, VELOCITY};
use record::{ClumpRecord, DomainRecord, Map, SurfaceShape, TableBuilder, WallRecord};
use scene::keys::Precision;
use serde_json::{Value, json};
use stream::{Line, NumberType, Rows, Table, Values};

pub(crate) fn kind(precision: Precision) -> NumberType {
    match precision {
        Precision::F64 => NumberType::F64,
        Precision::F32 => NumberType::F32,
    }
}

/// Particles in the order of their rows.
pub(crate) trait Particles: Sync {
    fn count(&self) -> usize;
    fn at(&self, n: usize) -> Particle;
}

impl Particles for Snapshot<'_> {
    fn count(&self) -> usize {
        self.len()
    }
    fn at(&self, n: usize) -> Particle {
        self.particle(n)
    }
}

impl Particles for &[Particle] {
    fn count(&self) -> usize {
        self.len()
    }
    fn at(&self, n: usize) -> Particle {
        self[n]
    }
}

/// The rows of the topic `/particles`; with clumps in the scene, the body of each row, too (its own id for a free sphere).
pub(crate) struct ParticleRows<'a, P> {
    /// The particles.
    pub all: P,
    /// Of positions and velocities.
    pub precision: Precision,
    /// Clumps by id, where the scene has any.
    pub clumps: Option<&'a [ClumpState]>,
    /// Clusters of particles by id; empty where there is none.
    pub clusters: &'a [(u32, u32)],
}

/// Numbers of a particle that are written in the precision asked for, in the order of [`measured`].
fn measured_columns() -> impl Iterator<Item = &'static str> {
    POSITION.into_iter().chain([RADIUS]).chain(VELOCITY).chain(SPIN)
}

fn measured(p: &Particle) -> [f64; 10] {
    let Particle { position: x, velocity: v, spin: w, radius, .. } = p;
    [x.x, x.y, x.z, *radius, v.x, v.y, v.z, w.x, w.y, w.z]
}

impl<P: Particles> Rows for ParticleRows<'_, P> {
    fn fields(&self) -> Vec<(&str, NumberType)> {
        let kind = kind(self.precision);
        let whole = [(ID, NumberType::U32), (MATERIAL, NumberType::U16)];
        let body = self.clumps.map(|_| (column::BODY, NumberType::U32));
        let cluster = (!self.clusters.is_empty()).then_some((column::CLUSTER, NumberType::U32));
        measured_columns().map(|name| (name, kind)).chain(whole).chain(body).chain(cluster).collect()
    }

    fn count(&self) -> usize {
        self.all.count()
    }

    fn put(&self, n: usize, row: &mut Line) {
        let p = self.all.at(n);
        match self.precision {
            Precision::F64 => measured(&p).into_iter().for_each(|x| row.put(x)),
            Precision::F32 => measured(&p).into_iter().for_each(|x| row.put(x as f32)),
        }
        row.put(p.id);
        row.put(p.material);
        if let Some(clumps) = self.clumps {
            let before = clumps.partition_point(|b| b.id <= p.id);
            row.put(clumps[..before].last().filter(|b| b.has(p.id)).map_or(p.id, |b| b.id));
        }
        if !self.clusters.is_empty() {
            row.put(cluster_of(self.clusters, p.id));
        }
    }
}

/// The table of the topic `/bodies`: a row for each rigid clump, at its centre of mass; the quaternion turns the frame that its shape was
/// given in.
pub(crate) fn clump_rows(rows: &[ClumpState]) -> Table {
    let turn = |b: &ClumpState| {
        let q = b.orientation;
        [q.w, q.i, q.j, q.k]
    };
    TableBuilder::new(rows.len())
        .vectors(POSITION, rows, |b| b.position)
        .orientations(rows, turn)
        .vectors(VELOCITY, rows, |b| b.velocity)
        .vectors(SPIN, rows, |b| b.spin)
        .numbers(column::MASS, rows.iter().map(|b| b.mass))
        .numbers(column::SCALE, rows.iter().map(|b| b.scale))
        .u32(ID, rows.iter().map(|b| b.id))
        .u32(column::MEMBERS, rows.iter().map(|b| b.members))
        .u16(column::CLUMP, rows.iter().map(|b| b.shape as u16))
        .done()
}

/// The record `clumps`: each shape by its index, in the frame that it was given in.
pub(crate) fn clumps(clumps: &Clumps) -> Map {
    let one = |(s, k): (&ClumpShape, u32)| {
        let sphere = |(c, r): &(Vec3, f64)| {
            let c = s.centre + s.frame * c;
            [c.x, c.y, c.z, *r]
        };
        ClumpRecord {
            centre: s.centre.into(),
            inertia: s.inertia,
            axes: Some([s.frame.w, s.frame.i, s.frame.j, s.frame.k]),
            material: s.material,
            name: s.name.clone(),
            scales: clumps.scales_of(k).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))),
            spheres: s.spheres.iter().map(sphere).collect(),
            volume: s.volume,
        }
    };
    ClumpRecord::to_map(&clumps.shapes.iter().zip(0..).map(one).collect::<Vec<_>>())
}

/// The table of the topic `/contacts`.
pub(crate) fn contacts(rows: &[ContactRecord], precision: Precision) -> Table {
    TableBuilder::of(rows.len(), kind(precision))
        .vectors(POSITION, rows, |c| c.point)
        .vectors(NORMAL, rows, |c| c.normal)
        .vectors(FORCE, rows, |c| c.force)
        .numbers(column::OVERLAP, rows.iter().map(|c| c.overlap))
        .u32(FIRST, rows.iter().map(|c| c.i))
        .u32(SECOND, rows.iter().map(|c| c.j))
        .u16(column::KIND, rows.iter().map(|c| u16::from(c.wall)))
        .numbers(column::WORK, rows.iter().map(|c| c.work))
        .done()
}

/// The table of the topic `/bonds`: a row for each bond that was made, half-way between its particles.
pub(crate) fn bonds(rows: &[BondState], precision: Precision) -> Table {
    TableBuilder::of(rows.len(), kind(precision))
        .vectors(POSITION, rows, |b| b.middle)
        .vectors(FORCE, rows, |b| b.force)
        .vectors(["mx_i", "my_i", "mz_i"], rows, |b| b.moments[0])
        .vectors(["mx_j", "my_j", "mz_j"], rows, |b| b.moments[1])
        .numbers(column::TENSION, rows.iter().map(|b| b.stress[0]))
        .numbers(column::SHEAR, rows.iter().map(|b| b.stress[1]))
        .u32(FIRST, rows.iter().map(|b| b.ids[0]))
        .u32(SECOND, rows.iter().map(|b| b.ids[1]))
        .numbers(column::TENSILE_STRENGTH, rows.iter().map(|b| b.strength[0]))
        .numbers(column::SHEAR_STRENGTH, rows.iter().map(|b| b.strength[1]))
        .with(column::MODE, Values::U8(rows.iter().map(|b| b.broken.map_or(0, |_| mode(b.mode))).collect()))
        .with(column::BROKEN, Values::U8(rows.iter().map(|b| u8::from(b.broken.is_some())).collect()))
        .with(column::BROKEN_AT, Values::F64(rows.iter().map(|b| b.broken.unwrap_or(0.0)).collect()))
        .done()
}

/// What broke a bond, as columns have it.
fn mode(mode: BreakMode) -> u8 {
    match mode {
        BreakMode::Tension => 1,
        BreakMode::Shear => 2,
    }
}

/// The table of the topic `/cracks`.
pub(crate) fn cracks(rows: &[Crack], precision: Precision) -> Table {
    TableBuilder::of(rows.len(), kind(precision))
        .vectors(POSITION, rows, |c| c.place)
        .vectors(NORMAL, rows, |c| c.normal)
        .numbers(RADIUS, rows.iter().map(|c| c.radius))
        .numbers(column::ENERGY, rows.iter().map(|c| c.energy))
        .with(column::TIME, Values::F64(rows.iter().map(|c| c.time).collect()))
        .with(column::MODE, Values::U8(rows.iter().map(|c| mode(c.mode)).collect()))
        .u32(FIRST, rows.iter().map(|c| c.ids[0]))
        .u32(SECOND, rows.iter().map(|c| c.ids[1]))
        .u32(column::CLUSTERS[0], rows.iter().map(|c| c.clusters[0]))
        .u32(column::CLUSTERS[1], rows.iter().map(|c| c.clusters[1]))
        .done()
}

/// A wall sphere now.
struct SphereNow {
    centre: Vec3,
    radius: f64,
    material: u16,
    wall: u16,
}

/// The table of the topic `/walls`: all wall spheres as they are now; `None` when there is none.
pub(crate) fn wall_spheres(sim: &Simulation, walls: &[WallHead]) -> Option<Table> {
    wall_table(walls, |index| sim.wall_spheres(index))
}

/// The same, of centres [m] and radii [m] that `spheres` gives for the wall of an index.
pub(crate) fn wall_table(walls: &[WallHead], spheres: impl Fn(usize) -> Vec<(Vec3, f64)>) -> Option<Table> {
    let of = |(index, wall): (usize, &WallHead)| {
        let (material, wall) = (wall.material, index as u16);
        let sphere = move |(centre, radius)| SphereNow { centre, radius, material, wall };
        spheres(index).into_iter().map(sphere)
    };
    let rows: Vec<SphereNow> = walls.iter().enumerate().filter(|(_, w)| w.spheres).flat_map(of).collect();
    if rows.is_empty() {
        return None;
    }
    let table = TableBuilder::new(rows.len())
        .vectors(POSITION, &rows, |r| r.centre)
        .numbers(RADIUS, rows.iter().map(|r| r.radius))
        .u16(MATERIAL, rows.iter().map(|r| r.material))
        .u16(column::WALL, rows.iter().map(|r| r.wall));
    Some(table.done())
}

/// What is kept of a wall when the engine has taken it.
pub(crate) struct WallHead {
    pub name: String,
    pub material: u16,
    pub spheres: bool,
}

/// The heads of a setup's walls.
pub(crate) fn heads(setup: &Setup) -> Vec<WallHead> {
    let head = |w: &Wall| WallHead {
        name: w.name.clone(),
        material: w.material,
        spheres: matches!(w.shape, WallShape::Spheres(_)),
    };
    setup.walls.iter().map(head).collect()
}

/// The message of the topic `/domain`: the periodic domain, with what strains it.
pub(crate) fn domain(time: f64, range: &[Option<(f64, f64)>; 3], cell: Option<&CellReport>) -> DomainRecord {
    let of = |v: &geom::Vec3| [v.x, v.y, v.z];
    let range = cell.map_or(range, |cell| &cell.range);
    let rows = |cell: &CellReport| [0, 1, 2].map(|a| [0, 1, 2].map(|b| cell.stress[(a, b)]));
    DomainRecord {
        time,
        low: range.map(|r| r.map(|r| r.0)),
        high: range.map(|r| r.map(|r| r.1)),
        strain: cell.map_or([0.0; 3], |cell| of(&cell.strain)),
        rate: cell.map_or([0.0; 3], |cell| of(&cell.rate)),
        stress: cell.map(rows),
        target: cell.map_or([None; 3], |cell| cell.target),
    }
}

/// What a servo follows: a number, or rows of time [s] and value.
fn target(target: &Target) -> Value {
    match target.rows() {
        [[_, value]] => json!(value),
        rows => json!(rows),
    }
}

/// The message of the topic `/surfaces`: planes and meshes at t = 0, and the motion of every wall.
pub(crate) fn surfaces(walls: &[Wall]) -> Value {
    let one = |w: &Wall| {
        let (surface, spheres) = match &w.shape {
            WallShape::Spheres(s) => (None, s.len()),
            WallShape::Plane(p) => (Some(SurfaceShape::Plane(*p)), 0),
            WallShape::Mesh(m) => (Some(SurfaceShape::Mesh(m.clone())), 0),
        };
        let servo = w.servo.as_ref().map(|s| {
            let what = if s.area.is_some() { "stress" } else { "force" };
            json!({"direction": s.direction, what: target(&s.target), "speed_limit": s.speed_limit})
        });
        let record = WallRecord { name: w.name.clone(), motion: w.motion.clone(), surface };
        record.to_json(w.material, spheres, servo)
    };
    Value::Array(walls.iter().map(one).collect())
}
