//! Grains and wall spheres of a setup as tables.

use dem::setup::{Setup, Wall, WallShape};
use geom::Vec3;
use stream::{Table, Values};

/// Spheres as columns.
#[derive(Default)]
struct Columns {
    place: Vec<Vec3>,
    radius: Vec<f64>,
    velocity: Vec<Vec3>,
    material: Vec<u16>,
    id: Vec<u32>,
    body: Vec<u32>,
}

/// The grains of a setup at the start.
pub fn table(setup: &Setup) -> anyhow::Result<Table> {
    let mut all = Columns::default();
    for p in &setup.particles {
        all.add((p.position, p.radius), p.velocity, p.material, [p.id, p.id]);
    }
    for body in &setup.clumps.placed {
        let shape = &setup.clumps.shapes[body.shape as usize];
        let spheres = shape.spheres_at(body.position, &body.orientation, body.scale);
        for (n, sphere) in spheres.enumerate() {
            all.add(sphere, body.velocity, shape.material, [body.id + n as u32, body.id]);
        }
    }
    let mut table = spheres(&all.place, all.radius)?;
    for (k, name) in ["vx", "vy", "vz"].into_iter().enumerate() {
        table.push(name, Values::F64(all.velocity.iter().map(|v| v[k]).collect()))?;
    }
    table.push("material", Values::U16(all.material))?;
    table.push("id", Values::U32(all.id))?;
    if !setup.clumps.placed.is_empty() {
        table.push("body", Values::U32(all.body))?;
    }
    Ok(table)
}

/// The spheres of a wall at t = 0.
pub fn wall_table(wall: &Wall) -> anyhow::Result<Table> {
    let all: &[(Vec3, f64)] = if let WallShape::Spheres(all) = &wall.shape { all } else { &[] };
    let places: Vec<Vec3> = all.iter().map(|(place, _)| *place).collect();
    spheres(&places, all.iter().map(|(_, radius)| *radius).collect())
}

fn spheres(places: &[Vec3], radius: Vec<f64>) -> anyhow::Result<Table> {
    let mut table = Table::with_rows(places.len());
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(name, Values::F64(places.iter().map(|p| p[k]).collect()))?;
    }
    table.push("radius", Values::F64(radius))?;
    Ok(table)
}

impl Columns {
    fn add(&mut self, (place, radius): (Vec3, f64), velocity: Vec3, material: u16, [id, body]: [u32; 2]) {
        self.place.push(place);
        self.radius.push(radius);
        self.velocity.push(velocity);
        self.material.push(material);
        self.id.push(id);
        self.body.push(body);
    }
}
