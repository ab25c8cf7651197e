//! The message of the topic `/surfaces`: planes and meshes at t = 0, and the motion of every wall.

use crate::column::POSITION;
use geom::motion::{Path, PathRow, Pose};
use geom::{Motion, Plane, Vec3, mesh::TriMesh};
use serde::Deserialize;
use serde_json::{Value, json};
use stream::{Table, Values};

/// One wall of the message.
#[derive(Debug, Clone, PartialEq)]
pub struct WallRecord {
    /// Name.
    pub name: String,
    /// Its motion, without that of a servo.
    pub motion: Motion,
    /// Its surface at t = 0; `None` of wall spheres, which are on the topic [`crate::topic::WALLS`].
    pub surface: Option<SurfaceShape>,
}

/// A wall that is not made of spheres.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceShape {
    /// Unbounded.
    Plane(Plane),
    /// Triangles, both sides of which act.
    Mesh(TriMesh),
}

impl WallRecord {
    /// The walls of a message.
    ///
    /// # Errors
    /// What is wrong, with the name of the wall.
    pub fn read_all(data: &[u8]) -> Result<Vec<WallRecord>, String> {
        let json: Value = serde_json::from_slice(data).map_err(|e| format!("not JSON: {e}"))?;
        let walls = json.as_array().ok_or("not a list of walls")?;
        walls.iter().enumerate().map(|(n, wall)| WallRecord::read(n, wall)).collect()
    }

    fn read(n: usize, wall: &Value) -> Result<WallRecord, String> {
        let name = wall["name"].as_str().map_or_else(|| format!("wall {n}"), str::to_owned);
        let motion = motion(&wall["motion"]).ok_or_else(|| format!("{name}: motion: a number is missing"))?;
        let surface = SurfaceShape::read(&wall["shape"]).map_err(|e| format!("{name}: {e}"))?;
        Ok(WallRecord { name, motion, surface })
    }

    /// The wall in the message; `material` is the index of its material, `spheres` their number, `servo` what its servo follows.
    pub fn to_json(&self, material: u16, spheres: usize, servo: Option<Value>) -> Value {
        let mut motion = to_json(&self.motion);
        if let Some(servo) = servo {
            motion["servo"] = servo;
        }
        let shape = self.surface.as_ref().map_or(json!({"spheres": spheres}), SurfaceShape::to_json);
        json!({"name": self.name, "material": material, "motion": motion, "shape": shape})
    }
}

impl SurfaceShape {
    /// The surface of a wall in the message; `None` of wall spheres.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(json: &Value) -> Result<Option<SurfaceShape>, String> {
        if let Some(plane) = json.get("plane") {
            let part = |name: &str| vector(&plane[name]).ok_or(format!("plane: {name}: not three numbers"));
            let plane = Plane::new(part("point")?, part("normal")?).map_err(|e| e.to_string())?;
            return Ok(Some(SurfaceShape::Plane(plane)));
        }
        let Some(mesh) = json.get("mesh") else { return Ok(None) };
        let rows = |name: &str| mesh[name].as_array().ok_or(format!("mesh: {name}: not a list"));
        let vertices = rows("vertices")?.iter().map(vector).collect::<Option<Vec<_>>>();
        let faces = rows("faces")?.iter().map(corners).collect::<Option<Vec<_>>>();
        let vertices = vertices.ok_or("mesh: a vertex is not three numbers")?;
        let faces = faces.ok_or("mesh: a face is not three vertex numbers")?;
        TriMesh::new(vertices, faces).map(|m| Some(SurfaceShape::Mesh(m))).map_err(|e| format!("mesh: {e}"))
    }

    fn to_json(&self) -> Value {
        match self {
            SurfaceShape::Plane(p) => json!({"plane": {"point": p.point, "normal": p.normal}}),
            SurfaceShape::Mesh(m) => json!({"mesh": {"vertices": m.vertices, "faces": m.faces}}),
        }
    }
}

/// A motion in messages and pages; what it does not do is left out, and so is `until` where it never ends.
pub fn to_json(m: &Motion) -> Value {
    let mut json = json!({
        "velocity": m.velocity, "turn": m.turn, "through": m.through,
        "amplitude": m.amplitude, "frequency": m.frequency,
    });
    if (m.from, m.until) != (0.0, f64::INFINITY) {
        json["from"] = m.from.into();
        // null: never.
        json["until"] = m.until.into();
    }
    if m.ramp != 0.0 {
        json["ramp"] = m.ramp.into();
    }
    if m.period.is_finite() {
        json["period"] = m.period.into();
    }
    if m.swing_frequency != 0.0 {
        json["swing"] = json!({"amplitude": m.swing, "frequency": m.swing_frequency});
    }
    if let Some(path) = &m.path {
        let row = |r: &PathRow| json!([r.time, r.shift.x, r.shift.y, r.shift.z, r.angle]);
        let rows: Vec<Value> = path.rows().iter().map(row).collect();
        json["path"] = json!({"about": path.about, "rows": rows});
    }
    if !m.then.is_empty() {
        json["then"] = m.then.iter().map(to_json).collect();
    }
    json
}

/// The motion of a wall; `None` when a number is missing.
fn motion(json: &Value) -> Option<Motion> {
    let swing = &json["swing"];
    let swings = !swing.is_null();
    let then = json["then"].as_array().into_iter().flatten().map(motion).collect::<Option<_>>()?;
    Some(Motion {
        velocity: vector(&json["velocity"])?,
        turn: vector(&json["turn"])?,
        through: vector(&json["through"])?,
        amplitude: vector(&json["amplitude"])?,
        frequency: json["frequency"].as_f64()?,
        from: json["from"].as_f64().unwrap_or(0.0),
        until: json["until"].as_f64().unwrap_or(f64::INFINITY),
        ramp: json["ramp"].as_f64().unwrap_or(0.0),
        period: json["period"].as_f64().unwrap_or(f64::INFINITY),
        swing: if swings { vector(&swing["amplitude"])? } else { Vec3::zeros() },
        swing_frequency: if swings { swing["frequency"].as_f64()? } else { 0.0 },
        path: if json["path"].is_null() { None } else { Some(path(&json["path"])?) },
        then,
    })
}

fn path(json: &Value) -> Option<Path> {
    let row = |row: &Value| {
        let [time, x, y, z, angle] = <[f64; 5]>::deserialize(row).ok()?;
        Some(PathRow { time, shift: Vec3::new(x, y, z), angle })
    };
    let rows = json["rows"].as_array()?.iter().map(row).collect::<Option<_>>()?;
    Path::new(vector(&json["about"])?, rows).ok()
}

/// Three finite numbers.
fn vector(json: &Value) -> Option<Vec3> {
    <[f64; 3]>::deserialize(json).ok().map(Vec3::from)
}

fn corners(json: &Value) -> Option<[u32; 3]> {
    <[u32; 3]>::deserialize(json).ok()
}

/// A table of wall spheres that are at their positions at t = 0, as they are in a pose.
pub fn moved(home: &Table, pose: &Pose) -> Table {
    each(home, |p| pose.position(&p))
}

/// A table of wall spheres that are at their positions in a pose, as they are at t = 0.
pub fn home(table: &Table, pose: &Pose) -> Table {
    each(table, |p| pose.home(&p))
}

/// A table whose positions are changed; one without positions stays as it is.
fn each(table: &Table, change: impl Fn(Vec3) -> Vec3) -> Table {
    let mut table = table.clone();
    let axes = POSITION.map(|name| table.get(name).map(Values::to_f64));
    let [Some(x), Some(y), Some(z)] = axes else { return table };
    let places: Vec<Vec3> = (0..x.len()).map(|i| change(Vec3::new(x[i], y[i], z[i]))).collect();
    for (k, name) in POSITION.into_iter().enumerate() {
        // A column as long as the one it replaces always fits.
        let _ = table.replace(name, Values::F64(places.iter().map(|p| p[k]).collect()));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_is_read_or_refused_by_what_is_wrong() {
        let mesh = |face: [u32; 3]| {
            let vertices = json!([[0, 0, 0], [1, 0, 0], [0, 1, 0]]);
            SurfaceShape::read(&json!({"mesh": {"vertices": vertices, "faces": [face]}}))
        };
        assert!(matches!(mesh([0, 1, 2]), Ok(Some(SurfaceShape::Mesh(_)))));
        assert!(mesh([0, 1, 3]).is_err_and(|e| e.contains("vertex 3")));
        assert_eq!(SurfaceShape::read(&json!({"spheres": 12})), Ok(None));
        let flat = json!({"plane": {"point": [0, 0, 0], "normal": [0, 0]}});
        assert!(SurfaceShape::read(&flat).is_err_and(|e| e.contains("normal")));
    }

    #[test]
    fn what_is_written_is_read_again() {
        let surface = Some(SurfaceShape::Plane("0,0,1,0,0,1".parse().unwrap()));
        let row = |time, x| PathRow { time, shift: Vec3::new(x, 0.0, 0.0), angle: 0.5 * x };
        let path = Path::new(Vec3::z(), vec![row(0.0, 0.0), row(1.0, 2.0)]).ok();
        let swing = Motion { swing: Vec3::y(), swing_frequency: 3.0, ramp: 0.1, ..Motion::default() };
        let first = Motion { frequency: 2.0, from: 0.5, until: 1.5, period: 4.0, ..Motion::default() };
        let motion = Motion::of(vec![first, swing, Motion { path, ..Motion::default() }]);
        let wall = WallRecord { name: "floor".to_owned(), motion, surface };
        let text = json!([wall.to_json(3, 0, None)]).to_string();
        assert_eq!(WallRecord::read_all(text.as_bytes()), Ok(vec![wall]));
    }
}
