//! Tables of a run: particles and walls at one time.

use crate::crossings::Builder;
use crate::model::Precision;
use dem::setup::{Particle, Setup, Wall, WallShape};
use dem::{ContactRecord, Simulation};
use serde_json::{Value, json};
use stream::{Table, Values};

fn numbers(precision: Precision, values: impl Iterator<Item = f64>) -> Values {
    match precision {
        Precision::F64 => Values::F64(values.collect()),
        Precision::F32 => Values::F32(values.map(|v| v as f32).collect()),
    }
}

/// The table of the topic `/particles`.
pub fn particles(rows: &[Particle], precision: Precision) -> Table {
    let one = |of: &dyn Fn(&Particle) -> f64| numbers(precision, rows.iter().map(of));
    Builder::new(rows.len())
        .with("x", one(&|p| p.position.x))
        .with("y", one(&|p| p.position.y))
        .with("z", one(&|p| p.position.z))
        .with("radius", one(&|p| p.radius))
        .with("vx", one(&|p| p.velocity.x))
        .with("vy", one(&|p| p.velocity.y))
        .with("vz", one(&|p| p.velocity.z))
        .with("wx", one(&|p| p.spin.x))
        .with("wy", one(&|p| p.spin.y))
        .with("wz", one(&|p| p.spin.z))
        .with("id", Values::U32(rows.iter().map(|p| p.id).collect()))
        .with("material", Values::U16(rows.iter().map(|p| p.material).collect()))
        .0
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
    pub material: u16,
    pub spheres: bool,
}

/// The heads of a setup's walls.
pub(crate) fn heads(setup: &Setup) -> Vec<WallHead> {
    let head =
        |w: &Wall| WallHead { material: w.material, spheres: matches!(w.shape, WallShape::Spheres(_)) };
    setup.walls.iter().map(head).collect()
}

/// The message of the topic `/surfaces`: planes and meshes at t = 0, and the motion of every wall.
pub(crate) fn surfaces(walls: &[Wall]) -> Value {
    let vector = |v: &geom::Vec3| json!([v.x, v.y, v.z]);
    let one = |w: &Wall| {
        let m = &w.motion;
        let motion = json!({
            "velocity": vector(&m.velocity), "turn": vector(&m.turn), "through": vector(&m.through),
            "amplitude": vector(&m.amplitude), "frequency": m.frequency,
        });
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
