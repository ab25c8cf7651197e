//! The specimen, the places of the stones, and their surfaces.

use crate::args::Args;
use crate::inputs::Grains;
use anyhow::Context;
use cli::OutputStream;
use std::fmt::Write as _;
use stones::{Library, Packing};
use stream::number_type::NumberType;
use stream::ply::{self, Element, Encoding, ListColumn, Ply};
use stream::{Table, Values};

/// Writes all outputs.
pub fn write(args: &Args, grains: &Grains, library: &Library, packing: &Packing) -> anyhow::Result<()> {
    let name = args.output.name();
    let ply = Ply { elements: vec![specimen(args, grains, packing)?], ..Ply::default() };
    let mut out = args.output.open()?;
    ply::write(&mut out, &ply, Encoding::BinaryLittleEndian)
        .with_context(|| format!("{name}: cannot write"))?;
    out.commit()?;
    if let Some(path) = &args.places {
        OutputStream::write_file(path, places(library, packing).as_bytes())?;
    }
    if let Some(path) = &args.surfaces {
        let mut bytes = Vec::new();
        ply::write(&mut bytes, &surfaces(library, packing)?, Encoding::BinaryLittleEndian)?;
        OutputStream::write_file(path, &bytes)?;
    }
    Ok(())
}

/// The grains; with rigid stones those of the soil only.
fn specimen(args: &Args, grains: &Grains, packing: &Packing) -> anyhow::Result<Element> {
    let kept = |k: &usize| args.bodies.is_none() || packing.clusters[*k] == 0;
    let rows: Vec<usize> = (0..grains.particles.len()).filter(kept).collect();
    let numbers = |of: &dyn Fn(usize) -> f64| Values::F64(rows.iter().map(|&k| of(k)).collect());
    let whole = |of: &dyn Fn(usize) -> u32| Values::U32(rows.iter().map(|&k| of(k)).collect());
    let mut table = Table::with_rows(rows.len());
    if grains.has_ids {
        table.push("id", whole(&|k| grains.particles[k].id))?;
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(name, numbers(&|k| grains.particles[k].position[axis]))?;
    }
    table.push("radius", numbers(&|k| grains.radii[k]))?;
    let moves =
        |v: fn(&dem::setup::Particle) -> geom::Vec3| grains.particles.iter().any(|p| v(p).norm() > 0.0);
    if moves(|p| p.velocity) {
        for (axis, name) in ["vx", "vy", "vz"].into_iter().enumerate() {
            table.push(name, numbers(&|k| grains.particles[k].velocity[axis]))?;
        }
    }
    if moves(|p| p.spin) {
        for (axis, name) in ["wx", "wy", "wz"].into_iter().enumerate() {
            table.push(name, numbers(&|k| grains.particles[k].spin[axis]))?;
        }
    }
    let stones = grains.materials.len() as u32;
    let class = |k: usize| match packing.clusters[k] {
        0 => 0,
        cluster => packing.classes[packing.placed[cluster as usize - 1].class].class,
    };
    let material =
        |k: usize| if packing.clusters[k] > 0 { stones } else { u32::from(grains.particles[k].material) };
    table.push("cluster", whole(&|k| packing.clusters[k]))?;
    table.push("class", whole(&class))?;
    table.push("material", whole(&material))?;
    Ok(Element { name: "vertex".to_owned(), table, lists: Vec::new() })
}

/// One line for each stone.
fn places(library: &Library, packing: &Packing) -> String {
    let mut text = "cluster,stone,class,x,y,z,qw,qx,qy,qz,scale,sieve_size,volume,mass,grains\n".to_owned();
    let density =
        packing.stone_mass / packing.placed.iter().map(|p| p.volume(&library.stones[p.stone])).sum::<f64>();
    for (k, p) in packing.placed.iter().enumerate() {
        let of = &library.stones[p.stone];
        let (c, q, volume) = (p.centre, p.orientation, p.volume(of));
        let name = of.name.replace('"', "\"\"");
        let class = packing.classes[p.class].class;
        let _ = writeln!(
            text,
            "{},\"{name}\",{class},{},{},{},{},{},{},{},{},{},{volume},{},{}",
            k + 1,
            c.x,
            c.y,
            c.z,
            q.w,
            q.i,
            q.j,
            q.k,
            p.scale,
            of.shape.sieve_size * p.scale,
            volume * density,
            p.grains.len()
        );
    }
    text
}

/// All stones as one mesh.
fn surfaces(library: &Library, packing: &Packing) -> anyhow::Result<Ply> {
    let (mut vertices, mut corners, mut clusters) = (Vec::new(), Vec::new(), Vec::new());
    for (k, p) in packing.placed.iter().enumerate() {
        let (mesh, first) = (p.mesh(&library.stones[p.stone]), vertices.len() as u32);
        corners.extend(mesh.faces.iter().flatten().map(|v| v + first));
        clusters.extend(std::iter::repeat_n(k as u32 + 1, mesh.vertices.len()));
        vertices.extend(mesh.vertices);
    }
    let mut table = Table::with_rows(vertices.len());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(name, Values::F64(vertices.iter().map(|v: &geom::Vec3| v[axis]).collect()))?;
    }
    table.push("cluster", Values::U32(clusters))?;
    let faces = corners.len() / 3;
    let list = ListColumn {
        name: "vertex_indices".to_owned(),
        position: 0,
        count_kind: NumberType::U8,
        ends: (1..=faces).map(|k| 3 * k).collect(),
        values: Values::U32(corners),
    };
    let vertex = Element { name: "vertex".to_owned(), table, lists: Vec::new() };
    let face = Element { name: "face".to_owned(), table: Table::with_rows(faces), lists: vec![list] };
    Ok(Ply { elements: vec![vertex, face], ..Ply::default() })
}
