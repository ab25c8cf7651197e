//! Tables of a run: particles and walls at one time.

use crate::crossings::Builder;
use crate::model::Precision;
use dem::setup::{ClumpShape, Clumps, Particle, Setup, Wall, WallShape};
use dem::{BodyState, BondState, ContactRecord, Simulation, Snapshot, WallForce};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use stream::{Kind, Line, Rows, Table, Values};

fn numbers(precision: Precision, values: impl Iterator<Item = f64>) -> Values {
    match precision {
        Precision::F64 => Values::F64(values.collect()),
        Precision::F32 => Values::F32(values.map(|v| v as f32).collect()),
    }
}

/// The rows of the topic `/particles`; with clumps in the scene, the body of each row, too (its own id for a free sphere).
pub struct ParticleRows<'a> {
    /// Who they are.
    pub all: Snapshot<'a>,
    /// Of places and velocities.
    pub precision: Precision,
    /// Clumps by id, where the scene has any.
    pub bodies: Option<&'a [BodyState]>,
}

/// Numbers of a particle that are written in the precision asked for, in the order of [`measured`].
const MEASURED: [&str; 10] = ["x", "y", "z", "radius", "vx", "vy", "vz", "wx", "wy", "wz"];

fn measured(p: &Particle) -> [f64; 10] {
    let Particle { position: x, velocity: v, spin: w, radius, .. } = p;
    [x.x, x.y, x.z, *radius, v.x, v.y, v.z, w.x, w.y, w.z]
}

impl Rows for ParticleRows<'_> {
    fn fields(&self) -> Vec<(&str, Kind)> {
        let kind = match self.precision {
            Precision::F64 => Kind::F64,
            Precision::F32 => Kind::F32,
        };
        let whole = [("id", Kind::U32), ("material", Kind::U16)];
        let body = self.bodies.map(|_| ("body", Kind::U32));
        MEASURED.into_iter().map(|name| (name, kind)).chain(whole).chain(body).collect()
    }

    fn count(&self) -> usize {
        self.all.len()
    }

    fn put(&self, n: usize, row: &mut Line) {
        let p = self.all.particle(n);
        match self.precision {
            Precision::F64 => measured(&p).into_iter().for_each(|x| row.put(x)),
            Precision::F32 => measured(&p).into_iter().for_each(|x| row.put(x as f32)),
        }
        row.put(p.id);
        row.put(p.material);
        if let Some(bodies) = self.bodies {
            let before = bodies.partition_point(|b| b.id <= p.id);
            row.put(bodies[..before].last().filter(|b| b.has(p.id)).map_or(p.id, |b| b.id));
        }
    }
}

/// The table of the topic `/bodies`: a row for each rigid clump, at its centre of mass; the quaternion turns the frame that its shape was
/// given in.
pub fn bodies(rows: &[BodyState]) -> Table {
    let turn = |of: &dyn Fn(&BodyState) -> f64| Values::F64(rows.iter().map(of).collect());
    Builder::new(rows.len())
        .vectors(["x", "y", "z"], rows, |b| b.position)
        .with("qw", turn(&|b| b.orientation.w))
        .with("qx", turn(&|b| b.orientation.i))
        .with("qy", turn(&|b| b.orientation.j))
        .with("qz", turn(&|b| b.orientation.k))
        .vectors(["vx", "vy", "vz"], rows, |b| b.velocity)
        .vectors(["wx", "wy", "wz"], rows, |b| b.spin)
        .f64("mass", rows.iter().map(|b| b.mass))
        .f64("scale", rows.iter().map(|b| b.scale))
        .with("id", Values::U32(rows.iter().map(|b| b.id).collect()))
        .with("members", Values::U32(rows.iter().map(|b| b.members).collect()))
        .with("clump", Values::U16(rows.iter().map(|b| b.shape as u16).collect()))
        .0
}

/// The record `clumps`: each shape by its index. Spheres and centre of mass in the frame that it was given in, principal moments of inertia of
/// density 1; the range of scales that there may be, where there may be any.
pub(crate) fn clumps(clumps: &Clumps) -> BTreeMap<String, String> {
    let one = |k: usize, s: &ClumpShape| {
        let own = || clumps.scales_of(k as u32);
        let range = own().fold(None, |range: Option<(f64, f64)>, (low, high)| {
            Some(range.map_or((low, high), |r| (r.0.min(low), r.1.max(high))))
        });
        let sphere = |(c, r): &(geom::Vec3, f64)| {
            let c = s.centre + s.frame * c;
            [c.x, c.y, c.z, *r]
        };
        let centre = [s.centre.x, s.centre.y, s.centre.z];
        json!({
            "name": s.name, "material": s.material, "volume": s.volume, "inertia": s.inertia, "centre": centre,
            "spheres": s.spheres.iter().map(sphere).collect::<Vec<_>>(), "scales": range,
        })
    };
    clumps.shapes.iter().enumerate().map(|(k, s)| (k.to_string(), one(k, s).to_string())).collect()
}

/// The table of the topic `/contacts`.
pub(crate) fn contacts(rows: &[ContactRecord], precision: Precision) -> Table {
    let one = |of: &dyn Fn(&ContactRecord) -> f64| numbers(precision, rows.iter().map(of));
    Builder::new(rows.len())
        .with("x", one(&|c| c.point.x))
        .with("y", one(&|c| c.point.y))
        .with("z", one(&|c| c.point.z))
        .with("nx", one(&|c| c.normal.x))
        .with("ny", one(&|c| c.normal.y))
        .with("nz", one(&|c| c.normal.z))
        .with("fx", one(&|c| c.force.x))
        .with("fy", one(&|c| c.force.y))
        .with("fz", one(&|c| c.force.z))
        .with("overlap", one(&|c| c.overlap))
        .with("id_i", Values::U32(rows.iter().map(|c| c.i).collect()))
        .with("id_j", Values::U32(rows.iter().map(|c| c.j).collect()))
        .with("kind", Values::U16(rows.iter().map(|c| u16::from(c.wall)).collect()))
        .with("work", one(&|c| c.work))
        .0
}

/// The table of the topic `/bonds`: a row for each bond that there was at the start, half-way between its particles.
pub(crate) fn bonds(rows: &[BondState], precision: Precision) -> Table {
    let one = |of: &dyn Fn(&BondState) -> f64| numbers(precision, rows.iter().map(of));
    Builder::new(rows.len())
        .with("x", one(&|b| b.middle.x))
        .with("y", one(&|b| b.middle.y))
        .with("z", one(&|b| b.middle.z))
        .with("fx", one(&|b| b.force.x))
        .with("fy", one(&|b| b.force.y))
        .with("fz", one(&|b| b.force.z))
        .with("mx_i", one(&|b| b.moments[0].x))
        .with("my_i", one(&|b| b.moments[0].y))
        .with("mz_i", one(&|b| b.moments[0].z))
        .with("mx_j", one(&|b| b.moments[1].x))
        .with("my_j", one(&|b| b.moments[1].y))
        .with("mz_j", one(&|b| b.moments[1].z))
        .with("tension", one(&|b| b.stress[0]))
        .with("shear", one(&|b| b.stress[1]))
        .with("id_i", Values::U32(rows.iter().map(|b| b.ids[0]).collect()))
        .with("id_j", Values::U32(rows.iter().map(|b| b.ids[1]).collect()))
        .with("broken", Values::U8(rows.iter().map(|b| u8::from(b.broken.is_some())).collect()))
        .with("broken_at", Values::F64(rows.iter().map(|b| b.broken.unwrap_or(0.0)).collect()))
        .0
}

/// The table of the topic `/walls`: all wall spheres as they are now; `None` when there is none.
pub(crate) fn wall_spheres(sim: &Simulation, walls: &[WallHead]) -> Option<Table> {
    let mut rows = Vec::new();
    for (index, wall) in walls.iter().enumerate().filter(|(_, w)| w.spheres) {
        rows.extend(sim.wall_spheres(index).into_iter().map(|(c, r)| (c, r, wall.material, index as u16)));
    }
    if rows.is_empty() {
        return None;
    }
    let table = Builder::new(rows.len())
        .vectors(["x", "y", "z"], &rows, |r| r.0)
        .f64("radius", rows.iter().map(|r| r.1))
        .with("material", Values::U16(rows.iter().map(|r| r.2).collect()))
        .with("wall", Values::U16(rows.iter().map(|r| r.3).collect()));
    Some(table.0)
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

/// The message of the topic `/wall_forces`: what acts on each wall now [N], and how far it was shifted [m].
pub(crate) fn wall_forces(time: f64, forces: &[WallForce], walls: &[WallHead]) -> Value {
    let vector = |v: &geom::Vec3| json!([v.x, v.y, v.z]);
    let one = |(f, w): (&WallForce, &WallHead)| json!({"name": w.name, "force": vector(&f.force), "shift": vector(&f.shift), "contacts": f.contacts});
    json!({"time": time, "walls": forces.iter().zip(walls).map(one).collect::<Vec<_>>()})
}

/// The message of the topic `/surfaces`: planes and meshes at t = 0, and the motion of every wall.
pub(crate) fn surfaces(walls: &[Wall]) -> Value {
    let vector = |v: &geom::Vec3| json!([v.x, v.y, v.z]);
    let one = |w: &Wall| {
        let m = &w.motion;
        let mut motion = json!({
            "velocity": vector(&m.velocity), "turn": vector(&m.turn), "through": vector(&m.through),
            "amplitude": vector(&m.amplitude), "frequency": m.frequency,
        });
        if (m.from, m.until) != (0.0, f64::INFINITY) {
            motion["from"] = m.from.into();
            // null: never.
            motion["until"] = m.until.into();
        }
        if let Some(s) = m.servo {
            motion["servo"] =
                json!({"direction": vector(&s.direction), "force": s.force, "speed_limit": s.speed_limit});
        }
        let shape = match &w.shape {
            WallShape::Spheres(s) => json!({"spheres": s.len()}),
            WallShape::Plane(p) => json!({"plane": {"point": vector(&p.point), "normal": vector(&p.normal)}}),
            WallShape::Mesh(m) => {
                json!({"mesh": {"vertices": m.vertices.iter().map(vector).collect::<Vec<_>>(), "faces": m.faces}})
            }
        };
        json!({"name": w.name, "material": w.material, "motion": motion, "shape": shape})
    };
    Value::Array(walls.iter().map(one).collect())
}
