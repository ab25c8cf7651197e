//! Small runs with known answers, made by hand.

use geom::Vec3;
use std::collections::BTreeMap;
use std::path::Path;
use stream::mcap::{Provenance, Writer};
use stream::{Table, Values};

/// A grain: id, place, velocity, radius, material.
#[derive(Clone, Copy)]
pub struct Grain {
    pub id: u32,
    pub place: Vec3,
    pub velocity: Vec3,
    pub radius: f64,
    pub material: u16,
}

/// A grain at rest of material 0.
pub fn grain(id: u32, place: [f64; 3], radius: f64) -> Grain {
    Grain { id, place: place.into(), velocity: Vec3::zeros(), radius, material: 0 }
}

/// Grains at rest of one radius, ids in order.
pub fn at_rest(places: impl IntoIterator<Item = [f64; 3]>, radius: f64) -> Vec<Grain> {
    (0..).zip(places).map(|(id, place)| grain(id, place, radius)).collect()
}

/// A contact: grain, partner, whether that is a wall, point, normal, force, sliding work.
pub type Touch = (u32, u32, bool, [f64; 3], [f64; 3], [f64; 3], f64);

/// A stream that is being made.
pub struct Made(pub Writer<Vec<u8>>);

/// Ids, σ and τ [Pa] of a bond; when it broke [s] and what broke it (1 tension, 2 shear).
pub type BondRow = ([u32; 2], [f64; 2], Option<(f64, u8)>);

impl Made {
    /// Two materials of 2500 and 1000 kg/m³, `a` and `b`; a scene.
    pub fn new(scene: &str) -> Made {
        let mut made = Made(Writer::new(Vec::new(), &Provenance::default()).unwrap());
        let material = |name, density: f64| format!("{{\"name\": \"{name}\", \"density\": {density}}}");
        made.record("scene", &[("toml", scene)]);
        made.record("materials", &[("0", &material("a", 2500.0)), ("1", &material("b", 1000.0))]);
        made
    }

    pub fn record(&mut self, name: &str, pairs: &[(&str, &str)]) {
        let map: BTreeMap<String, String> =
            pairs.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        self.0.metadata(name, map).unwrap();
    }

    fn points(&mut self, topic: &str, time: f64, columns: Vec<(&str, Values)>) {
        let mut table = Table::with_rows(columns[0].1.len());
        columns.into_iter().for_each(|(name, values)| table.push(name, values).unwrap());
        self.0.points(topic, (time * 1e9).round() as u64, "world", &table).unwrap();
    }

    pub fn frame(&mut self, time: f64, grains: &[Grain]) -> &mut Made {
        let one = |of: &dyn Fn(&Grain) -> f64| Values::F64(grains.iter().map(of).collect());
        let columns = vec![
            ("x", one(&|g| g.place.x)),
            ("y", one(&|g| g.place.y)),
            ("z", one(&|g| g.place.z)),
            ("radius", one(&|g| g.radius)),
            ("vx", one(&|g| g.velocity.x)),
            ("vy", one(&|g| g.velocity.y)),
            ("vz", one(&|g| g.velocity.z)),
            ("id", Values::U32(grains.iter().map(|g| g.id).collect())),
            ("material", Values::U16(grains.iter().map(|g| g.material).collect())),
        ];
        self.points("/particles", time, columns);
        self
    }

    pub fn contacts(&mut self, time: f64, rows: &[Touch]) -> &mut Made {
        let one = |of: &dyn Fn(&Touch) -> f64| Values::F64(rows.iter().map(of).collect());
        let columns = vec![
            ("x", one(&|t| t.3[0])),
            ("y", one(&|t| t.3[1])),
            ("z", one(&|t| t.3[2])),
            ("nx", one(&|t| t.4[0])),
            ("ny", one(&|t| t.4[1])),
            ("nz", one(&|t| t.4[2])),
            ("fx", one(&|t| t.5[0])),
            ("fy", one(&|t| t.5[1])),
            ("fz", one(&|t| t.5[2])),
            ("overlap", one(&|_| 1e-6)),
            ("id_i", one(&|t| f64::from(t.0))),
            ("id_j", one(&|t| f64::from(t.1))),
            ("kind", Values::U8(rows.iter().map(|t| u8::from(t.2)).collect())),
            ("work", one(&|t| t.6)),
        ];
        self.points("/contacts", time, columns);
        self
    }

    /// Wall spheres of radius 10 mm.
    pub fn wall_spheres(&mut self, places: &[[f64; 3]]) -> &mut Made {
        let one = |axis: usize| Values::F64(places.iter().map(|p| p[axis]).collect());
        let radius = Values::F64(vec![0.01; places.len()]);
        let columns = vec![("x", one(0)), ("y", one(1)), ("z", one(2)), ("radius", radius)];
        self.points("/walls", 0.0, columns);
        self
    }

    /// Passages through outlet 0: time and id; grains of radius 10 mm of material 0.
    pub fn passages(&mut self, time: f64, rows: &[(f64, u32)]) -> &mut Made {
        let zero = || Values::F64(vec![0.0; rows.len()]);
        let columns = vec![
            ("x", zero()),
            ("y", zero()),
            ("z", zero()),
            ("time", Values::F64(rows.iter().map(|r| r.0).collect())),
            ("radius", Values::F64(vec![0.01; rows.len()])),
            ("id", Values::U32(rows.iter().map(|r| r.1).collect())),
        ];
        self.points("/crossings", time, columns);
        self
    }

    /// Bonds: ids, tension and shear [Pa], time of the break.
    pub fn bonds(&mut self, time: f64, rows: &[BondRow]) -> &mut Made {
        let columns = vec![
            ("tension", Values::F64(rows.iter().map(|r| r.1[0]).collect())),
            ("shear", Values::F64(rows.iter().map(|r| r.1[1]).collect())),
            ("id_i", Values::U32(rows.iter().map(|r| r.0[0]).collect())),
            ("id_j", Values::U32(rows.iter().map(|r| r.0[1]).collect())),
            ("broken", Values::U8(rows.iter().map(|r| u8::from(r.2.is_some())).collect())),
            ("broken_at", Values::F64(rows.iter().map(|r| r.2.map_or(0.0, |b| b.0)).collect())),
            ("mode", Values::U8(rows.iter().map(|r| r.2.map_or(0, |b| b.1)).collect())),
        ];
        self.points("/bonds", time, columns);
        self
    }

    pub fn json(&mut self, topic: &str, time: f64, text: &str) -> &mut Made {
        self.0.bytes(topic, "json", (time * 1e9).round() as u64, text.as_bytes()).unwrap();
        self
    }

    pub fn save(self, path: &Path) {
        std::fs::write(path, self.0.finish().unwrap()).unwrap();
    }
}

/// Numbers from 0 to 1 that look random, the same every time (Knuth's MMIX generator).
pub struct Chance(pub u64);

impl Chance {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A face-centred cubic lattice of `n`³ cells of edge `a`, from the origin on: four places a cell.
pub fn fcc(n: usize, a: f64) -> Vec<[f64; 3]> {
    let offsets = [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];
    let cells = (0..n * n * n).map(move |k| [k % n, k / n % n, k / n / n]);
    cells.flat_map(|c| offsets.map(|o| [0, 1, 2].map(|k| (c[k] as f64 + o[k]) * a))).collect()
}
